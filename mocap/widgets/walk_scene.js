// What is seen: a soft ground, lines and discs on it, and figures of shaded capsules with their shadows. WebGL 2,
// and where there is none, round strokes on a flat canvas. Places are [x, y, z], metres, y up.

import { capsules } from "./walk_body.js";

const HEAD = "#version 300 es\nprecision highp float; uniform mat4 view; uniform vec3 eye, target, sun, ground, sky;\n";
const PAPER = `vec3 paper(vec2 p) { return mix(ground, sky, smoothstep(3., 24., length(p - target.xz))); }
float clear(vec2 p) { return 1. - smoothstep(9., 24., length(p - target.xz)); }\n`;
const SHADERS = {
  floor: [ // a wheel around the target, coloured at its corners: cheap where there is no graphics card
    "in vec2 corner; out vec3 c; void main() { vec2 p = corner + target.xz; c = paper(p); gl_Position = view * vec4(p.x, 0., p.y, 1.); }",
    "in vec3 c; out vec4 o; void main() { o = vec4(c, 1.); }",
  ],
  shadow: [ // of a capsule: a soft stadium, the softer and the paler the higher the capsule is
    `in vec2 corner; in vec4 a, b; out vec2 p; flat out vec4 ends, size; void main() {
      vec2 A = a.xz - sun.xz / sun.y * a.y, B = b.xz - sun.xz / sun.y * b.y, soft = .02 + .12 * max(vec2(a.y, b.y), 0.);
      vec2 way = B - A; float l = length(way); way = l > 1e-4 ? way / l : vec2(0, 1); vec2 across = vec2(way.y, -way.x);
      float reach = max(a.w + soft.x, b.w + soft.y); p = (A + B) / 2. + across * corner.x * reach + way * corner.y * (l / 2. + reach);
      ends = vec4(A, B); size = vec4(a.w, b.w, soft); gl_Position = view * vec4(p.x, .002, p.y, 1.); }`,
    `in vec2 p; flat in vec4 ends, size; uniform vec3 shade; out vec4 o; void main() {
      vec2 d = ends.zw - ends.xy; float u = clamp(dot(p - ends.xy, d) / max(dot(d, d), 1e-6), 0., 1.);
      float r = mix(size.x, size.y, u), soft = mix(size.z, size.w, u), far = length(p - ends.xy - u * d);
      float k = (1. - smoothstep(r - .8 * soft, r + soft, far)) * .05 / (.05 + 1.2 * soft * soft);
      o = vec4(paper(p) * mix(vec3(1.), shade, k), 1.); }`,
  ],
  ribbon: [ // what is drawn on the ground: places with an offset from the middle, for smooth rims, and a colour
    "in vec4 place, tint; out vec4 c; out float side; out vec2 p; void main() { c = tint; side = place.w; p = place.xz; gl_Position = view * vec4(place.xyz, 1.); }",
    "in vec4 c; in float side; in vec2 p; out vec4 o; void main() { float w = fwidth(side); o = vec4(c.rgb, c.a * (1. - smoothstep(1. - 1.5 * w, 1., abs(side))) * clear(p)); }",
  ],
  limb: [ // a tapered capsule: a ball whose upper half is at the other end, flattened from front to back
    `in vec4 corner, a, b, left; in float side; out vec3 n, p; out float tone; void main() {
      vec3 y = b.xyz - a.xyz; float l = length(y); y = l > 1e-5 ? y / l : vec3(0, 1, 0);
      vec3 x = normalize(left.xyz - y * dot(left.xyz, y) + vec3(0, 0, 1e-4)), z = cross(x, y); bool upper = corner.w > .5;
      float r = upper ? b.w : a.w, taper = clamp((a.w - b.w) / max(l, .02), -.8, .8);
      p = (upper ? b.xyz : a.xyz) + r * (x * corner.x + y * corner.y + z * corner.z * left.w);
      n = x * corner.x + y * (corner.y + taper * (1. - abs(corner.y))) + z * corner.z / left.w;
      tone = side; gl_Position = view * vec4(p, 1.); }`,
    `in vec3 n, p; in float tone; uniform vec3 middle, near, far; uniform float night; out vec4 o; void main() {
      vec3 m = normalize(n), v = normalize(eye - p), c = tone > .5 ? near : tone < -.5 ? far : middle;
      float wrap = clamp((dot(m, sun) + .4) / 1.4, 0., 1.), rim = pow(1. - max(dot(m, v), 0.), 3.), up = m.y * .5 + .5;
      float low = .75 + .25 * smoothstep(0., .6, p.y), shine = pow(max(dot(reflect(-sun, m), v), 0.), 24.) * .14;
      vec3 light = mix(ground * .62, sky * .78, up) * mix(1., 2.4, night) + wrap * wrap * vec3(1.22, 1.1, .95) * mix(1., .75, night);
      o = vec4(c * light * low + rim * sky * .28 * (.4 + .6 * up) + shine, 1.); }`,
  ],
};
const LAYOUTS = { floor: ["corner 2"], shadow: ["corner 2", "a 4", "b 4", "left 4", "side 1"], ribbon: ["place 4", "tint 4"], limb: ["corner 4", "a 4", "b 4", "left 4", "side 1"] };

export const COLOURS = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#f0e442"]; // after Okabe and Ito
export const LOOKS = {
  light: { ground: "#ece6da", sky: "#faf7f0", shade: "#8a8290", line: "#e2502a", middle: "#3b5a8c", near: "#4a6fa8", far: "#304a76", ink: "#2b2f3d", night: 0 },
  dark: { ground: "#1a1d26", sky: "#2a2e3b", shade: "#3c3f4c", line: "#ff7a4f", middle: "#d8cdb8", near: "#e9dfcb", far: "#c3b8a4", ink: "#f0e9dc", night: 1 },
};
export const rgb = (colour) => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16) / 255);

