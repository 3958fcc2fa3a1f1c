// The transition inspector: point at a cell of a grid, an edge of a graph or a seam of a walk, and see the two
// windows, the turn that aligns them, the weights that mix them, and the seam.
//
// `showing.py` packs a scene; the scripts beside this file compute, draw maps, and draw bodies. All of it runs in the
// page, so it needs no Python. The hand on the bodies is the player's.

import { GraphMap, GridMap, PathMap } from "./inspector_maps.js";
import {
  Clip,
  bestAngle,
  bestShift,
  gridAround,
  jolts,
  transformed,
  seamOf,
  sums,
} from "./inspector_maths.js";
import { INSPECTOR_PARTS, INSPECTOR_STYLE, NAMES } from "./inspector_page.js";
import { Chart, Stage } from "./inspector_stage.js";
import { drawInspector } from "./inspector_views.js";
import { Hand } from "../../widgets/player_hand.js";
import { keepKeys, partOf } from "../../widgets/player_page.js";
import { Camera, inflated } from "../../widgets/player_scene.js";

/**
 * @import { Packed } from "../../widgets/player_scene.js"
 * @import { Colours, Grid, PackedGraph, PackedWalk, Pair } from "./inspector_maps.js"
 * @import { Cloud, PackedClip, SeamFrame, Skeleton, Sums, Transform, Weighting } from "./inspector_maths.js"
 * @import { Tab } from "./inspector_views.js"
 *
 * What an inspector shows, as `showing.py` packs it.
 * @typedef {object} InspectorScene
 * @property {string} alt
 * @property {number} fps
 * @property {number} window frames
 * @property {number} around frames of clip to show around a window
 * @property {number} cells of a grid that the page measures, on each side of the pair
 * @property {Tab[]} tabs
 * @property {Tab} tab the first that is shown
 * @property {Skeleton} skeleton
 * @property {PackedClip[]} clips
 * @property {Colours} colours
 * @property {Omit<Pair, "centre">} pick
 * @property {Omit<Grid, "from" | "values"> & { offset: number, minima: number[][] } | null} grid
 * @property {PackedGraph | null} graph
 * @property {PackedWalk | null} walk
 * @property {string} key
 * @property {Packed} data
 *
 * What the tab of the seam shows of a clip by itself: its jolts from a frame of the window on.
 * @typedef {{ from: number, values: (number | null)[] }} Alone
 */

/** @type {Record<Tab, string>} */
const TABS = { windows: "windows", turn: "turn θ", weights: "weights α", seam: "seam" };

export class Inspector {
  /** @type {Clip[]} */
  clips;
  /** @type {Stage} */
  stage;
  /** @type {Chart} */
  chart;
  /** @type {{ walk?: PathMap, graph?: GraphMap, grid: GridMap }} */
  maps;
  /** @type {Hand} */
  hand;
  /** @type {Pair & { before: number, after: number }} what is looked at */
  pick;
  /** @type {number} frames of clip that are shown before the window */
  before;
  /** @type {number} and after it */
  after;
  /** @type {Cloud} the points of the first window */
  cloud;
  /** @type {Cloud} of the second one */
  otherCloud;
  /** @type {Sums} */
  sums;
  /** @type {number} the turn that aligns them best, radians */
  best;
  /** @type {number} the turn that is shown */
  angle;
  /** @type {Transform} */
  transform;
  /** @type {number} where the body faces */
  heading;
  /** @type {Record<string, any>} what was computed for this pair */
  cache = {};
  /** @type {Weighting} */
  kind = "cubic";
  /** @type {number | null} the turn that the reader has chosen */
  theta = null;
  /** @type {boolean} whether the reader has turned the view of this pair */
  turned = false;
  /** @type {number[]} metres [x, z] by which the reader has panned the view */
  panned = [0, 0];
  /** @type {number} metres from the camera to what is looked at */
  reach = 4;
  /** @type {boolean} whether the parts of the page show what is looked at */
  ready = false;
  /** @type {boolean} whether the distances around the pair are to be measured */
  stale = false;
  /** @type {boolean} */
  playing = false;
  /** @type {number | null} when the reader pointed, while the picture does not show it */
  asked = null;
  /** @type {number} milliseconds from there to the picture */
  took = 0;
  /** @type {number | null} when the last picture was drawn, while it plays */
  last = null;
  /** @type {number | null} the next picture that the browser was asked for */
  waiting = null;

