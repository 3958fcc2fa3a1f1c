// Bending of a walk onto a line, frame by frame, as `walk_bending.py` describes it, without a page or a picture.
// A frame is carried from the walk's own smooth path to the line. Feet that stand are held, and their legs are solved.

import { edgeAt, poseAlong, product, rotate } from "./walk_body.js";
import { compose } from "./walk_search.js";

/**
 * @import { Played, Pose } from "./walk_body.js"
 * @import { Clip, Graph, Line, Transform } from "./walk_search.js"
 *
 * A point of a path and the heading there, radians.
 * @typedef {{ heading: number, z: number, x: number }} MovingFrame
 *
 * The motion of an ankle in a frame that holds its foot, relative to the carried ankle: radians and metres.
 * @typedef {{ angle: number, z: number, x: number }} Motion
 *
 * The frames [start, end) of a foot that stands, the transform that carries it in all of them, and the points at which
 * its ankle and its ball are held, null if they do not stand.
 * @typedef {{ start: number, end: number, carried: Transform, held: (number[] | null)[], motions: Motion[] }} Stance
 *
 * A leg: [hip, knee, ankle, ball], the axis of its knee in the frame of its thigh, and the joints from the root to it.
 * @typedef {{ joints: number[], axis: number[], path: number[] }} Limb
 *
 * The vectors of a leg, the axis of its knee, the rotations of its joints in the world, and with its knee bent by
 * `flexion`, √(size + 2 radius cos flexion) is its length.
 * @typedef {{
 *   thigh: number[], shank: number[], wanted: number[], axis: number[], rotations: number[][],
 *   size: number, radius: number, flexion: number,
 * }} Solving
 */

const CHORD = 0.25; // metres before and after a point of a line between which its heading is measured
const AROUND = Array.from({ length: 9 }, (_, k) => k / 4 - 1); // places in a chord whose mean is the point
const EASE = 20; // frames in which a walk comes from one line onto the next
const BRIDGED = 2; // frames: a foot that lifts for so short a time stands on
const SHORTEST = 3; // frames: a shorter stance is none
const FADE = 8; // frames from the first and the last frame of a walk to the nearest stance of a foot
const STRAIGHTEST = (4 * Math.PI) / 180; // radians: no knee is straightened further
const DEEPEST = 0.05; // metres by which the root sinks at most
const SINKING = 4; // frames before and after, over which the root sinks
/** @type {Motion} */
const NOTHING = { angle: 0, z: 0, x: 0 };

/** Weights of the places in a chord, which leave a parabola where it is. */
const WEIGHTS = (() => {
  const bell = AROUND.map((u) => Math.exp(-0.5 * (u / 0.6) ** 2));
  /** @param {number} power */
  const moment = (power) => bell.reduce((sum, w, k) => sum + w * AROUND[k] ** power, 0);
  const flat = bell.map((w, k) => w * (1 - (AROUND[k] ** 2 * moment(2)) / moment(4)));
  const total = flat.reduce((sum, w) => sum + w, 0);
  return flat.map((w) => w / total);
})();

/** @param {number} angle */
const wrapped = (angle) => Math.atan2(Math.sin(angle), Math.cos(angle));
/** @param {number} share */
const smoothStep = (share) => share ** 2 * (3 - 2 * share);
/**
 * @param {number[]} a
 * @param {number[]} b
 */
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
/**
 * @param {number[]} a
 * @param {number[]} b
 */
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
/** @param {number[]} q */
const inverse = ([w, x, y, z]) => [w, -x, -y, -z];

/**
 * A point of the ground, carried by a transform.
 * @param {Transform} transform
 * @param {number[]} point
 */
export const carry = ([c, s, z, x], [pz, px]) => [c * pz - s * px + z, s * pz + c * px + x];

/**
 * The rotation about a unit vector.
 * @param {number[]} axis
 * @param {number} angle
 */
const about = (axis, angle) => [Math.cos(angle / 2), ...axis.map((value) => value * Math.sin(angle / 2))];

/**
 * The shortest rotation from one direction to another.
 * @param {number[]} a
 * @param {number[]} b
 */
function between(a, b) {
  const quaternion = [Math.sqrt(dot(a, a) * dot(b, b)) + dot(a, b), ...cross(a, b)];
  const length = Math.hypot(...quaternion) || 1;
  return quaternion.map((value) => value / length);
}

/**
 * The point of a line at an arc length, metres. Beyond both ends the line goes straight on.
 * @param {Line} line
 * @param {number} along
 */
