// What the player shows: characters, and the camera that sees them. `player.py` joins the scripts to one module.
//
// World: y up, metres, seconds. The camera turns about a target; `Camera.see` and `pixel` are the whole projection.

/**
 * Which clip a walk plays from a time on.
 * @typedef {{ start: number, name: string, colour: string }} Source
 *
 * Colours of what is marked on a path.
 * @typedef {{ seam: string, astray: string }} Marks
 *
 * Points [x, y, z, time] of one colour.
 * @typedef {{ colour: string, line: number[][] }} Trail
 *
 * A capsule of a part: [part, end, radius, other end, its radius, how flat it is, side].
 * @typedef {[number, number[], number, number[], number, number, number]} Piece
 *
 * What is drawn around the joints of a body, as `posed` in `walk_figure.py` packs it.
 * @typedef {{ parts: number[][], pieces: Piece[] }} PackedFigure
 *
 * A body without a place: `bones` are [from, to, side], `head` is a joint.
 * @typedef {PackedFigure & { joints: number, bones: number[][], head: number | null }} PackedBody
 *
 * A character, as `packed_character` in `player.py` packs it: times are in seconds, places in metres; `prints` are
 * [start, end, x, z, side], and `astray` are the times [start, end] at which it is off the path that was asked for.
 * @typedef {PackedBody & {
 *   name: string, fps: number, frames: number, offset: number, low: number[], step: number[],
 *   colour: string, path_colour: string,
 *   sources: Source[], seams: number[], astray: number[][], prints: number[][],
 * }} PackedCharacter
 *
 * Bytes, deflated: in base64 on a page, from a kernel as they are.
 * @typedef {string | Uint8Array<ArrayBuffer> | DataView<ArrayBuffer>} Packed
 *
 * What a player shows, as `player.py` packs it.
 * @typedef {object} Scene
 * @property {string} alt
 * @property {number} number which scene of its player it is
 * @property {boolean} reports whether Python listens to the frame
 * @property {boolean} follow
 * @property {boolean} [drawable] whether the reader may draw a path
 * @property {boolean} [autoplay]
 * @property {number} [yaw] radians, from where the camera looks first
 * @property {string[]} sides the colours of the middle, the left and the right of a body
 * @property {Marks} marks
 * @property {number} fps
 * @property {number} frames
 * @property {number[][]} asked positions [x, z] of the path that was asked for
 * @property {number[][]} obstacles discs [x, z, radius]
 * @property {number[][]} [boxes] x, y and z of the lowest corner, and of the highest one
 * @property {PackedCharacter[]} characters
 * @property {Packed} data
 */

export class Camera {
  /** @type {number} */
  home = 0.7; // the yaw to which the view returns
  yaw = 0.7;
  /** @type {number} */
  pitch = 0.25;
  /** @type {number} */
  zoom = 1;
  /** @type {number[]} */
  eye;
  /** @type {number[]} */
  right;
  /** @type {number[]} */
  up;
  /** @type {number[]} */
  ahead;
  /** @type {number} pixels */
  focus;
  /** @type {number[]} pixels */
  middle;
  /** @type {number} */
  across;
  /** @type {number} */
  down;
  /** @type {number} */
  far;

  /** @param {number} pitch */
  reset(pitch) {
    this.yaw = this.home;
    this.pitch = pitch;
    this.zoom = 1;
  }

  /**
   * Stand `distance` away from `target`, on a canvas of width × height pixels.
   * @param {number[]} target
   * @param {number} distance
   * @param {number} width
   * @param {number} height
   */
  place(target, distance, width, height) {
    const d = distance / this.zoom;
    const cy = Math.cos(this.yaw);
    const sy = Math.sin(this.yaw);
    const cp = Math.cos(this.pitch);
    const sp = Math.sin(this.pitch);
    this.eye = [target[0] + d * sy * cp, target[1] + d * sp, target[2] + d * cy * cp];
    this.right = [cy, 0, -sy];
    this.up = [-sy * sp, cp, -cy * sp];
    this.ahead = [-sy * cp, -sp, -cy * cp];
    this.focus = 1.5 * Math.min(width, height);
    this.middle = [width / 2, height / 2];
  }

  /**
   * The position of a point relative to the camera: [to the right, up, ahead], metres.
   * @param {number} x
   * @param {number} y
   * @param {number} z
   */
  see(x, y, z) {
    const a = x - this.eye[0];
    const b = y - this.eye[1];
    const c = z - this.eye[2];
    /** @param {number[]} v */
    const along = (v) => a * v[0] + b * v[1] + c * v[2];
    return [along(this.right), along(this.up), along(this.ahead)];
  }

  /** @param {number[]} seen */
  pixel([right, up, ahead]) {
    const scale = this.focus / ahead;
    return [this.middle[0] + right * scale, this.middle[1] - up * scale];
  }

  /**
   * The same without an array for each of thousands of points: sets `across`, `down` (pixels) and `far` (metres ahead).
   * @param {number} x
   * @param {number} y
   * @param {number} z
   */
  project(x, y, z) {
    const a = x - this.eye[0];
    const b = y - this.eye[1];
    const c = z - this.eye[2];
    const { right, up, ahead } = this;
    this.far = a * ahead[0] + b * ahead[1] + c * ahead[2];
    const scale = this.focus / this.far;
    this.across = this.middle[0] + (a * right[0] + b * right[1] + c * right[2]) * scale;
    this.down = this.middle[1] - (a * up[0] + b * up[1] + c * up[2]) * scale;
  }

