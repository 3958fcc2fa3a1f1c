// The bodies of a player: shaded capsules, which find their place by the joints alone. All pictures of a page share
// one canvas for them, as a browser keeps few with WebGL; where there is none, `player_picture.js` draws strokes.

const SUN = [-0.45, 0.78, 0.44], SHADOW = 0.3; // to the right, up and back, seen from the camera's side; how dark a shadow is
const SLOW = 24; // milliseconds for a picture, from where on it gets coarser

const less = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const inner = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const outer = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const without = (a, b) => { // the unit vector of a at right angles to the unit vector b
  const k = inner(a, b), v = [a[0] - k * b[0], a[1] - k * b[1], a[2] - k * b[2]], length = Math.hypot(...v);
  return length > 1e-6 ? v.map((c) => c / length) : without([b[1], b[2], b[0]], b);
};

// The axes of a part of a body: to its left, along it, ahead. A trunk keeps its left, a limb what it is along.
function axesOf(pose, [, from, to, left, right, level]) {
  const across = less(placeOf(pose, left), placeOf(pose, right)), along = less(placeOf(pose, to), placeOf(pose, from));
  const whole = (v) => without(v, [0, 0, 0]);
  const x = level ? whole(across) : null, y = level ? without(along, x) : whole(along), z = outer(x ?? without(across, y), y);
  return [x ?? outer(y, z), y, z];
}

// Write the capsules of a body at a pose; `figure` as `posed` in `walk_figure.py` gives it.
function capsulesAt({ parts, pieces }, pose, out, at) {
  const axes = parts.map((part) => axesOf(pose, part));
  for (const [part, a, ra, b, rb, flat, side] of pieces) {
    const [x, y, z] = axes[part], origin = placeOf(pose, parts[part][0]);
    const ends = [a, b].map((end) => origin.map((value, c) => value + x[c] * end[0] + y[c] * end[1] + z[c] * end[2]));
    out.set([...ends[0], ra, ...ends[1], rb, ...x, flat, side], at);
    at += SIZE;
  }
  return at;
}

class Shading {
  constructor(most) {
    const flat = new URLSearchParams(location.search).has("flat");
    const gl = flat ? null : document.createElement("canvas").getContext("webgl2", { antialias: true });
    if (gl) this.bodies = new Bodies(gl, most);
    this.most = most; this.sharp = 1; this.slow = 0;
  }

  // The one of this page, with room for so many capsules.
  static of(most) {
    if (!(Shading.one?.most >= most)) { Shading.one?.bodies?.gl.getExtension("WEBGL_lose_context")?.loseContext(); Shading.one = new Shading(Math.max(most, 64)); }
    return Shading.one.bodies && !Shading.one.bodies.gl.isContextLost() ? Shading.one : null;
  }

  // Draw figures [{ figure, pose, colours }] over what a pen has drawn; sizes are in pixels of the page.
  draw(pen, camera, figures, look, [wide, high]) {
    const { bodies } = this, { gl } = bodies, { canvas } = gl, begun = performance.now(), sharp = this.sharp * Math.min(devicePixelRatio || 1, 2);
    const size = [wide, high].map((length) => Math.max(1, Math.round(length * sharp)));
    if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
    const seen = viewOf(camera, wide, high);
    bodies.clear([0, 0, 0, 0]);
    bodies.shadows(seen, look, figures.reduce((at, { figure, pose }) => capsulesAt(figure, pose, bodies.instances, at), 0) / SIZE, SHADOW);
    for (const { figure, pose, colours } of figures) {
      const count = capsulesAt(figure, pose, bodies.instances, 0);
      gl.bufferSubData(gl.ARRAY_BUFFER, 0, bodies.instances.subarray(0, count));
      bodies.limbs(seen, { ...look, ...colours }, count / SIZE, figures.length > 3);
    }
    pen.drawImage(canvas, 0, 0, wide, high);
    this.slow += performance.now() - begun > SLOW ? Math.max(1, -this.slow) : -1; // a dozen slow pictures, or 99 quick ones
    if (this.slow > 11 || this.slow < -98) { this.sharp = Math.min(1, Math.max(0.5, this.sharp * (this.slow > 0 ? 0.8 : 1.25))); this.slow = 0; }
  }
}

// What the shaders ask of a camera of `player_scene.js`; the picture is `wide` × `high`.
function viewOf({ eye, right, up, ahead, focus }, wide, high) {
  const near = NEAR, end = 300, a = (end + near) / (end - near), b = (-2 * end * near) / (end - near), back = ahead.map((v) => -v);
  const rows = [right.map((v) => (2 * v * focus) / wide), up.map((v) => (2 * v * focus) / high), ahead.map((v) => v * a), ahead];
  const view = [0, 1, 2].flatMap((k) => rows.map((row) => row[k]));
  view.push(...rows.map((row, k) => -inner(row, eye) + (k === 2 ? b : 0)));
  const level = without([right[0], 0, right[2]], [0, 1, 0]), behind = without(back, [0, 1, 0]);
  const sun = [0, 1, 2].map((k) => SUN[0] * level[k] + SUN[1] * (k === 1) + SUN[2] * behind[k]);
  return { view: new Float32Array(view), eye, target: [0, 0, 0], sun };
}
