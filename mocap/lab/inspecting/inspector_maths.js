// What the inspector computes: bodies out of rotations, the best turn, the blend. `tests/browser/test_inspector.py`
// holds each of these formulas against the package's function, which every comment names.

const STEP = 1e-5; // metres, and parts of a quaternion: what one unit of a number means

// Undo what `packing.py` does: four planes of bytes make 32-bit numbers, and these are second differences over time.
function unpacked(bytes, { offset, frames, channels }) {
  const count = frames * channels, planes = new Uint8Array(bytes, offset, 4 * count), numbers = new Float64Array(count);
  for (let k = 0, change = 0, number = 0; k < count; k++) {
    if (k % frames === 0) change = number = 0;
    change = (change + (planes[k] | (planes[count + k] << 8) | (planes[2 * count + k] << 16) | (planes[3 * count + k] << 24))) | 0;
    number = (number + change) | 0;
    numbers[(k % frames) * channels + Math.floor(k / frames)] = number * STEP;
  }
  return numbers; // frame by frame: x, y, z of the root, then w, x, y, z of each joint
}

// ---- quaternions: w, x, y, z ----

const times = ([a, b, c, d], [e, f, g, h]) =>
  [a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g, a * g - b * h + c * e + d * f, a * h + b * g - c * f + d * e];

function turned([w, x, y, z], [a, b, c]) {
  const u = 2 * (y * c - z * b), v = 2 * (z * a - x * c), t = 2 * (x * b - y * a);
  return [a + w * u + y * t - z * v, b + w * v + z * u - x * t, c + w * t + x * v - y * u];
}

// `rotations.slerp`: the short way round, and on a straight line where both are almost equal.
function slerp(from, to, share) {
  const dot = from.reduce((sum, v, k) => sum + v * to[k], 0), sign = dot < 0 ? -1 : 1;
  const angle = Math.acos(Math.min(1, Math.abs(dot))), sine = Math.sin(angle);
  const [p, q] = sine < 1e-6 ? [1 - share, share] : [Math.sin((1 - share) * angle) / sine, Math.sin(share * angle) / sine];
  const mixed = from.map((v, k) => p * v + sign * q * to[k]), size = Math.hypot(...mixed) || 1;
  return mixed.map((v) => v / size);
}

// ---- poses: the root's place, and a quaternion for each joint ----

class Clip {
  constructor(packed, skeleton, bytes) {
    Object.assign(this, packed);
    this.skeleton = skeleton;
    this.numbers = unpacked(bytes, packed);
    this.known = new Map();
  }

  pose(frame) {
    const at = frame * this.channels, turns = [];
    for (let k = at + 3; k < at + this.channels; k += 4) turns.push(Array.from(this.numbers.subarray(k, k + 4)));
    const [x, y, z] = this.numbers.subarray(at, at + 3), [x0, z0] = this.origin;
    return { root: [x + x0, y, z + z0], turns };
  }

  // The joints of a frame, which do not change: they are computed once.
  joints(frame) {
    let places = this.known.get(frame);
    if (!places) this.known.set(frame, places = joints(this.skeleton, this.pose(frame)));
    return places;
  }

  // The points of a window, frame by frame: `matching.point_cloud`.
  cloud(start, frames) {
    return Array.from({ length: frames }, (_, p) => this.skeleton.points.map((joint) => this.joints(start + p)[joint]));
  }
}

// Where all joints of a pose are: `body.kinematics.joint_positions`.
function joints({ parents, offsets }, { root, turns }) {
  const places = [root], worlds = [turns[0]];
  for (let j = 1; j < parents.length; j++) {
    const parent = parents[j], arm = turned(worlds[parent], offsets[j]);
    places.push(places[parent].map((v, k) => v + arm[k]));
    worlds.push(times(worlds[parent], turns[j]));
  }
  return places;
}

// `PlanarTransform`: turn by an angle about +y, then shift over the ground.
function moved({ angle, x, z }, [a, b, c]) {
  const cos = Math.cos(angle), sin = Math.sin(angle);
  return [a * cos + c * sin + x, b, c * cos - a * sin + z];
}

function movedPose(transform, { root, turns }) {
  const half = transform.angle / 2, about = [Math.cos(half), 0, Math.sin(half), 0];
  return { root: moved(transform, root), turns: [times(about, turns[0]), ...turns.slice(1)] };
}

// ---- matching ----

