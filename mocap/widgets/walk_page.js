// The page: a reader draws, the walk grows while it plays, and the current clip is highlighted. `walking_page.py` fills it.

import { prepare, unpack, Walk, nearest } from "./walk_search.js";
import { bodyAt, edgeAt, footprints } from "./walk_body.js";
import { arrays, firstLine, pathOnto, read, written } from "./walk_line.js";
import { Camera } from "./walk_camera.js";
import { Hands } from "./walk_hands.js";
import { LOOKS, rgb } from "./bodies.js";
import { penOf } from "./canvas.js";
import { COLOURS, Scene } from "./walk_scene.js";
import { drawSmall } from "./walk_small.js";
import { bvh, download, gif } from "./walk_saving.js";

/**
 * @import { Print } from "./walk_body.js"
 * @import { Graph, Line, SearchedWalk } from "./walk_search.js"
 */

const LAG = 34; // frames from figure to figure of the parade
const PARADE = 12; // figures of it
const RESTS = 1.5; // seconds at the end of a walk until it begins anew

/**
 * A part of the page.
 * @param {string} id
 */
function $(id) {
  const found = document.getElementById(id);
  if (!found) throw new Error(`The page has no #${id}.`);
  return found;
}

/**
 * @param {number} value
 * @param {number} low
 * @param {number} high
 */
const clamp = (value, low, high) => Math.max(low, Math.min(value, high));
/** @param {string} query */
const asked = (query) => matchMedia(query).matches;

/** @param {string} id */
function canvasOf(id) {
  const found = $(id);
  if (!(found instanceof HTMLCanvasElement)) throw new Error(`#${id} is no canvas.`);
  return found;
}

