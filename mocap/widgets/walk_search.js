// A motion graph from its bytes, and the beam search of `mocap/plain.py`, line by line, without a page or a picture.
// Points of the ground are complex, z + ix. A transform [c, s, z, x] has the rotation c + is and the translation z + ix.

/**
 * A planar rigid transform [c, s, z, x].
 * @typedef {number[]} Transform
 *
 * Points of the ground, 1 cm apart.
 * @typedef {{ z: Float64Array, x: Float64Array }} Line
 *
 * The positions of the root in each frame, and the length of its path until then, metres.
 * @typedef {Line & { along: Float64Array }} Track
 *
 * A capsule at a joint: [joint, end, radius, other end, its radius, how flat it is, side].
 * @typedef {[number, number[], number, number[], number, number, number]} Piece
 *
 * The description of the bytes that `pack_graph` in `walking_page.py` returns.
 * @typedef {object} About
 * @property {number} fps
 * @property {number} window frames of a seam
 * @property {PackedClip[]} clips
 * @property {string[]} joints
 * @property {number[]} parents
 * @property {number[][]} offsets
 * @property {{ root: number, quaternion: number, angle: number, translation: number }} steps units of the numbers
 * @property {Piece[]} figure
 * @property {number[][]} feet [ankle, ball]
 * @property {{ joints: number[], axis: number[] }[]} limbs legs: [hip, knee, ankle, ball], and the axis of the knee
 * @property {{ beam_width: number, layer: number, look: number, rescue: number, seam: number }} search its settings
 * @property {number} nodes
 * @property {number} edges
 * @property {string[]} labels the kinds of motion
 * @property {string[]} moving the kinds that a figure can follow a line with
 *
 * @typedef {{ name: string, frames: number }} PackedClip
 *
 * `roots` are positions [x, y, z], `rotations` are quaternions of all joints, frame by frame. `path` is the smooth path
 * about which the root sways, and `stands` has a bit for each ankle and each ball that stands.
 * @typedef {{
 *   frames: number, roots: Float64Array, rotations: Float32Array, path: Line & { heading: Float64Array }, stands: Int32Array,
 * }} Clip
 *
 * @typedef {{ number: number, clip: number, frame: number, out: Edge[], ahead: Track }} Node
 *
 * `labels` are bits, of the kinds that all its frames are of.
 * @typedef {{
 *   number: number, start: Node, end: Node, seam: boolean, labels: number, frames: number, transform: Transform, track: Track,
 * }} Edge
 *
 * `dead` are the nodes from which each walk ends, for kinds of motion that were asked for.
 * @typedef {{
 *   about: About, clips: Clip[], nodes: Node[], edges: Edge[], weights: number[], dead: Map<number, Set<Node>>,
 * }} Graph
 *
 * The end of a walk: its node, and the transform of the clip that follows.
 * @typedef {{ node: Node, transform: Transform }} State
 *
 * A walk of the search: its cost, the cost that is expected, its length along the line (metres), its last edge, and the
 * walk without that edge.
 * @typedef {State & {
 *   cost: number, along: number, expected: number, edge?: Edge, previous?: SearchedWalk,
 * }} SearchedWalk
 *
 * @typedef {(count: number, order?: number) => Int32Array} Reader
 */

const CELL = 0.1; // metres, and radians of the heading: of two walks at one node in one cell, the better one is kept
/** @type {Track} */
const UNKNOWN = { z: new Float64Array(0), x: new Float64Array(0), along: new Float64Array(0) };

/**
 * Compose two transforms: first the second one, then the first.
 * @param {Transform} transform
 * @param {Transform} next
 */