function pointAt({ z, x }, along) {
  const last = z.length - 1;
  const at = Math.max(0, Math.min(100 * along, last));
  const k = Math.min(Math.floor(at), last - 1);
  const fraction = at - k;
  const point = [z[k] + fraction * (z[k + 1] - z[k]), x[k] + fraction * (x[k + 1] - x[k])];
  const beyond = along - at / 100;
  if (!beyond) return point;
  const chord = Math.min(100 * CHORD, last);
  const from = beyond < 0 ? 0 : Math.floor(last - chord);
  const to = beyond < 0 ? Math.ceil(chord) : last;
  const length = Math.hypot(z[to] - z[from], x[to] - x[from]) || 1;
  return [point[0] + (beyond * (z[to] - z[from])) / length, point[1] + (beyond * (x[to] - x[from])) / length];
}

/**
 * The frame that moves along a line, at an arc length: a mean over a chord, and the heading of the chord.
 * @param {Line} line
 * @param {number} along
 * @returns {MovingFrame}
 */
export function movingFrame(line, along) {
  const points = AROUND.map((u) => pointAt(line, along + CHORD * u));
  const [first, last] = [points[0], points[points.length - 1]];
  const [z, x] = [0, 1].map((c) => points.reduce((sum, point, k) => sum + WEIGHTS[k] * point[c], 0));
  return { heading: Math.atan2(last[1] - first[1], last[0] - first[0]), z, x };
}

/**
 * The frame that moves along the smooth path of a clip, transformed, and the metres since the frame before.
 * @param {Clip} clip
 * @param {number} frame
 * @param {Transform} transform
 */
function clipFrame({ path }, frame, transform) {
  const before = Math.max(frame - 1, 0);
  const [z, x] = carry(transform, [path.z[frame], path.x[frame]]);
  const heading = path.heading[frame] + Math.atan2(transform[1], transform[0]);
  return { heading, z, x, step: Math.hypot(path.z[frame] - path.z[before], path.x[frame] - path.x[before]) };
}

/**
 * The frame that moves along a walk's own path, and the metres since the frame before.
 * @param {Played} walk
 * @param {number} frame
 */
function ownFrame(walk, frame) {
  const [at, i] = edgeAt(walk, frame);
  const { start, end, seam, frames, transform } = walk.edges[at];
  const { clips, weights } = walk.graph;
  const first = clipFrame(clips[start.clip], start.frame + i, walk.transforms[at]);
  if (!seam) return first;
  const entered = compose(walk.transforms[at], transform);
  const second = clipFrame(clips[end.clip], end.frame - frames + i, entered);
  const weight = 1 - weights[i];
  return {
    heading: first.heading + weight * wrapped(second.heading - first.heading),
    z: first.z + weight * (second.z - first.z),
    x: first.x + weight * (second.x - first.x),
    step: first.step + weight * (second.step - first.step),
  };
}

/**
 * The bits of the ankles and balls that stand in a frame of a walk, which are those of the clip of larger weight.
 * @param {Played} walk
 * @param {number} frame
 */
function standsAt(walk, frame) {
  const [at, i] = edgeAt(walk, frame);
  const { start, end, seam, frames } = walk.edges[at];
  const { clips, weights } = walk.graph;
  if (seam && weights[i] < 0.5) return clips[end.clip].stands[end.frame - frames + i];
  return clips[start.clip].stands[start.frame + i];
}

/**
 * The runs [start, end) of frames in which a foot stands, joined over short gaps, without short runs.
 * @param {(frame: number) => boolean} stands
 * @param {number} from
 * @param {number} to
 */
function runs(stands, from, to) {
  /** @type {number[][]} */
  const found = [];
  for (let frame = from; frame < to; frame++) {
    if (!stands(frame)) continue;
    const last = found.at(-1);
    if (last && frame - last[1] <= BRIDGED) last[1] = frame + 1;
    else found.push([frame, frame + 1]);
  }
  return found.filter(([start, end]) => end - start >= SHORTEST);
}

// The bending of a walk that grows. All arrays have an entry for each frame.
export class Bending {
  /** @type {Transform[]} by which the body is carried */
  carried = [];
  /** @type {number[][][][]} for each limb and frame, where its ankle and its ball are in the walk that is not bent */
  feet;
  /** @type {Motion[][]} for each limb, the motion of the ankle that holds the foot */
  motions;
  /** @type {Stance[][]} for each limb */
  stances;
  /** @type {(Stance | undefined)[]} for each limb, a stance that the walk was cut in */
  kept;
  /** @type {number[]} by how much the root must sink for both feet, metres */
  shortfalls = [];
  /** @type {number[]} by how much it sinks, smoothly, metres */
  sinking = [];
  /** @type {Line | null} */
  line = null;
  along = 0; // metres on the line at the last frame
  first = 0; // the frame in which the walk began to follow the line
  cutAt = 0; // the frame at which the walk was cut last
  /** @type {MovingFrame} from the line's start to the walk in that frame */
  offset = { heading: 0, z: 0, x: 0 };

