// Bodies: the positions of all joints of a walk at any time, and the capsules around them, without a page or a picture.

import { writeCapsule } from "./bodies.js";
import { compose } from "./walk_search.js";

/**
 * @import { Bending } from "./walk_bending.js"
 * @import { Clip, Edge, Graph, Piece, Transform } from "./walk_search.js"
 *
 * The root's position [x, y, z], and the quaternions of all joints.
 * @typedef {{ root: number[], rotations: number[][] }} Pose
 *
 * The positions and orientations of all joints in the world.
 * @typedef {{ positions: number[][], rotations: number[][] }} Body
 *
 * The data of a walk that its display needs: its edges, with the transform and the first frame of each, and its bending.
 * @typedef {{
 *   graph: Graph, edges: PlayedEdge[], transforms: Transform[], begins: number[], frames: number,
 *   bending?: Pick<Bending, "posed">,
 * }} Played
 * @typedef {Pick<Edge, "start" | "end" | "seam" | "frames" | "transform">} PlayedEdge
 *
 * A footprint: the frame in which the foot comes down, its position, heading and side.
 * @typedef {{ frame: number, z: number, x: number, angle: number, side: number }} Print
 */

/**
 * The product of quaternions.
 * @param {number[]} p
 * @param {number[]} q
 */
export const product = ([w, x, y, z], [s, u, v, t]) => [
  w * s - x * u - y * v - z * t,
  w * u + x * s + y * t - z * v,
  w * v - x * t + y * s + z * u,
  w * t + x * v - y * u + z * s,
];

/**
 * Rotate a vector v by a quaternion (w, u): v + 2w (u × v) + 2 u × (u × v).
 * @param {number[]} rotation
 * @param {number[]} v
 */
export const rotate = ([w, a, b, c], [x, y, z]) => {
  const t = 2 * (b * z - c * y);
  const u = 2 * (c * x - a * z);
  const v = 2 * (a * y - b * x);
  return [x + w * t + b * v - c * u, y + w * u + c * t - a * v, z + w * v + a * u - b * t];
};

/**
 * Spherical linear interpolation from p to q, along the shorter arc.
 * @param {number[]} p
 * @param {number[]} q
 * @param {number} fraction
 */
function slerp(p, q, fraction) {
  const dot = p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3];
  const angle = Math.acos(Math.min(Math.abs(dot), 1));
  const near = angle < 1e-4;
  const sine = near ? 1 : Math.sin(angle);
  const a = near ? 1 - fraction : Math.sin((1 - fraction) * angle) / sine;
  const b = (near ? fraction : Math.sin(fraction * angle) / sine) * Math.sign(dot || 1);
  return p.map((value, c) => a * value + b * q[c]);
}

/**
 * A frame of a clip, transformed: the root's position [x, y, z], and the rotations of all joints.
 * @param {Clip} clip
 * @param {number} joints
 * @param {number} frame
 * @param {Transform} transform
 * @returns {Pose}
 */
function transformed(clip, joints, frame, [c, s, z, x]) {
  const [px, py, pz] = clip.roots.subarray(3 * frame, 3 * frame + 3);
  const half = Math.atan2(s, c) / 2;
  const rotations = Array.from({ length: joints }, (_, j) => [
    ...clip.rotations.subarray(4 * (joints * frame + j), 4 * (joints * frame + j) + 4),
  ]);
  rotations[0] = product([Math.cos(half), 0, Math.sin(half), 0], rotations[0]);
  return { root: [s * pz + c * px + x, py, c * pz - s * px + z], rotations };
}

/**
 * A pose between two.
 * @param {Pose} first
 * @param {Pose} second
 * @param {number} fraction
 * @returns {Pose}
 */
const mixed = (first, second, fraction) => ({
  root: first.root.map((value, c) => value + fraction * (second.root[c] - value)),
  rotations: first.rotations.map((rotation, j) => slerp(rotation, second.rotations[j], fraction)),
});

/**
 * The index of the edge that plays in a frame of a walk, and the frame within the edge.
 * @param {Played} walk
 * @param {number} frame
 */
