// A player of bodies on a canvas, without any library.
//
// `player.py` packs a scene. `player_scene.js` unpacks it, `player_picture.js` draws it, `player_page.js` has the
// parts of the page, `player_hand.js` the keys, mouse and fingers, and this file ties them together. The scripts
// are joined to one module. On a page, `start` starts every `.mocap-player`; in JupyterLab, anywidget calls
// `render`. Its `model` shares with Python: `scene`, with a number; `move`, which Python sets, and `at`, which the
// player sets: the number of a scene and a frame; `path`; and `best`, the line of a search that is under way.

import { LOOKS } from "./bodies.js";
import { Hand } from "./player_hand.js";
import { DARK, KEYS, LIGHT, PARTS, coloured, isDark, keepKeys, partOf } from "./player_page.js";
import { Picture } from "./player_picture.js";
import { Camera, Character, inflated } from "./player_scene.js";

/**
 * @import { Model, Palette, Rendered } from "./player_page.js"
 * @import { Scene } from "./player_scene.js"
 */

const FOLLOWED = 15; // metres of ground around a character that the camera follows
const CLOSE = 4.2; // metres from the camera to such a character; several are seen from further away
const STATUS = ["Plays all.", "Begins here. Press L where it shall end.", "Plays this part. L plays all."];

class Player {
  /** @type {Scene} the scene that is shown */
  scene;
  /** @type {Scene} the scene that came last: it may not be unpacked yet */
  latest;
  /** @type {Character[]} */
  characters;
  /** @type {number} of the scene */
  seconds;
  /** @type {number[]} what is looked at, if nothing is followed */
  centre;
  /** @type {number} metres from there to the camera */
  reach;
  /** @type {number[]} seconds at which the part that is played begins and ends */
  range = [];
  /** @type {number | null} since when Python looks for a walk */
  looking = null;
  /** @type {number[][]} the line of the best walk so far, while Python looks */
  best = [];
  /** @type {boolean} whether the hand draws a path */
  drawing = false;
  /** @type {number | null} when the last picture was drawn, while it plays */
  last = null;
  /** @type {number | null} the next picture that the browser was asked for */
  waiting = null;
  /** @type {number | undefined} milliseconds until the first picture */
  firstPicture;
  /** @type {number | null} the timer of the next report to Python */
  reporting = null;

  /**
   * @param {HTMLElement} root
   * @param {Scene} scene
   * @param {Model} [model] in JupyterLab
   */
  constructor(root, scene, model) {
    this.root = root;
    this.model = model;
    this.camera = new Camera();
    this.time = 0;
    this.speed = 1;
    this.panned = [0, 0];
    this.playing = false;
    this.visible = true;
    this.pictures = 0;
    this.near = 1; // how far the view has come to the figure
    this.chase = false; // whether it rotates with the figure
    this.calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    root.classList.add("mocap-player");
    root.dataset.started = "true"; // so that `start` does not start it a second time
    root.innerHTML = PARTS;
    this.canvas = partOf(root, "canvas", HTMLCanvasElement);
    this.play = partOf(root, ".play", HTMLButtonElement);
    this.scrub = partOf(root, ".scrub input", HTMLInputElement);
    this.strip = partOf(root, ".scrub div", HTMLElement);
    this.clock = partOf(root, ".clock", HTMLElement);
    this.select = partOf(root, "select", HTMLSelectElement);
    this.part = partOf(root, ".scrub b", HTMLElement);
    this.aside = partOf(root, ".aside input", HTMLInputElement);
    this.follow = partOf(root, ".follow", HTMLInputElement);
    this.ghosts = partOf(root, ".ghosts", HTMLInputElement);
    this.drawButton = partOf(root, ".draw", HTMLButtonElement);
    this.legend = partOf(root, ".legend", HTMLElement);
    this.message = partOf(root, ".message", HTMLElement);
    this.build();
    this.picture = new Picture(this.canvas, this.camera);
    this.hand = new Hand(this);
    this.load(scene).then(() => this.listen());
  }

  // ---- the page ----

