// The page on which a figure is steered: it plays what Python walks, and records it. `steering_server.py` serves it.

import { LOOKS } from "./bodies.js";
import { DARK, LIGHT, isDark, partOf } from "./player_page.js";
import { Picture } from "./player_picture.js";
import { Camera } from "./player_scene.js";
import { Hands } from "./steer_hands.js";
import { Link } from "./steer_link.js";
import { VIEWS, VIEW_OPTIONS, arrowOf } from "./steered_command.js";
import { Walker } from "./steered_walker.js";

/**
 * @import { Marks } from "./player_scene.js"
 * @import { Paces } from "./steer_hands.js"
 * @import { Refused } from "./steer_link.js"
 * @import { PackedMember } from "./steered_walker.js"
 *
 * What the page shows, as `SteeredSession.scene` packs it.
 * @typedef {Paces & { member: PackedMember, sides: string[], marks: Marks, longest: number }} SteeredScene
 */

const DISTANCE = 4.6; // metres from the camera to the figure
const TURN = 1.5; // radians per second, by which a key or a stick turns the view
const DRAG = 0.008; // radians per pixel of the right mouse button
const PITCHES = [0.05, 1.55]; // radians
const ZOOMS = [0.3, 4];
const LONGEST_STEP = 0.1; // seconds of a picture, after a pause of the browser
/** @type {Record<string, number>} */
const TURNING_KEYS = { KeyQ: -1, KeyE: 1 };

export class SteerPage {
  /** @type {number | null} the first frame of the recording under way */
  from = null;
  saved = 0;
  /** @type {boolean} whether the figure walks; it does from the first command on */
  playing = false;
  started = false;
  /** @type {number | null} when the last picture was drawn */
  last = null;
  /** @type {Set<string>} the keys that turn the view, held down */
  turning = new Set();
  /** @type {string} the last message of the link */
  heard = "";
  pictures = 0;

  /**
   * @param {HTMLElement} root
   * @param {SteeredScene} scene
   */
  constructor(root, scene) {
    this.scene = scene;
    this.stage = partOf(root, "#stage", HTMLCanvasElement);
    this.recordPart = partOf(root, "#record", HTMLButtonElement);
    this.pausePart = partOf(root, "#pause", HTMLButtonElement);
    this.speedPart = partOf(root, "#speed", HTMLInputElement);
    this.kindPart = partOf(root, "#kind", HTMLSelectElement);
    this.viewPart = partOf(root, "#view", HTMLSelectElement);
    this.statePart = partOf(root, "#state", HTMLElement);
    this.messagePart = partOf(root, "#message", HTMLElement);
    this.savedPart = partOf(root, "#saved", HTMLElement);
    this.pacePart = partOf(root, "#pace", HTMLElement);
    this.camera = new Camera();
    this.picture = new Picture(this.stage, this.camera);
    this.walker = new Walker(scene.member);
    this.link = new Link(this.walker);
    this.hands = new Hands(scene);
    /** @type {[heading: number, speed: number, label: string]} */
    this.command = [0, 0, ""];
    this.build(root);
    this.listen();
    this.stage.focus();
    this.tick(performance.now());
  }

  /** @param {HTMLElement} root */
  build(root) {
    const { labels, speeds, stands } = this.scene;
    const rest = stands ? "let go, and it stands." : "let go, and it walks slowly: its clips never stand.";
    partOf(root, "#start", HTMLElement).textContent =
      `Hold an arrow key, or press a place on the ground; ${rest} Space records.`;
    [this.speedPart.min, this.speedPart.max] = speeds.map(String);
    this.kindPart.replaceChildren(...labels.map((label) => new Option(label || "any", label)));
    partOf(root, "#kinds", HTMLElement).hidden = labels.length < 2;
    this.viewPart.innerHTML = VIEW_OPTIONS;
    [this.camera.yaw, this.camera.pitch] = VIEWS.behind;
    this.showPace();
  }