  /** @param {Graph} graph */
  constructor(graph) {
    this.graph = graph;
    const { limbs, parents } = graph.about;
    /** @type {Limb[]} */
    this.limbs = limbs.map(({ joints, axis }) => {
      /** @type {number[]} */
      const path = [];
      for (let joint = joints[3]; joint > 0; joint = parents[joint]) path.unshift(joint);
      return { joints, axis, path };
    });
    this.feet = limbs.map(() => []);
    this.motions = limbs.map(() => []);
    this.stances = limbs.map(() => []);
    this.kept = limbs.map(() => undefined);
  }

  get frames() {
    return this.carried.length;
  }

  /**
   * Follow a line from now on, smoothly from where the walk is.
   * @param {Line} line
   * @param {Played} walk
   */
  follow(line, walk) {
    const last = this.frames - 1;
    this.line = line;
    this.along = 0;
    this.first = this.frames;
    this.offset = { heading: 0, z: 0, x: 0 };
    if (last < 0) return;
    const own = ownFrame(walk, last);
    const [z, x] = carry(this.carried[last], [own.z, own.x]);
    const [c, s] = this.carried[last];
    const start = movingFrame(line, 0);
    this.offset = {
      heading: wrapped(own.heading + Math.atan2(s, c) - start.heading),
      z: z - start.z,
      x: x - start.x,
    };
  }

  /**
   * Forget all frames from one on. A stance that it cuts goes on where it is.
   * @param {number} frames
   */
  cut(frames) {
    this.cutAt = frames;
    this.carried.length = frames;
    this.shortfalls.length = Math.min(this.shortfalls.length, frames);
    this.sinking.length = Math.min(this.sinking.length, frames);
    this.stances.forEach((stances, n) => {
      this.feet[n].length = frames;
      this.motions[n].length = frames;
      this.kept[n] = stances.find(({ start, end }) => start < frames && end + BRIDGED >= frames);
      this.stances[n] = stances.filter(({ end }) => end + BRIDGED < frames);
    });
  }

  /**
   * Bend the frames by which a walk has grown.
   * @param {Played} walk
   */
  extend(walk) {
    for (let frame = this.frames; frame < walk.frames; frame++) {
      this.carried.push(this.carryFrame(walk, frame));
      const pose = poseAlong(walk, frame);
      this.limbs.forEach((limb, n) => {
        const { positions } = this.chain(pose, limb);
        this.feet[n].push(limb.joints.slice(2).map((joint) => [positions[joint][2], positions[joint][0]]));
      });
    }
    const changed = this.limbs.map((_, n) => this.hold(walk, n));
    const from = Math.max(0, Math.min(...changed, walk.frames));
    for (let frame = from; frame < walk.frames; frame++) {
      const pose = poseAlong(walk, frame);
      const needs = this.limbs.map((_, n) => this.shortfall(this.solving(pose, frame, n)));
      this.shortfalls[frame] = Math.max(0, ...needs);
    }
    this.sink(Math.max(0, from - 2 * SINKING));
  }

  /**
   * The transform that carries a frame onto the line.
   * @param {Played} walk
   * @param {number} frame
   * @returns {Transform}
   */
  carryFrame(walk, frame) {
    const { line, first, offset } = this;
    if (!line) return [1, 0, 0, 0];
    const own = ownFrame(walk, frame);
    if (frame) this.along += own.step;
    const target = movingFrame(line, this.along);
    const weight = 1 - smoothStep(Math.min(1, (frame - first + 1) / EASE));
    const angle = target.heading + weight * offset.heading - own.heading;
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    return [
      c,
      s,
      target.z + weight * offset.z - (c * own.z - s * own.x),
      target.x + weight * offset.x - (s * own.z + c * own.x),
    ];
  }

  /**
   * Find the stances of a foot anew, after those that are complete, and return the first frame that changes.
   * @param {Played} walk
   * @param {number} n
   */
  hold(walk, n) {
    const closed = this.stances[n].filter(({ end }) => end + BRIDGED < this.motions[n].length);
    const from = closed.at(-1)?.end ?? 0;
    /** @param {number} frame */
    const stands = (frame) => ((standsAt(walk, frame) >> (2 * n)) & 3) !== 0;
    const open = runs(stands, from, walk.frames).map(([start, end]) => this.stance(walk, n, start, end));
    this.stances[n] = [...closed, ...open];
    this.easeBetween(n, from, closed.at(-1), open);
    return from;
  }

