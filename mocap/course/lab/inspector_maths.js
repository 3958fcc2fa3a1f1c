// The computations of the inspector: bodies from rotations, the best rotation, the blend. `tests/browser/test_inspector.py`
// holds each of these formulas against the package's function, which every comment names.

import { summed } from "../../widgets/player_scene.js";

/**
 * A clip, as `packed_clip` in `showing.py` packs it: `plants` has a digit for each frame.
 * @typedef {{
 *   name: string, frames: number, channels: number, offset: number, origin: number[], plants: string,
 * }} PackedClip
 *
 * What draws and measures a body, as `packed_skeleton` packs it: `bones` are [from, to, side], `feet` [ball, side].
 * @typedef {{
 *   parents: number[], offsets: number[][], points: number[], bones: number[][], head: number | null,
 *   feet: number[][],
 * }} Skeleton
 *
 * The root's position, and the joints' quaternions, one after the other.
 * @typedef {{ root: number[], rotations: Float64Array }} Pose
 *
 * The points of a window, frame by frame.
 * @typedef {number[][][]} Cloud
 *
 * A rotation about +y, then a translation on the ground, with the cosine and the sine if they are known.
 * @typedef {{ angle: number, x: number, z: number, cos?: number, sin?: number }} Transform
 *
 * @typedef {{ A: number, B: number, fixed: number, mx: number, mz: number, mu: number, mw: number }} Sums
 *
 * How two clips are mixed: frames of the window, before it and after it, and the weights of the first clip.
 * @typedef {{ transform: Transform, window: number, before: number, after: number, kind: Weighting }} Mix
 *
 * @typedef {keyof typeof WEIGHTS} Weighting
 *
 * A frame of a seam: the weight of the first clip, where the joints are, and which feet stand, as bits.
 * @typedef {{ alpha: number, positions: number[][], contacts: number }} SeamFrame
 */

const STEP = 5e-6; // the unit of the numbers: metres, and components of a quaternion

/**
 * Undo what `player.py` does: four planes of bytes make 32-bit numbers, which the player's `summed` sums up. They are
 * given frame by frame: x, y, z of the root, then w, x, y, z of each joint.
 * @param {ArrayBuffer} bytes
 * @param {PackedClip} packed
 */
function unpacked(bytes, { offset, frames, channels }) {
  const count = frames * channels;
  const planes = new Uint8Array(bytes, offset, 4 * count);
  /**
   * @param {unknown} _
   * @param {number} k
   */
  const whole = (_, k) =>
    planes[k] | (planes[count + k] << 8) | (planes[2 * count + k] << 16) | (planes[3 * count + k] << 24);
  const numbers = summed(Int32Array.from({ length: count }, whole), frames);
  return Float64Array.from(
    { length: count },
    (_, k) => STEP * numbers[(k % channels) * frames + Math.floor(k / channels)],
  );
}

// ---- quaternions: w, x, y, z; many of them in one array, so that a page can multiply thousands in a few milliseconds ----

/**
 * The product of quaternions.
 * @param {ArrayLike<number> & Iterable<number>} p
 * @param {ArrayLike<number> & Iterable<number>} q
 */
const times = ([a, b, c, d], [e, f, g, h]) => [
  a * e - b * f - c * g - d * h,
  a * f + b * e + c * h - d * g,
  a * g - b * h + c * e + d * f,
  a * h + b * g - c * f + d * e,
];

/**
 * `rotations.slerp`: along the shorter arc, and linear if both are almost equal.
 * @param {Float64Array} from
 * @param {Float64Array} to
 * @param {number} fraction
 * @param {number} k
 * @param {Float64Array} out
 */
function slerp(from, to, fraction, k, out) {
  const dot = from[k] * to[k] + from[k + 1] * to[k + 1] + from[k + 2] * to[k + 2] + from[k + 3] * to[k + 3];
  const sign = dot < 0 ? -1 : 1;
  const angle = Math.acos(Math.min(1, Math.abs(dot)));
  const sine = Math.sin(angle);
  const near = sine < 1e-6;
  const p = near ? 1 - fraction : Math.sin((1 - fraction) * angle) / sine;
  const q = sign * (near ? fraction : Math.sin(fraction * angle) / sine);
  for (let n = k; n < k + 4; n++) out[n] = p * from[n] + q * to[n];
}

// ---- poses: the root's position, and the joints' quaternions, one after the other ----

export class Clip {
  /** @type {Map<number, number[][]>} the joints of frames */
  cache = new Map();

  /**
   * @param {PackedClip} packed
   * @param {Skeleton} skeleton
   * @param {ArrayBuffer} bytes
   */
  constructor(packed, skeleton, bytes) {
    this.name = packed.name;
    this.frames = packed.frames;
    this.channels = packed.channels;
    this.origin = packed.origin;
    this.contacts = packed.plants;
    this.skeleton = skeleton;
    this.numbers = unpacked(bytes, packed);
  }

