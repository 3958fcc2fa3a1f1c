// Lines on the ground: what a hand drew becomes smooth points 1 cm apart, {z, x}; and a line as a short word.

import { nearest } from "./walk_search.js";

const LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
const TIGHT = 0.8; // metres: nobody walks on a smaller circle
const SET_OUT = 0.9; // metres that clips take to begin a turn
const STRIDE = 0.25;
const TURN = (Math.PI * 0.72) / 32; // a letter goes 25 cm, and turns by up to 31 times 4°

/**
 * Points [z, x] at equal distances.
 * @param {number[][]} points
 * @param {number} gap
 */
export function even(points, gap) {
  const out = [points[0]];
  let [z, x] = points[0];
  for (const [toZ, toX] of points.slice(1)) {
    for (let far = Math.hypot(toZ - z, toX - x); far >= gap; far = Math.hypot(toZ - z, toX - x)) {
      z += ((toZ - z) / far) * gap;
      x += ((toX - x) / far) * gap;
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
  const most = Math.round(metres / 0.02);
  for (let pass = 0; pass < 3; pass++) {
    const sums = [[0, 0]];
    line.forEach(([z, x], i) => sums.push([sums[i][0] + z, sums[i][1] + x]));
    line = line.map((_, i) => {
      const reach = Math.min(most, i, line.length - 1 - i);
      const [a, b] = [sums[i - reach], sums[i + reach + 1]];
      return [(b[0] - a[0]) / (2 * reach + 1), (b[1] - a[1]) / (2 * reach + 1)];
    });
  }
  return even(line, 0.01);
}

/**
 * Turn per metre, over 30 cm.
 * @param {number[][]} line
 */
function sharpest(line) {
  /** @param {number} i */
  const way = (i) => Math.atan2(line[i + 10][1] - line[i - 10][1], line[i + 10][0] - line[i - 10][0]);
  let most = 0;
  for (let i = 10; i + 40 < line.length; i += 5) {
    const turn = way(i + 30) - way(i);
    most = Math.max(most, Math.abs(Math.atan2(Math.sin(turn), Math.cos(turn))) / 0.3);
  }
  return most;
}

/**
 * Smooth a line until it asks for no circle that is too tight.
 * @param {number[][]} points
 */
export function walkable(points) {
  let line = smooth(points, 0.12);
  for (let reach = 0.17; sharpest(line) > 1 / TIGHT && reach < 0.9; reach *= 1.35) {
    line = smooth(points, reach);
  }
  return line;
}

/**
 * A way from a place onto a line: straight on until clips have begun a turn, then by turns that can be walked
 * towards a place 70 cm further along the line.
 * @param {number[][]} line
 * @param {number[]} place
 * @param {number} heading
 */
export function ledOnto(line, [z, x], heading) {
  const way = [];
  const at = arrays(line);
  let k = 0;
  let off = Infinity;
  for (let far = 0; far < 12 && k + 30 < line.length && off > 0.02; far += 0.05) {
    way.push([z, x]);
    if (far > SET_OUT) {
      k = nearest(at, [z, x], k, k + 30);
      off = Math.hypot(line[k][0] - z, line[k][1] - x);
      const [toZ, toX] = line[Math.min(k + 70, line.length - 1)];
      const wanted = Math.atan2(toX - x, toZ - z) - heading;
      heading += Math.max(
        -0.05 / TIGHT,
        Math.min(Math.atan2(Math.sin(wanted), Math.cos(wanted)), 0.05 / TIGHT),
      );
    }
    [z, x] = [z + 0.05 * Math.cos(heading), x + 0.05 * Math.sin(heading)];
  }
  return smooth([...way, ...line.slice(k + 5)], 0.12);
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
    const turn = Math.max(
      -31,
      Math.min(31, Math.round(Math.atan2(Math.sin(wanted), Math.cos(wanted)) / TURN)),
    );
    angle += turn * TURN;
    z += STRIDE * Math.cos(angle);
    x += STRIDE * Math.sin(angle);
    text += LETTERS[turn + 31];
  }
  return LETTERS[first >> 6] + LETTERS[first & 63] + text;
}

/**
 * Null where the word is no line.
 * @param {string} text
 */
export function read(text) {
  const numbers = [...text].map((letter) => LETTERS.indexOf(letter));
  if (numbers.length < 6 || numbers.length > 2000 || numbers.includes(-1)) return null;
  let angle = ((numbers[0] * 64 + numbers[1]) / 4096) * 2 * Math.PI;
  const points = [[0, 0]];
  for (const number of numbers.slice(2)) {
    angle += (number - 31) * TURN;
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