  /**
   * A stance, held by the transform of its middle.
   * @param {Played} walk
   * @param {number} n
   * @param {number} start
   * @param {number} end
   * @returns {Stance}
   */
  stance(walk, n, start, end) {
    const kept = this.kept[n]?.start === start ? this.kept[n] : undefined;
    const carried = kept?.carried ?? this.carried[(start + end) >> 1];
    /** @param {number} frame */
    const bits = (frame) => (standsAt(walk, frame) >> (2 * n)) & 3;
    const frames = Array.from({ length: end - start }, (_, i) => start + i);
    const places = frames.map((frame) => this.feet[n][frame].map((foot) => carry(carried, foot)));
    const held = [0, 1].map((part) => {
      const standing = places.filter((_, i) => bits(start + i) & (1 << part));
      if (kept?.held[part]) return kept.held[part];
      if (!standing.length) return null;
      return [0, 1].map((c) => standing.reduce((sum, place) => sum + place[part][c], 0) / standing.length);
    });
    const motions = frames.map((frame, i) => {
      const parts = [0, 1].filter((part) => bits(frame) & (1 << part) && held[part]);
      const [slideZ, slideX] = [0, 1].map(
        (c) =>
          parts.reduce((sum, part) => sum + (held[part]?.[c] ?? 0) - places[i][part][c], 0) /
          Math.max(1, parts.length),
      );
      const here = this.carried[frame];
      const [z, x] = carry(here, this.feet[n][frame][0]);
      const angle = wrapped(Math.atan2(carried[1], carried[0]) - Math.atan2(here[1], here[0]));
      return { angle, z: places[i][0][0] + slideZ - z, x: places[i][0][1] + slideX - x };
    });
    return { start, end, carried, held, motions };
  }

  /**
   * Write the motions of an ankle from a frame on, eased from stance to stance.
   * @param {number} n
   * @param {number} from
   * @param {Stance | undefined} closed
   * @param {Stance[]} open
   */
  easeBetween(n, from, closed, open) {
    const { cutAt } = this;
    const motions = this.motions[n];
    /**
     * @param {number} start
     * @param {Motion} before
     * @param {number} end
     * @param {Motion} after
     */
    const ease = (start, before, end, after) => {
      if (cutAt > start + 1 && cutAt <= end) {
        ease(cutAt - 1, motions[cutAt - 1], end, after); // frames that were shown stay as they were
        return;
      }
      for (let frame = Math.max(0, start + 1); frame < Math.min(end, this.frames); frame++) {
        const weight = smoothStep((frame - start) / (end - start));
        motions[frame] = {
          angle: before.angle + weight * (after.angle - before.angle),
          z: before.z + weight * (after.z - before.z),
          x: before.x + weight * (after.x - before.x),
        };
      }
    };
    for (let frame = Math.max(from, cutAt); frame < this.frames; frame++) motions[frame] = NOTHING;
    let last = closed;
    for (const stance of open) {
      const start = last ? last.end - 1 : Math.max(0, stance.start - FADE) - 1;
      ease(start, last?.motions.at(-1) ?? NOTHING, stance.start, stance.motions[0]);
      stance.motions.forEach((motion, i) => {
        motions[stance.start + i] = motion;
      });
      last = stance;
    }
    if (last) ease(last.end - 1, last.motions.at(-1) ?? NOTHING, last.end + FADE, NOTHING);
  }

  /**
   * Let the root sink smoothly, and enough, from a frame on.
   * @param {number} from
   */
  sink(from) {
    const { shortfalls, frames } = this;
    /** @param {number} frame */
    const deepest = (frame) => {
      const middle = Math.max(0, Math.min(frame, frames - 1));
      return Math.max(0, ...shortfalls.slice(Math.max(0, middle - SINKING), middle + SINKING + 1));
    };
    const depths = Array.from({ length: frames - from + 2 * SINKING }, (_, i) => deepest(from - SINKING + i));
    for (let frame = from; frame < frames; frame++) {
      const around = depths.slice(frame - from, frame - from + 2 * SINKING + 1);
      this.sinking[frame] = around.reduce((sum, depth) => sum + depth, 0) / around.length;
    }
  }

  /**
   * The positions and rotations of the joints from the root to a foot, by their numbers.
   * @param {Pose} pose
   * @param {Limb} limb
   */
  chain(pose, { path }) {
    const { parents, offsets } = this.graph.about;
    const positions = [pose.root];
    const rotations = [pose.rotations[0]];
    for (const joint of path) {
      const above = parents[joint];
      const offset = rotate(rotations[above], offsets[joint]);
      positions[joint] = positions[above].map((value, c) => value + offset[c]);
      rotations[joint] = product(rotations[above], pose.rotations[joint]);
    }
    return { positions, rotations };
  }