export const compose = ([c, s, z, x], [d, t, y, w]) => [
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
 * Read whole numbers with folded signs, lowest bytes first, and sum them `order` times.
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
function readClip(read, { frames }, joints, { root, quaternion, angle, translation }) {
  const roots = new Float64Array(3 * frames);
  const rotations = new Float32Array(4 * joints * frames);
  for (let c = 0; c < 3; c++) {
    read(frames, 2).forEach((n, f) => {
      roots[3 * f + c] = n * root;
    });
  }
  for (let c = 0; c < 4 * joints; c++) {
    read(frames, 2).forEach((n, f) => {
      rotations[4 * joints * f + c] = n * quaternion;
    });
  }
  for (let q = 0; q < rotations.length; q += 4) {
    const length = Math.hypot(...rotations.subarray(q, q + 4)) || 1;
    for (let c = 0; c < 4; c++) rotations[q + c] /= length;
  }
  const [heading, z, x] = [angle, translation, translation].map((step) =>
    Float64Array.from(read(frames, 2), (n) => n * step),
  );
  return { frames, roots, rotations, path: { heading, z, x }, stands: read(frames, 1) };
}

/**
 * Unpack a graph; `about` describes the bytes.
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
  const starts = read(about.edges, 1);
  const ends = read(about.edges, 1);
  const [kinds, angles, offsetsZ, offsetsX] = [0, 0, 0, 0].map(() => read(about.edges));
  const { steps, window } = about;
  const edges = Array.from(starts, (startNumber, number) => {
    const start = nodes[startNumber];
    const end = nodes[ends[number]];
    const seam = Boolean(kinds[number] & 1);
    const frames = seam ? window : end.frame - start.frame;
    const offset = [offsetsZ[number] * steps.translation, offsetsX[number] * steps.translation];
    const transform = seam ? transformOf(start, end, angles[number] * steps.angle, offset) : [1, 0, 0, 0];
    /** @type {Edge} */
    const edge = { number, start, end, seam, labels: kinds[number] >> 1, frames, transform, track: UNKNOWN };
    start.out.push(edge);
    return edge;
  });
  /**
   * The transform of a seam, from the angle and the offset between its two roots.
   * @param {Node} start
   * @param {Node} end
   * @param {number} angle
   * @param {number[]} offset
   */
  function transformOf(start, end, angle, [offsetZ, offsetX]) {
    const a = 3 * start.frame;
    const b = 3 * (end.frame - window);
    const source = clips[start.clip].roots;
    const target = clips[end.clip].roots;
    const c = Math.cos(angle);
    const s = Math.sin(angle);
    const z = target[b + 2];
    const x = target[b];
    return [c, s, source[a + 2] + offsetZ - (c * z - s * x), source[a] + offsetX - (s * z + c * x)];
  }
  return { about, clips, nodes, edges, weights: cubicWeights(about.window), dead: new Map() };
}

// ---- tracks: the root's positions while an edge plays, and the length of its path ----

/**
 * The track of an edge.
 * @param {Graph} graph
 * @param {Edge} edge
 */
function trackOf(graph, { start, frames, seam, end, transform: [c, s, z, x] }) {
  const { roots } = graph.clips[start.clip];
  const targetRoots = graph.clips[end.clip].roots;
  const points = [];
  for (let i = 0; i < frames; i++) {
    const f = 3 * (start.frame + i);
    const g = 3 * (end.frame - frames + i);
    const w = seam ? graph.weights[i] : 1;
    const point = [roots[f + 2], roots[f]];
    if (seam) {
      point[0] = w * point[0] + (1 - w) * (c * targetRoots[g + 2] - s * targetRoots[g] + z);
      point[1] = w * point[1] + (1 - w) * (s * targetRoots[g + 2] + c * targetRoots[g] + x);
    }
    points.push(point);
  }
  return measured(roots, start.frame, points);
}

/**
 * Measure the root's path until each frame, from the frame before the first.
 * @param {Float64Array} roots
 * @param {number} frame
 * @param {number[][]} points
 * @returns {Track}
 */
function measured(roots, frame, points) {
  const previous = 3 * Math.max(frame - 1, 0);
  const along = new Float64Array(points.length);
  let length = 0;
  let z = roots[previous + 2];
  let x = roots[previous];
  points.forEach((point, i) => {
    length += Math.hypot(point[0] - z, point[1] - x);
    [z, x] = point;
    along[i] = length;
  });
  return { z: Float64Array.from(points, (p) => p[0]), x: Float64Array.from(points, (p) => p[1]), along };
}

