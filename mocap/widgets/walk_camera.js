// A camera that holds a whole line, or follows a figure from three quarters in front; the reader's hand turns it.

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
const NAMES = /** @type {const} */ (["z", "x", "y", "yaw", "pitch", "far"]);

export class Camera {
  at = { z: 0, x: 0, y: 0.5, yaw: -0.5, pitch: 0.9, far: 9 };
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
      y: 0.8,
      pitch: 0.3 + 0.06 * reach,
      yaw,
      far: (tall ? 5.6 : 4.6) + 1.6 * reach,
    });
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
    const pitch = Math.max(0.06, Math.min(at.pitch + hand.pitch, 1.5));
    const far = at.far * hand.zoom;
    const [cy, sy, cp, sp] = [Math.cos(yaw), Math.sin(yaw), Math.cos(pitch), Math.sin(pitch)];
    const back = [cp * sy, sp, cp * cy];
    const right = [cy, 0, -sy];
    const up = [-sp * sy, cp, -sp * cy];
    const eye = [at.x + far * back[0], at.y + far * back[1], at.z + far * back[2]];
    const zoom = 1 / Math.tan(width < height ? 0.42 : 0.34);
    const wide = (zoom * height) / width;
    const view = perspective({ eye, right, up, back }, [wide, zoom], 0.1, 200);
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
    const x = ((px / this.width) * 2 - 1) / this.wide;
    const y = (1 - (py / this.height) * 2) / this.zoom;
    const ray = [0, 1, 2].map((k) => this.right[k] * x + this.up[k] * y - this.back[k]);
    if (ray[1] > -0.02) return null;
    const far = Math.min(-this.eye[1] / ray[1], 60);
    return [this.eye[2] + far * ray[2], this.eye[0] + far * ray[0]];
  }
}
