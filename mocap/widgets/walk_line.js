// Lines on the ground: a drawn line is smoothed and sampled every 1 cm, {z, x}, and can be written as a short word.

import { nearest } from "./walk_search.js";

/** @import { Line } from "./walk_search.js" */

const LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
const TIGHT = 0.75; // metres: the smallest radius of a circle that is walked, at some 100° per second
const CELL_OF_LINE = 0.02; // metres between points of a line that is smoothed
const SMOOTH = 0.12; // metres by which each line is smoothed
const WIDEST = 0.9; // metres: no corner is rounded by means over more
const FALL = 0.35; // by which the reach of the means may differ from point to point
const STEP = 0.05; // metres of a path that is steered
const AHEAD = 55; // points of a line to the point that a path is steered to
const SET_OUT = 0.4; // metres straight on before a path turns to a line
const STRIDE = 0.25;
const ANGLE_STEP = (Math.PI * 0.72) / 32; // a letter stands for 25 cm, and a rotation by up to 31 times 4°

/**
 * Points [z, x] at equal distances.
 * @param {number[][]} points
 * @param {number} spacing
 */
export function even(points, spacing) {
  const out = [points[0]];
  let [z, x] = points[0];
  for (const [toZ, toX] of points.slice(1)) {
    for (let far = Math.hypot(toZ - z, toX - x); far >= spacing; far = Math.hypot(toZ - z, toX - x)) {
      z += ((toZ - z) / far) * spacing;
      x += ((toX - x) / far) * spacing;
      out.push([z, x]);
    }
  }
  return out;
}

/**
 * Three means over points to both sides of each point, as many as its reach; the ends stay.
 * @param {number[][]} points
 * @param {(i: number) => number} reachOf
 */
function threeMeans(points, reachOf) {
  let line = points;
  for (let pass = 0; pass < 3; pass++) {
    const sums = [[0, 0]];
    line.forEach(([z, x], i) => sums.push([sums[i][0] + z, sums[i][1] + x]));
    line = line.map((_, i) => {
      const reach = Math.min(reachOf(i), i, line.length - 1 - i);
      const [a, b] = [sums[i - reach], sums[i + reach + 1]];
      return [(b[0] - a[0]) / (2 * reach + 1), (b[1] - a[1]) / (2 * reach + 1)];
    });
  }
  return line;
}

/**
 * Smooth a line by means over twice `metres`; the ends stay.
 * @param {number[][]} points
 * @param {number} metres
 */
export function smooth(points, metres) {
  const reach = Math.round(metres / CELL_OF_LINE);
  return even(
    threeMeans(even(points, CELL_OF_LINE), () => reach),
    0.01,
  );
}

/**
 * The points at which a line bends more than clips can follow, measured over some 30 cm.
 * @param {number[][]} line
 */
function tightPoints(line) {
  const step = Math.round(0.15 / CELL_OF_LINE);
  /** @param {number} i */
  const chord = (i) => [line[i + step][0] - line[i][0], line[i + step][1] - line[i][1]];
  /** @type {number[]} */
  const tight = [];
  for (let i = step; i + step < line.length; i++) {
    const [before, after] = [chord(i - step), chord(i)];
    const change = Math.atan2(
      before[0] * after[1] - before[1] * after[0],
      before[0] * after[0] + before[1] * after[1],
    );
    const length = (Math.hypot(...before) + Math.hypot(...after)) / 2;
    if (Math.abs(change) > length / TIGHT) tight.push(i);
  }
  return tight;
}

/**
 * Round a line where it bends more than clips can follow, and leave it as it is elsewhere. Where it comes back on itself,
 * it is steered along, and makes a loop.
 * @param {number[][]} points
 */
export function walkable(points) {
  const drawn = even(points, CELL_OF_LINE);
  const reach = drawn.map(() => SMOOTH / CELL_OF_LINE);
  const widest = WIDEST / CELL_OF_LINE;
  while (Math.max(...reach) <= widest) {
    const line = threeMeans(drawn, (i) => Math.round(reach[i]));
    const tight = tightPoints(line);
    if (!tight.length) return even(line, 0.01);
    for (const i of tight) reach[i] *= 1.12;
    // Further away the reach falls slowly, so that the line has no kink.
    for (let i = 1; i < reach.length; i++) reach[i] = Math.max(reach[i], reach[i - 1] - FALL);
    for (let i = reach.length - 2; i >= 0; i--) reach[i] = Math.max(reach[i], reach[i + 1] - FALL);
  }
  const [start, ahead] = [drawn[0], drawn[Math.min(20, drawn.length - 1)]];
  const { path } = steer(smooth(drawn, SMOOTH), start, Math.atan2(ahead[1] - start[1], ahead[0] - start[0]));
  return smooth(path, SMOOTH);
}

/**
 * Go along a line with a curvature that clips can follow, always towards a point ahead on it. Return the path, and the
 * index of the point of the line at its end.
 * @param {number[][]} line
 * @param {number[]} position
 * @param {number} heading
 * @param {{ setOut?: number, joins?: number, farthest?: number }} limits metres: straight on at first, how near the path
 *   comes to the line until it ends, and its length
 */