/**
 * Compute the tracks of all edges, and of the frames ahead of each node. They serve every line.
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

// ---- a beam search: all walks advance along a line in layers, and each layer keeps the best ----

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
   * The cost of a track [KGP02, Eq. 9], by equal arc lengths, and its end along the line.
   * @param {Pick<SearchedWalk, "transform" | "along">} walk
   * @param {Track} track
   */
  price(walk, track) {
    const [c, s, z, x] = walk.transform;
    const { line } = this;
    const last = line.z.length - 1;
    let cost = 0;
    let along = walk.along;
    for (let i = 0; i < track.z.length; i++) {
      along = walk.along + track.along[i];
      const k = Math.floor(Math.min(100 * along, last));
      const dz = c * track.z[i] - s * track.x[i] + z - line.z[k];
      const dx = s * track.z[i] + c * track.x[i] + x - line.x[k];
      const error = dz * dz + dx * dx; // m²
      cost += error + 100 * error * error; // at 10 cm twice the cost of Eq. 9
    }
    return [cost, along];
  }

  /**
   * Estimate the cost of the frames ahead if the walk stays in its clip.
   * @param {Omit<SearchedWalk, "expected">} walk
   * @returns {SearchedWalk}
   */
  lookAhead(walk) {
    return Object.assign(walk, { expected: Math.min(this.price(walk, walk.node.ahead)[0], this.rescue) });
  }

  /**
   * Extend a walk by one edge.
   * @param {SearchedWalk} walk
   * @param {Edge} edge
   */
  lengthen(walk, edge) {
    const [cost, along] = this.price(walk, edge.track);
    const total = walk.cost + (cost + (edge.seam ? this.seam : 0));
    return this.lookAhead({
      cost: total,
      along,
      node: edge.end,
      transform: edge.seam ? compose(walk.transform, edge.transform) : walk.transform,
      edge,
      previous: walk,
    });
  }

  // A walk of no edges at each node that leads on by these kinds, aligned with the start of the line.
  starts() {
    const { line, look } = this;
    const reach = Math.min(30, line.z.length - 1);
    /** @type {SearchedWalk[]} */
    const walks = [];
    const heading = Math.atan2(line.x[reach] - line.x[0], line.z[reach] - line.z[0]);
    for (const node of this.graph.nodes) {
      if (!node.out.some((edge) => isOfKind(edge, this.labels) && !this.dead.has(edge.end))) continue;
      const { z, x } = node.ahead;
      const last = look - 1;
      if (z.length < look || Math.hypot(z[last] - z[0], x[last] - x[0]) <= 0.3) continue;
      const angle = heading - Math.atan2(x[last] - x[0], z[last] - z[0]);
      const c = Math.cos(angle);
      const s = Math.sin(angle);
      const transform = [c, s, line.z[0] - (c * z[0] - s * x[0]), line.x[0] - (s * z[0] + c * x[0])];
      walks.push(this.lookAhead({ cost: 0, along: 0, node, transform }));
    }
    return walks;
  }

  /**
   * Keep the walk of lowest cost of each cell, and of these the best.
   * @param {SearchedWalk[]} walks
   */
  bestOf(walks) {
    /** @type {Map<string, SearchedWalk>} */
    const kept = new Map();
    for (const walk of walks.sort((a, b) => a.cost + a.expected - (b.cost + b.expected))) {
      const [c, s, z, x] = walk.transform;
      const { ahead } = walk.node;
      const state = [
        c * ahead.z[0] - s * ahead.x[0] + z,
        s * ahead.z[0] + c * ahead.x[0] + x,
        Math.atan2(s, c),
      ];
      const cell = `${walk.node.number} ${state.map((value) => Math.floor(value / CELL))}`;
      if (!kept.has(cell)) kept.set(cell, walk);
      if (kept.size === this.beamWidth) break;
    }
    return [...kept.values()];
  }

  /**
   * For each layer, yield the walks that are kept, and the best complete walk so far.
   * @returns {Generator<[SearchedWalk[], SearchedWalk | null], void>}
   */
  *layers(starts = this.starts()) {
    const waiting = new Map([[0, starts]]);
    /** @type {SearchedWalk | null} */
    let best = null;
    while (waiting.size) {
      const layer = Math.min(...waiting.keys());
      const kept = this.bestOf(waiting.get(layer) ?? []);
      waiting.delete(layer);
      for (const walk of kept) {
        for (const edge of walk.node.out) {
          if (!this.isPlayable(edge)) continue;
          const longer = this.lengthen(walk, edge);
          if (best && longer.cost >= best.cost) continue;
          if (longer.along >= this.end) {
            best = longer;
            continue;
          }
          const next = Math.max(Math.floor(longer.along / this.layer), layer);
          const walks = waiting.get(next);
          if (walks) walks.push(longer);
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
  isPlayable(edge) {
    return isOfKind(edge, this.labels) && edge.end.ahead.z.length > 0 && !this.dead.has(edge.end);
  }
}

/**
 * Whether all frames of an edge are of one of these kinds.
 * @param {Edge} edge
 * @param {number} labels
 */
const isOfKind = ({ labels: own }, labels) => (own & labels) !== 0;

/**
 * The nodes from which each walk of these kinds ends.
 * @param {Graph} graph
 * @param {number} labels
 */
export function deadEnds({ nodes, dead: known }, labels) {
  const found = known.get(labels);
  if (found) return found;
  /** @type {Set<Node>} */
  const dead = new Set();
  for (let previousSize = -1; previousSize < dead.size;) {
    previousSize = dead.size;
    for (const node of nodes) {
      if (!node.out.some((edge) => isOfKind(edge, labels) && !dead.has(edge.end))) dead.add(node);
    }
  }
  known.set(labels, dead);
  return dead;
}

/**
 * The edges of a walk, in order, and the transform of its first clip.
 * @param {SearchedWalk} walk
 */
export function edgesOf(walk) {
  /** @type {Edge[]} */
  const edges = [];
  let start = walk;
  while (start.edge && start.previous) {
    edges.push(start.edge);
    start = start.previous;
  }
  return { edges: edges.reverse(), transform: start.transform };
}

/**
 * The index of the point of a line that is nearest to a position, among those from one index to another.
 * @param {Line} line
 * @param {number[]} position
 * @param {number} from
 * @param {number} to
 */
export function nearest({ z, x }, [positionZ, positionX], from = 0, to = z.length) {
  let best = from;
  let smallest = Infinity;
  for (let k = Math.max(0, Math.floor(from)); k < Math.min(to, z.length); k++) {
    const distance = Math.hypot(z[k] - positionZ, x[k] - positionX);
    if (distance < smallest) {
      smallest = distance;
      best = k;
    }
  }
  return best;
}