  listen() {
    this.recordPart.onclick = () => this.record();
    this.pausePart.onclick = () => this.pause();
    this.speedPart.oninput = () => {
      this.hands.speed = Number(this.speedPart.value);
      this.showPace();
    };
    this.kindPart.onchange = () => {
      this.hands.label = this.kindPart.value;
      this.hands.speed = this.scene.paces[this.hands.label];
      this.showPace();
    };
    this.viewPart.onchange = () => {
      [this.camera.yaw, this.camera.pitch] = VIEWS[this.viewPart.value];
    };
    this.speedPart.onpointerup = () => this.stage.focus(); // the keys of a slider that was dragged steer again
    document.onkeydown = (event) => this.key(event);
    document.onkeyup = ({ code }) => {
      this.hands.release(code);
      this.turning.delete(code);
    };
    window.onblur = () => this.letGo();
    this.stage.onpointerdown = (event) => this.point(event);
    this.stage.onpointermove = (event) => this.point(event);
    this.stage.onpointerup = () => (this.hands.pixel = null);
    this.stage.onpointercancel = () => (this.hands.pixel = null);
    this.stage.oncontextmenu = (event) => event.preventDefault();
    this.stage.onwheel = (event) => this.zoom(event);
  }

  // ---- hands ----

  // No key and no finger is held: the page does not hear of those that leave while another window has the focus.
  letGo() {
    this.hands.held.clear();
    this.hands.pixel = null;
    this.turning.clear();
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    const { code, target, repeat } = event;
    if (event.ctrlKey || event.altKey || event.metaKey || keepsKey(target, code)) return;
    if (code === "Space" || code === "KeyP") {
      if (!repeat) this.pressed(code === "Space" ? "record" : "pause");
    } else if (TURNING_KEYS[code]) this.turning.add(code);
    else if (!this.hands.press(code)) return;
    event.preventDefault();
  }

  /**
   * A press on the ground is a place to walk to, and the right button turns the view.
   * @param {PointerEvent} event
   */
  point(event) {
    const { type, buttons, pointerId, offsetX, offsetY, movementX, movementY } = event;
    if (type === "pointerdown") {
      this.stage.setPointerCapture(pointerId);
      this.stage.focus();
    }
    if (buttons === 1) this.hands.pixel = [offsetX, offsetY];
    if (buttons !== 2) return;
    this.camera.yaw -= DRAG * movementX;
    const [low, high] = PITCHES;
    this.camera.pitch = Math.min(high, Math.max(low, this.camera.pitch + DRAG * movementY));
  }

  /** @param {WheelEvent} event */
  zoom(event) {
    event.preventDefault();
    const [low, high] = ZOOMS;
    this.camera.zoom = Math.min(high, Math.max(low, this.camera.zoom * Math.exp(-event.deltaY / 400)));
  }

  // ---- the walk and its recording ----

  /** @param {boolean} playing */
  pause(playing = !this.playing) {
    this.playing = playing && !this.link.gone;
    this.pausePart.setAttribute("aria-pressed", String(!this.playing));
  }

  /** Start a recording, or end and save it. */
  async record() {
    if (!this.started || this.link.gone) return;
    if (this.from === null) {
      this.from = this.link.frame;
      this.pause(true);
      this.showRecording();
      return;
    }
    const frames = { first: this.from, last: this.link.frame };
    this.from = null;
    this.showRecording();
    /** @type {{ bvh: string, message: string } | Refused} */
    const answer = await this.link.post("record", frames);
    if ("why" in answer) this.say(answer.why, true);
    else this.save(answer.bvh, answer.message, (frames.last - frames.first) / this.walker.fps);
  }

