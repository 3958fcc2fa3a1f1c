// A motion graph out of its bytes, and the layered search of `mocap/plain.py`, line by line: no page, no picture.
// A point of the ground is z + ix: "z" is its real part. [c, s, z, x] lays a clip: turn = c + is, move = z + ix.

/**
 * A planar rigid transform [c, s, z, x].
 * @typedef {number[]} Lay
 *
 * Points of the ground, 1 cm apart.
 * @typedef {{ z: Float64Array, x: Float64Array }} Line
 *
 * Where the root is in each frame, and the length of its way until then, metres.
 * @typedef {Line & { along: Float64Array }} Track
 *
 * A capsule at a joint: [joint, end, radius, other end, its radius, how flat it is, side].
 * @typedef {[number, number[], number, number[], number, number, number]} Piece
 *
 * What the bytes hold, as `pack_graph` in `walking_page.py` says it.
 * @typedef {object} About
 * @property {number} fps
 * @property {number} window frames of a seam
 * @property {PackedClip[]} clips
 * @property {string[]} joints
 * @property {number[]} parents
 * @property {number[][]} offsets
 * @property {{ metres: number, parts: number, turn: number, move: number }} steps of the numbers
 * @property {Piece[]} figure
 * @property {number[][]} feet [ankle, ball]
 * @property {{ beam_width: number, layer: number, look: number, rescue: number, seam: number }} search how it is set
 * @property {number} nodes
 * @property {number} edges
 * @property {string[]} labels the kinds of motion
 * @property {string[]} going those that go somewhere
 *
 * @typedef {{ name: string, frames: number }} PackedClip
 *
 * `roots` are places [x, y, z], `turns` quaternions of all joints, frame by frame.
 * @typedef {{ frames: number, roots: Float64Array, turns: Float32Array }} Clip
 *
 * @typedef {{ number: number, clip: number, frame: number, out: Edge[], ahead: Track }} Node
 *
 * `labels` are bits.
 * @typedef {{
 *   number: number, start: Node, end: Node, seam: boolean, labels: number, frames: number, lay: Lay, track: Track,
 * }} Edge
 *
 * @typedef {{ about: About, clips: Clip[], nodes: Node[], edges: Edge[], weights: number[] }} Graph
 *
 * Where a walk ends: its node, and how the clip is laid from there on.
 * @typedef {{ node: Node, lay: Lay }} State
 *
 * A walk of the search: what it costs, how far it comes, what it will cost, and its last edge after another walk.
 * @typedef {State & { cost: number, along: number, expected: number, edge?: Edge, before?: Path }} Path
 *
 * @typedef {(count: number, order?: number) => Int32Array} Reader
 */

/** @type {Track} */
const UNKNOWN = { z: new Float64Array(0), x: new Float64Array(0), along: new Float64Array(0) };

/**
 * One transform after another.
 * @param {Lay} lay
 * @param {Lay} next
 */
export const after = ([c, s, z, x], [d, t, y, w]) => [
  c * d - s * t,
  s * d + c * t,
  c * y - s * w + z,
  s * y + c * w + x,
];

/**
 * The weights of the first clip of a seam [KGP02, Eq. 7].
 * @param {number} count
 */
export const cubicWeights = (count) =>
  Array.from({ length: count }, (_, i) => {
    const t = (i + 1) / count;
    return 2 * t ** 3 - 3 * t ** 2 + 1;
  });

// ---- the graph ----

/**
 * Bytes hold whole numbers, their signs folded in, lowest bytes first; they are summed up `order` times.
 * @param {Uint8Array} bytes
 * @returns {Reader}
 */
function reader(bytes) {
  let at = 0;
  return (count, order = 0) => {
    const numbers = new Int32Array(count);
    for (let i = 0; i < count; i++) {
      let folded = 0;
      for (let plane = 3; plane >= 0; plane--) folded = (folded << 8) | bytes[at + plane * count + i];
      numbers[i] = (folded >>> 1) ^ -(folded & 1);
    }
    at += 4 * count;
    for (; order; order--) for (let i = 1; i < count; i++) numbers[i] += numbers[i - 1];
    return numbers;
  };
}

