// Characters that obey one command, side by side. `steered_widget.py` answers the questions that are asked here.
//
// The pictures run on behind what Python has walked: where few seconds are left, the browser asks for a few more and says
// the command. How many are "few" goes by how long the last answers took; two questions may be under way. Where no
// answer comes, time runs slower and slower until it stands. Nothing is asked while nobody looks.

import { LOOKS } from "./bodies.js";
import { DARK, LIGHT, isDark, keepKeys, partOf } from "./player_page.js";
import { VIEWS, arrowOf, headingOf } from "./steered_command.js";
import { STEERING_KEYS, STEERING_PARTS, panel } from "./steering_page.js";
import { whenPointed } from "./touch.js";

/**
 * @import { Model, Rendered } from "./player_page.js"
 * @import { Marks } from "./player_scene.js"
 * @import { PackedMember, Told } from "./steered_walker.js"
 * @import { Panel, View } from "./steering_page.js"
 *
 * @typedef {{ heading: number, speed: number, label: string }} Command
 *
 * What the pictures show, as `steered_widget.py` packs it.
 * @typedef {{
 *   alt: string, members: PackedMember[], sides: string[], marks: Marks, speeds: number[], labels: string[],
 * }} Company
 *
 * The answers of Python.
 * @typedef {{ kind: "refused", why: string }} Refused
 * @typedef {{
 *   kind: "walked", view: number, number: number, cost: number, notes: string[], members: Told[],
 * }} Walked
 *
 * A command that is under way since a time: the question that carries it, and the second at which frames obey it.
 * @typedef {{ since: number, number: number | null, start: number | null }} UnderWay
 */

const PIECE = 0.05; // seconds of walking per question, at least
const MOST = 2; // questions under way; with more, a busy machine would only have more to do
const GENTLE = 0.03; // with fewer seconds left than this, time runs slower
const SILENT = 1000; // milliseconds without an answer until the page says that Python is busy
const LOST = 15000; // milliseconds without an answer until it says that Python may have ended
const FASTER = 0.1; // metres per second of a key
const TURN = Math.PI / 12; // radians of a key
/** @type {Record<string, number[]>} */
const DIRECTIONS = {
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  w: [0, 1],
  s: [0, -1],
  a: [-1, 0],
  d: [1, 0],
};

// What keys do beside these.
/** @type {Record<string, (steering: Steering) => void>} */
const ORDERS = {
  q: (steering) => steering.order({ heading: steering.command.heading + TURN }),
  e: (steering) => steering.order({ heading: steering.command.heading - TURN }),
  "+": (steering) => steering.order({ speed: steering.command.speed + FASTER }),
  "-": (steering) => steering.order({ speed: steering.command.speed - FASTER }),
  " ": (steering) => steering.toggle(),
};

class Steering {
  /** @type {number | null} the second that is shown */
  time = null;
  /** @type {Map<number, { at: number, seconds: number }>} the questions under way */
  asked = new Map();
  /** @type {number[]} milliseconds that the last answers took */
  trips = [50];
  /** @type {number[]} milliseconds that the last commands were under way */
  latencies = [];
  /** @type {UnderWay | null} */
  under = null;
  /** @type {Set<string>} the keys that are held down */
  held = new Set();
  /** @type {View} */
  shared = { yaw: VIEWS.behind[0], pitch: VIEWS.behind[1], zoom: 1 };
  /** @type {boolean} whether Python has ended */
  gone = false;
  /** @type {boolean} whether the reader has given a command */
  steered = false;
  /** @type {boolean} whether a command came after the last answer */
  warned = false;
  /** @type {boolean} whether the page says that Python is late */
  late = false;
  /** @type {number | null} when the last picture was drawn, while they walk */
  last = null;
  /** @type {number | null} the next picture that the browser was asked for */
  waiting = null;
  /** @type {number} what the last answer cost Python */
  cost = 0;

