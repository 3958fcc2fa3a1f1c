// The maps to point at: a distance grid, a graph along time, a walk from above. Each draws itself on a canvas, finds
// what is under a finger, moves on by the keys, and shows by an orange dot where the seam stands while it plays.

import {
  alongTime,
  arcBetween,
  clearedPen,
  mapInto,
  paintDisc,
  paintLine,
  paintStroke,
  penOf,
} from "../../widgets/canvas.js";
import { whenPointed } from "../../widgets/touch.js";

/**
 * @import { Palette } from "../../widgets/player_page.js"
 * @import { Inspector } from "./inspector.js"
 * @import { Clip } from "./inspector_maths.js"
 *
 * Two windows: a clip and the first frame of each. `centre` is where the grid stands; a transition has its number, a
 * seam its number, the frames of the walk around it, and its frame in the walk.
 * @typedef {{
 *   first: number, i: number, second: number, j: number, centre: number[],
 *   number?: number, seam?: number, before?: number, after?: number, frame?: number,
 * }} Pair
 *
 * Shades from 0 to 1, row by row, of cells that are `every` frames wide and start at `from`; NaN where there is none.
 * @typedef {{ rows: number, columns: number, every: number, from: number[], values: Float32Array }} Grid
 *
 * `transitions` are [clip, frame, clip, frame, cost], `spans` [clip, start, end].
 * @typedef {{ transitions: number[][], spans: number[][] }} PackedGraph
 *
 * A walk from above: `path` and `asked` are positions [x, z], the `pick` of a seam is [clip, frame, clip, frame].
 * @typedef {{
 *   path: number[][], asked: number[][],
 *   seams: { pick: number[], before: number, after: number, frame: number }[],
 * }} PackedWalk
 *
 * The colours of the package, as `LOOK` in `showing.py`.
 * @typedef {{
 *   sides: string[], curves: string[], sources: string[], seam: string, path: string, asked: string, quiet: string,
 * }} Colours
 *
 * @typedef {Palette & { paper: string, thread: string }} MapPalette
 *
 * Where the seam stands while it plays: the frames of both clips, a fraction of the window, and the frame of the walk.
 * @typedef {{ part: "before" | "window" | "after", cell: [number, number], fraction: number, frame: number }} Lit
 *
 * @typedef {{ pick: Pair, lit: Lit, fps: number, path: number[][], colours: Colours }} ShownOnMap
 *
 * Where the axes of the grid are, and their frames.
 * @typedef {{
 *   fps: number, from: number[], size: number[], left: number, top: number, scale: number,
 * }} Axes
 */

const NAME_WIDE = 96; // pixels
const MARGIN = 14; // pixels around a walk
const PLAYED = "#E69F00";
const CIVIDIS = [
  "#00224E",
  "#123570",
  "#3B496C",
  "#575D6D",
  "#707173",
  "#8A8678",
  "#A59C74",
  "#C3B369",
  "#E1CC55",
  "#FEE838",
];
/** @type {Record<string, number[]>} */
const STEPS = { ArrowUp: [0, -1], ArrowDown: [0, 1], ArrowLeft: [-1, 0], ArrowRight: [1, 0] };

/**
 * The pen of a cleared canvas for a map or a chart.
 * @param {HTMLCanvasElement} canvas
 */
export function sheet(canvas) {
  const cleared = clearedPen(canvas);
  cleared.pen.font = "11px system-ui, sans-serif";
  return cleared;
}

/**
 * What the upright axis of a map or a chart shows, along its middle.
 * @param {CanvasRenderingContext2D} pen
 * @param {string} text
 * @param {number} middle
 */
export function writeUpright(pen, text, middle) {
  pen.save();
  pen.translate(9, middle);
  pen.rotate(-Math.PI / 2);
  pen.textAlign = "center";
  pen.fillText(text, 0, 0);
  pen.restore();
}

