// Lines and discs on a canvas, and where the points of its maps are: what pages and widgets draw alike.

/** @typedef {CanvasRenderingContext2D | OffscreenCanvasRenderingContext2D} Pen */

/**
 * The pen of a canvas.
 * @param {HTMLCanvasElement} canvas
 * @param {CanvasRenderingContext2DSettings} [settings]
 */
export function penOf(canvas, settings) {
  const pen = canvas.getContext("2d", settings);
  if (!pen) throw new Error("The browser draws on no canvas.");
  return pen;
}

/**
 * Clear a canvas, and give it as many pixels as the screen has there; sizes are then in pixels of the page.
 * @param {HTMLCanvasElement} canvas
 */
export function clearedPen(canvas) {
  const sharp = devicePixelRatio || 1;
  const size = [canvas.clientWidth, canvas.clientHeight];
  const pixels = size.map((length) => Math.round(length * sharp));
  if (canvas.width !== pixels[0] || canvas.height !== pixels[1]) [canvas.width, canvas.height] = pixels;
  const pen = penOf(canvas);
  pen.setTransform(sharp, 0, 0, sharp, 0, 0);
  pen.clearRect(0, 0, size[0], size[1]);
  pen.lineCap = "round";
  pen.lineJoin = "round";
  return { pen, wide: size[0], high: size[1] };
}

/**
 * Stroke the current path of a pen.
 * @param {Pen} pen
 * @param {string} colour
 * @param {number} width
 * @param {number} alpha
 */
export function paintStroke(pen, colour, width, alpha = 1) {
  pen.globalAlpha = alpha;
  pen.strokeStyle = colour;
  pen.lineWidth = width;
  pen.stroke();
  pen.globalAlpha = 1;
}

/**
 * A line through points [x, y].
 * @param {Pen} pen
 * @param {number[][]} points
 * @param {string} colour
 * @param {number} width
 * @param {number} alpha
 */
export function paintLine(pen, points, colour, width = 1, alpha = 1) {
  pen.beginPath();
  points.forEach(([x, y], k) => (k ? pen.lineTo(x, y) : pen.moveTo(x, y)));
  paintStroke(pen, colour, width, alpha);
}

/**
 * A disc, with an edge if it has a colour.
 * @param {CanvasRenderingContext2D} pen
 * @param {number[]} centre
 * @param {number} radius
 * @param {string} colour
 * @param {string | null} edge
 */
export function paintDisc(pen, [x, y], radius, colour, edge = null) {
  pen.beginPath();
  pen.arc(x, y, radius, 0, 2 * Math.PI);
  pen.fillStyle = colour;
  pen.fill();
  if (edge !== null) paintStroke(pen, edge, 1.5);
}

/**
 * A map of points [x, y] into a box [left, top, width, height] of a canvas, as large as fits with the same scale on both
 * axes. An extent below `least` does not fill the box. `align` is where points stand that do not fill it: from 0, left
 * or at the top, to 1, right or at the bottom.
 * @param {number[][]} points
 * @param {number[]} box
 * @param {{ least: number, align?: number[] }} how
 * @returns {(point: number[]) => [number, number]}
 */
export function mapInto(points, [left, top, wide, high], { least, align = [0.5, 0.5] }) {
  const [[x0, x1], [y0, y1]] = [0, 1].map((k) => {
    const values = points.map((point) => point[k]);
    return [Math.min(...values), Math.max(...values)];
  });
  const scale = Math.min(wide / Math.max(x1 - x0, least), high / Math.max(y1 - y0, least));
  const x = left + align[0] * (wide - (x1 - x0) * scale);
  const y = top + align[1] * (high - (y1 - y0) * scale);
  return (point) => [x + (point[0] - x0) * scale, y + (point[1] - y0) * scale];
}

/**
 * Where frames of clips are along time: a row for each clip, the longest from the left to the right.
 * @param {{ frames: number }[]} clips
 * @param {number[]} ends
 * @param {number} top
 * @param {number} row
 * @returns {(clip: number, frame: number) => [number, number]}
 */
export function alongTime(clips, [left, right], top, row) {
  const longest = Math.max(...clips.map(({ frames }) => frames));
  return (clip, frame) => [left + ((right - left) * frame) / longest, top + row * clip];
}

/**
 * Points of an arc from a to b, whose middle is moved aside by x and y.
 * @param {number[]} a
 * @param {number[]} b
 * @param {number[]} aside
 * @returns {number[][]}
 */
export function arcBetween(a, b, aside) {
  return Array.from({ length: 13 }, (_, k) => k / 12).map((t) =>
    [0, 1].map((c) => a[c] + t * (b[c] - a[c]) + 4 * t * (1 - t) * aside[c]),
  );
}
