// A small overview: the line with the figure, and the clips as bars, with the current one highlighted and seams as arcs.

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
