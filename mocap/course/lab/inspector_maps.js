// The maps to point at: a distance grid, a graph along time, a walk from above. Each draws itself on a canvas, finds
// what is under a finger, moves on by the keys, and shows by an orange dot where the seam stands while it plays.

const CIVIDIS = ["#00224E", "#123570", "#3B496C", "#575D6D", "#707173", "#8A8678", "#A59C74", "#C3B369", "#E1CC55", "#FEE838"];
const STEPS = { ArrowUp: [0, -1], ArrowDown: [0, 1], ArrowLeft: [-1, 0], ArrowRight: [1, 0] };

// A canvas that is as sharp as the screen; its unit is a pixel of the page.
function sheet(canvas) {
  const sharp = devicePixelRatio || 1, size = [canvas.clientWidth, canvas.clientHeight];
  const pixels = size.map((length) => Math.round(length * sharp));
  if (canvas.width !== pixels[0] || canvas.height !== pixels[1]) [canvas.width, canvas.height] = pixels;
  const pen = canvas.getContext("2d");
  pen.setTransform(sharp, 0, 0, sharp, 0, 0);
  pen.clearRect(0, 0, ...size);
  pen.font = "11px system-ui, sans-serif";
  pen.lineCap = pen.lineJoin = "round";
  return { pen, wide: size[0], high: size[1] };
}

function ring(pen, x, y, radius, inner, outer) {
  for (const [colour, width] of [[outer, 4], [inner, 2]]) {
    pen.strokeStyle = colour; pen.lineWidth = width;
    pen.beginPath(); pen.arc(x, y, radius, 0, 2 * Math.PI); pen.stroke();
  }
}

function dot(pen, x, y, radius, colour, edge) {
  pen.fillStyle = colour; pen.strokeStyle = edge; pen.lineWidth = 1.5;
  pen.beginPath(); pen.arc(x, y, radius, 0, 2 * Math.PI); pen.fill(); pen.stroke();
}

function line(pen, points, colour, width = 1, alpha = 1) {
  pen.strokeStyle = colour; pen.lineWidth = width; pen.globalAlpha = alpha;
  pen.beginPath();
  points.forEach(([x, y], k) => (k ? pen.lineTo(x, y) : pen.moveTo(x, y)));
  pen.stroke();
  pen.globalAlpha = 1;
}

class Map2D {
  constructor(canvas, inspector) {
    Object.assign(this, { canvas, inspector, drawn: false });
    whenPointed(canvas, (event) => { canvas.focus({ preventScroll: true }); this.point(event); });
    canvas.addEventListener("keydown", (event) => {
      const step = STEPS[event.key];
      if (!step && event.key !== "n") return;
      const next = !this.drawn ? null : step ? this.step(step, event.shiftKey ? 10 : 1) : this.next?.();
      if (next) inspector.choose(next);
      event.preventDefault(); event.stopPropagation();
    });
  }

  point(event) {
    const found = this.drawn && this.under(event.offsetX, event.offsetY);
    if (found) this.inspector.choose(found);
  }
}

