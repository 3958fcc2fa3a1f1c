// Input on the canvas: rotating and zooming the view, and drawing a path, by mouse, touch or keys.

import { PEN_KEYS } from "./player_page.js";

/**
 * @import { Camera } from "./player_scene.js"
 *
 * The object that a hand controls: a player, or an inspector, which has no path to draw and no part to mark.
 * @typedef {object} Handled
 * @property {HTMLElement} root
 * @property {HTMLCanvasElement} canvas
 * @property {HTMLInputElement} scrub
 * @property {Camera} camera
 * @property {number[]} panned metres [x, z] that the reader has moved the view
 * @property {number} reach metres from the camera to what is looked at
 * @property {{ fps: number, asked?: number[][] }} scene
 * @property {number} seconds
 * @property {boolean} [chase] whether the view rotates with the walk
 * @property {boolean} [drawing] whether the hand draws a path
 * @property {() => number} frame
 * @property {(time: number) => void} seek
 * @property {(playing?: boolean) => void} toggle
 * @property {() => void} update
 * @property {(text: string) => void} showMessage
 * @property {() => void} [mark]
 * @property {(path: number[][]) => void} [ask]
 */

const SHORTEST = 0.5; // metres of a path that can be walked
const LONGEST = 100;
const PEN_STEP = 0.25; // metres per press of an arrow key
/** @type {Record<string, number[]>} */
const ARROWS = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] }; // radians
const PAN = 300; // pixels per radian of these

// The actions of keys on the canvas, beside the arrows.
/** @type {Record<string, (hand: Hand) => void>} */
const ON_CANVAS = {
  " ": ({ player }) => player.toggle(),
  "+": (hand) => hand.zoomBy(1.15),
  "-": (hand) => hand.zoomBy(1 / 1.15),
  Home: ({ player }) => player.seek(0),
  End: ({ player }) => player.seek(player.seconds),
  p: (hand) => hand.takePen(),
  l: ({ player }) => player.mark?.(),
};

// Conditions of keys that not all players have.
/** @type {Record<string, (hand: Hand) => boolean>} */
const OFFERED = {
  p: ({ player }) => Boolean(player.drawing),
  l: ({ player }) => Boolean(player.mark),
};

// The actions of keys while the pen is down, beside the arrows.
/** @type {Record<string, (hand: Hand) => void>} */
const WITH_PEN = {
  Backspace: (hand) => hand.takeBack(),
  Enter: (hand) => hand.putPenAway(() => hand.walk()),
  Escape: (hand) => hand.putPenAway(() => hand.forget()),
};

export class Hand {
  /** @type {Map<number, PointerEvent>} */
  pointers = new Map();
  /** @type {number[][]} positions [x, z] of a path */
  drawn = [];
  /** @type {number | null} the pointer that draws */
  stroke = null;
  /** @type {boolean} whether the keys draw */
  pen = false;
  /** @type {{ yaw: number, pitch: number }} of the camera when a finger came down */
  before = { yaw: 0, pitch: 0 };
  /** @type {number | undefined} of the camera when the path was drawn */
  yaw;

  /** @param {Handled} player */
  constructor(player) {
    this.player = player;
    const { canvas } = player;
    for (const kind of /** @type {const} */ (["pointerdown", "pointermove", "pointerup", "pointercancel"])) {
      canvas.addEventListener(kind, (event) => this[kind](event));
    }
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    player.root.addEventListener("keydown", (event) => this.key(event));
  }

  get camera() {
    return this.player.camera;
  }

  // While the hand draws, figure and view wait.
  get busy() {
    return this.stroke !== null || this.pen;
  }

  /**
   * @param {number} yaw
   * @param {number} pitch
   */
  orbit(yaw, pitch) {
    this.player.chase = false;
    this.camera.yaw += yaw;
    this.camera.pitch = Math.min(1.55, Math.max(0.02, this.camera.pitch + pitch));
    this.player.update();
  }

  /** @param {number} factor */
  zoomBy(factor) {
    this.camera.zoom = Math.min(12, Math.max(0.2, this.camera.zoom * factor));
    this.player.update();
  }

  /**
   * Move what is looked at over the ground, in pixels.
   * @param {number} across
   * @param {number} down
   */
  pan(across, down) {
    const { right, ahead, focus } = this.camera;
    const metres = this.player.reach / (this.camera.zoom * focus);
    const level = Math.hypot(ahead[0], ahead[2]) || 1;
    [0, 2].forEach((k, i) => {
      this.player.panned[i] += metres * ((down * ahead[k]) / level - across * right[k]);
    });
    this.player.update();
  }

  // ---- mouse and fingers ----

  /**
   * The wheel zooms where the canvas has the focus; elsewhere it scrolls the page.
   * @param {WheelEvent} event
   */
  wheel(event) {
    if (!event.ctrlKey && document.activeElement !== this.player.canvas) return;
    event.preventDefault();
    this.zoomBy(Math.exp(-event.deltaY / 400));
  }

