// Overviews: a small one of the line with the figure above the clips as bars, and the graph of the story.

import { alongTime, arcBetween, clearedPen, mapInto, paintDisc, paintLine } from "./canvas.js";
import { edgeAt } from "./walk_body.js";
import { COLOURS } from "./walk_scene.js";

/**
 * @import { Page } from "./walk_page.js"
 *
 * The pen of the overview, and its size.
 * @typedef {ReturnType<typeof clearedPen>} Cleared
 */

/**
 * Draw it, a square for the line, and the clips below.
 * @param {Page} page
 * @param {HTMLCanvasElement} canvas
 */
export function drawSmall(page, canvas) {
  const cleared = clearedPen(canvas);
  if (!page.walk.frames) return;
  drawLine(page, cleared);
  drawClips(page, cleared);
}

const ARCS = 260; // transitions of the graph that are drawn
const NAMES_FROM = 15; // pixels of a row in which the name of a clip can be read
const LABEL = 12; // pixels
const MARGIN = 8; // pixels

/**
 * The line from above, and where the figure is.
 * @param {Page} page
 * @param {Cleared} cleared
 */
function drawLine(page, { pen, wide }) {
  const { z, x } = page.line;
  const points = Array.from(z, (pz, i) => [x[i], pz]);
  const put = mapInto(points, [0.05 * wide, 0.05 * wide, 0.9 * wide, 0.9 * wide], { least: 0.1 });
  const [walkingZ, walkingX] = page.position();
  const line = points.filter((_, i) => i % 6 === 0).map(put);
  paintLine(pen, line, page.look.line, wide / 50);
  paintDisc(pen, put([walkingX, walkingZ]), wide / 24, page.look.ink);
}

/**
 * The clips along time, and the last edges of the walk, which fade.
 * @param {Page} page
 * @param {Cleared} cleared
 */
function drawClips({ walk, look, about, time }, { pen, wide, high }) {
  const { clips } = about;
  const row = (high - wide) / (clips.length + 0.5);
  const spot = alongTime(clips, [0.02 * wide, 0.98 * wide], wide + row / 2, row);
  clips.forEach((clip, n) => {
    paintLine(pen, [spot(n, 0), spot(n, clip.frames)], COLOURS[n % COLOURS.length], row * 0.35, 0.35);
  });
  const [now, elapsed] = edgeAt(walk, time);
  for (let at = Math.max(0, now - 40); at <= now; at++) {
    const { seam, frames, start, end } = walk.edges[at];
    const fade = Math.max(0, Math.min(1, 1 - (time - walk.begins[at] - frames) / 120));
    const from = spot(start.clip, start.frame);
    if (seam) {
      const arc = arcBetween(from, spot(end.clip, end.frame), [row / 2, 0]);
      paintLine(pen, arc, look.ink, row * 0.12, fade);
    } else {
      const to = spot(start.clip, start.frame + (at === now ? Math.min(frames, elapsed) : frames));
      paintLine(pen, [from, to], COLOURS[start.clip % COLOURS.length], row * 0.6, fade);
    }
  }
}

/** @type {{ canvas: OffscreenCanvas, size: string } | null} what of the graph does not move */
let still = null;

/**
 * Draw the graph: clips along time, their transitions as arcs, and the path of the walk through it until now.
 * @param {Page} page
 * @param {HTMLCanvasElement} canvas
 */
export function drawNet(page, canvas) {
  const cleared = clearedPen(canvas);
  const { pen, wide, high } = cleared;
  const { walk, about, time, look } = page;
  const row = high / (about.clips.length + 0.2);
  const spot = alongTime(about.clips, [MARGIN, wide - MARGIN], 0.75 * row, row);
  const size = [canvas.width, canvas.height, look.ink].join(" ");
  if (still?.size !== size) still = { canvas: stillNet(page, canvas, cleared, row, spot), size };
  pen.drawImage(still.canvas, 0, 0, wide, high);
  const [now, elapsed] = edgeAt(walk, time);
  const first = walk.begins.findIndex((begin) => begin >= walk.since);
  for (let at = Math.max(0, first); at <= now; at++) {
    const { seam, start, end, frames } = walk.edges[at];
    const from = spot(start.clip, start.frame);
    if (seam) {
      paintLine(pen, arcBetween(from, spot(end.clip, end.frame), [row / 2, 0]), look.ink, 1.5, 0.9);
    } else {
      const to = spot(start.clip, start.frame + (at === now ? Math.min(frames, elapsed) : frames));
      paintLine(pen, [from, to], COLOURS[start.clip % COLOURS.length], 5);
      if (at === now) paintDisc(pen, to, 6, look.ink);
    }
  }
}

/**
 * The names of the clips, their bars and transitions.
 * @param {Page} page
 * @param {HTMLCanvasElement} canvas
 * @param {Cleared} cleared
 * @param {number} row
 * @param {(clip: number, frame: number) => number[]} spot
 */
function stillNet({ graph, about, look }, canvas, { wide, high }, row, spot) {
  const copy = new OffscreenCanvas(canvas.width, canvas.height);
  const pen = /** @type {OffscreenCanvasRenderingContext2D} */ (copy.getContext("2d"));
  pen.scale(canvas.width / wide, canvas.height / high);
  pen.lineCap = "round";
  const seams = graph.edges.filter((edge) => edge.seam);
  const step = Math.max(1, Math.floor(seams.length / ARCS));
  for (const { start, end } of seams.filter((_, i) => i % step === 0)) {
    const arc = arcBetween(spot(start.clip, start.frame), spot(end.clip, end.frame), [row / 2, 0]);
    paintLine(pen, arc, look.ink, 0.7, 0.16);
  }
  pen.font = `${LABEL}px system-ui, sans-serif`;
  about.clips.forEach(({ name, frames }, n) => {
    paintLine(pen, [spot(n, 0), spot(n, frames)], COLOURS[n % COLOURS.length], 3, 0.55);
    const [x, y] = spot(n, 0);
    pen.fillStyle = look.ink;
    if (row >= NAMES_FROM) pen.fillText(name.replaceAll("_", " "), x, y - 5);
  });
  return copy;
}
