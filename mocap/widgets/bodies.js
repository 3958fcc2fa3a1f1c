// Figures of shaded capsules with their shadows, by WebGL 2. Positions are [x, y, z], metres, y up. `Bodies` draws them
// over another picture. The scene of the walking page adds a ground to them.

/**
 * @typedef {typeof LOOKS.light} Look
 *
 * The data of a camera for the shaders: its view matrix, and positions and a direction of the world.
 * @typedef {{ view: Float32Array, eye: number[], target: number[], sun: number[] }} Sight
 *
 * The attributes of a buffer, with their sizes, as texts, and a divisor: 1 if they advance with each instance, else 0.
 * @typedef {[attributes: string[], each: number, source: WebGLBuffer]} Layout
 */

const HEAD =
  "#version 300 es\nprecision highp float; uniform mat4 view; uniform vec3 eye, target, sun, ground, sky;\n";
const SHEET = `vec3 paper(vec2 p) { return mix(ground, sky, smoothstep(3., 24., length(p - target.xz))); }
float clear(vec2 p) { return 1. - smoothstep(9., 24., length(p - target.xz)); }\n`;
/** @type {Record<string, string[]>} */
export const FIGURES = {
  shadow: [
    // of a capsule: a soft stadium, the softer and the paler the higher the capsule is
    `in vec2 corner; in vec4 a, b; out vec2 p; flat out vec4 ends, size; void main() {
      vec2 A = a.xz - sun.xz / sun.y * a.y, B = b.xz - sun.xz / sun.y * b.y, soft = .02 + .12 * max(vec2(a.y, b.y), 0.);
      vec2 along = B - A; float l = length(along); along = l > 1e-4 ? along / l : vec2(0, 1); vec2 across = vec2(along.y, -along.x);
      float reach = max(a.w + soft.x, b.w + soft.y); p = (A + B) / 2. + across * corner.x * reach + along * corner.y * (l / 2. + reach);
      ends = vec4(A, B); size = vec4(a.w, b.w, soft); gl_Position = view * vec4(p.x, .002, p.y, 1.); }`,
    `in vec2 p; flat in vec4 ends, size; uniform vec3 shade; uniform float over; out vec4 o; void main() {
      vec2 d = ends.zw - ends.xy; float u = clamp(dot(p - ends.xy, d) / max(dot(d, d), 1e-6), 0., 1.);
      float r = mix(size.x, size.y, u), soft = mix(size.z, size.w, u), far = length(p - ends.xy - u * d);
      float k = (1. - smoothstep(r - .8 * soft, r + soft, far)) * .05 / (.05 + 1.2 * soft * soft);
      o = over > 0. ? vec4(0., 0., 0., over * k) : vec4(paper(p) * mix(vec3(1.), shade, k), 1.); }`,
  ],
  limb: [
    // a tapered capsule: a ball whose upper half is at the other end, flattened from front to back
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
const SHADED = /** @type {const} */ (["ground", "sky", "shade", "middle", "near", "far"]); // colours
const INSTANCE = ["a 4", "b 4", "left 4", "side 1"];
// Numbers of a capsule: an end and its radius, the other end and its radius, the direction of the body's left, its
// flatness, and its side (-1 right, 0, 1 left).
export const SIZE = 13;
/** @type {Record<string, string>} */
const SHAPES = { shadow: "corner 2", limb: "corner 4" };

export const LOOKS = {
  light: {
    ground: "#ece6da",
    sky: "#faf7f0",
    shade: "#8a8290",
    line: "#e2502a",
    middle: "#3b5a8c",
    near: "#4a6fa8",
    far: "#304a76",
    ink: "#2b2f3d",
    body: "#737b8c",
    night: 0,
  },
  dark: {
    ground: "#1a1d26",
    sky: "#2a2e3b",
    shade: "#3c3f4c",
    line: "#ff7a4f",
    middle: "#d8cdb8",
    near: "#e9dfcb",
    far: "#c3b8a4",
    ink: "#f0e9dc",
    body: "#c9c3b6",
    night: 1,
  },
};
/**
 * The inner product of vectors.
 * @param {number[]} a
 * @param {number[]} b
 */
export const inner = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/**
 * The matrix of a perspective view from `eye`, with the axes of the picture, and its scale across and up.
 * @param {{ eye: number[], right: number[], up: number[], back: number[] }} camera
 * @param {number[]} scale
 * @param {number} near
 * @param {number} end
 */
export function perspective({ eye, right, up, back }, [across, upward], near, end) {
  const depth = (end + near) / (near - end);
  const offset = (2 * end * near) / (near - end);
  const rows = [
    right.map((v) => v * across),
    up.map((v) => v * upward),
    back.map((v) => v * depth),
    back.map((v) => -v),
  ];
  const view = [0, 1, 2].flatMap((k) => rows.map((row) => row[k]));
  view.push(...rows.map((row, k) => -inner(row, eye) + (k === 2 ? offset : 0)));
  return new Float32Array(view);
}

/**
 * Write the numbers of a capsule, and return where the next one begins.
 * @param {Float32Array} out
 * @param {number} at
 * @param {number[][]} ends
 * @param {number[]} radii
 * @param {number[]} left
 * @param {number} flatness
 * @param {number} side
 */
export function writeCapsule(out, at, ends, radii, left, flatness, side) {
  out.set([...ends[0], radii[0], ...ends[1], radii[1], ...left, flatness, side], at);
  return at + SIZE;
}

/** @param {string} colour */
export const rgb = (colour) => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16) / 255);