  /**
   * @param {HTMLElement} root
   * @param {Model} model
   */
  constructor(root, model) {
    this.root = root;
    this.model = model;
    /** @type {Company} */
    this.scene = model.get("scene");
    this.view = Math.random(); // answers to another view are not timed
    this.playing = false;
    this.visible = true;
    this.pictures = 0;
    this.scripted = 0; // milliseconds of all pictures
    this.number = 0; // of the last question
    root.classList.add("mocap-player", "mocap-steering");
    root.dataset.started = "true";
    root.innerHTML = STEERING_PARTS;
    this.panelsPart = partOf(root, ".panels", HTMLElement);
    this.padPart = partOf(root, ".pad", HTMLElement);
    this.playPart = partOf(root, ".play", HTMLButtonElement);
    this.speedPart = partOf(root, ".speed", HTMLInputElement);
    this.kindPart = partOf(root, ".kind", HTMLSelectElement);
    this.viewPart = partOf(root, ".view", HTMLSelectElement);
    this.underPart = partOf(root, ".under", HTMLElement);
    this.messagePart = partOf(root, ".message", HTMLElement);
    this.knob = partOf(root, ".pad i", HTMLElement);
    this.speedSaid = partOf(root, "output", HTMLElement);
    this.panels = this.scene.members.map((member) => panel(member, this.shared));
    this.build();
    this.listen();
    this.showCommand();
    this.ask();
    this.update();
  }

  // ---- the page ----

  build() {
    const { root, scene } = this;
    const [low, high] = scene.speeds;
    this.panelsPart.append(...this.panels.map((one) => one.root));
    this.panelsPart.setAttribute("aria-label", `${scene.alt} ${STEERING_KEYS}`);
    this.panelsPart.title = STEERING_KEYS;
    this.speedPart.min = String(low);
    this.speedPart.max = String(high);
    this.kindPart.replaceChildren(...scene.labels.map((label) => new Option(label || "any", label)));
    partOf(root, ".kinds", HTMLElement).hidden = !scene.labels.length;
    keepKeys(root, ".panels, button, input, select");
    this.toggle(false);
  }

  /**
   * @param {string} text
   * @param {boolean} wrong
   */
  showMessage(text, wrong = false) {
    if (this.messagePart.textContent !== text) this.messagePart.textContent = text;
    this.messagePart.classList.toggle("error", wrong);
  }

  /** @param {boolean} playing */
  toggle(playing = !this.playing) {
    this.playing = playing;
    this.playPart.textContent = playing ? "❚❚" : "▶";
    this.playPart.setAttribute("aria-label", playing ? "pause" : "walk");
    this.update();
  }

  listen() {
    this.playPart.onclick = () => this.toggle();
    this.speedPart.oninput = () => this.order({ speed: Number(this.speedPart.value) });
    this.kindPart.onchange = () => this.order({ label: this.kindPart.value });
    this.viewPart.onchange = () => {
      [this.shared.yaw, this.shared.pitch] = VIEWS[this.viewPart.value];
      this.update();
    };
    this.padPart.onpointerdown = (event) => this.onPad(event);
    this.padPart.onpointermove = (event) => this.onPad(event);
    for (const one of this.panels) whenPointed(one.canvas, (event) => this.onGround(event, one));
    this.root.onkeydown = (event) => this.key(event);
    this.root.onkeyup = (event) => this.held.delete(keyName(event));
    this.root.addEventListener("focusout", () => this.held.clear()); // no part tells when its key goes up
    this.panelsPart.onwheel = (event) => this.wheel(event);
    this.resized = new ResizeObserver(() => this.update());
    this.resized.observe(this.panelsPart);
    this.seen = new IntersectionObserver((entries) => {
      this.visible = entries[entries.length - 1].isIntersecting;
      this.update();
    });
    this.seen.observe(this.panelsPart);
    this.model.on("msg:custom", this.answers);
    this.model.on("change:command", this.commands);
    this.model.on("comm_live_update", this.ended);
  }

  // What the model calls, which `end` takes back.
  /** @type {(content: Refused | Walked, buffers: DataView<ArrayBuffer>[]) => void} */
  answers = (content, buffers) => this.answered(content, buffers);
  commands = () => {
    this.commanded();
    this.showCommand();
    this.update();
  };
  ended = () => {
    this.gone = true;
    this.toggle(false);
    this.showMessage("Python has ended: run the cell again to steer.", true);
  };