  /**
   * The point of the ground under a pixel, or null above the horizon.
   * @param {number} px
   * @param {number} py
   */
  ground(px, py) {
    const r = (px - this.middle[0]) / this.focus;
    const u = (this.middle[1] - py) / this.focus;
    const ray = [0, 1, 2].map((i) => this.ahead[i] + r * this.right[i] + u * this.up[i]);
    const far = -this.eye[1] / ray[1];
    return far > 0 && far < 100 ? [this.eye[0] + far * ray[0], this.eye[2] + far * ray[2]] : null;
  }
}

/**
 * Inflate bytes.
 * @param {Packed} data
 */
export async function inflated(data) {
  /** @param {string} text */
  const fromBase64 = (text) =>
    Uint8Array.fromBase64?.(text) ?? Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const bytes = typeof data === "string" ? fromBase64(data) : data;
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

/**
 * Undo the second differences over time of `player.py`, channel by channel; the numbers wrap around as their type does.
 * @template {Int32Array | Uint16Array} T
 * @param {T} numbers
 * @param {number} frames
 * @returns {T}
 */
export function summed(numbers, frames) {
  let change = 0;
  let number = 0;
  for (let i = 0; i < numbers.length; i++) {
    if (i % frames === 0) {
      change = 0;
      number = 0;
    }
    change = (change + numbers[i]) | 0;
    number = (number + change) | 0;
    numbers[i] = number;
  }
  return numbers;
}

// A character: the positions of its joints at any time. A coordinate is low + step · number metres, with a 16-bit number.
export class Character {
  /** @type {number[]} its displacement, metres */
  away;
  /** @type {number[][]} */
  prints;
  /** @type {number[][]} [time, x, z] */
  path;
  /** @type {Trail[]} */
  trail;
  /** @type {number[][]} */
  diamonds;

  /**
   * @param {PackedCharacter} packed
   * @param {ArrayBuffer} bytes
   * @param {Partial<Marks>} marks
   */
  constructor(packed, bytes, marks) {
    this.fps = packed.fps;
    this.frames = packed.frames;
    this.joints = packed.joints;
    this.bones = packed.bones;
    this.head = packed.head;
    this.parts = packed.parts;
    this.pieces = packed.pieces;
    this.low = packed.low;
    this.step = packed.step;
    this.name = packed.name;
    this.colour = packed.colour;
    this.path_colour = packed.path_colour;
    this.sources = packed.sources;
    this.seams = packed.seams;
    this.astray = packed.astray;
    this.numbers = summed(
      new Uint16Array(bytes, packed.offset, packed.frames * packed.joints * 3),
      packed.frames,
    );
    this.seconds = (packed.frames - 1) / packed.fps;
    this.stands = packed.prints;
    this.move(0, 0, marks);
  }

  /**
   * Displace the character by some metres.
   * @param {number} x
   * @param {number} z
   * @param {Partial<Marks>} marks
   */
  move(x, z, marks) {
    this.away = [x, 0, z];
    this.prints = this.stands.map(([start, end, px, pz, side]) => [start, end, px + x, pz + z, side]);
    this.path = this.pathOnGround();
    this.trail = this.colouredPath(marks);
    this.diamonds = this.seams.map((time) => {
      const root = this.pose(time);
      return [root[0], 0, root[2]];
    });
  }

  /**
   * All joints at a time, interpolated between two frames: x, y, z, x, y, z, ...
   * @param {number} time
   */
  pose(time) {
    const at = Math.min(Math.max(time, 0), this.seconds) * this.fps;
    const frame = Math.min(Math.floor(at), this.frames - 1);
    const fraction = at - frame;
    const next = Math.min(frame + 1, this.frames - 1);
    const positions = new Float32Array(this.joints * 3);
    for (let i = 0; i < positions.length; i++) {
      positions[i] = this.coordinate(i, frame) * (1 - fraction) + this.coordinate(i, next) * fraction;
    }
    return positions;
  }

  /**
   * A coordinate of a joint in a frame, metres.
   * @param {number} index
   * @param {number} frame
   */
  coordinate(index, frame) {
    return (
      this.away[index % 3] +
      this.low[index % 3] +
      this.step[index % 3] * this.numbers[index * this.frames + frame]
    );
  }

  // [time, x, z] of the root, at fewer than 2000 times.
  pathOnGround() {
    const every = Math.max(1, Math.floor(this.frames / 1000));
    const path = [];
    for (let frame = 0; frame < this.frames; frame += every) {
      path.push([frame / this.fps, this.coordinate(0, frame), this.coordinate(2, frame)]);
    }
    return path;
  }

  /**
   * The path as lines of one colour: that of the clip, or red where it is off the path that was asked for.
   * @param {Partial<Marks>} marks
   */
  colouredPath({ astray = this.path_colour }) {
    /** @param {number} time */
    const own = (time) => (this.sources.length ? this.colourAt(time) : this.path_colour);
    /** @type {Trail[]} */
    const lines = [];
    /** @param {number} time */
    const colourOf = (time) =>
      this.astray.some(([start, end]) => start <= time && time < end) ? astray : own(time);
    for (const [time, x, z] of this.path) {
      const colour = colourOf(time);
      const last = lines.at(-1);
      if (last) last.line.push([x, 0, z, time]);
      if (last?.colour !== colour) lines.push({ colour, line: [[x, 0, z, time]] });
    }
    return lines;
  }

  /**
   * The colour of the clip that a time comes from.
   * @param {number} time
   */
  colourAt(time) {
    let colour = this.colour;
    for (const source of this.sources) if (source.start <= time + 1e-9) colour = source.colour;
    return colour;
  }
}