  /**
   * @param {HTMLElement} root
   * @param {InspectorScene} scene
   */
  constructor(root, scene) {
    this.root = root;
    this.scene = scene;
    this.camera = new Camera();
    this.fps = scene.fps;
    this.window = scene.window;
    this.camera.reset(0.22);
    this.tab = scene.tab;
    this.time = 0;
    this.visible = true;
    this.pictures = 0;
    root.classList.add("mocap-inspector");
    root.dataset.started = "true";
    root.innerHTML = `<style>${INSPECTOR_STYLE}</style>${INSPECTOR_PARTS}`;
    this.canvas = partOf(root, ".bodies", HTMLCanvasElement);
    this.scrub = partOf(root, ".scrub", HTMLInputElement);
    this.play = partOf(root, ".play", HTMLButtonElement);
    this.status = partOf(root, ".status", HTMLElement);
    this.now = partOf(root, ".now", HTMLElement);
    this.weights = partOf(root, ".kinds", HTMLSelectElement);
    this.key = partOf(root, ".names", HTMLElement);
    this.build();
    inflated(scene.data).then((bytes) => this.load(bytes));
  }

  get first() {
    return this.clips[this.pick.first];
  }
  get second() {
    return this.clips[this.pick.second];
  }

  build() {
    const { scene, root } = this;
    const tabs = partOf(root, ".tabs", HTMLElement);
    tabs.innerHTML = scene.tabs.map((tab) => `<button data-tab="${tab}">${TABS[tab]}</button>`).join("");
    tabs.hidden = scene.tabs.length === 1;
    keepKeys(root, "canvas, button, input, select");
  }

  /** @returns {NodeListOf<HTMLButtonElement>} */
  get tabButtons() {
    return this.root.querySelectorAll("[data-tab]");
  }

  /** @param {ArrayBuffer} bytes */
  load(bytes) {
    const { scene, root } = this;
    this.clips = scene.clips.map((clip) => new Clip(clip, scene.skeleton, bytes));
    this.stage = new Stage(this.canvas, this.camera);
    this.chart = new Chart(partOf(root, ".chart", HTMLCanvasElement), (value) => this.drag(value));
    const { grid } = scene;
    const keys = grid ? " N goes to the next minimum." : "";
    this.maps = { grid: new GridMap(this.mapCanvas("grid", true, keys), this) };
    this.loadPaths();
    root.classList.toggle("alone", !scene.graph && !scene.walk);
    if (grid) {
      root.classList.toggle("wide", grid.columns > 1.5 * grid.rows); // a long clip beside a short one gets the whole width
      const shades = new Uint8Array(bytes, grid.offset, grid.rows * grid.columns);
      const values = Float32Array.from(shades, (shade) => shade / 255);
      this.maps.grid.show({ ...grid, from: [0, 0], values }, grid.minima);
    }
    this.choose({ ...scene.pick, centre: [scene.pick.i, scene.pick.j] });
    this.hand = new Hand(this);
    this.listen();
    this.show(this.tab);
  }

  // The maps of a graph and of a walk, if there are such.
  loadPaths() {
    const { graph, walk } = this.scene;
    const [graphCanvas, walkCanvas] = [this.mapCanvas("graph", graph), this.mapCanvas("walk", walk)];
    if (graph) {
      graphCanvas.style.height = `${Math.min(300, 60 + 34 * this.clips.length)}px`;
      this.maps.graph = new GraphMap(graphCanvas, this);
      this.maps.graph.show(graph, this.clips);
    }
    if (walk) {
      this.maps.walk = new PathMap(walkCanvas, this);
      this.maps.walk.show(walk);
    }
  }

  /**
   * The canvas of a map, which is hidden if there is nothing to show.
   * @param {keyof typeof NAMES} kind
   * @param {unknown} shown
   * @param {string} [keys]
   */
  mapCanvas(kind, shown, keys = "") {
    const canvas = partOf(this.root, `.${kind}`, HTMLCanvasElement);
    canvas.hidden = !shown;
    canvas.setAttribute("aria-label", `${NAMES[kind]}${keys}`);
    return canvas;
  }