  end() {
    this.resized?.disconnect();
    this.seen?.disconnect();
    if (this.waiting) cancelAnimationFrame(this.waiting);
    this.model.off("msg:custom", this.answers);
    this.model.off("change:command", this.commands);
    this.model.off("comm_live_update", this.ended);
  }

  // ---- the command ----

  /** @returns {Command} */
  get command() {
    const [heading, speed, label] = this.model.get("command");
    return { heading, speed, label };
  }

  /** @param {Partial<Command>} change */
  order(change) {
    const { heading, speed, label } = { ...this.command, ...change };
    const [low, high] = this.scene.speeds;
    this.model.set("command", [heading, Math.round(20 * Math.min(high, Math.max(low, speed))) / 20, label]);
    if (!this.playing && !this.gone) this.toggle(true);
  }

  // A new command is under way from now on, until the first frames that know it are seen; what was said of the last one
  // goes.
  commanded() {
    this.steered = true;
    this.warned = true;
    this.under ??= { since: performance.now(), number: null, start: null };
  }

  /**
   * The heading of a direction on the picture: [to the right, up], where up is away from the reader.
   * @param {number[]} direction
   */
  heading(direction) {
    return headingOf(direction, this.shared.yaw);
  }

  /** @param {PointerEvent} event */
  onPad(event) {
    if (event.type === "pointerdown") {
      this.padPart.setPointerCapture(event.pointerId);
      this.panelsPart.focus({ preventScroll: true });
    } else if (!event.buttons) return;
    const { x, y, width } = this.padPart.getBoundingClientRect();
    const [low, high] = this.scene.speeds;
    const right = (2 * (event.clientX - x)) / width - 1;
    const up = 1 - (2 * (event.clientY - y)) / width;
    const far = Math.hypot(right, up);
    if (far > 0.1) {
      this.order({
        heading: this.heading([right, up]),
        speed: low + (high - low) * Math.min(1, Math.max(0, (far - 0.3) / 0.6)),
      });
    }
    event.preventDefault();
  }

  /**
   * @param {PointerEvent} event
   * @param {Panel} panel
   */
  onGround(event, { camera, walker }) {
    this.panelsPart.focus({ preventScroll: true });
    if (this.time === null || !camera.eye) return; // nothing was drawn yet
    const point = camera.ground(event.offsetX, event.offsetY);
    if (!point) return;
    const [x, , z] = walker.pose(this.time);
    const right = point[0] - x;
    const ahead = point[1] - z;
    if (Math.hypot(right, ahead) > 0.2) this.order({ heading: Math.atan2(right, ahead) });
  }

