// A character whose frames come bit by bit, and are drawn while they come.

const KEPT = 6; // seconds of its way that stay in sight

class Walker {
  constructor(packed) {
    Object.assign(this, packed, { path_colour: packed.colour, diamonds: [], prints: [], fault: "", delays: [] });
    this.frames = []; this.first = 0; // the number of the first frame that is kept
    this.centre = null;
  }

  // Take frames from Python: what is said of each, and the numbers of all.
  add({ first, waited, obeyed, blending, fault, delays }, numbers) {
    if (first !== this.first + this.frames.length) { this.frames = []; this.first = first; }
    const size = 3 * this.joints;
    for (let k = 0; k < waited.length; k++) {
      this.frames.push({ places: numbers.subarray(k * size, (k + 1) * size), waited: waited[k], obeyed: obeyed[k], blending: blending[k] });
    }
    const old = Math.max(0, this.frames.length - Math.round((KEPT + 2) * this.fps));
    this.frames.splice(0, old); this.first += old;
    Object.assign(this, { fault, delays });
  }

  // The time of its last frame, in seconds.
  get end() { return (this.first + this.frames.length - 1) / this.fps; }

  frame(time) {
    const k = Math.floor(time * this.fps + 1e-6) - this.first;
    return this.frames[Math.min(Math.max(k, 0), this.frames.length - 1)];
  }

  // All joints at a time, interpolated between two frames: x, y, z, x, y, z, ...
  pose(time) {
    const at = Math.min(Math.max(time * this.fps - this.first, 0), this.frames.length - 1), k = Math.floor(at), share = at - k;
    const a = this.frames[k].places, b = this.frames[Math.min(k + 1, this.frames.length - 1)].places;
    return a.map((from, i) => from + share * (b[i] - from));
  }

  // Metres per second on the ground, over the last half second.
  speed(time) {
    const half = Math.min(0.5, time - this.first / this.fps), [x, , z] = this.pose(time);
    const [x0, , z0] = this.pose(time - half);
    return half > 0.1 ? Math.hypot(x - x0, z - z0) / half : 0;
  }

  // The way of its last seconds, as lines of one colour: its own, or that of seams.
  trailUntil(time, seam) {
    const lines = [], every = Math.max(1, Math.round(this.fps / 10)), until = Math.floor(time * this.fps) - this.first;
    const from = Math.max(0, until - Math.round(KEPT * this.fps));
    for (let k = from + (every - ((from + this.first) % every)); k <= until && k < this.frames.length; k += every) {
      const { places, blending } = this.frames[k], colour = blending ? seam : this.path_colour, last = lines.at(-1);
      last?.line.push([places[0], 0, places[2]]);
      if (last?.colour !== colour) lines.push({ colour, line: [[places[0], 0, places[2]]] });
    }
    const [x, , z] = this.pose(time);
    lines.at(-1)?.line.push([x, 0, z]);
    return lines;
  }

  // Where the camera looks: above the ground under it, a little behind, so that the view does not rock with each step.
  target(time, seconds) {
    const [x, , z] = this.pose(time);
    this.centre ??= [x, 0.85, z];
    const share = 1 - Math.exp(-seconds / 0.3);
    this.centre = [this.centre[0] + share * (x - this.centre[0]), 0.85, this.centre[2] + share * (z - this.centre[2])];
    return this.centre;
  }

  colourAt() { return this.colour; }
}
