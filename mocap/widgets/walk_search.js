// A motion graph out of its bytes, and the layered search of `mocap/plain.py`, line by line: no page, no picture.
// A point of the ground is z + ix: "z" is its real part. [c, s, z, x] lays a clip: turn = c + is, move = z + ix.

export const after = ([c, s, z, x], [d, t, y, w]) => [c * d - s * t, s * d + c * t, c * y - s * w + z, s * y + c * w + x];
export const cubicWeights = (count) => Array.from({ length: count }, (_, i) => {
  const t = (i + 1) / count;
  return 2 * t ** 3 - 3 * t ** 2 + 1;
});

// ---- the graph ----

// Bytes hold whole numbers, their signs folded in, lowest bytes first; they are summed up `order` times.
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

function readClip(read, { frames }, joints, { metres, parts }) {
  const clip = { frames, roots: new Float64Array(3 * frames), turns: new Float32Array(4 * joints * frames) };
  for (let c = 0; c < 3; c++) read(frames, 2).forEach((n, f) => { clip.roots[3 * f + c] = n * metres; });
  for (let c = 0; c < 4 * joints; c++) read(frames, 2).forEach((n, f) => { clip.turns[4 * joints * f + c] = n * parts; });
  for (let q = 0; q < clip.turns.length; q += 4) {
    const length = Math.hypot(...clip.turns.subarray(q, q + 4)) || 1;
    for (let c = 0; c < 4; c++) clip.turns[q + c] /= length;
  }
  return clip;
}

// `about` says what the bytes hold: clips, joints, numbers of nodes and edges, steps of the numbers.
export function unpack(about, bytes) {
  const read = reader(bytes);
  const clips = about.clips.map((clip) => readClip(read, clip, about.parents.length, about.steps));
  const clipOf = read(about.nodes, 1), frameOf = read(about.nodes, 1);
  const nodes = Array.from(clipOf, (clip, number) => ({ number, clip, frame: frameOf[number], out: [] }));
  const [from, to] = [read(about.edges, 1), read(about.edges, 1)];
  const [kind, turn, dz, dx] = [0, 0, 0, 0].map(() => read(about.edges));
  const edges = Array.from(from, (start, number) => {
    const edge = { number, start: nodes[start], end: nodes[to[number]], seam: Boolean(kind[number] & 1), labels: kind[number] >> 1 };
    edge.frames = edge.seam ? about.window : edge.end.frame - edge.start.frame;
    edge.lay = edge.seam ? layOf(edge, turn[number] * about.steps.turn, dz[number] * about.steps.move, dx[number] * about.steps.move) : [1, 0, 0, 0];
    edge.start.out.push(edge);
    return edge;
  });
  function layOf({ start, end }, angle, aheadZ, aheadX) { // a seam knows how far its two roots are apart
    const a = 3 * start.frame, b = 3 * (end.frame - about.window), [one, other] = [clips[start.clip].roots, clips[end.clip].roots];
    const c = Math.cos(angle), s = Math.sin(angle), z = other[b + 2], x = other[b];
    return [c, s, one[a + 2] + aheadZ - (c * z - s * x), one[a] + aheadX - (s * z + c * x)];
  }
  return { about, clips, nodes, edges, weights: cubicWeights(about.window) };
}

// ---- tracks: where the root is while an edge plays, and how long its way is ----

function trackOf(graph, { start, frames, seam, end, lay: [c, s, z, x] }) {
  const { roots } = graph.clips[start.clip], other = graph.clips[end.clip].roots, points = [];
  for (let i = 0; i < frames; i++) {
    const f = 3 * (start.frame + i), g = 3 * (end.frame - frames + i), w = seam ? graph.weights[i] : 1;
    const point = [roots[f + 2], roots[f]];
    if (seam) {
      point[0] = w * point[0] + (1 - w) * (c * other[g + 2] - s * other[g] + z);
      point[1] = w * point[1] + (1 - w) * (s * other[g + 2] + c * other[g] + x);
    }
    points.push(point);
  }
  return measured(roots, start.frame, points);
}

function measured(roots, frame, points) { // how far the root has come in each frame, from the frame before the first
  const before = 3 * Math.max(frame - 1, 0), along = new Float64Array(points.length);
  let length = 0, z = roots[before + 2], x = roots[before];
  points.forEach((point, i) => {
    length += Math.hypot(point[0] - z, point[1] - x);
    [z, x] = point;
    along[i] = length;
  });
  return { z: Float64Array.from(points, (p) => p[0]), x: Float64Array.from(points, (p) => p[1]), along };
}

