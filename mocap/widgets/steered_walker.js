// A character whose frames come bit by bit, and are drawn while they come.

/**
 * @import { PackedBody, Trail } from "./player_scene.js"
 *
 * A character that is steered, as `steered_widget.py` packs it.
 * @typedef {PackedBody & { name: string, fps: number, colour: string }} PackedMember
 *
 * What Python tells of the frames that it has walked, as `Walked.report` in `company.py`.
 * @typedef {{
 *   first: number, waited: number[], obeyed: boolean[], blending: boolean[], fault: string, delays: number[],
 * }} Told
 */

const KEPT = 6; // seconds of its way that stay in sight

export class Walker {
  /** @type {{ positions: Float32Array, waited: number, obeyed: boolean, blending: boolean }[]} */
  frames = [];
  /** @type {number} the number of the first frame that is kept */
  first = 0;
  /** @type {string} the sentence of its error, or nothing */
  fault = "";
  /** @type {number[]} seconds until it obeyed each command */
  delays = [];
  /** @type {number[] | null} where the camera looks */
  centre = null;
  /** @type {Trail[]} */
  trail = [];
  /** @type {number[][]} */
  diamonds = [];
  /** @type {number[][]} */
  prints = [];

  /** @param {PackedMember} packed */
  constructor(packed) {
    this.name = packed.name;
    this.fps = packed.fps;
    this.colour = packed.colour;
    this.joints = packed.joints;
    this.bones = packed.bones;
    this.head = packed.head;
    this.parts = packed.parts;
    this.pieces = packed.pieces;
  }

  /**
   * Take frames from Python: what is said of each, and the numbers of all.
   * @param {Told} told
   * @param {Float32Array} numbers
   */
  add({ first, waited, obeyed, blending, fault, delays }, numbers) {
    if (first !== this.first + this.frames.length) {
      this.frames = [];
      this.first = first;
    }
    const size = 3 * this.joints;
    for (let k = 0; k < waited.length; k++) {
      this.frames.push({
        positions: numbers.subarray(k * size, (k + 1) * size),
        waited: waited[k],
        obeyed: obeyed[k],
        blending: blending[k],
      });
    }
    const old = Math.max(0, this.frames.length - Math.round((KEPT + 2) * this.fps));
    this.frames.splice(0, old);
    this.first += old;
    this.fault = fault;
    this.delays = delays;
  }

  // The time of its last frame, in seconds.
  get end() {
    return (this.first + this.frames.length - 1) / this.fps;
  }

  /** @param {number} time */
  frame(time) {
    const k = Math.floor(time * this.fps + 1e-6) - this.first;
    return this.frames[Math.min(Math.max(k, 0), this.frames.length - 1)];
  }

  /**
   * All joints at a time, interpolated between two frames: x, y, z, x, y, z, ...
   * @param {number} time
   */
  pose(time) {
    const at = Math.min(Math.max(time * this.fps - this.first, 0), this.frames.length - 1);
    const k = Math.floor(at);
    const fraction = at - k;
    const a = this.frames[k].positions;
    const b = this.frames[Math.min(k + 1, this.frames.length - 1)].positions;
    return a.map((from, i) => from + fraction * (b[i] - from));
  }

  /**
   * Metres per second on the ground, over the last half second.
   * @param {number} time
   */
  speed(time) {
    const half = Math.min(0.5, time - this.first / this.fps);
    const [x, , z] = this.pose(time);
    const [x0, , z0] = this.pose(time - half);
    return half > 0.1 ? Math.hypot(x - x0, z - z0) / half : 0;
  }

  /**
   * The path of its last seconds, as lines of one colour: its own, or that of seams.
   * @param {number} time
   * @param {string} seam
   */
  trailUntil(time, seam) {
    /** @type {Trail[]} */
    const lines = [];
    const every = Math.max(1, Math.round(this.fps / 10));
    const until = Math.floor(time * this.fps) - this.first;
    const from = Math.max(0, until - Math.round(KEPT * this.fps));
    for (
      let k = from + (every - ((from + this.first) % every));
      k <= until && k < this.frames.length;
      k += every
    ) {
      const { positions, blending } = this.frames[k];
      const colour = blending ? seam : this.colour;
      const last = lines.at(-1);
      last?.line.push([positions[0], 0, positions[2]]);
      if (last?.colour !== colour) lines.push({ colour, line: [[positions[0], 0, positions[2]]] });
    }
    const [x, , z] = this.pose(time);
    lines.at(-1)?.line.push([x, 0, z]);
    return lines;
  }

  /**
   * Where the camera looks: above the ground under it, a little behind, so that the view does not rock with each step.
   * @param {number} time
   * @param {number} seconds
   */
  target(time, seconds) {
    const [x, , z] = this.pose(time);
    this.centre ??= [x, 0.85, z];
    const fraction = 1 - Math.exp(-seconds / 0.3);
    this.centre = [
      this.centre[0] + fraction * (x - this.centre[0]),
      0.85,
      this.centre[2] + fraction * (z - this.centre[2]),
    ];
    return this.centre;
  }

  colourAt() {
    return this.colour;
  }
}
