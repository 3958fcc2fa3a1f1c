// The bodies of a player: shaded capsules, whose positions follow from the joints alone. All pictures of a page share
// one canvas for them, because browsers limit the number with WebGL. Without WebGL, `player_picture.js` draws strokes.

import { Bodies, SIZE, inner, perspective, program, webgl, writeCapsule } from "./bodies.js";
import { NEAR, positionOf } from "./player_picture.js";

/**
 * @import { Look, Sight } from "./bodies.js"
 * @import { Camera, PackedFigure } from "./player_scene.js"
 *
 * A body to draw, and the colours of its middle, its left and its right.
 * @typedef {{
 *   figure: PackedFigure, pose: Float32Array, colours: { middle: string, near: string, far: string },
 * }} ShadedFigure
 */

const SUN = [-0.45, 0.78, 0.44]; // to the right, up and back, seen from the camera's side
const SHADOW = 0.3; // how dark a shadow is
// The faces of a box as a strip of triangles. The bits of three numbers say at which corners of the strip x, y and z are
// high.
const BOX = [
  `uniform vec3 low, high; void main() {
    int corner = 1 << gl_VertexID;
    bvec3 upper = bvec3((0x287a & corner) != 0, (0x02af & corner) != 0, (0x31e3 & corner) != 0);
    gl_Position = view * vec4(mix(low, high, vec3(upper)), 1.); }`,
  "out vec4 o; void main() { o = vec4(0.); }",
];
const BOX_CORNERS = 14; // of the strip
const SLOW = 24; // milliseconds for a picture, from where on it gets coarser

/**
 * @param {ArrayLike<number>} a
 * @param {ArrayLike<number>} b
 */
const less = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
/**
 * @param {number[]} a
 * @param {number[]} b
 */
const outer = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
/**
 * The unit vector of a at right angles to the unit vector b.
 * @param {number[]} a
 * @param {number[]} b
 * @returns {number[]}
 */
const without = (a, b) => {
  const k = inner(a, b);
  const v = [a[0] - k * b[0], a[1] - k * b[1], a[2] - k * b[2]];
  const length = Math.hypot(...v);
  return length > 1e-6 ? v.map((c) => c / length) : without([b[1], b[2], b[0]], b);
};

/**
 * The axes of a part of a body: to its left, along it, ahead. A trunk keeps its left, a limb what it is along.
 * @param {Float32Array} pose
 * @param {number[]} part
 */
function axesOf(pose, [, from, to, left, right, level]) {
  const across = less(positionOf(pose, left), positionOf(pose, right));
  const along = less(positionOf(pose, to), positionOf(pose, from));
  /** @param {number[]} v */
  const whole = (v) => without(v, [0, 0, 0]);
  if (level) {
    const x = whole(across);
    const y = without(along, x);
    return [x, y, outer(x, y)];
  }
  const y = whole(along);
  const z = outer(without(across, y), y);
  return [outer(y, z), y, z];
}

/**
 * Write the capsules of a body at a pose; `figure` as `posed` in `walk_figure.py` gives it.
 * @param {PackedFigure} figure
 * @param {Float32Array} pose
 * @param {Float32Array} out
 * @param {number} at
 */
function capsulesAt({ parts, pieces }, pose, out, at) {
  const axes = parts.map((part) => axesOf(pose, part));
  for (const [part, a, ra, b, rb, flat, side] of pieces) {
    const [x, y, z] = axes[part];
    const origin = positionOf(pose, parts[part][0]);
    const ends = [a, b].map((end) =>
      origin.map((value, c) => value + x[c] * end[0] + y[c] * end[1] + z[c] * end[2]),
    );
    at = writeCapsule(out, at, ends, [ra, rb], x, flat, side);
  }
  return at;
}

export class Shading {
  /** @type {Shading | undefined} of this page */
  static one;

  /** @param {number} capacity */
  constructor(capacity) {
    const gl = webgl(document.createElement("canvas"), { antialias: true });
    this.bodies = gl && new Bodies(gl, capacity);
    this.box = gl && program(gl, BOX);
    this.capacity = capacity;
    this.sharp = 1;
    this.slow = 0;
  }