// Tracks serve every line, so they are made once: of each edge, and of the frames ahead of each node.
export function prepare(graph) {
  const { look } = graph.about.search;
  for (const edge of graph.edges) edge.track = trackOf(graph, edge);
  for (const node of graph.nodes) {
    const { roots, frames } = graph.clips[node.clip], count = Math.min(look, frames - node.frame);
    const points = Array.from({ length: count }, (_, i) => [roots[3 * (node.frame + i) + 2], roots[3 * (node.frame + i)]]);
    node.ahead = measured(roots, node.frame, points);
  }
  return graph;
}

// ---- the search: all walks advance along a line together, layer by layer; the best of each layer go on ----

export class Search {
  // `line`: points {z, x} of the ground, 1 cm apart; `labels`: the kinds of motion that may be played, as bits.
  constructor(graph, line, labels = -1, dead = new Set()) {
    Object.assign(this, { graph, line, labels, dead, end: (line.z.length - 1) / 100, ...graph.about.search });
  }

  price(walk, track) { // what a track costs [KGP02, Eq. 9], and how far it comes: root and line, at equal lengths
    const [c, s, z, x] = walk.lay, { line } = this, last = line.z.length - 1;
    let cost = 0, along = walk.along;
    for (let i = 0; i < track.z.length; i++) {
      along = walk.along + track.along[i];
      const k = Math.floor(Math.min(100 * along, last));
      const dz = c * track.z[i] - s * track.x[i] + z - line.z[k], dx = s * track.z[i] + c * track.x[i] + x - line.x[k];
      const off = dz * dz + dx * dx; // m²
      cost += off + 100 * off * off; // 10 cm off cost twice what Eq. 9 says
    }
    return [cost, along];
  }

  lookAhead(walk) { // what the walk will cost if its clip plays on
    walk.expected = Math.min(this.price(walk, walk.node.ahead)[0], this.rescue);
    return walk;
  }

  lengthen(walk, edge) {
    const [cost, along] = this.price(walk, edge.track), paid = walk.cost + (cost + (edge.seam ? this.seam : 0));
    return this.lookAhead({ cost: paid, along, node: edge.end, lay: edge.seam ? after(walk.lay, edge.lay) : walk.lay, edge, before: walk });
  }

  starts() { // each node from which the root goes somewhere: at the line's start, and along it
    const { line, look } = this, far = Math.min(30, line.z.length - 1), walks = [];
    const way = Math.atan2(line.x[far] - line.x[0], line.z[far] - line.z[0]);
    for (const node of this.graph.nodes) {
      const { z, x } = node.ahead, last = look - 1;
      if (z.length < look || Math.hypot(z[last] - z[0], x[last] - x[0]) <= 0.3) continue;
      const angle = way - Math.atan2(x[last] - x[0], z[last] - z[0]), c = Math.cos(angle), s = Math.sin(angle);
      const lay = [c, s, line.z[0] - (c * z[0] - s * x[0]), line.x[0] - (s * z[0] + c * x[0])];
      walks.push(this.lookAhead({ cost: 0, along: 0, node, lay }));
    }
    return walks;
  }

  bestOf(walks) { // cross out what stands where another one stands and costs more; keep the best of the others
    const kept = new Map();
    for (const walk of walks.sort((a, b) => a.cost + a.expected - (b.cost + b.expected))) {
      const [c, s, z, x] = walk.lay, point = walk.node.ahead;
      const here = [c * point.z[0] - s * point.x[0] + z, s * point.z[0] + c * point.x[0] + x, Math.atan2(s, c)];
      const place = `${walk.node.number} ${here.map((value) => Math.floor(value / 0.1))}`;
      if (!kept.has(place)) kept.set(place, walk);
      if (kept.size === this.width) break;
    }
    return [...kept.values()];
  }

