// The picture of the walking page: a soft ground, lines and discs on it, and figures with their shadows. Without
// WebGL 2, it is drawn as round strokes on a flat canvas.

import { Bodies, FIGURES, rgb, SIZE, webgl } from "./bodies.js";
import { paintLine, penOf } from "./canvas.js";
import { capsules } from "./walk_body.js";

/**
 * @import { Layout, Look } from "./bodies.js"
 * @import { Body } from "./walk_body.js"
 * @import { View } from "./walk_camera.js"
 * @import { Piece } from "./walk_search.js"
 */

const GROUND = {
  floor: [
    // a wheel around the target, coloured at its corners, which is fast without a graphics card
    "in vec2 corner; out vec3 c; void main() { vec2 p = corner + target.xz; c = paper(p); gl_Position = view * vec4(p.x, 0., p.y, 1.); }",
    "in vec3 c; out vec4 o; void main() { o = vec4(c, 1.); }",
  ],
  ribbon: [
    // drawings on the ground: positions with an offset from the middle, for smooth rims, and a colour
    "in vec4 position, tint; out vec4 c; out float side; out vec2 p; void main() { c = tint; side = position.w; p = position.xz; gl_Position = view * vec4(position.xyz, 1.); }",
    "in vec4 c; in float side; in vec2 p; out vec4 o; void main() { float w = fwidth(side); o = vec4(c.rgb, c.a * (1. - smoothstep(1. - 1.5 * w, 1., abs(side))) * clear(p)); }",
  ],
};
// Radii of the rings of the ground, metres.
const RINGS = [0, 3, 6, 10, 16, 24, 90];
const SPOKES = 32;
const PER_POINT = 8; // numbers of a point of a band: its position, its side, its colour
// The colours of clips, after Okabe and Ito, darker or lighter: on both grounds their contrast is 3 or more.
export const COLOURS = ["#0072b2", "#a86a00", "#00805e", "#b05588", "#1f83c4", "#d0500a", "#857a00"];

class Ground extends Bodies {
  /**
   * @param {WebGL2RenderingContext} gl
   * @param {number} capacity
   */
  constructor(gl, capacity) {
    super(gl, capacity, { ...GROUND, ...FIGURES });
  }

  /**
   * @param {string} name
   * @returns {Layout[]}
   */
  layouts(name) {
    if (name in FIGURES) return super.layouts(name);
    if (!this.strip) this.strip = this.buffer(new Float32Array(PER_POINT));
    return name === "ribbon"
      ? [[["position 4", "tint 4"], 0, this.strip]]
      : [[["corner 2"], 0, this.wheel()]];
  }

  wheel() {
    /** @type {number[]} */
    const wheel = [];
    /**
     * @param {number} ring
     * @param {number} spoke
     */
    const rim = (ring, spoke) => {
      const angle = (2 * Math.PI * spoke) / SPOKES;
      return [RINGS[ring] * Math.cos(angle), RINGS[ring] * Math.sin(angle)];
    };
    for (let ring = 0; ring + 1 < RINGS.length; ring++) {
      for (let i = 0; i < SPOKES; i++) {
        wheel.push(...rim(ring, i), ...rim(ring + 1, i), ...rim(ring + 1, i + 1));
        wheel.push(...rim(ring, i), ...rim(ring + 1, i + 1), ...rim(ring, i + 1));
      }
    }
    this.corners = wheel.length / 2;
    return this.buffer(new Float32Array(wheel));
  }
}

export class Scene {
  /** @type {number[]} points of all bands, as triangles */
  bands = [];
  /** @type {number[]} where the camera is */
  eye = [0, 0, 0];
  /** @type {number} metres from the camera within which bands have their stated width */
  reach = 1;

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {Piece[]} pieces
   * @param {number} capacity
   */
  constructor(canvas, pieces, capacity) {
    this.canvas = canvas;
    this.pieces = pieces;
    this.gl = webgl(canvas, { antialias: true, alpha: false });
    this.figures = this.gl && new Ground(this.gl, pieces.length * capacity);
    this.instances = this.figures?.instances ?? new Float32Array(SIZE * pieces.length * capacity);
  }

  /**
   * A band along points [z, x] of the ground; `alpha` by the number of the point.
   * @param {number[][]} points
   * @param {number} half
   * @param {number[]} colour
   * @param {(point: number) => number} alpha
   * @param {number} height
   */
  band(points, half, colour, alpha, height = 0.004) {
    // Far from the eye it is wider, so that it does not thin out.
    const sides = points.map(([z, x], i) => {
      const [az, ax] = points[Math.max(0, i - 1)];
      const [bz, bx] = points[Math.min(points.length - 1, i + 1)];
      const [ex, ey, ez] = this.eye;
      const wide =
        (half * Math.max(1, Math.hypot(x - ex, ey, z - ez) / this.reach)) /
        (Math.hypot(bz - az, bx - ax) || 1);
      return [(bx - ax) * wide, -(bz - az) * wide];
    });
    for (let i = 0; i + 1 < points.length; i++) {
      /**
       * @param {number} k
       * @param {number} side
       */
      const corner = (k, side) => [
        points[k][1] + side * sides[k][1],
        height,
        points[k][0] + side * sides[k][0],
        side,
        ...colour,
        alpha(k),
      ];
      this.bands.push(...corner(i, 1), ...corner(i, -1), ...corner(i + 1, 1));
      this.bands.push(...corner(i + 1, 1), ...corner(i, -1), ...corner(i + 1, -1));
    }
  }

