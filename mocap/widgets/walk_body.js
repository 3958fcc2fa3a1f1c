// Bodies: where all joints of a walk are, at any moment, and the capsules around them. No page, no picture.

import { after } from "./walk_search.js";

/**
 * @import { Clip, Edge, Graph, Lay, Piece } from "./walk_search.js"
 *
 * The root's place [x, y, z], and the quaternions of all joints.
 * @typedef {{ root: number[], turns: number[][] }} Pose
 *
 * The places and orientations of all joints in the world.
 * @typedef {{ places: number[][], turns: number[][] }} Body
 *
 * What is asked of a walk to see it: its edges with how each is laid, and its first frame.
 * @typedef {{
 *   graph: Graph, edges: PlayedEdge[], lays: Lay[], begins: number[], frames: number,
 * }} Played
 * @typedef {Pick<Edge, "start" | "end" | "seam" | "frames" | "lay">} PlayedEdge
 *
 * Where a foot stands: the frame in which it comes down, its place, heading and side.
 * @typedef {{ frame: number, z: number, x: number, angle: number, side: number }} Print
 */

/**
 * The product of quaternions.
 * @param {number[]} p
 * @param {number[]} q
 */
const product = ([w, x, y, z], [s, u, v, t]) => [
  w * s - x * u - y * v - z * t,
  w * u + x * s + y * t - z * v,
  w * v - x * t + y * s + z * u,
  w * t + x * v - y * u + z * s,
];

/**
 * Rotate a vector v by a quaternion (w, u): v + 2w (u × v) + 2 u × (u × v).
 * @param {number[]} turn
 * @param {number[]} v
 */
export const rotate = ([w, a, b, c], [x, y, z]) => {
  const t = 2 * (b * z - c * y);
  const u = 2 * (c * x - a * z);
  const v = 2 * (a * y - b * x);
  return [x + w * t + b * v - c * u, y + w * u + c * t - a * v, z + w * v + a * u - b * t];
};

/**
 * Spherical linear interpolation from p to q, the short way round.
 * @param {number[]} p
 * @param {number[]} q
 * @param {number} share
 */
function slerp(p, q, share) {
  const dot = p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3];
  const angle = Math.acos(Math.min(Math.abs(dot), 1));
  const near = angle < 1e-4;
  const sine = near ? 1 : Math.sin(angle);
  const a = near ? 1 - share : Math.sin((1 - share) * angle) / sine;
  const b = (near ? share : Math.sin(share * angle) / sine) * Math.sign(dot || 1);
  return p.map((value, c) => a * value + b * q[c]);
}

/**
 * A frame of a clip, laid on the ground: the root's place [x, y, z], and the turns of all joints.
 * @param {Clip} clip
 * @param {number} joints
 * @param {number} frame
 * @param {Lay} lay
 * @returns {Pose}
 */
function laid(clip, joints, frame, [c, s, z, x]) {
  const [px, py, pz] = clip.roots.subarray(3 * frame, 3 * frame + 3);
  const half = Math.atan2(s, c) / 2;
  const turns = Array.from({ length: joints }, (_, j) => [
    ...clip.turns.subarray(4 * (joints * frame + j), 4 * (joints * frame + j) + 4),
  ]);
  turns[0] = product([Math.cos(half), 0, Math.sin(half), 0], turns[0]);
  return { root: [s * pz + c * px + x, py, c * pz - s * px + z], turns };
}

/**
 * A pose between two.
 * @param {Pose} one
 * @param {Pose} other
 * @param {number} share
 * @returns {Pose}
 */
const mixed = (one, other, share) => ({
  root: one.root.map((value, c) => value + share * (other.root[c] - value)),
  turns: one.turns.map((turn, j) => slerp(turn, other.turns[j], share)),
});

/**
 * The edge that plays in a frame of a walk, and how far it has come.
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
 * The pose of a whole frame.
 * @param {Played} walk
 * @param {number} frame
 */
export function poseAt(walk, frame) {
  const [at, i] = edgeAt(walk, frame);
  const edge = walk.edges[at];
  const { graph } = walk;
  const joints = graph.about.parents.length;
  const one = laid(graph.clips[edge.start.clip], joints, edge.start.frame + i, walk.lays[at]);
  if (!edge.seam) return one;
  const lay = after(walk.lays[at], edge.lay);
  const other = laid(graph.clips[edge.end.clip], joints, edge.end.frame - edge.frames + i, lay);
  return mixed(one, other, 1 - graph.weights[i]);
}

/**
 * The pose at any time, in frames, with all joints' places and orientations in the world.
 * @param {Played} walk
 * @param {number} time
 * @returns {Body}
 */
export function bodyAt(walk, time) {
  const last = walk.frames - 1;
  const first = Math.max(0, Math.min(Math.floor(time), last));
  const share = Math.max(0, Math.min(time - first, 1));
  let pose = poseAt(walk, first);
  if (share > 0 && first < last) pose = mixed(pose, poseAt(walk, first + 1), share);
  const { parents, offsets } = walk.graph.about;
  const places = [pose.root];
  const turns = [pose.turns[0]];
  for (let j = 1; j < parents.length; j++) {
    const way = rotate(turns[parents[j]], offsets[j]);
    places.push(places[parents[j]].map((value, c) => value + way[c]));
    turns.push(product(turns[parents[j]], pose.turns[j]));
  }
  return { places, turns };
}

/**
 * The capsules of a body, 13 numbers each: an end and its radius, the other end and its radius, the way to the
 * body's left, how flat it is, and its side (-1 right, 0, 1 left).
 * @param {Piece[]} pieces
 * @param {Body} body
 * @param {Float32Array} out
 * @param {number} at
 */
export function capsules(pieces, { places, turns }, out, at = 0) {
  for (const [joint, a, ra, b, rb, flat, side] of pieces) {
    const ends = [a, b].map((end) => rotate(turns[joint], end).map((value, c) => value + places[joint][c]));
    out.set([...ends[0], ra, ...ends[1], rb, ...rotate(turns[joint], [1, 0, 0]), flat, side], at);
    at += 13;
  }
  return at;
}

/**
 * Where feet stand: the toes rest near the ground. It is that for three frames.
 * @param {Played} walk
 * @param {number[][]} feet
 * @param {number} from
 */
export function footprints(walk, feet, from = 0) {
  /** @type {Print[]} */
  const prints = [];
  const rests = feet.map(() => ({ frames: 0, place: [Infinity, Infinity] }));
  for (let frame = from; frame < walk.frames; frame++) {
    const { places } = bodyAt(walk, frame);
    feet.forEach(([ankle, ball], side) => {
      const rest = rests[side];
      const [x, , z] = places[ball];
      const still = Math.hypot(x - rest.place[0], z - rest.place[1]) < 0.012;
      rest.frames = still ? rest.frames + 1 : 0;
      rest.place = [x, z];
      if (rest.frames !== 3) return;
      const angle = Math.atan2(x - places[ankle][0], z - places[ankle][2]);
      prints.push({
        frame: frame - 3,
        z: 0.6 * z + 0.4 * places[ankle][2],
        x: 0.6 * x + 0.4 * places[ankle][0],
        angle,
        side,
      });
    });
  }
  return prints;
}
