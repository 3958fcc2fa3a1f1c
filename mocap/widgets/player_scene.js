// What the player shows: characters, and the camera that sees them. `player.py` joins the scripts to one module.
//
// World: y up, metres, seconds. The camera turns about a target; `Camera.see` and `pixel` are the whole projection.

class Camera {
  constructor() { this.reset(0.25); }
  reset(pitch) { this.yaw = 0.7; this.pitch = pitch; this.zoom = 1; }

  // Stand `distance` away from `target`, on a canvas of width × height pixels.
  place(target, distance, width, height) {
    const d = distance / this.zoom, cy = Math.cos(this.yaw), sy = Math.sin(this.yaw);
    const cp = Math.cos(this.pitch), sp = Math.sin(this.pitch);
    this.eye = [target[0] + d * sy * cp, target[1] + d * sp, target[2] + d * cy * cp];
    this.right = [cy, 0, -sy];
    this.up = [-sy * sp, cp, -cy * sp];
    this.ahead = [-sy * cp, -sp, -cy * cp];
    this.focus = 1.5 * Math.min(width, height);
    this.middle = [width / 2, height / 2];
  }

  // Where a point is, seen from the camera: [to the right, up, ahead], metres.
  see(x, y, z) {
    const a = x - this.eye[0], b = y - this.eye[1], c = z - this.eye[2];
    const along = (v) => a * v[0] + b * v[1] + c * v[2];
    return [along(this.right), along(this.up), along(this.ahead)];
  }

  pixel([right, up, ahead]) {
    const scale = this.focus / ahead;
    return [this.middle[0] + right * scale, this.middle[1] - up * scale];
  }

  // The same without an array for each of thousands of points: sets `across`, `down` (pixels) and `far` (metres ahead).
  project(x, y, z) {
    const a = x - this.eye[0], b = y - this.eye[1], c = z - this.eye[2], { right, up, ahead } = this;
    this.far = a * ahead[0] + b * ahead[1] + c * ahead[2];
    const scale = this.focus / this.far;
    this.across = this.middle[0] + (a * right[0] + b * right[1] + c * right[2]) * scale;
    this.down = this.middle[1] - (a * up[0] + b * up[1] + c * up[2]) * scale;
  }

  // The point of the ground under a pixel, or null above the horizon.
  ground(px, py) {
    const r = (px - this.middle[0]) / this.focus, u = (this.middle[1] - py) / this.focus;
    const ray = [0, 1, 2].map((i) => this.ahead[i] + r * this.right[i] + u * this.up[i]);
    const far = -this.eye[1] / ray[1];
    return far > 0 && far < 100 ? [this.eye[0] + far * ray[0], this.eye[2] + far * ray[2]] : null;
  }
}

async function inflated(data) {
  const fromBase64 = (text) => Uint8Array.fromBase64?.(text) ?? Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const bytes = typeof data === "string" ? fromBase64(data) : data;
  return new Response(new Response(bytes).body.pipeThrough(new DecompressionStream("deflate"))).arrayBuffer();
}

// Undo the second differences over time of `player.py`, channel by channel; the numbers wrap around as their type does.
function summed(numbers, frames) {
  for (let i = 0, change = 0, number = 0; i < numbers.length; i++) {
    if (i % frames === 0) change = number = 0;
    change = (change + numbers[i]) | 0;
    number = (number + change) | 0;
    numbers[i] = number;
  }
  return numbers;
}

// A character: where its joints are at any time. A coordinate is low + step · number metres, with a 16-bit number.
class Character {
  constructor(packed, bytes, marks) {
    Object.assign(this, packed);
    this.numbers = summed(new Uint16Array(bytes, packed.offset, packed.frames * packed.joints * 3), packed.frames);
    this.seconds = (packed.frames - 1) / packed.fps;
    this.stands = packed.prints;
    this.move(0, 0, marks);
  }

  // Walk so many metres beside its own place.
  move(x, z, marks) {
    this.away = [x, 0, z];
    this.prints = this.stands.map(([start, end, px, pz, side]) => [start, end, px + x, pz + z, side]);
    this.path = this.pathOnGround();
    this.trail = this.colouredPath(marks);
    this.diamonds = this.seams.map((time) => { const root = this.pose(time); return [root[0], 0, root[2]]; });
  }

  // All joints at a time, interpolated between two frames: x, y, z, x, y, z, ...
  pose(time) {
    const at = Math.min(Math.max(time, 0), this.seconds) * this.fps;
    const frame = Math.min(Math.floor(at), this.frames - 1), share = at - frame;
    const next = Math.min(frame + 1, this.frames - 1), places = new Float32Array(this.joints * 3);
    for (let i = 0; i < places.length; i++) places[i] = this.place(i, frame) * (1 - share) + this.place(i, next) * share;
    return places;
  }

  place(coordinate, frame) {
    return this.away[coordinate % 3] + this.low[coordinate % 3] + this.step[coordinate % 3] * this.numbers[coordinate * this.frames + frame];
  }

  // [time, x, z] of the root, at fewer than 2000 times.
  pathOnGround() {
    const every = Math.max(1, Math.floor(this.frames / 1000)), path = [];
    for (let frame = 0; frame < this.frames; frame += every) path.push([frame / this.fps, this.place(0, frame), this.place(2, frame)]);
    return path;
  }

  // The path as lines of one colour: that of the clip, or red where it is off the path that was asked for.
  colouredPath(marks) {
    const own = (time) => (this.sources.length ? this.colourAt(time) : this.path_colour), lines = [];
    const colourOf = (time) => (this.astray.some(([start, end]) => start <= time && time < end) ? marks.astray : own(time));
    for (const [time, x, z] of this.path) {
      const colour = colourOf(time), last = lines.at(-1);
      if (last) last.line.push([x, 0, z, time]);
      if (last?.colour !== colour) lines.push({ colour, line: [[x, 0, z, time]] });
    }
    return lines;
  }

  // The colour of the clip that a time comes from.
  colourAt(time) {
    let colour = this.colour;
    for (const source of this.sources) if (source.start <= time + 1e-9) colour = source.colour;
    return colour;
  }
}