/**
 * Read a clip.
 * @param {Reader} read
 * @param {PackedClip} packed
 * @param {number} joints
 * @param {About["steps"]} steps
 */
function readClip(read, { frames }, joints, { metres, parts }) {
  const clip = { frames, roots: new Float64Array(3 * frames), turns: new Float32Array(4 * joints * frames) };
  for (let c = 0; c < 3; c++) {
    read(frames, 2).forEach((n, f) => {
      clip.roots[3 * f + c] = n * metres;
    });
  }
  for (let c = 0; c < 4 * joints; c++) {
    read(frames, 2).forEach((n, f) => {
      clip.turns[4 * joints * f + c] = n * parts;
    });
  }
  for (let q = 0; q < clip.turns.length; q += 4) {
    const length = Math.hypot(...clip.turns.subarray(q, q + 4)) || 1;
    for (let c = 0; c < 4; c++) clip.turns[q + c] /= length;
  }
  return clip;
}

/**
 * `about` says what the bytes hold: clips, joints, numbers of nodes and edges, steps of the numbers.
 * @param {About} about
 * @param {Uint8Array} bytes
 * @returns {Graph}
 */
export function unpack(about, bytes) {
  const read = reader(bytes);
  const clips = about.clips.map((clip) => readClip(read, clip, about.parents.length, about.steps));
  const clipOf = read(about.nodes, 1);
  const frameOf = read(about.nodes, 1);
  /** @type {Node[]} */
  const nodes = Array.from(clipOf, (clip, number) => ({
    number,
    clip,
    frame: frameOf[number],
    out: [],
    ahead: UNKNOWN,
  }));
  const [from, to] = [read(about.edges, 1), read(about.edges, 1)];
  const [kind, turn, dz, dx] = [0, 0, 0, 0].map(() => read(about.edges));
  const { steps, window } = about;
  const edges = Array.from(from, (leave, number) => {
    const [start, end] = [nodes[leave], nodes[to[number]]];
    const seam = Boolean(kind[number] & 1);
    const frames = seam ? window : end.frame - start.frame;
    const ahead = [dz[number] * steps.move, dx[number] * steps.move];
    const lay = seam ? layOf(start, end, turn[number] * steps.turn, ahead) : [1, 0, 0, 0];
    /** @type {Edge} */
    const edge = { number, start, end, seam, labels: kind[number] >> 1, frames, lay, track: UNKNOWN };
    start.out.push(edge);
    return edge;
  });
  /**
   * A seam knows how far its two roots are apart.
   * @param {Node} start
   * @param {Node} end
   * @param {number} angle
   * @param {number[]} ahead
   */
  function layOf(start, end, angle, [aheadZ, aheadX]) {
    const a = 3 * start.frame;
    const b = 3 * (end.frame - window);
    const [one, other] = [clips[start.clip].roots, clips[end.clip].roots];
    const c = Math.cos(angle);
    const s = Math.sin(angle);
    const z = other[b + 2];
    const x = other[b];
    return [c, s, one[a + 2] + aheadZ - (c * z - s * x), one[a] + aheadX - (s * z + c * x)];
  }
  return { about, clips, nodes, edges, weights: cubicWeights(about.window) };
}

// ---- tracks: where the root is while an edge plays, and how long its way is ----

/**
 * The track of an edge.
 * @param {Graph} graph
 * @param {Edge} edge
 */
function trackOf(graph, { start, frames, seam, end, lay: [c, s, z, x] }) {
  const { roots } = graph.clips[start.clip];
  const other = graph.clips[end.clip].roots;
  const points = [];
  for (let i = 0; i < frames; i++) {
    const f = 3 * (start.frame + i);
    const g = 3 * (end.frame - frames + i);
    const w = seam ? graph.weights[i] : 1;
    const point = [roots[f + 2], roots[f]];
    if (seam) {
      point[0] = w * point[0] + (1 - w) * (c * other[g + 2] - s * other[g] + z);
      point[1] = w * point[1] + (1 - w) * (s * other[g + 2] + c * other[g] + x);
    }
    points.push(point);
  }
  return measured(roots, start.frame, points);
}