// Rows are frames of the first clip, columns those of the second; a cell is a pair of windows.
class GridMap extends Map2D {
  // Take `values`, shades from 0 to 1 row by row, of cells that are `every` frames wide and start at `from`.
  show(grid, minima) {
    Object.assign(this, { grid, minima });
    const picture = document.createElement("canvas"), { rows, columns, values } = grid;
    [picture.width, picture.height] = [columns, rows];
    const pixels = new ImageData(columns, rows), palette = CIVIDIS.map((hex) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16)));
    values.forEach((shade, k) => {
      const at = shade * (palette.length - 1), low = Math.min(Math.floor(at), palette.length - 2);
      const colour = Number.isNaN(shade) ? [128, 128, 128, 0] : [...palette[low].map((v, n) => v + (at - low) * (palette[low + 1][n] - v)), 255];
      pixels.data.set(colour, 4 * k);
    });
    picture.getContext("2d").putImageData(pixels, 0, 0);
    this.picture = picture;
  }

  // Where the grid is on the canvas, as large as fits with the same scale on both axes.
  place(wide, high) {
    const { rows, columns } = this.grid, scale = Math.min((wide - 50) / columns, (high - 38) / rows);
    return { left: 44, top: 6, scale: scale / this.grid.every };
  }

  at(i, j) {
    const { left, top, scale } = this.box, [i0, j0] = this.grid.from, half = this.grid.every / 2;
    return [left + (j - j0 + half) * scale, top + (i - i0 + half) * scale];
  }

  cell(i, j) {
    const { rows, columns, every, from } = this.grid, [i0, j0] = from, { window, first, second } = this.inspector;
    const inside = (v, low, count, frames) => Math.min(Math.max(v, low), low + (count - 1) * every, frames - window);
    return { ...this.inspector.pick, i: inside(i, Math.max(0, i0), rows, first.frames), j: inside(j, Math.max(0, j0), columns, second.frames) };
  }

  under(x, y) {
    const { left, top, scale } = this.box, { every, from } = this.grid;
    const frame = (v, start) => start + every * Math.floor(v / scale / every);
    return this.cell(frame(y - top, from[0]), frame(x - left, from[1]));
  }

  step([across, down], far) { const { i, j } = this.inspector.pick; return this.cell(i + far * down, j + far * across); }

  // The minimum of next higher cost; after the last one, the lowest.
  next() {
    const { i, j } = this.inspector.pick, at = this.minima.findIndex(([r, c]) => r === i && c === j);
    return this.minima.length ? this.cell(...this.minima[(at + 1) % this.minima.length]) : null;
  }

  draw(palette, { pick, lit, fps, path }) {
    if (!this.grid) return;
    const { rows, columns, every, from } = this.grid;
    this.canvas.style.maxHeight = `${((this.canvas.clientWidth - 50) / columns) * rows + 44}px`; // no more than a flat grid takes
    const { pen, wide, high } = sheet(this.canvas);
    this.drawn = true;
    const { left, top, scale } = this.box = this.place(wide, high), size = [columns * every * scale, rows * every * scale];
    pen.imageSmoothingEnabled = false;
    pen.drawImage(this.picture, left, top, ...size);
    for (const [i, j] of this.minima) dot(pen, ...this.at(i, j), 2, "#fff", "#0008");
    pen.fillStyle = palette.ink;
    this.ticks(pen, { fps, from, size, left, top, scale });
    pen.save();
    pen.beginPath(); pen.rect(left, top, ...size); pen.clip();
    if (path) line(pen, path.map(([i, j]) => this.at(i, j)), "#fff", 2, 0.8); // the frames of the window, one after the other
    if (lit) {
      const [x, y] = this.at(...lit.cell);
      if (lit.part !== "after") line(pen, [[left, y], [left + size[0], y]], PLAYED, 1.5); // the first clip's frame
      if (lit.part !== "before") line(pen, [[x, top], [x, top + size[1]]], PLAYED, 1.5);
      if (lit.part === "window") dot(pen, x, y, 5, PLAYED, "#222");
    }
    ring(pen, ...this.at(pick.i, pick.j), 7, "#fff", "#222");
    pen.restore();
  }

  // Seconds along both axes, and whose they are.
  ticks(pen, { fps, from, size, left, top, scale }) {
    const { first, second } = this.inspector, seconds = [5, 2, 1, 0.5, 0.2, 0.1].find((s) => Math.min(...size) / (s * fps * scale) >= 3) ?? 0.1;
    const labels = (start, length, put) => {
      for (let k = Math.max(0, Math.ceil(start / fps / seconds - 1e-9)); k * seconds * fps <= start + length / scale; k++) {
        put((k * seconds * fps - start) * scale, String(Number((k * seconds).toFixed(1))));
      }
    };
    pen.textBaseline = "top"; pen.textAlign = "center";
    labels(from[1], size[0], (x, text) => pen.fillText(text, left + x, top + size[1] + 4));
    pen.fillText(`${second.name} (s)`, left + size[0] / 2, top + size[1] + 18);
    pen.textBaseline = "middle"; pen.textAlign = "right";
    labels(from[0], size[1], (y, text) => pen.fillText(text, left - 5, top + y));
    pen.save();
    pen.translate(9, top + size[1] / 2); pen.rotate(-Math.PI / 2); pen.textAlign = "center";
    pen.fillText(`${first.name} (s)`, 0, 0);
    pen.restore();
  }
}

// A bar for each clip, along time; an arc for each transition, from a ring where it leaves to a disc where it enters.
class GraphMap extends Map2D {
  show(graph, clips, fps) { Object.assign(this, { graph, clips, fps }); }

  place(clip, frame) {
    const { wide, clips } = this, longest = Math.max(...clips.map((c) => c.frames)), rows = clips.length;
    return [NAME_WIDE + ((wide - NAME_WIDE - 12) * frame) / longest, 26 + ((this.high - 44) * clip) / Math.max(1, rows - 1 || 1)];
  }

  arc([source, leave, target, enter]) {
    const [x0, y0] = this.place(source, leave), [x1, y1] = this.place(target, enter + this.inspector.window), lift = source === target ? 20 : 0;
    return Array.from({ length: 13 }, (_, k) => k / 12).map((t) => [x0 + t * (x1 - x0), y0 + t * (y1 - y0) - 4 * t * (1 - t) * lift]);
  }

  under(x, y) {
    const far = (number) => Math.min(...this.arc(this.graph.transitions[number]).map(([u, v]) => Math.hypot(u - x, v - y)));
    const all = this.graph.transitions.map((_, n) => [far(n), n]);
    return this.transition(all.reduce((best, one) => (one[0] < best[0] ? one : best))[1]);
  }