// The sums of [KGP02, Eqs. 2-4] over two clouds; from them come the best turn, and the distance at any turn.
function sums(cloud, other) {
  let n = 0, A = 0, B = 0, fixed = 0;
  const mean = [0, 0, 0, 0];
  for (let p = 0; p < cloud.length; p++) for (let k = 0; k < cloud[p].length; k++, n++) {
    const [x, , z] = cloud[p][k], [u, , w] = other[p][k];
    mean[0] += x; mean[1] += z; mean[2] += u; mean[3] += w;
  }
  const [mx, mz, mu, mw] = mean.map((v) => v / n);
  for (let p = 0; p < cloud.length; p++) for (let k = 0; k < cloud[p].length; k++) {
    const [x, y, z] = cloud[p][k], [u, v, w] = other[p][k], X = x - mx, Z = z - mz, U = u - mu, W = w - mw;
    A += X * U + Z * W; B += X * W - U * Z;
    fixed += X * X + Z * Z + U * U + W * W + (y - v) * (y - v);
  }
  return { A: A / n, B: B / n, fixed: fixed / n, mx, mz, mu, mw };
}

const bestAngle = ({ A, B }) => Math.atan2(B, A);

// The root of the mean squared distance, metres, when the second cloud is turned by an angle and shifted best.
const distanceAt = ({ A, B, fixed }, angle) => Math.sqrt(Math.max(0, fixed - 2 * (A * Math.cos(angle) + B * Math.sin(angle))));

function bestShift({ mx, mz, mu, mw }, angle) {
  const [u, , w] = moved({ angle, x: 0, z: 0 }, [mu, 0, mw]);
  return { angle, x: mx - u, z: mz - w };
}

// The distances, metres, around a pair of windows: rows and columns `every` frames apart, NaN where a clip ends.
function gridAround(first, i, second, j, window, reach, every) {
  const steps = 2 * reach + 1, values = new Float32Array(steps * steps).fill(NaN);
  const clouds = (clip, at) => Array.from({ length: steps }, (_, k) => at + (k - reach) * every).map((start) =>
    (start >= 0 && start + window <= clip.frames ? clip.cloud(start, window) : null));
  const rows = clouds(first, i), columns = clouds(second, j);
  rows.forEach((row, r) => columns.forEach((column, c) => {
    if (!row || !column) return;
    const all = sums(row, column);
    values[r * steps + c] = distanceAt(all, bestAngle(all));
  }));
  return { values, rows: steps, columns: steps, every, from: [i - reach * every, j - reach * every] };
}

// ---- blending ----

// The weights of the first clip: `blending.cubic_weights`, `linear_weights`, and those of a cut.
const WEIGHTS = {
  cubic: (t) => 2 * t ** 3 - 3 * t ** 2 + 1,
  linear: (t) => 1 - t,
  cut: () => 0,
};

function weightsOf(kind, window) { return Array.from({ length: window }, (_, p) => WEIGHTS[kind]((p + 1) / window)); }

function blended(a, b, alpha) {
  return {
    root: a.root.map((v, k) => alpha * v + (1 - alpha) * b.root[k]),
    turns: a.turns.map((turn, k) => slerp(b.turns[k], turn, alpha)),
  };
}

// The seam with the frames around it: `blending.join`. `alpha` is 1 before the window and 0 after it.
function seamOf(first, i, second, j, { transform, window, before, after, kind }) {
  const weights = weightsOf(kind, window), frames = [];
  for (let f = -before; f < window + after; f++) {
    const alpha = f < 0 ? 1 : f < window ? weights[f] : 0;
    const a = alpha > 0 ? first.pose(i + f) : null, b = alpha < 1 ? movedPose(transform, second.pose(j + f)) : null;
    const pose = a && b ? blended(a, b, alpha) : a ?? b;
    frames.push({ alpha, places: joints(first.skeleton, pose), plants: alpha >= 0.5 ? first.plants?.[i + f] : second.plants?.[j + f] });
  }
  return frames;
}

// How far the velocity jumps in each frame, m/s, the RMS over the points: `quality.jumps`; null at both ends.
function jolts(frames, points, fps) {
  return frames.map((_, f) => {
    if (f === 0 || f === frames.length - 1) return null;
    const [p, q, r] = [-1, 0, 1].map((step) => frames[f + step].places ?? frames[f + step]);
    let sum = 0;
    for (const n of points) for (let k = 0; k < 3; k++) sum += (r[n][k] - 2 * q[n][k] + p[n][k]) ** 2;
    return Math.sqrt(sum / points.length) * fps;
  });
}