  build() {
    keepKeys(this.root, "canvas, button, input, select");
    this.select.value = "1";
    partOf(this.root, ".reset", HTMLElement).onclick = () => this.frameAll();
    const full = partOf(this.root, ".full", HTMLElement);
    full.hidden = !document.fullscreenEnabled;
    full.onclick = () =>
      document.fullscreenElement ? document.exitFullscreen() : this.root.requestFullscreen();
    this.root.onfullscreenchange = () => {
      full.textContent = document.fullscreenElement ? "leave full screen" : "full screen";
    };
  }

  /** @param {Scene} scene */
  async load(scene) {
    this.latest = scene;
    const bytes = await inflated(scene.data);
    if (scene !== this.latest) return;
    const again = Boolean(scene.drawable && this.scene); // a reader who draws one path after the other keeps the view
    this.scene = scene;
    this.characters = scene.characters.map((packed) => new Character(packed, bytes, scene.marks));
    this.seconds = (scene.frames - 1) / scene.fps;
    const plays = Boolean(scene.autoplay) && !this.calm;
    this.looking = null;
    if (!again) this.openView();
    else if (plays) this.chaseFigure();
    this.showParts();
    this.range = [];
    this.showRange();
    this.hand.drawn = [];
    this.hand.pen = false;
    this.showMessage(this.model?.get("message") ?? "");
    this.showSources();
    if (!again) this.frameAll();
    this.seek(this.firstFrame() / scene.fps);
    this.toggle(plays);
  }

  // The view of a first scene.
  openView() {
    this.follow.checked = this.scene.follow;
    if (this.scene.yaw !== undefined) {
      this.camera.yaw = this.scene.yaw;
      this.camera.home = this.scene.yaw;
    }
    if (this.scene.drawable) this.drawing = true;
  }

  // The view after a stroke.
  chaseFigure() {
    this.near = this.follow.checked ? this.near : 0;
    this.chase = true;
    this.follow.checked = true;
  }

  // What the page offers for this scene.
  showParts() {
    const { alt, drawable, frames, characters } = this.scene;
    this.canvas.setAttribute(
      "aria-label",
      `${alt} ${KEYS}${drawable ? " P takes the pen to draw a path." : ""}`,
    );
    this.scrub.max = String(frames - 1);
    this.drawButton.hidden = !drawable;
    if (this.aside.parentElement) this.aside.parentElement.hidden = characters.length < 2;
  }

  // Where the reader was, or Python put it, in this scene: an older scene's frames do not count.
  firstFrame() {
    const placed = [this.model?.get("at"), this.model?.get("move")].find(
      (pair) => pair?.[0] === this.scene.number,
    );
    return placed ? placed[1] : 0;
  }

  /** @param {string} text */
  showMessage(text) {
    this.message.textContent = text;
    this.message.classList.toggle("error", /^\w+Error:/.test(text));
  }

  // The coloured bar under the slider with a tick per seam, and the names of its colours.
  showSources() {
    const [{ sources, seams, astray }] = this.characters;
    const { marks } = this.scene;
    /** @param {number} time */
    const percent = (time) => `${(100 * time) / this.seconds}%`;
    const stops = sources.map(
      (s, i) => `${s.colour} ${percent(s.start)} ${percent(sources[i + 1]?.start ?? this.seconds)}`,
    );
    this.strip.style.background = stops.length ? `linear-gradient(to right, ${stops.join(", ")})` : "none";
    this.strip.replaceChildren(
      ...seams.map((time) => {
        const tick = document.createElement("i");
        Object.assign(tick.style, { left: percent(time), background: marks.seam });
        return tick;
      }),
    );
    const several = this.characters.length > 1 ? this.characters : [];
    const named = sources.length ? [...sources, ...several.slice(1)] : [...several];
    const colours = new Map(named.map((s) => [`${s.colour} ${s.name}`, [s.colour, s.name]]));
    if (seams.length) colours.set("seam", [marks.seam, "seam"]);
    if (astray.length) colours.set("astray", [marks.astray, "off the path"]);
    this.legend.replaceChildren(...[...colours.values()].flatMap(([colour, name]) => coloured(colour, name)));
  }