/**
 * The WebGL 2 of a canvas, if the browser has it and the page's address does not ask for `flat` pictures.
 * @param {HTMLCanvasElement} canvas
 * @param {WebGLContextAttributes} settings
 */
export function webgl(canvas, settings) {
  const flat = new URLSearchParams(location.search).has("flat");
  return flat ? null : canvas.getContext("webgl2", settings);
}

/**
 * @param {WebGL2RenderingContext} gl
 * @param {string[]} shaders
 */
export function program(gl, [vertex, fragment]) {
  const made = gl.createProgram();
  const texts = new Map([
    [gl.VERTEX_SHADER, vertex],
    [gl.FRAGMENT_SHADER, fragment],
  ]);
  for (const [type, text] of texts) {
    const shader = gl.createShader(type);
    if (!shader) throw new Error("no WebGL any more");
    gl.shaderSource(shader, HEAD + SHEET + text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) {
      throw new Error(gl.getShaderInfoLog(shader) ?? "a shader does not compile");
    }
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  return made;
}

/**
 * Corners x, y, z and which half; triangles.
 * @param {number} around
 * @param {number[]} heights
 */
function ball(around, heights) {
  /** @type {number[]} */
  const corners = [];
  /** @type {number[]} */
  const faces = [];
  const ringSize = around + 1;
  heights.forEach((degrees, ring) => {
    const up = (degrees * Math.PI) / 180;
    const upper = ring * 2 >= heights.length ? 1 : 0;
    for (let i = 0; i <= around; i++) {
      const angle = (2 * Math.PI * i) / around;
      corners.push(Math.cos(up) * Math.cos(angle), Math.sin(up), Math.cos(up) * Math.sin(angle), upper);
      if (ring && i < around) {
        faces.push(
          ring * ringSize + i,
          (ring - 1) * ringSize + i,
          ring * ringSize + i + 1,
          ring * ringSize + i + 1,
          (ring - 1) * ringSize + i,
          (ring - 1) * ringSize + i + 1,
        );
      }
    }
  });
  return [corners, faces];
}

export class Bodies {
  /**
   * @param {WebGL2RenderingContext} gl
   * @param {number} capacity capsules
   * @param {Record<string, string[]>} shaders
   */
  constructor(gl, capacity, shaders = FIGURES) {
    this.gl = gl;
    this.instances = new Float32Array(SIZE * capacity);
    // Two balls, a fine one and a coarse one for many figures.
    const [[fine, few], [coarse, fewer]] = [
      ball(16, [-90, -64, -40, -18, 0, 0, 18, 40, 64, 90]),
      ball(10, [-90, -45, 0, 0, 45, 90]),
    ];
    const corners = new Float32Array([...fine, ...coarse]);
    const faces = new Uint16Array([...few, ...fewer.map((corner) => corner + fine.length / 4)]);
    this.balls = [
      [few.length, 0],
      [fewer.length, 2 * few.length],
    ];
    this.instanceBuffer = this.buffer(this.instances);
    this.triangles = this.buffer(faces, gl.ELEMENT_ARRAY_BUFFER);
    /** @type {Record<string, WebGLBuffer>} */
    this.shapes = {
      shadow: this.buffer(new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1])),
      limb: this.buffer(corners),
    };
    this.parts = Object.fromEntries(
      Object.entries(shaders).map(([name, texts]) => [name, this.part(name, program(gl, texts))]),
    );
  }

  /**
   * @param {BufferSource} data
   * @param {GLenum} target
   */
  buffer(data, target = this.gl.ARRAY_BUFFER) {
    const made = this.gl.createBuffer();
    this.gl.bindBuffer(target, made);
    this.gl.bufferData(target, data, this.gl.STATIC_DRAW);
    return made;
  }

  /**
   * @param {string} name
   * @returns {Layout[]}
   */
  layouts(name) {
    return [
      [[SHAPES[name]], 0, this.shapes[name]],
      [INSTANCE, 1, this.instanceBuffer],
    ];
  }

  /**
   * @param {string} name
   * @param {WebGLProgram} made
   */
  part(name, made) {
    const { gl } = this;
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.triangles);
    for (const [list, each, source] of this.layouts(name)) {
      const attributes = list.map((text) => {
        const [attribute, size] = text.split(" ");
        return { attribute, size: Number(size) };
      });
      const stride = 4 * attributes.reduce((sum, { size }) => sum + size, 0);
      gl.bindBuffer(gl.ARRAY_BUFFER, source);
      let offset = 0;
      for (const { attribute, size } of attributes) {
        const at = gl.getAttribLocation(made, attribute);
        if (at >= 0) {
          gl.enableVertexAttribArray(at);
          gl.vertexAttribPointer(at, size, gl.FLOAT, false, stride, offset);
          gl.vertexAttribDivisor(at, each);
        }
        offset += 4 * size;
      }
    }
    return { made, array };
  }

  /**
   * @param {string} name
   * @param {Sight} camera
   * @param {Look} look
   * @param {number} over
   */
  use(name, camera, look, over = 0) {
    const { gl } = this;
    const { made, array } = this.parts[name];
    /** @param {string} uniform */
    const at = (uniform) => gl.getUniformLocation(made, uniform);
    gl.useProgram(made);
    gl.bindVertexArray(array);
    gl.uniformMatrix4fv(at("view"), false, camera.view);
    gl.uniform3fv(at("eye"), camera.eye);
    gl.uniform3fv(at("target"), camera.target);
    gl.uniform3fv(at("sun"), camera.sun);
    for (const colour of SHADED) gl.uniform3fv(at(colour), rgb(look[colour]));
    gl.uniform1f(at("night"), look.night);
    gl.uniform1f(at("over"), over);
  }

  /** @param {number[]} colour */
  clear(colour) {
    const { gl } = this;
    gl.viewport(0, 0, gl.canvas.width, gl.canvas.height);
    const [red, green, blue, alpha] = colour;
    gl.clearColor(red, green, blue, alpha);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.disable(gl.DEPTH_TEST);
  }

  /**
   * Shadows that overlap are one shadow: the darkest of them, or, over another picture, the least transparent.
   * @param {Sight} camera
   * @param {Look} look
   * @param {number} count
   * @param {number} over
   */
  shadows(camera, look, count, over = 0) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.instanceBuffer);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, this.instances.subarray(0, SIZE * count));
    gl.enable(gl.BLEND);
    gl.blendEquation(over ? gl.MAX : gl.MIN);
    this.use("shadow", camera, look, over);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
    gl.blendEquation(gl.FUNC_ADD);
    gl.disable(gl.BLEND);
  }

  /**
   * @param {Sight} camera
   * @param {Look} look
   * @param {number} count
   * @param {boolean} coarse
   */
  limbs(camera, look, count, coarse = false) {
    const { gl } = this;
    const [corners, begin] = this.balls[Number(coarse)];
    gl.enable(gl.DEPTH_TEST);
    this.use("limb", camera, look);
    gl.drawElementsInstanced(gl.TRIANGLES, corners, gl.UNSIGNED_SHORT, begin, count);
  }
}