  // Left and right go along time, by the place that a transition leaves; up to a higher cost, down to a lower one.
  step([across, down], far) {
    const all = this.graph.transitions, number = Math.max(0, this.inspector.pick.number ?? 0);
    const sorted = all.map((_, n) => n).sort((a, b) => (across ? all[a][0] - all[b][0] || all[a][1] - all[b][1] : all[b][4] - all[a][4]));
    const at = sorted.indexOf(number) + far * (across || down);
    return this.transition(sorted[Math.min(Math.max(at, 0), sorted.length - 1)]);
  }

  transition(number) {
    const [first, i, second, j] = this.graph.transitions[number];
    return { first, i, second, j, number, centre: [i, j] };
  }

  draw(palette, { pick, lit, colours }) {
    const { pen, wide, high } = sheet(this.canvas);
    Object.assign(this, { wide, high, drawn: true });
    pen.textBaseline = "middle"; pen.textAlign = "right"; pen.fillStyle = palette.ink;
    this.clips.forEach((clip, k) => {
      line(pen, [this.place(k, 0), this.place(k, clip.frames)], colours.quiet, 1);
      pen.fillText(clip.name.slice(0, 16), NAME_WIDE - 6, this.place(k, 0)[1], NAME_WIDE - 8);
    });
    for (const [clip, start, end] of this.graph.spans) line(pen, [this.place(clip, start), this.place(clip, end)], colours.sources[clip % colours.sources.length], 5);
    const fade = Math.min(1, 0.15 + 30 / (this.graph.transitions.length + 1));
    for (const transition of this.graph.transitions) line(pen, this.arc(transition), colours.seam, 1, fade);
    const arc = this.arc([pick.first, pick.i, pick.second, pick.j]);
    line(pen, arc, palette.ink, 4); line(pen, arc, colours.seam, 2.5);
    dot(pen, ...arc[0], 4, palette.paper, colours.seam); dot(pen, ...arc.at(-1), 4, colours.seam, palette.ink);
    if (!lit) return;
    const on = lit.part === "before" ? this.place(pick.first, lit.cell[0]) : lit.part === "after" ? this.place(pick.second, lit.cell[1])
      : arc[Math.round(12 * lit.share)];
    dot(pen, ...on, 5, PLAYED, "#222");
  }
}

const NAME_WIDE = 96, PLAYED = "#E69F00";

// A walk seen from above: z upwards, x to the left; a diamond for each seam.
class PathMap extends Map2D {
  show(walk) {
    this.walk = walk;
    const all = [...walk.path, ...walk.asked], range = (k) => [Math.min(...all.map((p) => p[k])), Math.max(...all.map((p) => p[k]))];
    [this.x, this.z] = [range(0), range(1)];
  }

  place([x, z]) {
    const { wide, high } = this, span = ([low, high_]) => Math.max(high_ - low, 0.5), margin = 14;
    const scale = Math.min((wide - 2 * margin) / span(this.x), (high - 2 * margin) / span(this.z)), middle = ([low, high_]) => (low + high_) / 2;
    return [wide / 2 - (x - middle(this.x)) * scale, high / 2 - (z - middle(this.z)) * scale];
  }

  seam(number) {
    const { pick, before, after, frame } = this.walk.seams[number], [first, i, second, j] = pick;
    return { first, i, second, j, seam: number, before, after, frame, centre: [i, j] };
  }

  under(x, y) {
    const far = ({ frame }) => { const [u, v] = this.place(this.walk.path[frame]); return Math.hypot(u - x, v - y); };
    return this.seam(this.walk.seams.reduce((best, seam, n, all) => (far(seam) < far(all[best]) ? n : best), 0));
  }

  step([across, down], far) { return this.seam(Math.min(Math.max((this.inspector.pick.seam ?? 0) + far * (across || down), 0), this.walk.seams.length - 1)); }

  draw(palette, { pick, lit, colours }) {
    const { pen, wide, high } = sheet(this.canvas), { walk } = this;
    Object.assign(this, { wide, high, drawn: true });
    if (walk.asked.length) line(pen, walk.asked.map((p) => this.place(p)), palette.asked, 6, 0.75);
    line(pen, walk.path.map((p) => this.place(p)), colours.path, 2.5);
    walk.seams.forEach(({ frame }, n) => {
      const [x, y] = this.place(walk.path[frame]), size = n === pick.seam ? 8 : 5;
      pen.fillStyle = colours.seam; pen.strokeStyle = n === pick.seam ? palette.ink : palette.paper; pen.lineWidth = 1.5;
      pen.beginPath(); pen.moveTo(x - size, y); pen.lineTo(x, y - size); pen.lineTo(x + size, y); pen.lineTo(x, y + size); pen.closePath();
      pen.fill(); pen.stroke();
    });
    const at = walk.path[Math.round(lit?.frame ?? -1)];
    if (at) dot(pen, ...this.place(at), 5, PLAYED, "#222");
  }
}