  // Look at all characters' paths and the path asked for, from so far away that figures and paths are in the picture.
  frameAll() {
    this.camera.reset(this.scene.drawable ? 0.9 : 0.25);
    this.panned = [0, 0];
    const positions = [
      ...this.characters.flatMap((c) => c.path.map(([, x, z]) => [x, z])),
      ...this.scene.asked,
    ];
    /** @param {number} i */
    const span = (i) =>
      positions.reduce(
        ([low, high], p) => [Math.min(low, p[i]), Math.max(high, p[i])],
        [Infinity, -Infinity],
      );
    const [[x0, x1], [z0, z1]] = [span(0), span(1)];
    this.centre = [(x0 + x1) / 2, 0.8, (z0 + z1) / 2];
    const corners = positions.flatMap(([x, z]) =>
      [-0.3, 0.3].flatMap((d) => [
        [x + d, 0, z + d],
        [x + d, 1.9, z + d],
      ]),
    );
    const wide = this.canvas.clientWidth || 720;
    const high = this.canvas.clientHeight || 380;
    /** @param {number[]} pixel */
    const outside = ([x, y]) => Math.abs(x / wide - 0.5) > 0.47 || Math.abs(y / high - 0.5) > 0.47;
    const fits = () => {
      this.camera.place(this.centre, this.reach, wide, high);
      return corners.every((point) => {
        const seen = this.camera.see(point[0], point[1], point[2]);
        return seen[2] > 0.1 && !outside(this.camera.pixel(seen));
      });
    };
    for (this.reach = 3.2; !fits() && this.reach < 1000; this.reach *= 1.1);
    this.update();
  }

  listen() {
    this.play.onclick = () => this.toggle();
    this.scrub.oninput = () => {
      this.toggle(false);
      this.seek(Number(this.scrub.value) / this.scene.fps);
    };
    this.select.onchange = () => {
      this.speed = Number(this.select.value);
    };
    this.follow.onchange = () => {
      this.near = 1;
      this.chase = false;
      this.update();
    };
    this.ghosts.onchange = () => this.update();
    this.aside.onchange = () => this.beside();
    this.drawButton.onclick = () => {
      this.drawing = !this.drawing;
      this.update();
    };
    this.resized = new ResizeObserver(() => this.update());
    this.resized.observe(this.canvas);
    this.seen = new IntersectionObserver((entries) => {
      this.visible = entries[entries.length - 1].isIntersecting;
      this.update();
    });
    this.seen.observe(this.canvas);
    this.link();
  }

  // ---- Python ----

  link() {
    const { model } = this;
    if (!model) return;
    /** @param {number[]} move */
    const follow = ([number, frame]) => {
      if (this.scene !== this.latest || number !== this.scene.number || frame === this.frame()) return;
      this.toggle(false);
      this.seek(frame / this.scene.fps);
    };
    model.on("change:move", () => follow(model.get("move")));
    model.on("change:at", () => follow(model.get("at"))); // another view of the same player has moved
    model.on("change:scene", () => this.load(model.get("scene")));
    model.on("change:best", () => {
      this.best = model.get("best");
      this.update();
    });
    model.on("change:message", () => {
      if (!model.get("message")) return;
      this.looking = null;
      this.showMessage(model.get("message"));
    });
  }

  // Send Python the frame, at most twenty times per second, if Python listens.
  report() {
    const { model } = this;
    if (!model || !this.scene.reports || this.reporting) return;
    this.reporting = setTimeout(() => {
      this.reporting = null;
      const [number, frame] = model.get("at");
      if (number === this.scene.number && frame === this.frame()) return;
      model.set("at", [this.scene.number, this.frame()]);
      model.save_changes();
    }, 50);
  }

  /** @param {number[][]} path */
  ask(path) {
    this.showMessage("Looking for a walk …");
    this.looking = performance.now();
    this.best = [];
    this.update();
    this.model?.set("message", ""); // or the same message twice would be no change
    this.model?.set("path", path);
    this.model?.save_changes();
  }