/**
 * @param {CanvasRenderingContext2D} pen
 * @param {number} x
 * @param {number} y
 * @param {number} radius
 * @param {string} inner
 * @param {string} outer
 */
function ring(pen, x, y, radius, inner, outer) {
  pen.beginPath();
  pen.arc(x, y, radius, 0, 2 * Math.PI);
  paintStroke(pen, outer, 4);
  paintStroke(pen, inner, 2);
}

class Map2D {
  /** @type {boolean} */
  drawn = false;

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {Inspector} inspector
   */
  constructor(canvas, inspector) {
    this.canvas = canvas;
    this.inspector = inspector;
    whenPointed(canvas, (event) => {
      canvas.focus({ preventScroll: true });
      this.point(event);
    });
    canvas.addEventListener("keydown", (event) => {
      const step = STEPS[event.key];
      if (!step && event.key !== "n") return;
      if (this.drawn) this.go(step ? this.step(step, event.shiftKey ? 10 : 1) : this.next());
      event.preventDefault();
      event.stopPropagation();
    });
  }

  /** @param {PointerEvent} event */
  point(event) {
    if (this.drawn) this.go(this.under(event.offsetX, event.offsetY));
  }

  /** @param {Pair | null} pair */
  go(pair) {
    if (pair) this.inspector.choose(pair);
  }

  /**
   * What is at a point of the canvas.
   * @abstract
   * @param {number} _x
   * @param {number} _y
   * @returns {Pair | null}
   */
  under(_x, _y) {
    return null;
  }

  /**
   * What is some steps away from what is chosen: to the right or the left, up or down.
   * @abstract
   * @param {number[]} _step
   * @param {number} _far
   * @returns {Pair | null}
   */
  step(_step, _far) {
    return null;
  }

  /**
   * What comes next by cost.
   * @returns {Pair | null}
   */
  next() {
    return null;
  }

  /**
   * @abstract
   * @param {MapPalette} _palette
   * @param {ShownOnMap} _shown
   */
  draw(_palette, _shown) {}
}

// Rows are frames of the first clip, columns those of the second; a cell is a pair of windows.
export class GridMap extends Map2D {
  /** @type {Grid} */
  grid;
  /** @type {number[][]} pairs of windows, the lowest cost first */
  minima;
  /** @type {HTMLCanvasElement} */
  picture;
  /** @type {{ left: number, top: number, scale: number }} where the grid is */
  box;