  /**
   * Offer a recording: the browser stores it, and a link stays.
   * @param {string} text
   * @param {string} message
   * @param {number} seconds
   */
  save(text, message, seconds) {
    this.saved++;
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text], { type: "text/plain" }));
    link.download = `steered-${this.saved}.bvh`;
    link.textContent = `${link.download}, ${seconds.toFixed(1)} s`;
    this.savedPart.hidden = false;
    this.savedPart.append(link);
    link.click();
    this.stage.focus();
    this.say(`Recorded as ${link.download}, ${seconds.toFixed(1)} s. ${message}`);
  }

  showRecording() {
    const isOn = this.from !== null;
    this.recordPart.setAttribute("aria-pressed", String(isOn));
    this.recordPart.textContent = isOn ? "Stop" : "Record";
    this.say(isOn ? "Recording." : "");
  }

  /**
   * @param {string} text
   * @param {boolean} wrong
   */
  say(text, wrong = false) {
    if (this.messagePart.textContent !== text) this.messagePart.textContent = text;
    this.messagePart.classList.toggle("error", wrong);
  }

  showPace() {
    this.speedPart.value = String(this.hands.speed);
    this.pacePart.textContent = `${this.hands.speed.toFixed(2)} m/s`;
  }

  // ---- time and pictures ----

  /** @param {number} now */
  tick(now) {
    const seconds = this.last === null ? 0 : Math.min(LONGEST_STEP, (now - this.last) / 1000);
    this.last = now;
    const { link, hands } = this;
    for (const button of hands.readPad()) this.pressed(button);
    for (const code of this.turning) this.camera.yaw += TURNING_KEYS[code] * TURN * seconds;
    this.camera.yaw += hands.turn * TURN * seconds;
    if (link.time !== null) {
      this.command = hands.command(this.camera, [...this.walker.pose(link.time)]);
      if (!this.started) this.start();
    }
    if (this.playing) link.play(seconds);
    if (this.playing || link.time === null) link.ask(this.command).then(() => this.answered());
    if (link.time !== null) this.draw(link.time, seconds);
    requestAnimationFrame((later) => this.tick(later));
  }

  /** @param {string} button of the page */
  pressed(button) {
    if (button === "record") this.record();
    else this.pause();
  }

  // The figure stands still until the first command, so that nothing moves that nobody asked for.
  start() {
    this.recordPart.disabled = false;
    this.pausePart.disabled = false;
    if (this.command[1] === 0) return;
    this.started = true;
    this.pause(true);
  }

  // Show what is new about the link: a warning, an error, or its end.
  answered() {
    const { link } = this;
    if (link.message === this.heard) return;
    this.heard = link.message;
    if (link.gone) {
      this.pause(false);
      this.from = null;
      this.showRecording();
      this.recordPart.disabled = true;
      this.pausePart.disabled = true;
    }
    this.say(link.message, true);
  }

  /**
   * @param {number} time
   * @param {number} seconds since the last picture
   */
  draw(time, seconds) {
    const dark = isDark();
    const { walker, scene } = this;
    const palette = dark ? DARK : LIGHT;
    const [heading, speed] = this.command;
    walker.colour = palette.ink;
    walker.trail = walker.trailUntil(time, scene.marks.seam);
    const target = walker.target(time, seconds);
    this.picture.draw({
      characters: [walker],
      time,
      asked: speed ? arrowOf(target, heading, speed) : [],
      drawn: [],
      pen: this.hands.goal,
      sides: scene.sides,
      marks: scene.marks,
      palette,
      ghosts: false,
      target,
      distance: DISTANCE,
      reach: 6,
      light: dark ? LOOKS.dark : LOOKS.light,
    });
    if (this.pictures++ % 6 === 0) this.showState(time);
  }

  /** @param {number} time */
  showState(time) {
    const recorded = this.from === null ? 0 : time - this.from / this.walker.fps;
    const clock = this.from === null ? "" : ` · recorded ${recorded.toFixed(1)} s`;
    this.statePart.textContent = `${this.walker.speed(time).toFixed(1)} m/s${clock}`;
    if (recorded > this.scene.longest - 0.2) this.record();
  }
}

/**
 * Whether a key belongs to the part of the page that has the focus: a slider and a list keep theirs, and a button space.
 * @param {EventTarget | null} part
 * @param {string} code
 */
function keepsKey(part, code) {
  if (!(part instanceof Element)) return false;
  if (part.matches("input, select")) return !code.startsWith("Shift");
  return code === "Space" && part.matches("button, summary, a");
}

const scenePart = partOf(document, "#scene", HTMLScriptElement);
Object.assign(document.body, { steering: new SteerPage(document.body, JSON.parse(scenePart.text)) });