  /**
   * @param {number} frame
   * @returns {Pose}
   */
  pose(frame) {
    const at = frame * this.channels;
    const [x0, z0] = this.origin;
    const { numbers } = this;
    return {
      root: [numbers[at] + x0, numbers[at + 1], numbers[at + 2] + z0],
      rotations: numbers.subarray(at + 3, at + this.channels),
    };
  }

  /**
   * The joints of a frame, which do not change: they are computed once.
   * @param {number} frame
   */
  joints(frame) {
    const cached = this.cache.get(frame);
    if (cached) return cached;
    const positions = joints(this.skeleton, this.pose(frame));
    this.cache.set(frame, positions);
    return positions;
  }

  /**
   * The points of a window, frame by frame: `matching.point_cloud`.
   * @param {number} start
   * @param {number} frames
   * @returns {Cloud}
   */
  cloud(start, frames) {
    return Array.from({ length: frames }, (_, p) =>
      this.skeleton.points.map((joint) => this.joints(start + p)[joint]),
    );
  }
}

/**
 * Where all joints of a pose are: `body.kinematics.joint_positions`. A parent comes before its children.
 * @param {Skeleton} skeleton
 * @param {Pose} pose
 */
function joints({ parents, offsets }, { root, rotations }) {
  const positions = [root];
  const worlds = Float64Array.from(rotations);
  for (let j = 1; j < parents.length; j++) {
    const p = 4 * parents[j];
    const w = worlds[p];
    const x = worlds[p + 1];
    const y = worlds[p + 2];
    const z = worlds[p + 3];
    const [a, b, c] = offsets[j];
    const u = 2 * (y * c - z * b);
    const v = 2 * (z * a - x * c);
    const t = 2 * (x * b - y * a);
    const from = positions[parents[j]]; // the offset, rotated by its parent
    positions.push([
      from[0] + a + w * u + y * t - z * v,
      from[1] + b + w * v + z * u - x * t,
      from[2] + c + w * t + x * v - y * u,
    ]);
    const k = 4 * j;
    const e = rotations[k];
    const f = rotations[k + 1];
    const g = rotations[k + 2];
    const h = rotations[k + 3];
    worlds[k] = w * e - x * f - y * g - z * h;
    worlds[k + 1] = w * f + x * e + y * h - z * g;
    worlds[k + 2] = w * g - x * h + y * e + z * f;
    worlds[k + 3] = w * h + x * g - y * f + z * e;
  }
  return positions;
}

/**
 * `PlanarTransform`: a rotation about +y, then a translation on the ground.
 * @param {Transform} transform
 * @param {number[]} position
 */
export function transformed({ angle, x, z, cos = Math.cos(angle), sin = Math.sin(angle) }, [a, b, c]) {
  return [a * cos + c * sin + x, b, c * cos - a * sin + z];
}

/**
 * @param {Transform} transform
 * @param {Pose} pose
 * @returns {Pose}
 */
function transformedPose(transform, { root, rotations }) {
  const half = transform.angle / 2;
  const about = [Math.cos(half), 0, Math.sin(half), 0];
  const all = Float64Array.from(rotations);
  all.set(times(about, rotations.subarray(0, 4)));
  return { root: transformed(transform, root), rotations: all };
}

// ---- matching ----

/**
 * The sums of [KGP02, Eqs. 2-4] over two clouds; they give the best rotation, and the distance for any rotation.
 * @param {Cloud} cloud
 * @param {Cloud} other
 */
export function sums(cloud, other) {
  let n = 0;
  let A = 0;
  let B = 0;
  let fixed = 0;
  const mean = [0, 0, 0, 0];
  for (let p = 0; p < cloud.length; p++) {
    for (let k = 0; k < cloud[p].length; k++, n++) {
      const [x, , z] = cloud[p][k];
      const [u, , w] = other[p][k];
      mean[0] += x;
      mean[1] += z;
      mean[2] += u;
      mean[3] += w;
    }
  }
  const [mx, mz, mu, mw] = mean.map((v) => v / n);
  for (let p = 0; p < cloud.length; p++) {
    for (let k = 0; k < cloud[p].length; k++) {
      const [x, y, z] = cloud[p][k];
      const [u, v, w] = other[p][k];
      const X = x - mx;
      const Z = z - mz;
      const U = u - mu;
      const W = w - mw;
      A += X * U + Z * W;
      B += X * W - U * Z;
      fixed += X * X + Z * Z + U * U + W * W + (y - v) * (y - v);
    }
  }
  return { A: A / n, B: B / n, fixed: fixed / n, mx, mz, mu, mw };
}

/** @param {Sums} sums */
export const bestAngle = ({ A, B }) => Math.atan2(B, A);