  /**
   * Take shades and the minima, which are marked.
   * @param {Grid} grid
   * @param {number[][]} minima
   */
  show(grid, minima) {
    this.grid = grid;
    this.minima = minima;
    const picture = document.createElement("canvas");
    const { rows, columns, values } = grid;
    [picture.width, picture.height] = [columns, rows];
    const pixels = new ImageData(columns, rows);
    const palette = CIVIDIS.map((hex) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16)));
    values.forEach((shade, k) => {
      const at = shade * (palette.length - 1);
      const low = Math.min(Math.floor(at), palette.length - 2);
      const colour = Number.isNaN(shade)
        ? [128, 128, 128, 0]
        : [...palette[low].map((v, n) => v + (at - low) * (palette[low + 1][n] - v)), 255];
      pixels.data.set(colour, 4 * k);
    });
    penOf(picture).putImageData(pixels, 0, 0);
    this.picture = picture;
  }

  /**
   * Where the grid is on the canvas, as large as fits with the same scale on both axes.
   * @param {number} wide
   * @param {number} high
   */
  boxFor(wide, high) {
    const { rows, columns } = this.grid;
    const scale = Math.min((wide - 50) / columns, (high - 38) / rows);
    return { left: 44, top: 6, scale: scale / this.grid.every };
  }

  /**
   * @param {number} i
   * @param {number} j
   * @returns {[number, number]}
   */
  at(i, j) {
    const { left, top, scale } = this.box;
    const [i0, j0] = this.grid.from;
    const half = this.grid.every / 2;
    return [left + (j - j0 + half) * scale, top + (i - i0 + half) * scale];
  }

  /**
   * @param {number} i
   * @param {number} j
   * @returns {Pair}
   */
  cell(i, j) {
    const { rows, columns, every, from } = this.grid;
    const [i0, j0] = from;
    const { window, first, second } = this.inspector;
    /**
     * @param {number} v
     * @param {number} low
     * @param {number} count
     * @param {number} frames
     */
    const inside = (v, low, count, frames) =>
      Math.min(Math.max(v, low), low + (count - 1) * every, frames - window);
    return {
      ...this.inspector.pick,
      i: inside(i, Math.max(0, i0), rows, first.frames),
      j: inside(j, Math.max(0, j0), columns, second.frames),
    };
  }

  /**
   * @param {number} x
   * @param {number} y
   */
  under(x, y) {
    const { left, top, scale } = this.box;
    const { every, from } = this.grid;
    /**
     * @param {number} v
     * @param {number} start
     */
    const frame = (v, start) => start + every * Math.floor(v / scale / every);
    return this.cell(frame(y - top, from[0]), frame(x - left, from[1]));
  }

  /**
   * @param {number[]} step
   * @param {number} far
   */
  step([across, down], far) {
    const { i, j } = this.inspector.pick;
    return this.cell(i + far * down, j + far * across);
  }

  // The minimum of next higher cost; after the last one, the lowest.
  next() {
    const { i, j } = this.inspector.pick;
    const at = this.minima.findIndex(([r, c]) => r === i && c === j);
    if (!this.minima.length) return null;
    const [r, c] = this.minima[(at + 1) % this.minima.length];
    return this.cell(r, c);
  }

  /**
   * @param {MapPalette} palette
   * @param {ShownOnMap} shown
   */
  draw(palette, { pick, lit, fps, path }) {
    if (!this.grid) return;
    const { rows, columns, every, from } = this.grid;
    const flat = ((this.canvas.clientWidth - 50) / columns) * rows + 44; // pixels that a flat grid takes
    this.canvas.style.maxHeight = `${flat}px`;
    const { pen, wide, high } = sheet(this.canvas);
    this.drawn = true;
    this.box = this.boxFor(wide, high);
    const { left, top, scale } = this.box;
    const size = [columns * every * scale, rows * every * scale];
    pen.imageSmoothingEnabled = false;
    pen.drawImage(this.picture, left, top, size[0], size[1]);
    for (const [i, j] of this.minima) paintDisc(pen, this.at(i, j), 2, "#fff", "#0008");
    pen.fillStyle = palette.ink;
    this.ticks(pen, { fps, from, size, left, top, scale });
    pen.save();
    pen.beginPath();
    pen.rect(left, top, size[0], size[1]);
    pen.clip();
    const frames = path.map(([i, j]) => this.at(i, j)); // of the window, one after the other
    paintLine(pen, frames, "#fff", 2, 0.8);
    const [x, y] = this.at(...lit.cell);
    const row = [left, left + size[0]].map((end) => [end, y]); // the first clip's frame
    const column = [top, top + size[1]].map((end) => [x, end]);
    if (lit.part !== "after") paintLine(pen, row, PLAYED, 1.5);
    if (lit.part !== "before") paintLine(pen, column, PLAYED, 1.5);
    if (lit.part === "window") paintDisc(pen, [x, y], 5, PLAYED, "#222");
    ring(pen, ...this.at(pick.i, pick.j), 7, "#fff", "#222");
    pen.restore();
  }

  /**
   * Seconds along both axes, and whose they are.
   * @param {CanvasRenderingContext2D} pen
   * @param {Axes} where
   */
  ticks(pen, { fps, from, size, left, top, scale }) {
    const { first, second } = this.inspector;
    const seconds = [5, 2, 1, 0.5, 0.2, 0.1].find((s) => Math.min(...size) / (s * fps * scale) >= 3) ?? 0.1;
    /**
     * @param {number} start
     * @param {number} length
     * @param {(at: number, text: string) => void} put
     */
    const labels = (start, length, put) => {
      for (
        let k = Math.max(0, Math.ceil(start / fps / seconds - 1e-9));
        k * seconds * fps <= start + length / scale;
        k++
      ) {
        put((k * seconds * fps - start) * scale, String(Number((k * seconds).toFixed(1))));
      }
    };
    pen.textBaseline = "top";
    pen.textAlign = "center";
    labels(from[1], size[0], (x, text) => pen.fillText(text, left + x, top + size[1] + 4));
    pen.fillText(`${second.name} (s)`, left + size[0] / 2, top + size[1] + 18);
    pen.textBaseline = "middle";
    pen.textAlign = "right";
    labels(from[0], size[1], (y, text) => pen.fillText(text, left - 5, top + y));
    writeUpright(pen, `${first.name} (s)`, top + size[1] / 2);
  }
}