  // In each layer yield the walks that go on, and the best one at the line's end so far.
  * layers(starts = this.starts()) {
    const waiting = new Map([[0, starts]]);
    let best = null;
    while (waiting.size) {
      const layer = Math.min(...waiting.keys()), kept = this.bestOf(waiting.get(layer));
      waiting.delete(layer);
      for (const walk of kept) {
        for (const edge of walk.node.out) {
          if (!(edge.labels & this.labels) || !edge.end.ahead.z.length || this.dead.has(edge.end)) continue; // another kind, or a dead end
          const longer = this.lengthen(walk, edge);
          if (best && longer.cost >= best.cost) continue;
          if (longer.along >= this.end) { best = longer; continue; }
          const next = Math.max(Math.floor(longer.along / this.layer), layer);
          if (waiting.has(next)) waiting.get(next).push(longer); else waiting.set(next, [longer]);
        }
      }
      yield [kept, best];
    }
  }
}

// Nodes from which no walk of these kinds goes on for ever.
function deadEnds({ nodes }, labels) {
  const dead = new Set();
  for (let before = -1; before < dead.size;) {
    before = dead.size;
    for (const node of nodes) if (!node.out.some((edge) => edge.labels & labels && !dead.has(edge.end))) dead.add(node);
  }
  return dead;
}

// The edges of a walk, from its start on, and how its first clip is laid.
export function edgesOf(walk) {
  const edges = [];
  for (; walk.before; walk = walk.before) edges.push(walk.edge);
  return { edges: edges.reverse(), lay: walk.lay };
}

// A walk that grows by pieces while it plays: each piece is searched on the next metres of the line from where the
// last one ends, abreast of the line again. So a long line is begun at once, and lengths do not drift apart.
export class Walk {
  constructor(graph, labels = -1, { far = 5, keep = 2 } = {}) {
    Object.assign(this, { graph, labels, far, keep, edges: [], lays: [], begins: [], frames: 0, at: 0, state: null });
  }

  add(edge) {
    this.begins.push(this.frames);
    this.edges.push(edge);
    this.lays.push(this.state.lay);
    this.frames += edge.frames;
    this.state = { node: edge.end, lay: edge.seam ? after(this.state.lay, edge.lay) : this.state.lay };
  }

  // Forget what was to come after the next node after a frame; give the frame of this node.
  turnFrom(frame) {
    const left = this.begins.findIndex((begin) => begin > frame);
    if (left > 0) {
      this.state = { node: this.edges[left].start, lay: this.lays[left] };
      this.frames = this.begins[left];
      for (const list of [this.edges, this.lays, this.begins]) list.length = left;
    }
    return this.frames - 1;
  }

  follow(line) { Object.assign(this, { line, at: 0, since: this.frames, done: false }); }

  here() { // where the root is at the walk's end
    const [c, s, z, x] = this.state.lay, { ahead } = this.state.node;
    return [c * ahead.z[0] - s * ahead.x[0] + z, s * ahead.z[0] + c * ahead.x[0] + x];
  }

  // Search the next piece; yields the best unfinished walk after each layer, and at last adds what was found.
  * grow() {
    const { line, at } = this, ends = at + 100 * (this.far + 2) >= line.z.length, stop = ends ? line.z.length : at + 100 * this.far + 1;
    let best = null;
    // So that the next line can be walked on from the end; else any walk of this kind; else, from here on, of any kind.
    const kinds = [[this.labels, deadEnds(this.graph, this.labels)], [this.labels], ...(this.state ? [[-1]] : [])];
    for (const [labels, dead] of kinds) {
      const search = new Search(this.graph, { z: line.z.slice(at, stop), x: line.x.slice(at, stop) }, labels, dead);
      const starts = this.state ? [search.lookAhead({ cost: 0, along: 0, ...this.state })] : undefined;
      for (const [kept, found] of search.layers(starts)) { best = found; yield kept[0]; }
      if (best) break;
    }
    if (!best) { this.done = true; return; }
    const { edges, lay } = edgesOf(best);
    this.state ??= { node: edges[0].start, lay };
    let come = 0;
    for (const edge of edges) {
      this.add(edge);
      come += edge.track.along.at(-1);
      if (!ends && come > this.keep) break;
    }
    this.done = ends;
    this.at = nearest(line, this.here(), at, at + 100 * (come + 1));
  }
}

// Which point of a line, of those between two, is nearest to a place.
export function nearest({ z, x }, [placeZ, placeX], from = 0, to = z.length) {
  let best = from, least = Infinity;
  for (let k = Math.max(0, Math.floor(from)); k < Math.min(to, z.length); k++) {
    const off = Math.hypot(z[k] - placeZ, x[k] - placeX);
    if (off < least) { least = off; best = k; }
  }
  return best;
}