  /**
   * Wherever the focus is in the widget; a slider and a list keep their own keys, and so does space on a button.
   * @param {KeyboardEvent} event
   */
  key(event) {
    if (this.leaves(event)) return;
    const name = keyName(event);
    const direction = DIRECTIONS[name];
    if (direction && event.shiftKey && name.startsWith("Arrow")) this.orbit(direction);
    else if (direction) this.hold(name, event.repeat);
    else if (ORDERS[name]) ORDERS[name](this);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  /**
   * Whether a key is left to the browser or to a part of the page.
   * @param {KeyboardEvent} event
   */
  leaves({ ctrlKey, metaKey, altKey, target, key }) {
    if (ctrlKey || metaKey || altKey) return true;
    if (target === this.playPart) return key === " ";
    return target instanceof Element && target.matches("input, select");
  }

  /**
   * Hold a key of a direction: two of them are one between.
   * @param {string} name
   * @param {boolean} repeated
   */
  hold(name, repeated) {
    this.held.add(name);
    const [right, up] = [...this.held]
      .map((key) => DIRECTIONS[key])
      .reduce(([a, b], [c, d]) => [a + c, b + d], [0, 0]);
    if (!repeated && (right || up)) this.order({ heading: this.heading([right, up]) });
  }

  /** @param {number[]} direction */
  orbit([right, up]) {
    this.shared.yaw += 0.1 * right;
    this.shared.pitch = Math.min(1.55, Math.max(0.05, this.shared.pitch + 0.1 * up));
    this.update();
  }

  /**
   * The wheel zooms where the pictures have the focus; elsewhere it scrolls the page.
   * @param {WheelEvent} event
   */
  wheel(event) {
    if (document.activeElement !== this.panelsPart) return;
    event.preventDefault();
    this.shared.zoom = Math.min(4, Math.max(0.3, this.shared.zoom * Math.exp(-event.deltaY / 400)));
    this.update();
  }

  // ---- Python ----

  // The last second that all characters have walked.
  get walked() {
    return Math.min(...this.panels.map(({ walker }) => walker.end));
  }

  // The seconds of it that are not yet shown.
  get ahead() {
    return this.time === null ? 0 : this.walked - this.time;
  }

  // The seconds that must be ahead when a question is asked: as long as nearly all answers take, and a little more.
  get lead() {
    return Math.min(0.5, [...this.trips].sort((a, b) => b - a)[this.trips.length >> 3] / 1000 + GENTLE);
  }

  // The seconds that Python has been asked for, and has not sent.
  get promised() {
    return [...this.asked.values()].reduce((sum, { seconds }) => sum + seconds, 0);
  }

  ask() {
    const missing = this.time === null ? PIECE : this.lead - this.ahead - this.promised;
    const seconds = Math.max(PIECE, missing);
    if (missing <= 0 || this.asked.size >= MOST || this.gone) return;
    this.asked.set(++this.number, { at: performance.now(), seconds });
    if (this.under && this.under.number === null) this.under.number = this.number;
    try {
      this.model.send({
        kind: "ask",
        view: this.view,
        number: this.number,
        seconds,
        command: this.model.get("command"),
      });
      this.model.save_changes(); // after the question, which carries the command as well, and is in a hurry
    } catch {
      this.ended();
    }
  }

  /**
   * @param {Refused | Walked} content
   * @param {DataView<ArrayBuffer>[]} buffers
   */
  answered(content, buffers) {
    if (this.gone) return; // an answer that was under way would take back what was said of the end
    if (content.kind === "refused") {
      this.showMessage(content.why, true);
      this.asked.clear();
      return;
    }
    if (content.view === this.view) this.timeTrip(content);
    content.members.forEach((member, k) => this.panels[k].walker.add(member, numbersOf(buffers[k])));
    if (content.notes.length) this.showMessage(content.notes.join("\n"));
    else if (this.late || this.warned) this.showMessage("");
    this.late = false;
    this.warned = false;
    this.cost = content.cost;
    const { walked } = this;
    this.time ??= walked;
    if (this.time < walked - 1) this.time = walked - 0.1; // after a long pause in another view
    this.update();
  }

  /**
   * Remember how long the answer took, and the first frame that a new command affects.
   * @param {Walked} walked
   */
  timeTrip({ number, members }) {
    const question = this.asked.get(number);
    if (question) this.trips = [...this.trips.slice(-19), performance.now() - question.at];
    this.asked.delete(number);
    if (this.under?.number === number) this.under.start = members[0].first / this.panels[0].walker.fps;
  }

  // ---- time and pictures ----

  update() {
    this.waiting ??= requestAnimationFrame((now) => this.tick(now));
  }

  /** @param {number} now */
  tick(now) {
    this.waiting = null;
    if (!this.root.isConnected || !this.visible || this.time === null) {
      this.last = null;
      return;
    }
    const seconds = this.last ? Math.min(0.1, (now - this.last) / 1000) : 0;
    const before = performance.now();
    this.last = this.playing ? now : null;
    if (this.playing) {
      const ahead = Math.max(0, this.ahead);
      this.time += Math.min(ahead, seconds * Math.min(1, ahead / GENTLE));
      this.ask();
      this.arrived(this.time);
      this.update();
    }
    this.draw(seconds);
    this.scripted += performance.now() - before;
  }

  /**
   * Note how long the new command was under way, when the first frames that it affects are shown.
   * @param {number} time
   */
  arrived(time) {
    const { under } = this;
    if (under && under.start !== null && time >= under.start) {
      this.latencies = [...this.latencies.slice(-8), performance.now() - under.since];
      this.under = null;
    }
    const [oldest] = this.asked.values();
    const silent = oldest ? performance.now() - oldest.at : 0;
    if (silent > LOST) {
      this.showMessage("Python does not answer. Has it ended? Then run the cell again.", true);
    } else if (silent > SILENT) this.showMessage("Python is busy: the figures wait until it answers.");
    this.late = silent > SILENT;
  }

  /** @param {number} seconds */
  draw(seconds) {
    const dark = isDark();
    const palette = dark ? DARK : LIGHT;
    const { sides, marks } = this.scene;
    const time = this.time ?? this.walked;
    this.root.classList.toggle("dark", dark);
    for (const { camera, picture, walker } of this.panels) {
      Object.assign(camera, this.shared);
      walker.trail = walker.trailUntil(time, marks.seam);
      const target = walker.target(time, seconds);
      const asked = this.arrow(target);
      picture.draw({
        characters: [walker],
        time,
        asked,
        drawn: [],
        pen: null,
        sides,
        marks,
        palette,
        ghosts: false,
        target,
        distance: 4.2,
        reach: 3,
        light: dark ? LOOKS.dark : LOOKS.light,
      });
    }
    this.pictures++;
    if (this.pictures % 6 === 1 || !this.playing) this.showState(time);
  }

  /**
   * The command as an arrow on the ground, longer for a faster one.
   * @param {number[]} place
   */
  arrow(place) {
    const { heading, speed } = this.command;
    return arrowOf(place, heading, speed);
  }

  showCommand() {
    const { heading, speed, label } = this.command;
    const [low, high] = this.scene.speeds;
    const { yaw } = this.shared;
    const [s, c] = [Math.sin(heading), Math.cos(heading)];
    const right = s * Math.cos(yaw) - c * Math.sin(yaw);
    const up = -s * Math.sin(yaw) - c * Math.cos(yaw);
    const far = 46 * (0.3 + 0.6 * ((speed - low) / (high - low)));
    this.knob.style.transform = `translate(${(far * right).toFixed(1)}px, ${(-far * up).toFixed(1)}px)`;
    this.speedPart.value = String(speed);
    this.speedSaid.textContent = `${speed.toFixed(2)} m/s`;
    this.kindPart.value = label;
  }

  /** @param {number} time */
  showState(time) {
    this.showCommand();
    for (const { walker, state, fault } of this.panels) {
      const { waited, obeyed } = walker.frame(time);
      const { delays } = walker;
      const mean = delays.length
        ? ` · mean of ${delays.length}: ${(delays.reduce((a, b) => a + b) / delays.length).toFixed(2)} s`
        : "";
      // Nothing is said of what no reader asked for.
      const told = this.steered
        ? ` · ${obeyed ? "obeyed after" : "not yet, after"} ${waited.toFixed(2)} s${mean}`
        : "";
      state.textContent = `${walker.speed(time).toFixed(1)} m/s${told}`;
      if (fault.textContent !== walker.fault) fault.textContent = walker.fault;
    }
    const latencies = [...this.latencies].sort((a, b) => a - b);
    const median = latencies.length ? (latencies[latencies.length >> 1] / 1000).toFixed(2) : null;
    this.underPart.textContent = median
      ? `A command is under way to Python and back for ${median} s, which are not counted above.`
      : "";
    Object.assign(this.root.dataset, { playing: this.playing, latency: median ?? "" });
  }
}

/** @param {KeyboardEvent} event */
function keyName(event) {
  return event.key.length === 1 ? event.key.toLowerCase() : event.key;
}

/**
 * The numbers of a buffer, wherever its bytes begin.
 * @param {DataView<ArrayBuffer> | ArrayBuffer} buffer
 */
function numbersOf(buffer) {
  const view = ArrayBuffer.isView(buffer) ? buffer : new DataView(buffer);
  return new Float32Array(view.buffer.slice(view.byteOffset, view.byteOffset + view.byteLength));
}

// In JupyterLab: called by anywidget.
export default {
  /** @param {Rendered} rendered */
  render({ model, el }) {
    const steering = new Steering(el, model);
    Object.assign(el, { steering });
    return () => steering.end();
  },
};