function program(gl, [vertex, fragment]) {
  const made = gl.createProgram();
  for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, HEAD + PAPER + text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  return made;
}

function ball(around, heights) { // corners x, y, z and which half; triangles
  const corners = [], faces = [], turn = around + 1;
  heights.forEach((degrees, ring) => {
    const up = (degrees * Math.PI) / 180, upper = ring * 2 >= heights.length ? 1 : 0;
    for (let i = 0; i <= around; i++) {
      const angle = (2 * Math.PI * i) / around;
      corners.push(Math.cos(up) * Math.cos(angle), Math.sin(up), Math.cos(up) * Math.sin(angle), upper);
      if (ring && i < around) faces.push(ring * turn + i, (ring - 1) * turn + i, ring * turn + i + 1, ring * turn + i + 1, (ring - 1) * turn + i, (ring - 1) * turn + i + 1);
    }
  });
  return [new Float32Array(corners), new Uint16Array(faces)];
}

export class Scene {
  constructor(canvas, pieces, most) {
    Object.assign(this, { canvas, pieces, instances: new Float32Array(13 * pieces.length * most), bands: [] });
    this.gl = new URLSearchParams(location.search).has("flat") ? null : canvas.getContext("webgl2", { antialias: true, alpha: false });
    if (this.gl) this.prepare(); else this.flat = canvas.getContext("2d");
  }

  prepare() {
    const { gl } = this, wheel = [];
    const buffer = (data, target = gl.ARRAY_BUFFER) => {
      const made = gl.createBuffer();
      gl.bindBuffer(target, made);
      gl.bufferData(target, data, gl.STATIC_DRAW);
      return made;
    };
    for (const [near, far] of [[0, 3], [3, 6], [6, 10], [10, 16], [16, 24], [24, 90]]) {
      for (let i = 0; i < 32; i++) {
        const rim = (r, k) => [r * Math.cos((k * Math.PI) / 16), r * Math.sin((k * Math.PI) / 16)];
        wheel.push(...rim(near, i), ...rim(far, i), ...rim(far, i + 1), ...rim(near, i), ...rim(far, i + 1), ...rim(near, i + 1));
      }
    }
    const [corners, faces] = ball(16, [-90, -64, -40, -18, 0, 0, 18, 40, 64, 90]);
    Object.assign(this, { corners: wheel.length / 2, faces: faces.length, places: buffer(this.instances), strip: buffer(new Float32Array(8)) });
    const shapes = { floor: buffer(new Float32Array(wheel)), shadow: buffer(new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1])), ribbon: this.strip, limb: buffer(corners) };
    this.parts = Object.fromEntries(Object.entries(SHADERS).map(([name, texts]) => {
      const made = program(gl, texts), array = gl.createVertexArray();
      gl.bindVertexArray(array);
      if (name === "limb") gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer(faces, gl.ELEMENT_ARRAY_BUFFER));
      const sizes = LAYOUTS[name].map((text) => text.split(" ")), own = name === "ribbon" ? 2 : 1;
      for (const [list, each, source] of [[sizes.slice(0, own), 0, shapes[name]], [sizes.slice(own), 1, this.places]]) {
        const stride = 4 * list.reduce((sum, [, size]) => sum + Number(size), 0);
        gl.bindBuffer(gl.ARRAY_BUFFER, source);
        list.reduce((offset, [attribute, size]) => {
          const at = gl.getAttribLocation(made, attribute);
          if (at >= 0) { gl.enableVertexAttribArray(at); gl.vertexAttribPointer(at, Number(size), gl.FLOAT, false, stride, offset); gl.vertexAttribDivisor(at, each); }
          return offset + 4 * size;
        }, 0);
      }
      return [name, { made, array }];
    }));
  }

  use(name, camera, look) {
    const { gl } = this, { made, array } = this.parts[name], at = (uniform) => gl.getUniformLocation(made, uniform);
    gl.useProgram(made);
    gl.bindVertexArray(array);
    gl.uniformMatrix4fv(at("view"), false, camera.view);
    for (const [uniform, value] of [["eye", camera.eye], ["target", camera.target], ["sun", camera.sun]]) gl.uniform3fv(at(uniform), value);
    for (const colour of ["ground", "sky", "shade", "middle", "near", "far"]) gl.uniform3fv(at(colour), rgb(look[colour]));
    gl.uniform1f(at("night"), look.night);
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
    const { gl, pieces } = this, count = bodies.reduce((at, body) => capsules(pieces, body, this.instances, at), 0) / 13;
    if (!gl) { this.drawFlat(camera, look, count); this.bands = []; return; }
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(...rgb(look.sky), 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.disable(gl.DEPTH_TEST);
    this.use("floor", camera, look);
    gl.drawArrays(gl.TRIANGLES, 0, this.corners);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.places);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, this.instances.subarray(0, 13 * count));
    gl.enable(gl.BLEND);
    gl.blendEquation(gl.MIN); // shadows that overlap are one shadow
    this.use("shadow", camera, look);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
    gl.blendEquation(gl.FUNC_ADD);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.strip);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(this.bands), gl.DYNAMIC_DRAW);
    this.use("ribbon", camera, look);
    gl.drawArrays(gl.TRIANGLES, 0, this.bands.length / 8);
    gl.disable(gl.BLEND);
    gl.enable(gl.DEPTH_TEST);
    this.use("limb", camera, look);
    gl.drawElementsInstanced(gl.TRIANGLES, this.faces, gl.UNSIGNED_SHORT, 0, count);
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
      for (let k = 0; k < 13 * count; k += 13) {
        const v = instances.subarray(k, k + 13), cast = (height - 1) / camera.sun[1];
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