  /** @param {PointerEvent} event */
  pointerdown(event) {
    this.player.canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, event);
    this.before = { yaw: this.camera.yaw, pitch: this.camera.pitch };
    this.stroke =
      this.player.drawing && event.button === 0 && this.pointers.size === 1 ? event.pointerId : null;
    if (this.stroke !== null) this.drawn = [];
  }

  /**
   * One finger or the mouse turns the view; two fingers zoom and move it, as shift or the right button do. In drawing
   * mode, one finger or the left button draws.
   * @param {PointerEvent} event
   */
  pointermove(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const others = [...this.pointers.values()].filter((other) => other.pointerId !== event.pointerId);
    /**
     * @param {PointerEvent} p
     * @param {PointerEvent} q
     */
    const from = (p, q) => Math.hypot(p.offsetX - q.offsetX, p.offsetY - q.offsetY);
    this.pointers.set(event.pointerId, event);
    const [across, down] = [event.offsetX - before.offsetX, event.offsetY - before.offsetY];
    if (others.length) {
      this.zoomBy(from(event, others[0]) / Math.max(1, from(before, others[0])));
      this.pan(across / 2, down / 2);
    } else if (event.shiftKey || event.buttons === 2) this.pan(across, down);
    else if (this.stroke === event.pointerId) this.draw(this.camera.ground(event.offsetX, event.offsetY));
    else this.orbit(-across / 150, down / 150);
  }

  /** @param {PointerEvent} event */
  pointerup(event) {
    this.pointers.delete(event.pointerId);
    if (this.stroke === event.pointerId) this.walk();
    this.stroke = null;
    this.player.update();
  }

  /**
   * The finger scrolls the page: the rotation of the view until that was clear is undone.
   * @param {PointerEvent} event
   */
  pointercancel(event) {
    this.pointers.delete(event.pointerId);
    this.stroke = null;
    Object.assign(this.camera, this.before);
    this.player.update();
  }

  // ---- the path that is drawn ----

  /** @param {number[] | null} position */
  draw(position) {
    const last = this.drawn.at(-1);
    if (position && (!last || Math.hypot(position[0] - last[0], position[1] - last[1]) > 0.05)) {
      this.drawn.push(position);
    }
    this.player.update();
  }

  get metres() {
    return this.drawn.reduce(
      (sum, [x, z], i) => sum + (i ? Math.hypot(x - this.drawn[i - 1][0], z - this.drawn[i - 1][1]) : 0),
      0,
    );
  }

  // Ask for a walk along what was drawn, or say why there is none.
  walk() {
    const { metres } = this;
    if (metres < SHORTEST) {
      this.player.showMessage(
        `That is ${metres.toFixed(1)} m. Drag over the ground for at least ${SHORTEST} m.`,
      );
    } else if (metres > LONGEST) {
      this.player.showMessage(`That is ${metres.toFixed(0)} m. Draw at most ${LONGEST} m, or zoom in.`);
    } else {
      this.yaw = this.camera.yaw;
      this.player.ask?.(this.drawn);
      return;
    }
    this.drawn = [];
    this.player.update();
  }

  // ---- keys ----

  /** @param {KeyboardEvent} event */
  key(event) {
    const { player } = this;
    const act = event.target === player.canvas ? this.onCanvas(event) : undefined;
    if (act) act();
    else if (event.target === player.scrub && event.key === " ") player.toggle();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  /**
   * The action of a key on the canvas, if it has one.
   * @param {KeyboardEvent} event
   * @returns {(() => void) | undefined}
   */
  onCanvas(event) {
    const { key } = event;
    const direction = ARROWS[key];
    if (direction && this.pen && !event.shiftKey) {
      return () => this.penStep(Math.sign(direction[0]), Math.sign(direction[1]));
    }
    if (direction) return this.arrowKey(direction, event);
    if (OFFERED[key] && !OFFERED[key](this)) return undefined;
    const act = (this.pen && WITH_PEN[key]) || ON_CANVAS[key];
    return act && (() => act(this));
  }

  /**
   * The action of an arrow: it rotates or pans the view, or shows the next frame.
   * @param {number[]} direction
   * @param {KeyboardEvent} event
   * @returns {(() => void) | undefined}
   */
  arrowKey([yaw, pitch], event) {
    const { player } = this;
    if (event.shiftKey) return () => this.orbit(yaw, pitch);
    if (event.altKey) return () => this.pan(PAN * yaw, PAN * pitch);
    if (!yaw) return undefined; // up and down scroll the page
    return () => {
      player.toggle(false);
      player.seek((player.frame() + Math.sign(yaw)) / player.scene.fps);
    };
  }

  takePen() {
    const start = this.player.scene.asked?.[0] ?? [0, 0];
    this.pen = true;
    this.drawn = [[...start]];
    this.player.showMessage(`The pen is down. ${PEN_KEYS}`);
    this.player.update();
  }

  /**
   * Draw a step to the right or the left, up or down: up is away from the camera.
   * @param {number} across
   * @param {number} up
   */
  penStep(across, up) {
    const [x, z] = this.drawn[this.drawn.length - 1];
    const { ahead, right } = this.camera;
    const a = across * PEN_STEP;
    const b = (up * PEN_STEP) / (Math.hypot(ahead[0], ahead[2]) || 1);
    this.drawn.push([x + a * right[0] + b * ahead[0], z + a * right[2] + b * ahead[2]]);
    this.player.showMessage(`${this.metres.toFixed(2)} m drawn. ${PEN_KEYS}`);
    this.player.update();
  }

  takeBack() {
    if (this.drawn.length > 1) this.drawn.pop();
    this.player.update();
  }

  forget() {
    this.drawn = [];
    this.player.showMessage("");
  }

  /** @param {() => void} then */
  putPenAway(then) {
    this.pen = false;
    then();
    this.player.update();
  }
}