export function edgeAt(walk, frame) {
  let low = 0;
  let high = walk.edges.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (walk.begins[middle] <= frame) low = middle;
    else high = middle - 1;
  }
  return [low, frame - walk.begins[low]];
}

/**
 * The pose of a whole frame, bent onto the line if the walk is.
 * @param {Played} walk
 * @param {number} frame
 */
export function poseAt(walk, frame) {
  const pose = poseAlong(walk, frame);
  return walk.bending ? walk.bending.posed(pose, frame) : pose;
}

/**
 * The pose of a whole frame of a walk that is not bent.
 * @param {Played} walk
 * @param {number} frame
 */
export function poseAlong(walk, frame) {
  const [at, i] = edgeAt(walk, frame);
  const edge = walk.edges[at];
  const { graph } = walk;
  const joints = graph.about.parents.length;
  const first = transformed(graph.clips[edge.start.clip], joints, edge.start.frame + i, walk.transforms[at]);
  if (!edge.seam) return first;
  const transform = compose(walk.transforms[at], edge.transform);
  const second = transformed(graph.clips[edge.end.clip], joints, edge.end.frame - edge.frames + i, transform);
  return mixed(first, second, 1 - graph.weights[i]);
}

/**
 * The positions and orientations of all joints in the world at any time, in frames.
 * @param {Played} walk
 * @param {number} time
 * @returns {Body}
 */
export function bodyAt(walk, time) {
  const last = walk.frames - 1;
  const first = Math.max(0, Math.min(Math.floor(time), last));
  const fraction = Math.max(0, Math.min(time - first, 1));
  let pose = poseAt(walk, first);
  if (fraction > 0 && first < last) pose = mixed(pose, poseAt(walk, first + 1), fraction);
  const { parents, offsets } = walk.graph.about;
  const positions = [pose.root];
  const rotations = [pose.rotations[0]];
  for (let j = 1; j < parents.length; j++) {
    const offset = rotate(rotations[parents[j]], offsets[j]);
    positions.push(positions[parents[j]].map((value, c) => value + offset[c]));
    rotations.push(product(rotations[parents[j]], pose.rotations[j]));
  }
  return { positions, rotations };
}

/**
 * Write the capsules of a body.
 * @param {Piece[]} pieces
 * @param {Body} body
 * @param {Float32Array} out
 * @param {number} at
 */
export function capsules(pieces, { positions, rotations }, out, at = 0) {
  for (const [joint, a, ra, b, rb, flatness, side] of pieces) {
    const ends = [a, b].map((end) =>
      rotate(rotations[joint], end).map((value, c) => value + positions[joint][c]),
    );
    at = writeCapsule(out, at, ends, [ra, rb], rotate(rotations[joint], [1, 0, 0]), flatness, side);
  }
  return at;
}

/**
 * The footprints of a walk: a ball of a foot is at rest for three frames.
 * @param {Played} walk
 * @param {number[][]} feet
 * @param {number} from
 */
export function footprints(walk, feet, from = 0) {
  /** @type {Print[]} */
  const prints = [];
  const rests = feet.map(() => ({ frames: 0, position: [Infinity, Infinity] }));
  for (let frame = from; frame < walk.frames; frame++) {
    const { positions } = bodyAt(walk, frame);
    feet.forEach(([ankle, ball], side) => {
      const rest = rests[side];
      const [x, , z] = positions[ball];
      const still = Math.hypot(x - rest.position[0], z - rest.position[1]) < 0.012;
      rest.frames = still ? rest.frames + 1 : 0;
      rest.position = [x, z];
      if (rest.frames !== 3) return;
      const angle = Math.atan2(x - positions[ankle][0], z - positions[ankle][2]);
      prints.push({
        frame: frame - 3,
        z: 0.6 * z + 0.4 * positions[ankle][2],
        x: 0.6 * x + 0.4 * positions[ankle][0],
        angle,
        side,
      });
    });
  }
  return prints;
}