  listen() {
    for (const button of this.tabButtons) {
      const tab = this.scene.tabs.find((name) => name === button.dataset.tab);
      if (tab) button.onclick = () => this.show(tab);
    }
    this.play.onclick = () => this.toggle();
    this.weights.onchange = () => {
      this.kind = /** @type {Weighting} */ (this.weights.value); // the page offers no others
      this.compute();
      this.update();
    };
    partOf(this.root, ".best", HTMLButtonElement).onclick = () => {
      this.theta = null;
      this.compute();
      this.controls();
      this.update();
    };
    this.scrub.oninput = () => this.move(Number(this.scrub.value));
    this.resized = new ResizeObserver(() => this.update());
    for (const canvas of this.root.querySelectorAll("canvas")) this.resized.observe(canvas);
    this.seen = new IntersectionObserver((entries) => {
      this.visible = entries[entries.length - 1].isIntersecting;
      this.update();
    });
    this.seen.observe(this.root);
    const orbit = this.hand.orbit.bind(this.hand);
    this.hand.orbit = (yaw, pitch) => {
      this.turned = true;
      orbit(yaw, pitch);
    };
  }

  /**
   * The slider's value: an angle in degrees, or a frame.
   * @param {number} value
   */
  move(value) {
    this.toggle(false);
    if (this.tab === "turn") {
      this.theta = (value * Math.PI) / 180;
      this.compute();
    } else this.seek(value / this.fps);
    this.update();
  }

  /**
   * A finger on the chart, in the units of its axis: degrees, frames from 1, or seconds from the start of the window.
   * @param {number} value
   */
  drag(value) {
    const slid = {
      windows: value - 1,
      weights: value - 1,
      turn: value,
      seam: this.before + value * this.fps,
    }[this.tab];
    this.move(Math.round(Math.min(Math.max(slid, Number(this.scrub.min)), Number(this.scrub.max))));
  }

  // ---- what is looked at ----

  /**
   * Take a pair of windows. Its best rotation is shown until the reader drags another one.
   * @param {Pair} pick
   */
  choose(pick) {
    this.asked = performance.now();
    const other =
      !this.pick || String(pick.centre) !== String(this.pick.centre) || pick.number !== this.pick.number;
    this.pick = { before: this.scene.around, after: this.scene.around, ...pick };
    this.theta = null;
    if (other) {
      this.turned = false;
      this.panned = [0, 0];
    }
    this.compute();
    if (this.ready) this.controls();
    this.stale = other && !this.scene.grid;
    this.update();
  }

  compute() {
    const { first, second, pick, window, scene } = this;
    const { i, j } = pick;
    /**
     * @param {number} wanted
     * @param {number} have
     */
    const room = (wanted, have) => Math.max(0, Math.min(wanted, have));
    this.before = room(pick.before, Math.min(i, first.frames));
    this.after = room(pick.after, second.frames - j - window);
    this.cloud = first.cloud(i, window);
    this.otherCloud = second.cloud(j, window);
    this.sums = sums(this.cloud, this.otherCloud);
    this.best = bestAngle(this.sums);
    this.angle = this.theta ?? this.best;
    this.transform = bestShift(this.sums, this.angle);
    this.cache = {};
    this.heading = facing(this.cloud, scene.skeleton, first.joints(i + Math.floor(window / 2)));
  }

  /**
   * What only some tabs show is computed when it is first asked for: the seam, its jolts, and those of each clip alone.
   * @template T
   * @param {string} what
   * @param {() => T} compute
   * @returns {T}
   */
  once(what, compute) {
    return (this.cache[what] ??= compute());
  }

  /** @returns {SeamFrame[]} */
  get seam() {
    const { first, second, pick, transform, window, before, after, kind } = this;
    return this.once("seam", () =>
      seamOf(first, pick.i, second, pick.j, { transform, window, before, after, kind }),
    );
  }

  /** @returns {(number | null)[]} */
  get jolts() {
    const positions = this.seam.map((frame) => frame.positions);
    return this.once("jolts", () => jolts(positions, this.scene.skeleton.points, this.fps));
  }

  /**
   * The jolts of each clip by itself.
   * @returns {Alone[]}
   */
  get own() {
    const { first, second, pick, window, before, after } = this;
    /**
     * @param {Clip} clip
     * @param {number} at
     * @param {number} from
     * @param {number} to
     * @returns {Alone}
     */
    const alone = (clip, at, from, to) => {
      const start = Math.max(from, -at);
      const length = Math.min(to, clip.frames - at) - start;
      const frames = Array.from({ length }, (_, f) => clip.joints(at + start + f));
      return { from: start, values: jolts(frames, this.scene.skeleton.points, this.fps) };
    };
    return this.once("own", () => [
      alone(first, pick.i, -before, window + after),
      alone(second, pick.j, -before, window + after),
    ]);
  }