  /**
   * What solving a leg needs, in the walk that is not bent: as the body is carried, so is the whole solution.
   * @param {Pose} pose
   * @param {number} frame
   * @param {number} n
   * @returns {Solving}
   */
  solving(pose, frame, n) {
    const limb = this.limbs[n];
    const { positions, rotations } = this.chain(pose, limb);
    const [hip, knee, ankle] = limb.joints.map((joint) => positions[joint]);
    const [c, s] = this.carried[frame];
    const { z, x } = this.motions[n][frame];
    const shift = [c * x - s * z, 0, c * z + s * x]; // the motion, before it is carried
    const thigh = knee.map((value, k) => value - hip[k]);
    const shank = ankle.map((value, k) => value - knee[k]);
    const wanted = ankle.map((value, k) => value - hip[k] + shift[k]);
    const axis = rotate(rotations[limb.joints[0]], limb.axis);
    const along = dot(shank, axis);
    const across = shank.map((value, k) => value - along * axis[k]);
    const size = dot(thigh, thigh) + dot(shank, shank) + 2 * along * dot(thigh, axis);
    const cosine = dot(thigh, across);
    const sine = dot(thigh, cross(axis, across));
    const radius = Math.hypot(cosine, sine);
    return { thigh, shank, wanted, axis, rotations, size, radius, flexion: -Math.atan2(sine, cosine) };
  }

  /**
   * By how much the hip must sink for a leg to reach its target, metres.
   * @param {Solving} solving
   */
  shortfall({ wanted, size, radius, flexion }) {
    const longest = size + 2 * radius * Math.cos(Math.min(Math.abs(flexion), STRAIGHTEST));
    const level = wanted[0] ** 2 + wanted[2] ** 2;
    const sinking = -wanted[1] - Math.sqrt(Math.max(longest - level, 0));
    return Math.max(0, Math.min(sinking, DEEPEST));
  }

  /**
   * The bent pose of a frame, from the pose of the walk that is not bent.
   * @param {Pose} pose
   * @param {number} frame
   * @returns {Pose}
   */
  posed(pose, frame) {
    const { root, rotations } = this.carriedPose(pose, frame);
    this.limbs.forEach((_, n) => this.solve(pose, frame, n, rotations));
    return { root: [root[0], root[1] - this.sinking[frame], root[2]], rotations };
  }

  /**
   * The pose of a frame, carried onto the line. Its feet are not held.
   * @param {Pose} pose
   * @param {number} frame
   * @returns {Pose}
   */
  carriedPose(pose, frame) {
    const [c, s] = this.carried[frame];
    const [z, x] = carry(this.carried[frame], [pose.root[2], pose.root[0]]);
    const rotations = [...pose.rotations];
    rotations[0] = product(about([0, 1, 0], Math.atan2(s, c)), rotations[0]);
    return { root: [x, pose.root[1], z], rotations };
  }

  /**
   * Write the rotations of the hip, the knee and the ankle that hold a foot.
   * @param {Pose} pose
   * @param {number} frame
   * @param {number} n
   * @param {number[][]} out
   */
  solve(pose, frame, n, out) {
    const solving = this.solving(pose, frame, n);
    const { thigh, shank, axis, size, radius, flexion } = solving;
    const [wantedX, wantedY, wantedZ] = solving.wanted;
    const wanted = [wantedX, wantedY + this.sinking[frame], wantedZ];
    const straightest = Math.cos(Math.min(Math.abs(flexion), STRAIGHTEST));
    const cosine = (dot(wanted, wanted) - size) / (2 * Math.max(radius, 1e-9));
    const bend = Math.acos(Math.max(-1, Math.min(cosine, straightest)));
    const fold = about(axis, bend - flexion);
    const bent = rotate(fold, shank);
    const swing = between(
      thigh.map((value, k) => value + bent[k]),
      wanted,
    );
    const sole = product(inverse(product(swing, fold)), about([0, 1, 0], this.motions[n][frame].angle));
    const { parents } = this.graph.about;
    [swing, fold, sole].forEach((rotation, k) => {
      // A rotation of the world comes on top of that of a joint, seen from the frame of its parent.
      const joint = this.limbs[n].joints[k];
      const above = solving.rotations[parents[joint]];
      out[joint] = product(product(product(inverse(above), rotation), above), pose.rotations[joint]);
    });
  }
}