/**
 * How far the root has come in each frame, from the frame before the first.
 * @param {Float64Array} roots
 * @param {number} frame
 * @param {number[][]} points
 * @returns {Track}
 */
function measured(roots, frame, points) {
  const before = 3 * Math.max(frame - 1, 0);
  const along = new Float64Array(points.length);
  let length = 0;
  let z = roots[before + 2];
  let x = roots[before];
  points.forEach((point, i) => {
    length += Math.hypot(point[0] - z, point[1] - x);
    [z, x] = point;
    along[i] = length;
  });
  return { z: Float64Array.from(points, (p) => p[0]), x: Float64Array.from(points, (p) => p[1]), along };
}

/**
 * Tracks serve every line, so they are made once: of each edge, and of the frames ahead of each node.
 * @param {Graph} graph
 */
export function prepare(graph) {
  const { look } = graph.about.search;
  for (const edge of graph.edges) edge.track = trackOf(graph, edge);
  for (const node of graph.nodes) {
    const { roots, frames } = graph.clips[node.clip];
    const count = Math.min(look, frames - node.frame);
    const points = Array.from({ length: count }, (_, i) => [
      roots[3 * (node.frame + i) + 2],
      roots[3 * (node.frame + i)],
    ]);
    node.ahead = measured(roots, node.frame, points);
  }
  return graph;
}

// ---- the search: all walks advance along a line together, layer by layer; the best of each layer go on ----

export class Search {
  /**
   * `line`: points {z, x} of the ground, 1 cm apart; `labels`: the kinds of motion that may be played, as bits.
   * @param {Graph} graph
   * @param {Line} line
   * @param {number} labels
   * @param {Set<Node>} dead
   */
  constructor(graph, line, labels = -1, dead = new Set()) {
    this.graph = graph;
    this.line = line;
    this.labels = labels;
    this.dead = dead;
    this.end = (line.z.length - 1) / 100;
    const { beam_width: beamWidth, layer, look, rescue, seam } = graph.about.search;
    this.beamWidth = beamWidth;
    this.layer = layer;
    this.look = look;
    this.rescue = rescue;
    this.seam = seam;
  }

  /**
   * What a track costs [KGP02, Eq. 9], and how far it comes: root and line, at equal lengths.
   * @param {Pick<Path, "lay" | "along">} walk
   * @param {Track} track
   */
  price(walk, track) {
    const [c, s, z, x] = walk.lay;
    const { line } = this;
    const last = line.z.length - 1;
    let cost = 0;
    let along = walk.along;
    for (let i = 0; i < track.z.length; i++) {
      along = walk.along + track.along[i];
      const k = Math.floor(Math.min(100 * along, last));
      const dz = c * track.z[i] - s * track.x[i] + z - line.z[k];
      const dx = s * track.z[i] + c * track.x[i] + x - line.x[k];
      const off = dz * dz + dx * dx; // m²
      cost += off + 100 * off * off; // 10 cm off cost twice what Eq. 9 says
    }
    return [cost, along];
  }

  /**
   * What the walk will cost if its clip plays on.
   * @param {Omit<Path, "expected">} walk
   * @returns {Path}
   */
  lookAhead(walk) {
    return Object.assign(walk, { expected: Math.min(this.price(walk, walk.node.ahead)[0], this.rescue) });
  }

  /**
   * A walk with one more edge.
   * @param {Path} walk
   * @param {Edge} edge
   */
  lengthen(walk, edge) {
    const [cost, along] = this.price(walk, edge.track);
    const paid = walk.cost + (cost + (edge.seam ? this.seam : 0));
    return this.lookAhead({
      cost: paid,
      along,
      node: edge.end,
      lay: edge.seam ? after(walk.lay, edge.lay) : walk.lay,
      edge,
      before: walk,
    });
  }