  // ---- time ----

  frame() {
    return Math.round(this.time * this.scene.fps);
  }

  /** @param {number} time */
  seek(time) {
    this.time = Math.min(Math.max(time, 0), this.seconds);
    this.report();
    this.update();
  }

  // The first call marks where what is played begins, the second where it ends, the third takes both back.
  mark() {
    this.range = this.range.length === 2 ? [] : [...this.range, this.time].sort((a, b) => a - b);
    if (this.range.length === 2 && this.range[1] - this.range[0] < 0.1) this.range = [];
    this.showRange();
    this.showMessage(STATUS[this.range.length]);
  }

  showRange() {
    /** @param {number} time */
    const percent = (time) => `${(100 * time) / this.seconds}%`;
    const [begin = 0, end = begin] = this.range;
    Object.assign(this.part.style, { left: percent(begin), width: percent(end - begin) });
    this.part.hidden = !this.range.length;
  }

  // Put the characters beside each other, seen from here, or back where they walk.
  beside() {
    const { right } = this.camera;
    const spacing = this.aside.checked ? 1.1 : 0;
    const middle = (this.characters.length - 1) / 2;
    this.characters.forEach((character, k) =>
      character.move(spacing * (k - middle) * right[0], spacing * (k - middle) * right[2], this.scene.marks),
    );
    this.update();
  }

  // The boxes of the scene, with each character that is beside where it walks.
  boxes() {
    const { boxes = [] } = this.scene;
    const places = new Map(this.characters.map(({ away }) => [String(away), away]));
    return [...places.values()].flatMap((away) =>
      boxes.map((box) => box.map((value, c) => value + away[c % 3])),
    );
  }

  /** @param {boolean} playing */
  toggle(playing = !this.playing) {
    this.playing = playing;
    this.last = null;
    this.play.textContent = this.playing ? "❚❚" : "▶";
    this.play.setAttribute("aria-label", this.playing ? "pause" : "play");
    this.update();
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
    const seconds = this.last === null ? 0 : Math.min(0.25, (now - this.last) / 1000);
    if (this.playing && !this.hand.busy) {
      this.time += seconds * this.speed;
      const [begin, end] = this.range.length === 2 ? this.range : [0, this.seconds];
      if (this.time > end) this.time = end > begin ? begin + ((this.time - begin) % (end - begin)) : begin;
      this.last = now;
      this.report();
      this.update();
    } else this.last = null;
    if (this.looking) this.update();
    this.draw(seconds);
  }

  // ---- the picture ----

  /** @param {number} seconds */
  draw(seconds = 0) {
    if (this.chase) this.swing(seconds);
    const { asked, obstacles, sides, marks } = this.scene;
    const { drawn, pen } = this.hand;
    const dark = isDark();
    const palette = dark ? DARK : LIGHT;
    this.root.classList.toggle("dark", dark);
    this.picture.draw({
      characters: this.characters,
      time: this.time,
      asked,
      drawn,
      pen: pen ? drawn[drawn.length - 1] : null,
      obstacles,
      boxes: this.boxes(),
      sides,
      marks,
      palette,
      ghosts: this.ghosts.checked,
      target: this.target(),
      distance: this.distance(),
      reach: this.follow.checked ? Math.min(this.reach, FOLLOWED) : this.reach,
      light: dark ? LOOKS.dark : LOOKS.light,
    });
    if (this.looking) this.showLooking(this.looking, palette.asked);
    this.drawInset(palette);
    this.showState();
  }

  // Metres from the camera to what is looked at.
  distance() {
    if (!this.follow.checked) return this.reach;
    return this.reach + this.near * (CLOSE + 1.6 * this.spread() - this.reach);
  }

  /**
   * The whole path that is drawn or asked for, small, while the picture shows a part of it.
   * @param {Palette} palette
   */
  drawInset(palette) {
    const { drawable, asked } = this.scene;
    if (!drawable || !(this.follow.checked || this.looking)) return;
    const { drawn, yaw } = this.hand;
    const path = drawn.length ? drawn : asked;
    this.picture.drawInset(path, this.characters[0].pose(this.time), yaw ?? 0.7, palette);
  }

