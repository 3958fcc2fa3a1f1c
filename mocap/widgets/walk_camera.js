// A camera that holds a whole line, looks straight down on it, or follows a figure from three quarters in front. The
// reader's hand turns it.

import { perspective } from "./bodies.js";

/**
 * @import { Sight } from "./bodies.js"
 * @import { Line } from "./walk_search.js"
 *
 * What the scene needs of the camera.
 * @typedef {Sight & { zoom: number }} View
 */

/** @param {number[]} v */
const unit = (v) => v.map((value) => value / Math.hypot(...v));
const ACROSS = 10; // metres of the ground across the picture while a line is drawn
const INSIDE = 0.84; // of the picture: what must stay in view is not nearer to its rim
const ROOM = 2.6; // metres around a line from above: at a rim, a body leans out of it
const FOOTER = 90; // pixels below the picture from above
const STRAIGHT_DOWN = Math.PI / 2;
const CLOSE = 3.4; // metres from a figure that is seen from the side
const NAMES = /** @type {const} */ (["z", "x", "y", "yaw", "pitch", "far", "aside", "below"]);

/**
 * What is a metre away from the axis at a distance of a metre, in half widths and half heights of the picture.
 * @param {number} width
 * @param {number} height
 */
function scaleOf(width, height) {
  const up = 1 / Math.tan(width < height ? 0.42 : 0.34);
  return { across: (up * height) / width, up };
}

/**
 * The directions [z, x] of the ground that point to the right and up on a picture from straight above.
 * @param {number} yaw
 */
const axesOf = (yaw) => [
  [-Math.sin(yaw), Math.cos(yaw)],
  [-Math.cos(yaw), -Math.sin(yaw)],
];

/**
 * The matrix of a view whose middle is beside that of the picture, by parts of its half width and its half height.
 * @param {Float32Array} view
 * @param {number} across
 * @param {number} up
 */
function shifted(view, across, up) {
  for (let column = 0; column < 16; column += 4) {
    view[column] += across * view[column + 3];
    view[column + 1] += up * view[column + 3];
  }
  return view;
}

export class Camera {
  // `aside` and `below` are the shares of the picture that are covered at the right and at the bottom.
  at = { z: 0, x: 0, y: 0.5, yaw: -0.5, pitch: 0.9, far: 9, aside: 0, below: 0 };
  goal = { ...this.at };
  hand = { yaw: 0, pitch: 0, zoom: 1 };
  // Of the last picture.
  eye = [0, 0, 0];
  right = [1, 0, 0];
  up = [0, 1, 0];
  back = [0, 0, 1];
  zoom = 1;
  wide = 1;
  width = 1;
  height = 1;

  /**
   * Look at all of a line.
   * @param {Line} line
   * @param {boolean} tall
   */
  hold({ z, x }, tall) {
    const [z0, z1, x0, x1] = [Math.min(...z), Math.max(...z), Math.min(...x), Math.max(...x)];
    const far = Math.max(4.5, Math.hypot(z1 - z0, x1 - x0) * (tall ? 1.7 : 1.05) + 1.5);
    Object.assign(this.goal, { z: (z0 + z1) / 2, x: (x0 + x1) / 2, y: 0.3, pitch: 0.95, yaw: -0.5, far });
  }

  /**
   * Look straight down on all of a line, turned so that it fills the picture.
   * @param {Line} line
   * @param {number} width
   * @param {number} height
   * @param {number} footer pixels below it
   */
  holdAbove({ z, x }, width, height, footer = FOOTER) {
    const scale = scaleOf(width, height);
    const { aside, below } = this.goal;
    const free = Math.max(0.4, 1 - footer / height); // of the height, above the buttons
    let best = { far: Infinity, yaw: 0, across: [0, 0], up: [0, 0] };
    for (let yaw = 0; yaw < Math.PI; yaw += Math.PI / 24) {
      const [across, up] = axesOf(yaw).map(([az, ax]) => {
        const along = Array.from(z, (value, i) => az * value + ax * x[i]);
        return [Math.min(...along), Math.max(...along)];
      });
      const far = Math.max(
        (((across[1] - across[0] + ROOM) / 2) * scale.across) / (1 - aside),
        (((up[1] - up[0] + ROOM) / 2) * scale.up) / free / (1 - below),
        3,
      );
      if (far < best.far) best = { far, yaw, across, up };
    }
    const [right, upward] = axesOf(best.yaw);
    const a = (best.across[0] + best.across[1]) / 2;
    const b = (best.up[0] + best.up[1]) / 2 - ((1 - free) * best.far) / scale.up;
    Object.assign(this.goal, {
      z: a * right[0] + b * upward[0],
      x: a * right[1] + b * upward[1],
      y: 0,
      pitch: STRAIGHT_DOWN,
      yaw: best.yaw,
      far: best.far,
    });
  }