  /**
   * The second clip's joints at a frame of the window, aligned.
   * @param {number} p
   */
  aligned(p) {
    return this.second.joints(this.pick.j + p).map((position) => transformed(this.transform, position));
  }

  // ---- the player's words, which `Hand` uses ----

  get frames() {
    return this.tab === "seam" ? this.seam.length : this.window;
  }
  get seconds() {
    return (this.frames - 1) / this.fps;
  }
  frame() {
    return Math.min(this.frames - 1, Math.max(0, Math.round(this.time * this.fps)));
  }
  /** @param {number} time */
  seek(time) {
    this.time = Math.min(Math.max(time, 0), this.seconds);
    this.update();
  }

  /** @param {boolean} playing */
  toggle(playing = !this.playing) {
    this.playing = playing && this.tab !== "turn";
    this.last = null;
    this.play.textContent = this.playing ? "❚❚" : "▶";
    this.play.setAttribute("aria-label", this.playing ? "pause" : "play");
    this.update();
  }

  /** @param {Tab} tab */
  show(tab) {
    this.tab = tab;
    this.time = tab === "seam" ? 0 : (this.window >> 1) / this.fps;
    this.controls();
    this.toggle(tab === "seam" && !matchMedia("(prefers-reduced-motion: reduce)").matches);
    this.ready = true;
  }

  controls() {
    const turn = this.tab === "turn";
    /**
     * @param {string} what
     * @param {boolean} hidden
     */
    const set = (what, hidden) => {
      partOf(this.root, what, HTMLElement).hidden = hidden;
    };
    for (const button of this.tabButtons) {
      button.setAttribute("aria-pressed", String(button.dataset.tab === this.tab));
    }
    set(".play", turn);
    set(".best", !turn);
    set(".kind", !["weights", "seam"].includes(this.tab));
    const [low, high] = turn ? [-180, 180] : [0, this.frames - 1];
    Object.assign(this.scrub, { min: String(low), max: String(high), step: "1" });
    this.scrub.setAttribute("aria-label", turn ? "θ, degrees" : "frame");
  }

  update() {
    this.waiting ??= requestAnimationFrame((now) => this.tick(now));
  }

  /** @param {number} now */
  tick(now) {
    this.waiting = null;
    if (!this.root.isConnected || !this.visible) {
      this.last = null;
      return;
    }
    if (this.playing) {
      if (this.last !== null) {
        this.time += Math.min(0.25, (now - this.last) / 1000) * (this.tab === "seam" ? 0.5 : 0.25);
      }
      if (this.time > this.seconds) this.time = 0;
      this.last = now;
      this.update();
    }
    this.draw();
    if (this.asked) {
      this.took = performance.now() - this.asked;
      this.asked = null;
    }
    if (this.stale) {
      this.stale = false;
      requestAnimationFrame(() => {
        this.look();
        this.update();
      });
    }
  }

  // Measure the distances around a transition, after its picture has been drawn.
  look() {
    const { first, second, pick, window } = this;
    const [i, j] = pick.centre;
    const every = Math.max(1, Math.round(this.fps / 30));
    const grid = gridAround(first, i, second, j, window, this.scene.cells, every);
    const distances = grid.values.filter((v) => !Number.isNaN(v));
    const low = Math.min(...distances);
    const high = Math.max(...distances);
    const values = grid.values.map((v) => (v - low) / (high - low || 1));
    this.maps.grid.show({ ...grid, values }, [[i, j]]);
  }

  draw() {
    drawInspector(this);
  }

  /**
   * Say what is shown, beside what is looked at.
   * @param {string} text
   */
  showMessage(text) {
    this.now.textContent = text;
    this.scrub.setAttribute("aria-valuetext", text);
  }
}

/**
 * Where a body faces: across the line from its right to its left side, which is the mean of its points on each.
 * @param {Cloud} cloud
 * @param {Skeleton} skeleton
 * @param {number[][]} positions
 */
function facing(cloud, { bones }, positions) {
  /** @param {number} side */
  const mean = (side) =>
    bones
      .filter((bone) => bone[2] === side)
      .reduce(([x, z, n], [, to]) => [x + positions[to][0], z + positions[to][2], n + 1], [0, 0, 0]);
  const [left, right] = [1, 2].map(mean).map(([x, z, n]) => [x / (n || 1), z / (n || 1)]);
  return Math.atan2(-(left[1] - right[1]), left[0] - right[0]);
}