  /**
   * The one of this page, with room for so many capsules.
   * @param {number} capacity
   */
  static of(capacity) {
    let { one } = Shading;
    if (!one || one.capacity < capacity) {
      one?.bodies?.gl.getExtension("WEBGL_lose_context")?.loseContext();
      one = new Shading(Math.max(capacity, 64));
      Shading.one = one;
    }
    return one.bodies && !one.bodies.gl.isContextLost() ? one : null;
  }

  /**
   * Draw figures [{ figure, pose, colours }] over what a pen has drawn; sizes are in pixels of the page.
   * @param {CanvasRenderingContext2D} pen
   * @param {Camera} camera
   * @param {ShadedFigure[]} figures
   * @param {Look} look
   * @param {number[]} size
   * @param {number[][]} boxes which hide the figures behind them
   */
  draw(pen, camera, figures, look, [wide, high], boxes = []) {
    const { bodies } = this;
    if (!bodies) return;
    const { gl } = bodies;
    const { canvas } = gl;
    const begun = performance.now();
    const sharp = this.sharp * Math.min(devicePixelRatio || 1, 2);
    const size = [wide, high].map((length) => Math.max(1, Math.round(length * sharp)));
    if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
    const seen = viewOf(camera, wide, high);
    bodies.clear([0, 0, 0, 0]);
    bodies.shadows(
      seen,
      look,
      figures.reduce((at, { figure, pose }) => capsulesAt(figure, pose, bodies.instances, at), 0) / SIZE,
      SHADOW,
    );
    this.hide(seen, boxes);
    for (const { figure, pose, colours } of figures) {
      const count = capsulesAt(figure, pose, bodies.instances, 0);
      gl.bufferSubData(gl.ARRAY_BUFFER, 0, bodies.instances.subarray(0, count));
      bodies.limbs(seen, { ...look, ...colours }, count / SIZE, figures.length > 3);
    }
    pen.drawImage(canvas, 0, 0, wide, high);
    this.slow += performance.now() - begun > SLOW ? Math.max(1, -this.slow) : -1; // a dozen slow pictures, or 99 quick ones
    if (this.slow > 11 || this.slow < -98) {
      this.sharp = Math.min(1, Math.max(0.5, this.sharp * (this.slow > 0 ? 0.8 : 1.25)));
      this.slow = 0;
    }
  }

  /**
   * Mark how far away boxes are, so that what is drawn behind them later stays hidden. A pen draws the boxes.
   * @param {Sight} camera
   * @param {number[][]} boxes
   */
  hide(camera, boxes) {
    const { bodies, box: made } = this;
    if (!bodies || !made || !boxes.length) return;
    const { gl } = bodies;
    /** @param {string} uniform */
    const at = (uniform) => gl.getUniformLocation(made, uniform);
    gl.useProgram(made);
    gl.bindVertexArray(null);
    gl.uniformMatrix4fv(at("view"), false, camera.view);
    gl.enable(gl.DEPTH_TEST);
    gl.colorMask(false, false, false, false);
    for (const box of boxes) {
      gl.uniform3fv(at("low"), box.slice(0, 3));
      gl.uniform3fv(at("high"), box.slice(3));
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, BOX_CORNERS);
    }
    gl.colorMask(true, true, true, true);
  }
}

/**
 * The data for the shaders from a camera of `player_scene.js`; the picture is `wide` × `high`.
 * @param {Camera} camera
 * @param {number} wide
 * @param {number} high
 * @returns {Sight}
 */
function viewOf({ eye, right, up, ahead, focus }, wide, high) {
  const back = ahead.map((v) => -v);
  const view = perspective({ eye, right, up, back }, [(2 * focus) / wide, (2 * focus) / high], NEAR, 300);
  const level = without([right[0], 0, right[2]], [0, 1, 0]);
  const behind = without(back, [0, 1, 0]);
  const sun = [0, 1, 2].map((k) => SUN[0] * level[k] + (k === 1 ? SUN[1] : 0) + SUN[2] * behind[k]);
  return { view, eye, target: [0, 0, 0], sun };
}
