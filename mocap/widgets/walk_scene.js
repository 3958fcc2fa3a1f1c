// What is seen on the walking page: a soft ground, lines and discs on it, and figures with their shadows; where there
// is no WebGL 2, round strokes on a flat canvas.

import { capsules } from "./walk_body.js";
import { Bodies, FIGURES, rgb, SIZE } from "./bodies.js";

const GROUND = {
  floor: [ // a wheel around the target, coloured at its corners: cheap where there is no graphics card
    "in vec2 corner; out vec3 c; void main() { vec2 p = corner + target.xz; c = paper(p); gl_Position = view * vec4(p.x, 0., p.y, 1.); }",
    "in vec3 c; out vec4 o; void main() { o = vec4(c, 1.); }",
  ],
  ribbon: [ // what is drawn on the ground: places with an offset from the middle, for smooth rims, and a colour
    "in vec4 place, tint; out vec4 c; out float side; out vec2 p; void main() { c = tint; side = place.w; p = place.xz; gl_Position = view * vec4(place.xyz, 1.); }",
    "in vec4 c; in float side; in vec2 p; out vec4 o; void main() { float w = fwidth(side); o = vec4(c.rgb, c.a * (1. - smoothstep(1. - 1.5 * w, 1., abs(side))) * clear(p)); }",
  ],
};
export const COLOURS = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#f0e442"]; // after Okabe and Ito

class Ground extends Bodies {
  constructor(gl, most) { super(gl, most, { ...GROUND, ...FIGURES }); }

  layouts(name) {
    if (name in FIGURES) return super.layouts(name);
    this.strip ??= this.buffer(new Float32Array(8));
    return name === "ribbon" ? [[["place 4", "tint 4"], 0, this.strip]] : [[["corner 2"], 0, this.wheel()]];
  }

  wheel() {
    const wheel = [];
    for (const [near, far] of [[0, 3], [3, 6], [6, 10], [10, 16], [16, 24], [24, 90]]) {
      for (let i = 0; i < 32; i++) {
        const rim = (r, k) => [r * Math.cos((k * Math.PI) / 16), r * Math.sin((k * Math.PI) / 16)];
        wheel.push(...rim(near, i), ...rim(far, i), ...rim(far, i + 1), ...rim(near, i), ...rim(far, i + 1), ...rim(near, i + 1));
      }
    }
    this.corners = wheel.length / 2;
    return this.buffer(new Float32Array(wheel));
  }
}

export class Scene {
  constructor(canvas, pieces, most) {
    Object.assign(this, { canvas, pieces, bands: [] });
    this.gl = new URLSearchParams(location.search).has("flat") ? null : canvas.getContext("webgl2", { antialias: true, alpha: false });
    if (this.gl) this.figures = new Ground(this.gl, pieces.length * most); else this.flat = canvas.getContext("2d");
    this.instances = this.figures?.instances ?? new Float32Array(SIZE * pieces.length * most);
  }

  // A band along points [z, x] of the ground; `alpha` by the number of the point.
  band(points, half, colour, alpha, height = 0.004) {
    const sides = points.map(([z, x], i) => { // far from the eye it is wider, so that it does not thin out
      const [az, ax] = points[Math.max(0, i - 1)], [bz, bx] = points[Math.min(points.length - 1, i + 1)], [ex, ey, ez] = this.eye;
      const wide = (half * Math.max(1, Math.hypot(x - ex, ey, z - ez) / this.reach)) / (Math.hypot(bz - az, bx - ax) || 1);
      return [(bx - ax) * wide, -(bz - az) * wide];
    });
    for (let i = 0; i + 1 < points.length; i++) {
      const corner = (k, side) => [points[k][1] + side * sides[k][1], height, points[k][0] + side * sides[k][0], side, ...colour, alpha(k)];
      for (const [k, side] of [[i, 1], [i, -1], [i + 1, 1], [i + 1, 1], [i, -1], [i + 1, -1]]) this.bands.push(...corner(k, side));
    }
  }

  disc([z, x], long, wide, angle, colour, alpha, height = 0.006) {
    const rim = (i) => {
      const p = long * Math.cos((i * Math.PI) / 9), q = wide * Math.sin((i * Math.PI) / 9), c = Math.cos(angle), s = Math.sin(angle);
      return [x + s * p + c * q, height, z + c * p - s * q, 1, ...colour, alpha];
    };
    for (let i = 0; i < 18; i++) this.bands.push(x, height, z, 0, ...colour, alpha, ...rim(i), ...rim(i + 1));
  }

  // Draw everything; `bodies` as `bodyAt` gives them.
  draw(camera, look, bodies) {
    const { gl, pieces } = this, count = bodies.reduce((at, body) => capsules(pieces, body, this.instances, at), 0) / SIZE;
    if (!gl) { this.drawFlat(camera, look, count); this.bands = []; return; }
    const { figures } = this;
    figures.clear([...rgb(look.sky), 1]);
    figures.use("floor", camera, look);
    gl.drawArrays(gl.TRIANGLES, 0, figures.corners);
    figures.shadows(camera, look, count);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.bindBuffer(gl.ARRAY_BUFFER, figures.strip);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(this.bands), gl.DYNAMIC_DRAW);
    figures.use("ribbon", camera, look);
    gl.drawArrays(gl.TRIANGLES, 0, this.bands.length / 8);
    gl.disable(gl.BLEND);
    figures.limbs(camera, look, count, bodies.length > 3);
    this.bands = [];
  }

  drawFlat(camera, look, count) { // triangles of the ground, shadows and limbs as round strokes
    const { flat: pen, canvas, bands, instances } = this;
    const see = (x, y, z) => {
      const m = camera.view, w = m[3] * x + m[7] * y + m[11] * z + m[15];
      return [(1 + (m[0] * x + m[4] * y + m[8] * z + m[12]) / w) / 2 * canvas.width, (1 - (m[1] * x + m[5] * y + m[9] * z + m[13]) / w) / 2 * canvas.height, w];
    };
    pen.fillStyle = look.ground;
    pen.fillRect(0, 0, canvas.width, canvas.height);
    for (let at = 0; at < bands.length; at += 24) {
      const corners = [0, 8, 16].map((k) => see(bands[at + k], bands[at + k + 1], bands[at + k + 2]));
      if (corners.some(([, , w]) => w < 0.1)) continue;
      pen.fillStyle = `rgba(${bands.slice(at + 4, at + 7).map((v) => Math.round(255 * v))},${bands[at + 7]})`;
      pen.beginPath();
      for (const [px, py] of corners) pen.lineTo(px, py);
      pen.fill();
    }
    pen.lineCap = "round";
    for (const height of [0, 1]) {
      for (let k = 0; k < SIZE * count; k += SIZE) {
        const v = instances.subarray(k, k + SIZE), cast = (height - 1) / camera.sun[1];
        const ends = [v.subarray(0, 3), v.subarray(4, 7)].map(([x, y, z]) => see(x + cast * camera.sun[0] * y, height * y, z + cast * camera.sun[2] * y));
        if (ends.some(([, , w]) => w < 0.1)) continue;
        pen.strokeStyle = height ? look[v[12] > 0 ? "near" : v[12] < 0 ? "far" : "middle"] : look.shade;
        pen.lineWidth = ((v[3] + v[7]) * camera.zoom * canvas.height) / 2 / ends[0][2];
        pen.beginPath();
        for (const [px, py] of ends) pen.lineTo(px, py + 0.01);
        pen.stroke();
      }
    }
  }
}