// A bar for each clip, along time; an arc for each transition, from a ring where it leaves to a disc where it enters.
export class GraphMap extends Map2D {
  /** @type {PackedGraph} */
  graph;
  /** @type {Clip[]} */
  clips;
  /** @type {ReturnType<typeof alongTime>} of a frame of a clip */
  positionOf;

  /**
   * @param {PackedGraph} graph
   * @param {Clip[]} clips
   */
  show(graph, clips) {
    this.graph = graph;
    this.clips = clips;
  }

  /**
   * Points of an arc.
   * @param {number[]} transition
   */
  arc([source, leave, target, enter]) {
    const ends = [this.positionOf(source, leave), this.positionOf(target, enter + this.inspector.window)];
    return arcBetween(ends[0], ends[1], [0, source === target ? -20 : 0]);
  }

  /**
   * @param {number} x
   * @param {number} y
   */
  under(x, y) {
    const far = (/** @type {number} */ number) =>
      Math.min(...this.arc(this.graph.transitions[number]).map(([u, v]) => Math.hypot(u - x, v - y)));
    const all = this.graph.transitions.map((_, n) => [far(n), n]);
    return this.transition(all.reduce((best, one) => (one[0] < best[0] ? one : best))[1]);
  }

  /**
   * Left and right go along time, by the frame that a transition leaves; up to a higher cost, down to a lower one.
   * @param {number[]} step
   * @param {number} far
   */
  step([across, down], far) {
    const all = this.graph.transitions;
    const number = Math.max(0, this.inspector.pick.number ?? 0);
    /**
     * @param {number} a
     * @param {number} b
     */
    const order = (a, b) => (across ? all[a][0] - all[b][0] || all[a][1] - all[b][1] : all[b][4] - all[a][4]);
    const sorted = all.map((_, n) => n).sort(order);
    const at = sorted.indexOf(number) + far * (across || down);
    return this.transition(sorted[Math.min(Math.max(at, 0), sorted.length - 1)]);
  }

  /**
   * @param {number} number
   * @returns {Pair}
   */
  transition(number) {
    const [first, i, second, j] = this.graph.transitions[number];
    return { first, i, second, j, number, centre: [i, j] };
  }

