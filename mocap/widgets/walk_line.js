// Lines on the ground: a drawn line is smoothed and sampled every 1 cm, {z, x}, and can be written as a short word.

import { nearest } from "./walk_search.js";

const LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
const TIGHT = 0.8; // metres: the smallest radius of a circle that the clips can follow
const SET_OUT = 0.9; // metres that clips need until they begin to turn
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
 * Three means over twice `metres`; the ends stay.
 * @param {number[][]} points
 * @param {number} metres
 */
export function smooth(points, metres) {
  let line = even(points, 0.02);
  const halfWidth = Math.round(metres / 0.02);
  for (let pass = 0; pass < 3; pass++) {
    const sums = [[0, 0]];
    line.forEach(([z, x], i) => sums.push([sums[i][0] + z, sums[i][1] + x]));
    line = line.map((_, i) => {
      const reach = Math.min(halfWidth, i, line.length - 1 - i);
      const [a, b] = [sums[i - reach], sums[i + reach + 1]];
      return [(b[0] - a[0]) / (2 * reach + 1), (b[1] - a[1]) / (2 * reach + 1)];
    });
  }
  return even(line, 0.01);
}

/**
 * The largest curvature, 1/m, measured over 30 cm.
 * @param {number[][]} line
 */
function largestCurvature(line) {
  /** @param {number} i */
  const headingAt = (i) => Math.atan2(line[i + 10][1] - line[i - 10][1], line[i + 10][0] - line[i - 10][0]);
  let largest = 0;
  for (let i = 10; i + 40 < line.length; i += 5) {
    const change = headingAt(i + 30) - headingAt(i);
    largest = Math.max(largest, Math.abs(Math.atan2(Math.sin(change), Math.cos(change))) / 0.3);
  }
  return largest;
}

/**
 * Smooth a line until its curvature is small enough for the clips.
 * @param {number[][]} points
 */
export function walkable(points) {
  let line = smooth(points, 0.12);
  for (let reach = 0.17; largestCurvature(line) > 1 / TIGHT && reach < 0.9; reach *= 1.35) {
    line = smooth(points, reach);
  }
  return line;
}

/**
 * A path from a position onto a line: straight on until clips can have begun to turn, then with a curvature that they
 * can follow, towards a point 70 cm further along the line.
 * @param {number[][]} line
 * @param {number[]} position
 * @param {number} heading
 */
export function pathOnto(line, [z, x], heading) {
  const path = [];
  const at = arrays(line);
  let k = 0;
  let distance = Infinity;
  for (let far = 0; far < 12 && k + 30 < line.length && distance > 0.02; far += 0.05) {
    path.push([z, x]);
    if (far > SET_OUT) {
      k = nearest(at, [z, x], k, k + 30);
      distance = Math.hypot(line[k][0] - z, line[k][1] - x);
      const [toZ, toX] = line[Math.min(k + 70, line.length - 1)];
      const wanted = Math.atan2(toX - x, toZ - z) - heading;
      heading += Math.max(
        -0.05 / TIGHT,
        Math.min(Math.atan2(Math.sin(wanted), Math.cos(wanted)), 0.05 / TIGHT),
      );
    }
    [z, x] = [z + 0.05 * Math.cos(heading), x + 0.05 * Math.sin(heading)];
  }
  return smooth([...path, ...line.slice(k + 5)], 0.12);
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
  return smooth(points, 0.12);
}

export function firstLine() {
  // loops, as a pen tries them
  const points = [];
  for (let t = -1.2; t <= 13.4; t += 0.02) {
    points.push([1.55 * Math.cos(t) * (1 - 0.02 * t), 0.62 * t - 1.5 * Math.sin(t) - 3.8]);
  }
  return smooth(points, 0.1);
}