function steer(line, [z, x], heading, { setOut = 0, joins = -1, farthest = Infinity } = {}) {
  const path = [[z, x]];
  const at = arrays(line);
  const longest = Math.min(farthest, 0.02 * line.length + 5); // a path that does not come to the end has an end
  let k = 0;
  let distance = Infinity;
  for (let far = 0; far < longest && k + 8 < line.length && distance > joins; far += STEP) {
    if (far >= setOut) {
      k = Math.max(nearest(at, [z, x], k, k + 30), setOut ? k : Math.min(k + 2, line.length - 1));
      distance = Math.hypot(line[k][0] - z, line[k][1] - x);
      const [toZ, toX] = line[Math.min(k + AHEAD, line.length - 1)];
      const wanted = Math.atan2(toX - x, toZ - z) - heading;
      const turn = Math.atan2(Math.sin(wanted), Math.cos(wanted));
      heading += Math.max(-STEP / TIGHT, Math.min(turn, STEP / TIGHT));
    }
    [z, x] = [z + STEP * Math.cos(heading), x + STEP * Math.sin(heading)];
    path.push([z, x]);
  }
  return { path, k };
}

/**
 * A path from a position onto a line: straight on until clips can have begun to turn, then with a curvature that they
 * can follow.
 * @param {number[][]} line
 * @param {number[]} position
 * @param {number} heading
 */
export function pathOnto(line, position, heading) {
  const { path, k } = steer(line, position, heading, { setOut: SET_OUT, joins: 0.02, farthest: 12 });
  return smooth([...path, ...line.slice(k + 5)], SMOOTH);
}

/**
 * The mean distance of points from those of a track, metres.
 * @param {number[][]} points
 * @param {number[][]} track
 */
export function meanDistance(points, track) {
  const all = arrays(track);
  const thin = points.filter((_, i) => i % 5 === 0);
  return thin.reduce((sum, point) => sum + distanceTo(all, point), 0) / thin.length;
}

/**
 * The largest distance of points from a line, metres.
 * @param {number[][]} points
 * @param {number[][]} line
 */
export function roundedBy(points, line) {
  const all = arrays(line.filter((_, i) => i % 3 === 0));
  return Math.max(0, ...points.filter((_, i) => i % 5 === 0).map((point) => distanceTo(all, point)));
}

/**
 * @param {Line} line
 * @param {number[]} point
 */
function distanceTo(line, [z, x]) {
  const k = nearest(line, [z, x]);
  return Math.hypot(line.z[k] - z, line.x[k] - x);
}

/** @param {number[][]} line */
export const arrays = (line) => ({
  z: Float64Array.from(line, (p) => p[0]),
  x: Float64Array.from(line, (p) => p[1]),
});

/**
 * The first direction in two letters, then a letter for each 25 cm.
 * @param {number[][]} line
 */
export function written(line) {
  const points = even(line, 0.02);
  const ahead = points[Math.min(10, points.length - 1)];
  let [z, x] = points[0];
  let k = 0;
  let text = "";
  const first = Math.floor((Math.atan2(ahead[1] - x, ahead[0] - z) / (2 * Math.PI) + 1) * 4096) % 4096;
  let angle = (first / 4096) * 2 * Math.PI;
  while (k < points.length - 8) {
    while (k < points.length - 1 && Math.hypot(points[k][0] - z, points[k][1] - x) < STRIDE) k++;
    const wanted = Math.atan2(points[k][1] - x, points[k][0] - z) - angle;
    const steps = Math.max(
      -31,
      Math.min(31, Math.round(Math.atan2(Math.sin(wanted), Math.cos(wanted)) / ANGLE_STEP)),
    );
    angle += steps * ANGLE_STEP;
    z += STRIDE * Math.cos(angle);
    x += STRIDE * Math.sin(angle);
    text += LETTERS[steps + 31];
  }
  return LETTERS[first >> 6] + LETTERS[first & 63] + text;
}

/**
 * Read a word as a line; null if it is not one.
 * @param {string} text
 */
export function read(text) {
  const numbers = [...text].map((letter) => LETTERS.indexOf(letter));
  if (numbers.length < 6 || numbers.length > 2000 || numbers.includes(-1)) return null;
  let angle = ((numbers[0] * 64 + numbers[1]) / 4096) * 2 * Math.PI;
  const points = [[0, 0]];
  for (const number of numbers.slice(2)) {
    angle += (number - 31) * ANGLE_STEP;
    const [z, x] = points[points.length - 1];
    points.push([z + STRIDE * Math.cos(angle), x + STRIDE * Math.sin(angle)]);
  }
  return smooth(points, SMOOTH);
}

export function firstLine() {
  // loops, as a pen tries them
  const points = [];
  for (let t = -1.2; t <= 13.4; t += 0.02) {
    points.push([1.55 * Math.cos(t) * (1 - 0.02 * t), 0.62 * t - 1.5 * Math.sin(t) - 3.8]);
  }
  return smooth(points, 0.1);
}