  // Each node from which the root goes somewhere: at the line's start, and along it.
  starts() {
    const { line, look } = this;
    const far = Math.min(30, line.z.length - 1);
    /** @type {Path[]} */
    const walks = [];
    const way = Math.atan2(line.x[far] - line.x[0], line.z[far] - line.z[0]);
    for (const node of this.graph.nodes) {
      const { z, x } = node.ahead;
      const last = look - 1;
      if (z.length < look || Math.hypot(z[last] - z[0], x[last] - x[0]) <= 0.3) continue;
      const angle = way - Math.atan2(x[last] - x[0], z[last] - z[0]);
      const c = Math.cos(angle);
      const s = Math.sin(angle);
      const lay = [c, s, line.z[0] - (c * z[0] - s * x[0]), line.x[0] - (s * z[0] + c * x[0])];
      walks.push(this.lookAhead({ cost: 0, along: 0, node, lay }));
    }
    return walks;
  }

  /**
   * Cross out what stands where another one stands and costs more; keep the best of the others.
   * @param {Path[]} walks
   */
  bestOf(walks) {
    /** @type {Map<string, Path>} */
    const kept = new Map();
    for (const walk of walks.sort((a, b) => a.cost + a.expected - (b.cost + b.expected))) {
      const [c, s, z, x] = walk.lay;
      const point = walk.node.ahead;
      const here = [
        c * point.z[0] - s * point.x[0] + z,
        s * point.z[0] + c * point.x[0] + x,
        Math.atan2(s, c),
      ];
      const place = `${walk.node.number} ${here.map((value) => Math.floor(value / 0.1))}`;
      if (!kept.has(place)) kept.set(place, walk);
      if (kept.size === this.beamWidth) break;
    }
    return [...kept.values()];
  }

  /**
   * In each layer yield the walks that go on, and the best one at the line's end so far.
   * @returns {Generator<[Path[], Path | null], void>}
   */
  *layers(starts = this.starts()) {
    const waiting = new Map([[0, starts]]);
    /** @type {Path | null} */
    let best = null;
    while (waiting.size) {
      const layer = Math.min(...waiting.keys());
      const kept = this.bestOf(waiting.get(layer) ?? []);
      waiting.delete(layer);
      for (const walk of kept) {
        for (const edge of walk.node.out) {
          if (!this.goesOn(edge)) continue;
          const longer = this.lengthen(walk, edge);
          if (best && longer.cost >= best.cost) continue;
          if (longer.along >= this.end) {
            best = longer;
            continue;
          }
          const next = Math.max(Math.floor(longer.along / this.layer), layer);
          const others = waiting.get(next);
          if (others) others.push(longer);
          else waiting.set(next, [longer]);
        }
      }
      yield [kept, best];
    }
  }

  /**
   * Whether an edge may be played and leads to no dead end.
   * @param {Edge} edge
   */
  goesOn({ labels, end }) {
    return (labels & this.labels) !== 0 && end.ahead.z.length > 0 && !this.dead.has(end);
  }
}

/**
 * Nodes from which no walk of these kinds goes on for ever.
 * @param {Graph} graph
 * @param {number} labels
 */
function deadEnds({ nodes }, labels) {
  /** @type {Set<Node>} */
  const dead = new Set();
  for (let before = -1; before < dead.size;) {
    before = dead.size;
    for (const node of nodes) {
      if (!node.out.some((edge) => edge.labels & labels && !dead.has(edge.end))) dead.add(node);
    }
  }
  return dead;
}

/**
 * The edges of a walk, from its start on, and how its first clip is laid.
 * @param {Path} walk
 */
export function edgesOf(walk) {
  /** @type {Edge[]} */
  const edges = [];
  let start = walk;
  while (start.edge && start.before) {
    edges.push(start.edge);
    start = start.before;
  }
  return { edges: edges.reverse(), lay: start.lay };
}

// A walk that grows by pieces while it plays: each piece is searched on the next metres of the line from where the
// last one ends, abreast of the line again. So a long line is begun at once, and lengths do not drift apart.
export class Walk {
  /** @type {Edge[]} */
  edges = [];
  /** @type {Lay[]} how each edge is laid */
  lays = [];
  /** @type {number[]} the first frame of each edge */
  begins = [];
  /** @type {State | null} where it ends */
  state = null;
  /** @type {Line} the line that it follows */
  line = UNKNOWN;
  frames = 0;
  at = 0; // the point of the line that is abreast of its end
  since = 0; // the frame in which it began to follow the line
  done = false; // whether it has come to the line's end

