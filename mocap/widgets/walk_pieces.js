// Walks that grow along a line, piece by piece, without a page or a picture.

import { Bending } from "./walk_bending.js";
import { compose, deadEnds, edgesOf, Search } from "./walk_search.js";

/** @import { Edge, Graph, Line, SearchedWalk, State, Transform } from "./walk_search.js" */

const REST = 0.1; // metres of a line that need not be walked
/** @type {Line} */
const NOWHERE = { z: new Float64Array(0), x: new Float64Array(0) };

// A walk that grows by pieces while it plays. Each piece is searched on the next metres of the line, and then bent onto
// it. A long line is begun at once, and arc lengths do not drift apart.
export class Walk {
  /** @type {Edge[]} */
  edges = [];
  /** @type {Transform[]} of each edge */
  transforms = [];
  /** @type {number[]} the first frame of each edge */
  begins = [];
  /** @type {State | null} its end */
  state = null;
  /** @type {Line} the line that it follows */
  line = NOWHERE;
  frames = 0;
  at = 0; // the index of the point of the line that is nearest to its end
  since = 0; // the frame in which it began to follow the line
  done = false; // whether it has reached the end of the line

  /**
   * @param {Graph} graph
   * @param {number} labels
   * @param {{ reach?: number, keep?: number }} pieces
   */
  constructor(graph, labels = -1, { reach = 5, keep = 2 } = {}) {
    this.graph = graph;
    this.labels = labels;
    this.bending = new Bending(graph);
    this.reach = reach; // metres of a piece
    this.keep = keep; // metres of it that are kept
  }

  /**
   * Append an edge, and return the new end.
   * @param {Edge} edge
   * @param {State} state
   */
  add(edge, { transform }) {
    this.begins.push(this.frames);
    this.edges.push(edge);
    this.transforms.push(transform);
    this.frames += edge.frames;
    this.state = {
      node: edge.end,
      transform: edge.seam ? compose(transform, edge.transform) : transform,
    };
    return this.state;
  }

  /**
   * Remove the edges that begin after the edge of a frame; return the last frame that remains.
   * @param {number} frame
   */
  cutAfter(frame) {
    const count = this.begins.findIndex((begin) => begin > frame);
    if (count > 0) {
      this.state = { node: this.edges[count].start, transform: this.transforms[count] };
      this.frames = this.begins[count];
      for (const list of [this.edges, this.transforms, this.begins]) list.length = count;
      this.bending.cut(this.frames);
    }
    return this.frames - 1;
  }

  /** @param {Line} line */
  follow(line) {
    this.line = line;
    this.at = 0;
    this.since = this.frames;
    this.done = false;
    this.bending.follow(line, this);
  }

  /**
   * The end of the walk on the line, null if it has not begun.
   * @returns {State | null}
   */
  get end() {
    if (!this.state) return null;
    const { node, transform } = this.state;
    return { node, transform: compose(this.bending.carried[this.frames - 1], transform) };
  }

  /**
   * Search the next piece: yield the best unfinished walk after each layer, and finally append the result.
   * @returns {Generator<SearchedWalk, void>}
   */
  *grow() {
    const { line, at } = this;
    const ends = at + 100 * (this.reach + 2) >= line.z.length;
    const stop = ends ? line.z.length : at + 100 * this.reach + 1;
    const piece = { z: line.z.slice(at, stop), x: line.x.slice(at, stop) };
    /** @type {SearchedWalk | null} */
    let best = null;
    const { end } = this;
    // First a walk from whose end the next line can be followed, then any walk of this kind.
    const searches = [
      new Search(this.graph, piece, this.labels, deadEnds(this.graph, this.labels)),
      new Search(this.graph, piece, this.labels),
    ];
    for (const search of searches) {
      const starts = end ? [search.lookAhead({ cost: 0, along: 0, ...end })] : undefined;
      for (const [kept, found] of search.layers(starts)) {
        best = found;
        yield kept[0];
      }
      if (best) break;
    }
    if (!best) {
      this.done = true;
      return;
    }
    this.append(best, ends);
  }

  /**
   * Append the first metres of a found walk, or all of it at the end of the line.
   * @param {SearchedWalk} best
   * @param {boolean} ends
   */
  append(best, ends) {
    const { edges, transform } = edgesOf(best);
    let state = this.state ?? { node: edges[0].start, transform };
    let length = 0;
    for (const edge of edges) {
      state = this.add(edge, state);
      length += edge.track.along.at(-1) ?? 0;
      if (!ends && length > this.keep) break;
    }
    const before = this.bending.along;
    this.bending.extend(this);
    const { along } = this.bending;
    const last = this.line.z.length - 1;
    // A walk that sways is shorter on the line than it is itself, so that another piece may be needed.
    this.done = ends && (along > last / 100 - REST || along < before + REST);
    this.at = Math.min(Math.floor(100 * along), last - 1);
  }
}
