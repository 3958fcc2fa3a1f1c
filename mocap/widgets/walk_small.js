// A small overview: the line with the figure, and the clips as bars, with the current one highlighted and seams as arcs.

import { edgeAt } from "./walk_body.js";
import { COLOURS, flatPen } from "./walk_scene.js";

/** @import { Page } from "./walk_page.js" */

/**
 * Draw it, a square for the line, and the clips below.
 * @param {Page} page
 * @param {HTMLCanvasElement} canvas
 */
export function drawSmall(page, canvas) {
  const { walk, look, about } = page;
  const ratio = Math.min(devicePixelRatio, 2);
  const width = canvas.clientWidth * ratio;
  const height = canvas.clientHeight * ratio;
  const pen = flatPen(canvas);
  if (canvas.width !== width) Object.assign(canvas, { width, height });
  pen.clearRect(0, 0, width, height);
  if (!walk.frames || page.stroke) return;
  const { z, x } = page.line;
  const size = width * 0.9;
  const [z0, z1, x0, x1] = [Math.min(...z), Math.max(...z), Math.min(...x), Math.max(...x)];
  const scale = size / Math.max(z1 - z0, x1 - x0, 0.1);
  /**
   * @param {number} pz
   * @param {number} px
   * @returns {[number, number]}
   */
  const put = (pz, px) => [
    width / 2 + (px - (x0 + x1) / 2) * scale,
    width / 2 + (pz - (z0 + z1) / 2) * scale,
  ];
  pen.lineWidth = width / 50;
  pen.lineCap = "round";
  pen.lineJoin = "round";
  pen.strokeStyle = look.line;
  pen.beginPath();
  for (let i = 0; i < z.length; i += 6) pen.lineTo(...put(z[i], x[i]));
  pen.stroke();
  pen.fillStyle = look.ink;
  pen.beginPath();
  const [walkingZ, walkingX] = page.position();
  pen.arc(...put(walkingZ, walkingX), width / 24, 0, 7);
  pen.fill();
  const { clips } = about;
  const longest = Math.max(...clips.map((clip) => clip.frames));
  const row = (height - width) / (clips.length + 0.5);
  const top = width + row / 2;
  /**
   * @param {number} clip
   * @param {number} frame
   * @returns {[number, number]}
   */
  const spot = (clip, frame) => [(frame / longest) * width * 0.96 + width * 0.02, top + clip * row];
  clips.forEach((clip, n) => {
    pen.globalAlpha = 0.35;
    pen.lineWidth = row * 0.35;
    pen.strokeStyle = COLOURS[n % 7];
    pen.beginPath();
    pen.moveTo(...spot(n, 0));
    pen.lineTo(...spot(n, clip.frames));
    pen.stroke();
  });
  const [now, elapsed] = edgeAt(walk, page.time);
  for (let at = Math.max(0, now - 40); at <= now; at++) {
    const edge = walk.edges[at];
    const fade = Math.max(0, Math.min(1, 1 - (page.time - walk.begins[at] - edge.frames) / 120));
    const colour = COLOURS[edge.start.clip % 7];
    pen.globalAlpha = fade;
    pen.strokeStyle = edge.seam ? look.ink : colour;
    pen.lineWidth = edge.seam ? row * 0.12 : row * 0.6;
    pen.beginPath();
    pen.moveTo(...spot(edge.start.clip, edge.start.frame));
    if (edge.seam) {
      const [ax, ay] = spot(edge.start.clip, edge.start.frame);
      const [bx, by] = spot(edge.end.clip, edge.end.frame);
      pen.quadraticCurveTo((ax + bx) / 2 + row, (ay + by) / 2, bx, by);
    } else {
      const played = at === now ? Math.min(edge.frames, elapsed) : edge.frames;
      pen.lineTo(...spot(edge.start.clip, edge.start.frame + played));
    }
    pen.stroke();
  }
  pen.globalAlpha = 1;
}
