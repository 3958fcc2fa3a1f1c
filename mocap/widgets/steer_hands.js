// The hands of the reader: keys, a gamepad, the mouse and fingers become one command.
//
// Directions are those of the picture: up walks away from the reader. If none is given, the figure is asked to stand.

import { headingOf } from "./steered_command.js";

/**
 * @import { Camera } from "./player_scene.js"
 * @import { Order } from "./steer_link.js"
 *
 * The kinds of motion and the speeds to choose from, as `SteeredSession.scene` packs them.
 * @typedef {{
 *   labels: string[], speeds: number[], paces: Record<string, number>, fast: [label: string, speed: number],
 *   stands: boolean,
 * }} Paces
 */

// The keys by their places on the keyboard, whatever its letters are.
/** @type {Record<string, [right: number, up: number]>} */
const DIRECTIONS = {
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  KeyW: [0, 1],
  KeyS: [0, -1],
  KeyA: [-1, 0],
  KeyD: [1, 0],
};
const FAST_KEYS = ["ShiftLeft", "ShiftRight"];
const QUIET = 0.25; // of a stick's way: less is no direction
const STEP = Math.PI / 36; // radians between the headings of sticks and mice: Python plans anew for each
const REACHED = 0.3; // metres from a place on the ground that is reached
const STOPPING = 0.6; // seconds before it, in which the figure is asked to stand
// Buttons of a gamepad in its standard layout.
const PAD = { record: 0, fast: [5, 7], pause: 9 };

export class Hands {
  /** @type {Set<string>} the keys that are held down */
  held = new Set();
  /** @type {number[]} the left stick of a gamepad: to the right, up */
  stick = [0, 0];
  /** @type {number} the right stick, which turns the view */
  turn = 0;
  fastButton = false;
  /** @type {number[] | null} a position [x, z] on the ground to walk to */
  goal = null;
  /** @type {number[] | null} the pixel at which the ground is pressed */
  pixel = null;
  heading = 0;
  /** @type {Set<number>} the buttons of the gamepad that were down */
  down = new Set();

  /** @param {Paces} paces */
  constructor(paces) {
    this.paces = paces;
    this.label = paces.labels[0];
    this.speed = paces.paces[this.label];
  }

  /** Whether a key is one of direction or pace; it is then held. @param {string} code */
  press(code) {
    if (!(code in DIRECTIONS) && !FAST_KEYS.includes(code)) return false;
    this.held.add(code);
    if (code in DIRECTIONS) this.goal = null;
    return true;
  }

  /** @param {string} code */
  release(code) {
    this.held.delete(code);
  }

  get isFast() {
    return this.fastButton || FAST_KEYS.some((code) => this.held.has(code));
  }

  /** The direction on the picture that keys or the stick give: to the right, up. */
  get direction() {
    const keys = [...this.held].map((code) => DIRECTIONS[code] ?? [0, 0]);
    const sum = keys.reduce(([right, up], [a, b]) => [right + a, up + b], [0, 0]);
    return Math.hypot(...sum) > 0 ? sum : this.stick;
  }

  /**
   * Read the first gamepad that is connected. Its buttons that were pressed since are returned, by name.
   * @returns {string[]}
   */
  readPad() {
    const pad = navigator.getGamepads().find((one) => one?.connected);
    if (!pad) {
      this.stick = [0, 0];
      return [];
    }
    const [right, down, across = 0] = pad.axes;
    this.stick = Math.hypot(right, down) > QUIET ? [right, -down] : [0, 0];
    if (this.stick[0] || this.stick[1]) this.goal = null;
    this.turn = Math.abs(across) > QUIET ? across : 0;
    this.fastButton = PAD.fast.some((number) => pad.buttons[number]?.pressed);
    const now = new Set([PAD.record, PAD.pause].filter((number) => pad.buttons[number]?.pressed));
    const fresh = [...now].filter((number) => !this.down.has(number));
    this.down = now;
    return fresh.map((number) => (number === PAD.record ? "record" : "pause"));
  }

  /**
   * The command of this moment.
   * @param {Camera} camera
   * @param {number[]} place of the figure: x, y, z
   * @returns {Order}
   */
  command(camera, [x, , z]) {
    if (this.pixel) this.goal = camera.ground(this.pixel[0], this.pixel[1]) ?? this.goal;
    const { direction } = this;
    const far = Math.min(1, Math.hypot(...direction));
    const [label, speed] = this.isFast ? this.paces.fast : [this.label, this.speed];
    if (far > 0) {
      this.heading = inSteps(headingOf(direction, camera.yaw));
      const some = Math.max(this.paces.speeds[0], Math.round(10 * far * speed) / 10); // of a stick halfway
      return [this.heading, far < 1 ? some : speed, label];
    }
    if (this.goal) {
      const [right, ahead] = [this.goal[0] - x, this.goal[1] - z];
      if (this.pixel || Math.hypot(right, ahead) > REACHED + STOPPING * speed) {
        if (Math.hypot(right, ahead) > REACHED) this.heading = inSteps(Math.atan2(right, ahead));
        return [this.heading, speed, label];
      }
      this.goal = null;
    }
    return [this.heading, 0, ""];
  }
}

/** @param {number} angle */
const inSteps = (angle) => STEP * Math.round(angle / STEP);