/**
 * The root of the mean squared distance, metres, if the second cloud is rotated by an angle and optimally translated.
 * @param {Sums} sums
 * @param {number} angle
 */
export const distanceAt = ({ A, B, fixed }, angle) =>
  Math.sqrt(Math.max(0, fixed - 2 * (A * Math.cos(angle) + B * Math.sin(angle))));

/**
 * @param {Sums} sums
 * @param {number} angle
 * @returns {Transform}
 */
export function bestShift({ mx, mz, mu, mw }, angle) {
  const [u, , w] = transformed({ angle, x: 0, z: 0 }, [mu, 0, mw]);
  return { angle, x: mx - u, z: mz - w, cos: Math.cos(angle), sin: Math.sin(angle) };
}

/**
 * The distances, metres, around a pair of windows: rows and columns `every` frames apart, NaN where a clip ends.
 * @param {Clip} first
 * @param {number} i
 * @param {Clip} second
 * @param {number} j
 * @param {number} window
 * @param {number} reach
 * @param {number} every
 */
export function gridAround(first, i, second, j, window, reach, every) {
  const steps = 2 * reach + 1;
  const values = new Float32Array(steps * steps).fill(NaN);
  /**
   * @param {Clip} clip
   * @param {number} at
   */
  const clouds = (clip, at) =>
    Array.from({ length: steps }, (_, k) => at + (k - reach) * every).map((start) =>
      start >= 0 && start + window <= clip.frames ? clip.cloud(start, window) : null,
    );
  const rows = clouds(first, i);
  const columns = clouds(second, j);
  rows.forEach((row, r) =>
    columns.forEach((column, c) => {
      if (!row || !column) return;
      const all = sums(row, column);
      values[r * steps + c] = distanceAt(all, bestAngle(all));
    }),
  );
  return { values, rows: steps, columns: steps, every, from: [i - reach * every, j - reach * every] };
}

// ---- blending ----

// The weights of the first clip: `blending.cubic_weights`, `linear_weights`, and those of a cut.
export const WEIGHTS = {
  cubic: (/** @type {number} */ t) => 2 * t ** 3 - 3 * t ** 2 + 1,
  linear: (/** @type {number} */ t) => 1 - t,
  cut: () => 0,
};

/**
 * The weights of the first clip in each frame of a window.
 * @param {Weighting} kind
 * @param {number} window
 */
export function weightsOf(kind, window) {
  return Array.from({ length: window }, (_, p) => WEIGHTS[kind]((p + 1) / window));
}

/**
 * @param {Pose} a
 * @param {Pose} b
 * @param {number} alpha
 * @returns {Pose}
 */
function blended(a, b, alpha) {
  const rotations = new Float64Array(a.rotations.length);
  for (let k = 0; k < rotations.length; k += 4) slerp(b.rotations, a.rotations, alpha, k, rotations);
  return { root: a.root.map((v, k) => alpha * v + (1 - alpha) * b.root[k]), rotations };
}

/**
 * The seam with the frames around it: `blending.join`. `alpha` is 1 before the window and 0 after it.
 * @param {Clip} first
 * @param {number} i
 * @param {Clip} second
 * @param {number} j
 * @param {Mix} how
 * @returns {SeamFrame[]}
 */
export function seamOf(first, i, second, j, { transform, window, before, after, kind }) {
  const weights = weightsOf(kind, window);
  const weightAt = (/** @type {number} */ f) => (f < window ? weights[f] : 0);
  /**
   * @param {number} f
   * @param {number} alpha
   */
  const positionsAt = (f, alpha) => {
    if (alpha === 1) return first.joints(i + f);
    if (alpha === 0) return second.joints(j + f).map((position) => transformed(transform, position));
    const pose = transformedPose(transform, second.pose(j + f));
    return joints(first.skeleton, blended(first.pose(i + f), pose, alpha));
  };
  return Array.from({ length: before + window + after }, (_, k) => {
    const f = k - before;
    const alpha = f < 0 ? 1 : weightAt(f);
    const contacts = Number(alpha >= 0.5 ? first.contacts[i + f] : second.contacts[j + f]);
    return { alpha, positions: positionsAt(f, alpha), contacts };
  });
}

/**
 * How far the velocity jumps in each frame, m/s, the RMS over the points: `quality.jumps`; null at both ends.
 * @param {number[][][]} frames
 * @param {number[]} points
 * @param {number} fps
 */
export function jolts(frames, points, fps) {
  return frames.map((_, f) => {
    if (f === 0 || f === frames.length - 1) return null;
    const [p, q, r] = [-1, 0, 1].map((step) => frames[f + step]);
    let sum = 0;
    for (const n of points) for (let k = 0; k < 3; k++) sum += (r[n][k] - 2 * q[n][k] + p[n][k]) ** 2;
    return Math.sqrt(sum / points.length) * fps;
  });
}