  /**
   * @param {MapPalette} palette
   * @param {ShownOnMap} shown
   */
  draw(palette, { pick, lit, colours }) {
    const { pen, wide, high } = sheet(this.canvas);
    const row = (high - 44) / Math.max(1, this.clips.length - 1);
    this.positionOf = alongTime(this.clips, [NAME_WIDE, wide - 12], 26, row);
    this.drawn = true;
    pen.textBaseline = "middle";
    pen.textAlign = "right";
    pen.fillStyle = palette.ink;
    this.clips.forEach((clip, k) => {
      paintLine(pen, [this.positionOf(k, 0), this.positionOf(k, clip.frames)], colours.quiet, 1);
      pen.fillText(clip.name.slice(0, 16), NAME_WIDE - 6, this.positionOf(k, 0)[1], NAME_WIDE - 8);
    });
    for (const [clip, start, end] of this.graph.spans) {
      const colour = colours.sources[clip % colours.sources.length];
      paintLine(pen, [this.positionOf(clip, start), this.positionOf(clip, end)], colour, 5);
    }
    const fade = Math.min(1, 0.15 + 30 / (this.graph.transitions.length + 1));
    for (const transition of this.graph.transitions) {
      paintLine(pen, this.arc(transition), colours.seam, 1, fade);
    }
    const arc = this.arc([pick.first, pick.i, pick.second, pick.j]);
    paintLine(pen, arc, palette.ink, 4);
    paintLine(pen, arc, colours.seam, 2.5);
    paintDisc(pen, arc[0], 4, palette.paper, colours.seam);
    paintDisc(pen, arc[arc.length - 1], 4, colours.seam, palette.ink);
    const on = {
      before: this.positionOf(pick.first, lit.cell[0]),
      window: arc[Math.round(12 * lit.fraction)],
      after: this.positionOf(pick.second, lit.cell[1]),
    };
    paintDisc(pen, on[lit.part], 5, PLAYED, "#222");
  }
}

// A walk seen from above: z upwards, x to the left; a diamond for each seam.
export class PathMap extends Map2D {
  /** @type {PackedWalk} */
  walk;
  /** @type {(point: number[]) => [number, number]} of a point [x, z] */
  positionOf;

  /** @param {PackedWalk} walk */
  show(walk) {
    this.walk = walk;
  }

  /**
   * @param {number} number
   * @returns {Pair}
   */
  seam(number) {
    const { pick, before, after, frame } = this.walk.seams[number];
    const [first, i, second, j] = pick;
    return { first, i, second, j, seam: number, before, after, frame, centre: [i, j] };
  }

  /**
   * @param {number} x
   * @param {number} y
   */
  under(x, y) {
    const offs = this.walk.seams.map(({ frame }) => {
      const [u, v] = this.positionOf(this.walk.path[frame]);
      return Math.hypot(u - x, v - y);
    });
    return this.seam(offs.indexOf(Math.min(...offs)));
  }

  /**
   * @param {number[]} step
   * @param {number} far
   */
  step([across, down], far) {
    const number = (this.inspector.pick.seam ?? 0) + far * (across || down);
    return this.seam(Math.min(Math.max(number, 0), this.walk.seams.length - 1));
  }

  /**
   * @param {MapPalette} palette
   * @param {ShownOnMap} shown
   */
  draw(palette, { pick, lit, colours }) {
    const { pen, wide, high } = sheet(this.canvas);
    const { walk } = this;
    /** @param {number[]} point */
    const turned = ([x, z]) => [-x, -z];
    const all = [...walk.path, ...walk.asked].map(turned);
    const put = mapInto(all, [MARGIN, MARGIN, wide - 2 * MARGIN, high - 2 * MARGIN], { least: 0.5 });
    this.positionOf = (point) => put(turned(point));
    this.drawn = true;
    const [asked, path] = [walk.asked, walk.path].map((points) => points.map((p) => this.positionOf(p)));
    if (asked.length) paintLine(pen, asked, palette.asked, 6, 0.75);
    paintLine(pen, path, colours.path, 2.5);
    walk.seams.forEach(({ frame }, n) => {
      const [x, y] = this.positionOf(walk.path[frame]);
      const size = n === pick.seam ? 8 : 5;
      pen.fillStyle = colours.seam;
      pen.strokeStyle = n === pick.seam ? palette.ink : palette.paper;
      pen.lineWidth = 1.5;
      pen.beginPath();
      pen.moveTo(x - size, y);
      pen.lineTo(x, y - size);
      pen.lineTo(x + size, y);
      pen.lineTo(x, y + size);
      pen.closePath();
      pen.fill();
      pen.stroke();
    });
    const at = walk.path[Math.round(lit.frame)];
    if (at) paintDisc(pen, this.positionOf(at), 5, PLAYED, "#222");
  }
}
