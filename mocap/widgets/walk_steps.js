// What the story shows of a walk: its pieces, cuts in place of blends, walks at random and the layers of a search,
// without a page or a picture.

import { bodyAt } from "./walk_body.js";
import { deadEnds, Search } from "./walk_search.js";

/**
 * @import { Played } from "./walk_body.js"
 * @import { Bending } from "./walk_bending.js"
 * @import { Edge, Graph, Line, SearchedWalk, State } from "./walk_search.js"
 *
 * Frames of a walk from one clip: the clip, its first frame there, and the frames [begin, end) of the walk.
 * @typedef {{ clip: number, from: number, begin: number, end: number }} ClipPiece
 */

const DRAWN = 24; // walks of a layer that are drawn, the best ones
const METRES = 6; // of the line that is searched

/**
 * Split a walk into pieces of clips, from a frame on. A seam belongs to its first clip until the middle of the blend.
 * @param {Played} walk
 * @param {number} since
 */
export function piecesOf(walk, since = 0) {
  /** @type {ClipPiece[]} */
  const pieces = [];
  /** @param {ClipPiece} piece */
  const append = (piece) => {
    const last = pieces.at(-1);
    if (piece.begin === piece.end) return;
    const goesOn = last?.clip === piece.clip && last.from + piece.begin - last.begin === piece.from;
    if (last && goesOn) last.end = piece.end;
    else pieces.push(piece);
  };
  walk.edges.forEach(({ start, end, seam, frames }, at) => {
    const begin = walk.begins[at];
    if (begin < since) return;
    const middle = seam ? frames >> 1 : frames;
    append({ clip: start.clip, from: start.frame, begin, end: begin + middle });
    const rest = frames - middle;
    append({ clip: end.clip, from: end.frame - rest, begin: begin + middle, end: begin + frames });
  });
  return pieces;
}

/**
 * The same walk with cuts in place of blends: in the middle of each seam one clip follows the other. Its feet are not
 * held, so that all of the jump is seen.
 * @param {Played & { bending: Bending }} walk
 * @param {number} middle the share of a seam after which it is cut
 * @returns {Played}
 */
export function cutOf(walk, middle = 0.5) {
  const { graph, bending } = walk;
  const weights = graph.weights.map((_, i) => (i < middle * graph.weights.length ? 1 : 0));
  const bent = { posed: bending.carriedPose.bind(bending) };
  const { edges, transforms, begins, frames } = walk;
  return { graph: { ...graph, weights }, edges, transforms, begins, frames, bending: bent };
}

/**
 * The largest distance that a joint jumps where a seam is cut in a frame, metres.
 * @param {Played & { bending: Bending }} walk
 * @param {number} frame in a seam
 */
export function jumpAt(walk, frame) {
  const first = bodyAt(cutOf(walk, 1), frame).positions;
  const second = bodyAt(cutOf(walk, 0), frame).positions;
  return Math.max(...first.map((joint, j) => Math.hypot(...joint.map((value, c) => value - second[j][c]))));
}

/**
 * Walk at random through a graph, among the edges of some kinds: the points [z, x] of the root, some frames apart.
 * @param {Graph} graph
 * @param {State} state
 * @param {{ labels: number, metres: number, random?: () => number }} how
 */
export function randomTrack(graph, { node, transform }, { labels, metres, random = Math.random }) {
  const dead = deadEnds(graph, labels);
  /** @type {SearchedWalk} */
  let walk = { node, transform, cost: 0, expected: 0, along: 0 };
  const search = new Search(graph, { z: new Float64Array(1), x: new Float64Array(1) }, labels, dead);
  while (walk.along < metres) {
    const edges = walk.node.out.filter((edge) => search.isPlayable(edge));
    if (!edges.length) break;
    walk = search.lengthen(walk, edges[Math.floor(random() * edges.length)]);
  }
  return trackOfWalk(walk, 4);
}

/**
 * The points [z, x] of a searched walk, from its end to its start, some frames apart.
 * @param {SearchedWalk} end
 * @param {number} step
 */
export function trackOfWalk(end, step) {
  /** @type {number[][]} */
  const points = [];
  for (let walk = end; walk.previous && walk.edge; walk = walk.previous) {
    const [c, s, z, x] = walk.previous.transform;
    const { track } = walk.edge;
    for (let i = track.z.length - 1; i >= 0; i -= step) {
      points.push([c * track.z[i] - s * track.x[i] + z, s * track.z[i] + c * track.x[i] + x]);
    }
  }
  return points;
}

// A search along the first metres of a line, layer by layer, with another beam width than that of the page.
export class SlowSearch {
  /** @type {number[][][]} the tracks of the best walks of the last layer */
  tracks = [];
  /** @type {number[][] | null} the track of the best walk, once the search is at its end */
  found = null;
  kept = 0; // walks of the last layer
  done = false;

  /**
   * @param {Graph} graph
   * @param {Line} line
   * @param {number} labels
   * @param {number} beamWidth
   */
  constructor(graph, line, labels, beamWidth) {
    const stop = 100 * METRES + 1;
    this.line = { z: line.z.slice(0, stop), x: line.x.slice(0, stop) };
    const search = new Search(graph, this.line, labels, deadEnds(graph, labels));
    search.beamWidth = beamWidth;
    this.layers = search.layers();
  }

  // Advance by one layer.
  step() {
    const { value, done } = this.layers.next();
    if (!value) {
      this.done = Boolean(done);
      this.tracks = [];
      return;
    }
    const [kept, best] = value;
    this.kept = kept.length;
    this.tracks = kept.slice(0, DRAWN).map((walk) => trackOfWalk(walk, 5));
    if (best) this.found = trackOfWalk(best, 2);
  }
}