async function loaded() {
  const about = JSON.parse($("about").textContent ?? "");
  const packed = Uint8Array.from(atob(($("graph").textContent ?? "").trim()), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return prepare(unpack(about, new Uint8Array(await new Response(stream).arrayBuffer())));
}

export class Page extends Hands {
  /** @type {Walk} */
  walk;
  /** @type {number[][]} of the line, [z, x] */
  points;
  /** @type {Line} that is walked along */
  line;
  /** @type {Generator<SearchedWalk, void> | null} the search that is under way */
  growing = null;
  /** @type {SearchedWalk | null} the best walk of it so far */
  ghost = null;
  /** @type {Print[]} */
  prints = [];
  /** @type {number} when the line was drawn */
  begun = 0;
  /** @type {number | undefined} milliseconds from there to the first walk of the page */
  first;
  /** @type {number} width of the page, pixels */
  width = 0;
  /** @type {number} height of the page, pixels */
  height = 0;
  time = 0; // the frame that is shown
  figures = 1;
  above = false; // whether all of the line is seen
  rest = 0; // seconds since the walk is at its end
  sharp = 1; // as a fraction of the screen's pixels
  slow = 0; // pictures that came late, at most 20
  ticks = 0; // pictures

  /** @param {Graph} graph */
  constructor(graph) {
    super();
    this.graph = graph;
    this.about = graph.about;
    this.kind = Math.max(0, this.about.labels.indexOf("walk"));
    this.playing = !asked("(prefers-reduced-motion: reduce)");
    this.look = asked("(prefers-color-scheme: dark)") ? LOOKS.dark : LOOKS.light;
    this.moments = $("moments");
    this.canvas = canvasOf("stage");
    this.small = canvasOf("small");
    this.camera = new Camera();
    this.scene = new Scene(this.canvas, this.about.figure, PARADE);
    this.before = performance.now();
    this.listen();
    this.buttons();
    this.fit();
    if (!this.fromAddress()) this.set(firstLine(), false);
    this.aim(0, true);
    requestAnimationFrame((now) => this.picture(now));
  }

  get bits() {
    return 1 << this.kind;
  }

  // ---- a line, and the walk along it ----

  /**
   * Walk along points. If they begin near the figure, it continues from its position, and turns around if they lead back.
   * @param {number[][]} points
   * @param {boolean} announced
   */
  set(points, announced = true) {
    if (points.length < 80) {
      this.showMessage("Draw a longer line: a metre or more.");
      return;
    }
    if (this.walk?.frames && this.isNear(points[0])) this.points = this.redirect(points);
    else {
      this.points = points;
      this.walk = new Walk(this.graph);
      this.time = 0;
      this.prints = [];
    }
    this.line = arrays(this.points);
    this.walk.labels = this.bits;
    this.walk.follow(this.line);
    this.growing = null;
    this.ghost = null;
    this.shown = null;
    this.begun = performance.now();
    this.moments.hidden = true;
    if (announced) {
      history.replaceState(null, "", `#${this.about.labels[this.kind] ?? "any"}.${written(this.points)}`);
      document.body.classList.add("walking");
    }
  }

  /**
   * Whether the figure is near a point.
   * @param {number[]} point
   */
  isNear([pz, px]) {
    const [z, x] = this.position();
    return Math.hypot(pz - z, px - x) < 1.2;
  }

  /**
   * Cut the walk soon after the current frame, and return a path from its new end onto a line.
   * @param {number[][]} points
   */
  redirect(points) {
    const end = this.walk.cutAfter(this.time + 6);
    this.prints = this.prints.filter((print) => print.frame < this.walk.frames);
    const [z, x] = this.positionAt(end - 8);
    const position = this.positionAt(end);
    return pathOnto(points, position, Math.atan2(position[1] - x, position[0] - z));
  }

  fromAddress() {
    const [label, word] = location.hash.slice(1).split(".");
    const kind = this.about.labels.indexOf(label);
    const points = word && read(word);
    if (kind >= 0) this.choose(kind);
    if (points) this.set(points, false);
    return Boolean(points);
  }

  /** @param {number} kind */
  choose(kind) {
    this.kind = kind;
    for (const button of $("kinds").querySelectorAll("button")) {
      button.setAttribute("aria-pressed", String(button.id === `kind${kind}`));
    }
  }

  /**
   * Search on for some milliseconds, while less than three seconds of walk are left.
   * @param {number} milliseconds
   */
  grow(milliseconds) {
    const { walk } = this;
    const end = performance.now() + milliseconds;
    while (!walk.done && walk.frames - this.time < 90 && performance.now() < end) {
      this.growing ??= walk.grow();
      const { value, done } = this.growing.next();
      if (value) this.ghost = value;
      if (done) this.grown();
    }
  }

  grown() {
    const last = this.prints.at(-1);
    const begin = last ? last.frame + 4 : 0;
    this.growing = null;
    this.ghost = null;
    if (!this.walk.frames) {
      this.showMessage(`No ${this.about.labels[this.kind]} in these clips goes along this line.`);
      return;
    }
    this.prints.push(
      ...footprints(this.walk, this.about.feet, begin).filter((print) => print.frame >= begin),
    );
    this.first ??= performance.now() - this.begun;
    if (this.walk.done) this.report();
  }

  report() {
    const { walk, about } = this;
    const seams = walk.edges.filter((edge, at) => edge.seam && walk.begins[at] >= walk.since).length;
    /** @type {number[]} */
    const distances = [];
    for (let frame = walk.since; frame < walk.frames; frame += 3) {
      const position = this.positionAt(frame);
      const k = nearest(this.line, position);
      distances.push(Math.hypot(this.line.z[k] - position[0], this.line.x[k] - position[1]));
    }
    const mean = (100 * distances.reduce((sum, distance) => sum + distance, 0)) / distances.length;
    const names = [...new Set(walk.edges.map((edge) => about.clips[edge.start.clip].name))];
    const metres = this.line.z.length / 100;
    const seconds = (walk.frames - walk.since) / about.fps;
    this.showMessage(`${metres.toFixed(1)} m · ${seams} seams · ${mean.toFixed(0)} cm off the line`);
    this.canvas.setAttribute(
      "aria-label",
      `A figure walks ${metres.toFixed(0)} metres along a line in ${seconds.toFixed(0)} seconds, ` +
        `from the clips ${names.join(", ")}, with ${seams} seams.`,
    );
  }

  /** @param {string} text */
  showMessage(text) {
    $("message").textContent = text;
  }

  /** @param {number} frame */
  positionAt(frame) {
    const [at, i] = edgeAt(this.walk, clamp(Math.floor(frame), 0, this.walk.frames - 1));
    const [c, s, z, x] = this.walk.transforms[at];
    const { track } = this.walk.edges[at];
    return [c * track.z[i] - s * track.x[i] + z, s * track.z[i] + c * track.x[i] + x];
  }

  /** @param {number} ahead */
  position(ahead = 0) {
    return this.positionAt(this.time + ahead);
  }

  // ---- pictures ----

  fit() {
    const ratio = Math.min(devicePixelRatio, 2) * this.sharp;
    this.width = innerWidth;
    this.height = innerHeight;
    Object.assign(this.canvas, { width: innerWidth * ratio, height: innerHeight * ratio });
  }

  /**
   * Let the camera follow the walk, or hold all of the line.
   * @param {number} seconds
   * @param {boolean} snap
   */
  aim(seconds, snap = false) {
    const tall = this.width < this.height;
    if (this.stroke) return;
    if (this.above || !this.walk.frames) this.camera.hold(this.line, tall);
    else {
      const frame = Math.min(this.time, this.walk.frames - 1);
      const [z, x] = this.positionAt(frame - (this.figures > 1 ? (this.figures * LAG) / 3 : 0));
      const [az, ax] = this.positionAt(frame - 15);
      const [bz, bx] = this.positionAt(frame + 5);
      this.camera.follow(seconds, [z, x], Math.atan2(bx - ax, bz - az), tall, this.figures > 1 ? 2.2 : 0);
    }
    this.camera.step(seconds, snap);
  }

  /** @param {number} now */
  picture(now) {
    const since = now - this.before;
    const seconds = clamp(since / 1000, 0, 0.1);
    const { walk } = this;
    this.before = now;
    // Half of the time where the figure would wait, however slow pictures are.
    this.grow(walk.frames - this.time < 15 ? clamp(since, 40, 250) : 10);
    if (this.playing && walk.frames && !this.stroke && !this.shown) this.walkOn(seconds);
    this.slow = clamp(this.slow + (seconds > 0.04 ? 1 : -1), 0, 20); // too few pictures a second: fewer pixels
    if (this.slow === 20 && this.sharp > 0.5) {
      this.sharp *= 0.8;
      this.slow = 0;
      this.fit();
    }
    this.aim(seconds);
    this.draw();
    requestAnimationFrame((next) => this.picture(next));
  }

  /**
   * Go on by some seconds, and begin anew a while after the end.
   * @param {number} seconds
   */
  walkOn(seconds) {
    const { walk } = this;
    const last = walk.frames - 1 + (walk.done ? (this.figures - 1) * LAG : 0);
    this.time = Math.min(this.time + seconds * this.about.fps, last);
    this.rest = walk.done && this.time >= last ? this.rest + seconds : 0;
    if (this.rest <= RESTS) return;
    this.time = 0;
    this.rest = 0;
  }

  bodies() {
    const { walk, shown } = this;
    if (!walk.frames) return [];
    if (shown) return shown.bodies;
    const all = Array.from({ length: this.figures }, (_, n) => this.time - n * LAG).filter(
      (time, n) => !n || time >= 0,
    );
    return all.map((time) => bodyAt(walk, Math.min(time, walk.frames - 1)));
  }

  draw() {
    const { scene, walk, look, camera } = this;
    const half = clamp(camera.at.far * camera.hand.zoom * 0.0055, 0.022, 0.06);
    const line = rgb(look.line);
    const ink = rgb(look.ink);
    const seen = camera.view(this.width, this.height);
    scene.eye = seen.eye;
    scene.reach = 1.2 * camera.at.far * camera.hand.zoom;
    if (this.stroke) scene.band(this.stroke, half, line, () => 1);
    else {
      const step = Math.max(3, Math.ceil(this.points.length / 700));
      const thin = this.points.filter((_, i) => i % step === 0);
      const here = walk.frames ? nearest(this.line, this.position()) / step : 0;
      scene.band(thin, half, line, (i) => (i < here ? 0.35 : 0.95));
    }
    if (this.ghost) this.drawGhost(this.ghost, half, ink);
    if (walk.frames && !this.stroke) {
      this.drawTrail(half, ink);
      this.drawPrints(ink);
      this.drawSeams(half);
    }
    scene.draw(seen, look, this.stroke ? [] : this.bodies());
    this.ticks += 1;
    if (this.ticks % 4 === 1) drawSmall(this, this.small);
  }

  /**
   * Footprints of the last six seconds.
   * @param {number[]} ink
   */
  drawPrints(ink) {
    for (const print of this.prints) {
      const age = this.time - print.frame;
      if (age <= 0 || age >= 180) continue;
      const alpha = 0.3 * Math.min(1, age / 4) * (1 - age / 180);
      this.scene.disc([print.z, print.x], 0.12, 0.045, print.angle, ink, alpha, 0.005);
    }
  }

  /**
   * A ring for each seam, larger while it plays.
   * @param {number} half
   */
  drawSeams(half) {
    for (const { at, frame } of this.seams()) {
      const near = Math.max(0, 1 - Math.abs(this.time - frame) / 12);
      const radius = half * (1.5 + 2 * near);
      const position = this.positionAt(frame);
      const colour = rgb(COLOURS[this.walk.edges[at].end.clip % COLOURS.length]);
      this.scene.disc(position, radius, radius, 0, colour, 0.95, 0.007);
      this.scene.disc(position, half * 0.7, half * 0.7, 0, rgb(this.look.ground), 0.95, 0.008);
    }
  }

  /**
   * The best walk of a search that is under way.
   * @param {SearchedWalk} ghost
   * @param {number} half
   * @param {number[]} colour
   */
  drawGhost(ghost, half, colour) {
    /** @type {number[][]} */
    const points = [];
    for (let walk = ghost; walk.previous && walk.edge; walk = walk.previous) {
      const [c, s, z, x] = walk.previous.transform;
      const { track } = walk.edge;
      for (let i = track.z.length - 1; i >= 0; i -= 3) {
        points.push([c * track.z[i] - s * track.x[i] + z, s * track.z[i] + c * track.x[i] + x]);
      }
    }
    if (points.length > 1) this.scene.band(points, half * 0.4, colour, () => 0.4, 0.006);
  }

  /**
   * Two seconds back and ahead.
   * @param {number} half
   * @param {number[]} colour
   */
  drawTrail(half, colour) {
    const from = Math.max(0, Math.floor(this.time) - 60);
    const to = Math.min(this.walk.frames - 1, Math.floor(this.time) + 60);
    const points = [];
    for (let frame = from; frame <= to; frame += 2) points.push(this.positionAt(frame));
    /** @param {number} i */
    const alpha = (i) => 0.6 * (1 - ((from + 2 * i - this.time) / 60) ** 2);
    this.scene.band(points, half * 0.4, colour, alpha, 0.006);
  }

  seams() {
    const { walk } = this;
    return walk.edges
      .flatMap((edge, at) => (edge.seam ? [{ at, frame: walk.begins[at] + 5 }] : []))
      .filter(({ frame }) => frame < walk.frames);
  }

  /** @param {boolean} on */
  play(on) {
    this.playing = on;
    $("play").textContent = on ? "stop" : "go";
  }

  /** @param {boolean} above */
  view(above) {
    this.above = above;
    Object.assign(this.camera.hand, { yaw: 0, pitch: 0, zoom: 1 });
    $("above").setAttribute("aria-pressed", String(above));
  }

  buttons() {
    const { labels } = this.about;
    labels.forEach((name, kind) => {
      if (!this.about.moving.includes(name)) return;
      const button = Object.assign(document.createElement("button"), {
        id: `kind${kind}`,
        textContent: name,
      });
      button.onclick = () => {
        this.choose(kind);
        if (this.points) this.set(this.points);
      };
      $("kinds").append(button, " ");
    });
    this.choose(this.kind);
    this.play(this.playing);
    $("play").onclick = () => this.play(!this.playing);
    $("above").onclick = () => this.view(!this.above);
    $("parade").onclick = () => {
      this.figures = this.figures > 1 ? 1 : PARADE;
      $("parade").setAttribute("aria-pressed", String(this.figures > 1));
    };
    $("bvh").onclick = () => {
      this.finish();
      download(bvh(this.walk), "walk.bvh");
    };
    $("gif").onclick = () => this.saveGif();
  }

  // Search to the line's end.
  finish() {
    const { time } = this;
    while (!this.walk.done) {
      this.time = this.walk.frames;
      this.grow(1000);
    }
    this.time = time;
  }

  saveGif() {
    this.finish();
    const { canvas, walk } = this;
    const time = this.time;
    const small = document.createElement("canvas");
    const width = 400;
    const height = Math.round((width * this.height) / this.width);
    const pictures = [];
    Object.assign(small, { width, height });
    const pen = penOf(small, { willReadFrequently: true });
    for (let frame = 0; frame < Math.min(walk.frames, 20 * this.about.fps); frame += this.about.fps / 12.5) {
      this.time = frame;
      this.aim(0.08, frame === 0);
      this.draw();
      pen.drawImage(canvas, 0, 0, width, height);
      pictures.push(pen.getImageData(0, 0, width, height).data);
    }
    this.time = time;
    download(gif(pictures, width, height, 8), "walk.gif");
  }
}

loaded().then((graph) => {
  Object.assign(window, { page: new Page(graph) });
});