  /**
   * @param {Graph} graph
   * @param {number} labels
   * @param {{ far?: number, keep?: number }} pieces
   */
  constructor(graph, labels = -1, { far = 5, keep = 2 } = {}) {
    this.graph = graph;
    this.labels = labels;
    this.far = far; // metres of a piece
    this.keep = keep; // metres of it that are kept
  }

  /**
   * Play an edge from where the walk ends, and return where it ends now.
   * @param {Edge} edge
   * @param {State} state
   */
  add(edge, { lay }) {
    this.begins.push(this.frames);
    this.edges.push(edge);
    this.lays.push(lay);
    this.frames += edge.frames;
    this.state = { node: edge.end, lay: edge.seam ? after(lay, edge.lay) : lay };
    return this.state;
  }

  /**
   * Forget what was to come after the next node after a frame; give the frame of this node.
   * @param {number} frame
   */
  turnFrom(frame) {
    const left = this.begins.findIndex((begin) => begin > frame);
    if (left > 0) {
      this.state = { node: this.edges[left].start, lay: this.lays[left] };
      this.frames = this.begins[left];
      for (const list of [this.edges, this.lays, this.begins]) list.length = left;
    }
    return this.frames - 1;
  }

  /** @param {Line} line */
  follow(line) {
    this.line = line;
    this.at = 0;
    this.since = this.frames;
    this.done = false;
  }

  /**
   * Where the root is at the walk's end.
   * @param {State} state
   */
  here({ lay: [c, s, z, x], node: { ahead } }) {
    return [c * ahead.z[0] - s * ahead.x[0] + z, s * ahead.z[0] + c * ahead.x[0] + x];
  }

  /**
   * Search the next piece; yields the best unfinished walk after each layer, and at last adds what was found.
   * @returns {Generator<Path, void>}
   */
  *grow() {
    const { line, at } = this;
    const ends = at + 100 * (this.far + 2) >= line.z.length;
    const stop = ends ? line.z.length : at + 100 * this.far + 1;
    const piece = { z: line.z.slice(at, stop), x: line.x.slice(at, stop) };
    /** @type {Path | null} */
    let best = null;
    // So that the next line can be walked on from the end; else any walk of this kind; else, from here on, of any kind.
    const searches = [
      new Search(this.graph, piece, this.labels, deadEnds(this.graph, this.labels)),
      new Search(this.graph, piece, this.labels),
      ...(this.state ? [new Search(this.graph, piece)] : []),
    ];
    for (const search of searches) {
      const starts = this.state ? [search.lookAhead({ cost: 0, along: 0, ...this.state })] : undefined;
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
    this.take(best, ends);
  }

  /**
   * Play the first metres of what was found, or all of it at the line's end.
   * @param {Path} best
   * @param {boolean} ends
   */
  take(best, ends) {
    const { line, at } = this;
    const { edges, lay } = edgesOf(best);
    let state = this.state ?? { node: edges[0].start, lay };
    let come = 0;
    for (const edge of edges) {
      state = this.add(edge, state);
      come += edge.track.along.at(-1) ?? 0;
      if (!ends && come > this.keep) break;
    }
    this.done = ends;
    this.at = nearest(line, this.here(state), at, at + 100 * (come + 1));
  }
}

/**
 * Which point of a line, of those between two, is nearest to a place.
 * @param {Line} line
 * @param {number[]} place
 * @param {number} from
 * @param {number} to
 */
export function nearest({ z, x }, [placeZ, placeX], from = 0, to = z.length) {
  let best = from;
  let least = Infinity;
  for (let k = Math.max(0, Math.floor(from)); k < Math.min(to, z.length); k++) {
    const off = Math.hypot(z[k] - placeZ, x[k] - placeX);
    if (off < least) {
      least = off;
      best = k;
    }
  }
  return best;
}