  /**
   * After a stroke: come near, to a view from three quarters in front, and turn slowly with the walk, until the reader
   * turns it.
   * @param {number} seconds
   */
  swing(seconds) {
    const { camera, time } = this;
    const [first] = this.characters;
    /** @param {number} rate */
    const fraction = (rate) => 1 - Math.exp(-rate * seconds);
    const [a, b] = [first.pose(time - 0.5), first.pose(time + 0.2)];
    const error = Math.atan2(b[0] - a[0], b[2] - a[2]) + 0.75 - camera.yaw;
    camera.yaw += fraction(this.near < 0.9 ? 2 : 0.5) * Math.atan2(Math.sin(error), Math.cos(error));
    camera.pitch += fraction(2) * (0.3 - camera.pitch);
    camera.zoom += fraction(2) * (1 - camera.zoom);
    this.near += fraction(2) * (1 - this.near);
  }

  /**
   * While Python looks for a walk: the best one so far, a place that runs along the reader's line, and the seconds.
   * @param {number} since
   * @param {string} colour
   */
  showLooking(since, colour) {
    const { drawn } = this.hand;
    const seconds = (performance.now() - since) / 1000;
    this.picture.stroke([this.best.map(([x, z]) => [x, 0, z])], this.scene.marks.seam, 4);
    this.picture.write(`looking for a walk: ${seconds.toFixed(1)} s`);
    if (!drawn.length || this.calm || this.best.length) return;
    const [x, z] = drawn[Math.floor(20 * seconds) % drawn.length];
    this.picture.disc([x, 0.01, z], 0.15, colour, 0.9, true);
  }

  // Above the ground amid the characters, averaged over a second so that the view does not rock with each step.
  target() {
    const { near } = this;
    const [x, z] = this.panned;
    const whole = [this.centre[0] + x, this.centre[1], this.centre[2] + z];
    if (!this.follow.checked) return whole;
    const mean = [x, 0.85, z];
    const fraction = 1 / (9 * this.characters.length);
    for (const character of this.characters) {
      for (let i = -4; i <= 4; i++) {
        const pose = character.pose(this.time + i / 8);
        mean[0] += fraction * pose[0];
        mean[2] += fraction * pose[2];
      }
    }
    return mean.map((value, k) => whole[k] + near * (value - whole[k]));
  }

  // How far the characters are from the middle between them, at most, in metres.
  spread() {
    const positions = this.characters.map((character) => character.pose(this.time));
    /** @param {number} k */
    const mean = (k) => positions.reduce((sum, position) => sum + position[k] / positions.length, 0);
    const [x, z] = [mean(0), mean(2)];
    return Math.max(...positions.map((position) => Math.hypot(position[0] - x, position[2] - z)));
  }

  showState() {
    const frame = this.frame();
    const text = `frame ${frame} of ${this.scene.frames} · ${this.time.toFixed(2)} s`;
    if (document.activeElement !== this.scrub || this.playing) this.scrub.value = String(frame);
    this.scrub.setAttribute("aria-valuetext", text);
    this.clock.textContent = text;
    this.drawButton.setAttribute("aria-pressed", String(this.drawing));
    this.canvas.classList.toggle("drawing", this.drawing);
    Object.assign(this.root.dataset, { frame, playing: this.playing });
    this.pictures++;
    this.firstPicture ??= performance.now();
  }

  end() {
    this.resized?.disconnect();
    this.seen?.disconnect();
    if (this.reporting) clearTimeout(this.reporting);
    if (this.waiting) cancelAnimationFrame(this.waiting);
  }
}

// In JupyterLab: called by anywidget.
export default {
  /** @param {Rendered} rendered */
  render({ model, el }) {
    const player = new Player(el, model.get("scene"), model);
    Object.assign(el, { player });
    return () => player.end();
  },
};