  /**
   * An ellipse on the ground.
   * @param {number[]} position
   * @param {number} long
   * @param {number} wide
   * @param {number} angle
   * @param {number[]} colour
   * @param {number} alpha
   * @param {number} height
   */
  disc([z, x], long, wide, angle, colour, alpha, height = 0.006) {
    /** @param {number} i */
    const rim = (i) => {
      const p = long * Math.cos((i * Math.PI) / 9);
      const q = wide * Math.sin((i * Math.PI) / 9);
      const c = Math.cos(angle);
      const s = Math.sin(angle);
      return [x + s * p + c * q, height, z + c * p - s * q, 1, ...colour, alpha];
    };
    for (let i = 0; i < 18; i++) this.bands.push(x, height, z, 0, ...colour, alpha, ...rim(i), ...rim(i + 1));
  }

  /**
   * Draw everything; `bodies` as `bodyAt` gives them.
   * @param {View} camera
   * @param {Look} look
   * @param {Body[]} bodies
   */
  draw(camera, look, bodies) {
    const { gl, pieces, figures } = this;
    const count = bodies.reduce((at, body) => capsules(pieces, body, this.instances, at), 0) / SIZE;
    if (!gl || !figures) {
      this.drawFlat(camera, look, count);
      this.bands = [];
      return;
    }
    figures.clear([...rgb(look.sky), 1]);
    figures.use("floor", camera, look);
    gl.drawArrays(gl.TRIANGLES, 0, figures.corners ?? 0);
    figures.shadows(camera, look, count);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.bindBuffer(gl.ARRAY_BUFFER, figures.strip ?? null);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(this.bands), gl.DYNAMIC_DRAW);
    figures.use("ribbon", camera, look);
    gl.drawArrays(gl.TRIANGLES, 0, this.bands.length / PER_POINT);
    gl.disable(gl.BLEND);
    figures.limbs(camera, look, count, bodies.length > 3);
    this.bands = [];
  }

  /**
   * Triangles of the ground, shadows and limbs as round strokes.
   * @param {View} camera
   * @param {Look} look
   * @param {number} count
   */
  drawFlat(camera, look, count) {
    const { canvas, bands, instances } = this;
    const pen = penOf(canvas);
    /**
     * @param {number} x
     * @param {number} y
     * @param {number} z
     */
    const see = (x, y, z) => {
      const m = camera.view;
      const w = m[3] * x + m[7] * y + m[11] * z + m[15];
      return [
        ((1 + (m[0] * x + m[4] * y + m[8] * z + m[12]) / w) / 2) * canvas.width,
        ((1 - (m[1] * x + m[5] * y + m[9] * z + m[13]) / w) / 2) * canvas.height,
        w,
      ];
    };
    pen.fillStyle = look.ground;
    pen.fillRect(0, 0, canvas.width, canvas.height);
    for (let at = 0; at < bands.length; at += 3 * PER_POINT) {
      const corners = [0, PER_POINT, 2 * PER_POINT].map((k) =>
        see(bands[at + k], bands[at + k + 1], bands[at + k + 2]),
      );
      if (corners.some(([, , w]) => w < 0.1)) continue;
      pen.fillStyle = `rgba(${bands.slice(at + 4, at + 7).map((v) => Math.round(255 * v))},${bands[at + 7]})`;
      pen.beginPath();
      for (const [px, py] of corners) pen.lineTo(px, py);
      pen.fill();
    }
    pen.lineCap = "round";
    for (const height of [0, 1]) {
      for (let k = 0; k < SIZE * count; k += SIZE) {
        const v = instances.subarray(k, k + SIZE);
        const cast = (height - 1) / camera.sun[1];
        const ends = [v.subarray(0, 3), v.subarray(4, 7)].map(([x, y, z]) =>
          see(x + cast * camera.sun[0] * y, height * y, z + cast * camera.sun[2] * y),
        );
        if (ends.some(([, , w]) => w < 0.1)) continue;
        const colour = height ? colourOf(v[SIZE - 1], look) : look.shade;
        paintLine(pen, ends, colour, ((v[3] + v[7]) * camera.zoom * canvas.height) / 2 / ends[0][2]);
      }
    }
  }
}

/**
 * The colour of a side of a body.
 * @param {number} side
 * @param {Look} look
 */
function colourOf(side, { near, far, middle }) {
  if (side > 0) return near;
  return side < 0 ? far : middle;
}