  /**
   * Look straight down at once, `ACROSS` metres across, for a line to be drawn: what is under a point of the picture
   * stays there if what must be seen stays in view.
   * @param {number[] | null} seen
   * @param {number[]} pixel
   * @param {number} width
   * @param {number} height
   */
  lookDown(seen, pixel, width, height) {
    const point = this.ground(pixel[0], pixel[1]);
    const yaw = this.at.yaw + this.hand.yaw;
    const [right, up] = axesOf(yaw);
    const half = ACROSS / 2;
    const across = half * ((2 * pixel[0]) / width - 1);
    const upward = half * (height / width) * (1 - (2 * pixel[1]) / height);
    const [z, x] = point
      ? [0, 1].map((c) => point[c] - across * right[c] - upward * up[c])
      : (seen ?? [this.at.z, this.at.x]);
    const far = half * scaleOf(width, height).across;
    Object.assign(this.hand, { yaw: 0, pitch: 0, zoom: 1 });
    Object.assign(this.at, { z, x, y: 0, pitch: STRAIGHT_DOWN, yaw, far, aside: 0, below: 0 });
    this.goal = { ...this.at };
    if (seen) this.keepInView(seen, width, height);
    this.view(width, height);
  }

  /**
   * Move a camera that looks down so that a point is in the picture.
   * @param {number[]} point
   * @param {number} width
   * @param {number} height
   */
  keepInView([z, x], width, height) {
    const scale = scaleOf(width, height);
    const limits = [this.at.far / scale.across, this.at.far / scale.up].map((half) => INSIDE * half);
    axesOf(this.at.yaw).forEach(([az, ax], k) => {
      const off = az * (z - this.at.z) + ax * (x - this.at.x);
      const beyond = off - Math.max(-limits[k], Math.min(off, limits[k]));
      this.at.z += beyond * az;
      this.at.x += beyond * ax;
    });
    this.goal = { ...this.at };
  }

  /**
   * Follow a position with a heading; `reach` is the extent of the group of figures, in metres.
   * @param {number} seconds
   * @param {number[]} position
   * @param {number} heading
   * @param {boolean} tall
   * @param {number} reach
   */
  follow(seconds, position, heading, tall, reach = 0) {
    const error = heading + 0.75 - this.goal.yaw;
    const lag = 1 - Math.exp(-0.5 * seconds); // it swings round slowly
    const yaw = this.goal.yaw + lag * Math.atan2(Math.sin(error), Math.cos(error));
    Object.assign(this.goal, {
      z: position[0],
      x: position[1],
      y: 0.8 - 0.3 * reach, // above the buttons
      pitch: 0.3 + 0.12 * reach,
      yaw,
      far: (tall ? 5.6 : 4.6) + 2.6 * reach,
    });
  }

  /**
   * Look from the side at a figure with a heading, and at what is within a reach of it.
   * @param {number[]} position
   * @param {number} heading
   * @param {number} reach metres
   * @param {number[]} size of the picture, pixels
   */
  beside([z, x], heading, reach, [width, height]) {
    const { aside, below } = this.goal;
    const scale = scaleOf(width, height);
    const far = Math.max(CLOSE / (1 - below), (reach * scale.across) / (1 - aside));
    Object.assign(this.goal, { z, x, y: 0.85, pitch: 0.12, yaw: heading + Math.PI / 2, far });
  }

  /**
   * @param {number} seconds
   * @param {boolean} snap
   */
  step(seconds, snap) {
    for (const name of NAMES) {
      const fraction = snap ? 1 : 1 - Math.exp(-seconds * (name === "z" || name === "x" ? 3.5 : 2.2));
      const error = this.goal[name] - this.at[name];
      this.at[name] += fraction * (name === "yaw" ? Math.atan2(Math.sin(error), Math.cos(error)) : error);
    }
  }

  /**
   * The view that the scene needs. The axes of the picture are kept for `ground`.
   * @param {number} width
   * @param {number} height
   * @returns {View}
   */
  view(width, height) {
    const { at, hand } = this;
    const yaw = at.yaw + hand.yaw;
    const pitch = Math.max(0.06, Math.min(at.pitch + hand.pitch, STRAIGHT_DOWN));
    const far = at.far * hand.zoom;
    const [cy, sy, cp, sp] = [Math.cos(yaw), Math.sin(yaw), Math.cos(pitch), Math.sin(pitch)];
    const back = [cp * sy, sp, cp * cy];
    const right = [cy, 0, -sy];
    const up = [-sp * sy, cp, -sp * cy];
    const eye = [at.x + far * back[0], at.y + far * back[1], at.z + far * back[2]];
    const { across: wide, up: zoom } = scaleOf(width, height);
    const view = shifted(perspective({ eye, right, up, back }, [wide, zoom], 0.1, 200), -at.aside, at.below);
    const sun = unit([-0.62 * cy + 0.34 * sy, 0.95, 0.62 * sy + 0.34 * cy]); // over the left shoulder of the viewer
    Object.assign(this, { eye, right, up, back, zoom, wide, width, height });
    return { view, eye, target: [at.x, 0, at.z], sun, zoom };
  }

  /**
   * The point [z, x] of the ground under a point of the picture.
   * @param {number} px
   * @param {number} py
   */
  ground(px, py) {
    const x = ((px / this.width) * 2 - 1 + this.at.aside) / this.wide;
    const y = (1 - (py / this.height) * 2 - this.at.below) / this.zoom;
    const ray = [0, 1, 2].map((k) => this.right[k] * x + this.up[k] * y - this.back[k]);
    if (ray[1] > -0.02) return null;
    const far = Math.min(-this.eye[1] / ray[1], 60);
    return [this.eye[2] + far * ray[2], this.eye[0] + far * ray[0]];
  }
}
