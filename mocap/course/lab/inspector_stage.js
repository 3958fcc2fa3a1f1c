// The stage, where the bodies of two windows and of their blend stand, and the chart below it, on the same clock.
// `Picture` and its colours for light and dark pages are the player's.

import { sheet, writeUpright } from "./inspector_maps.js";
import { paintDisc, paintLine } from "../../widgets/canvas.js";
import { Picture, sideOf } from "../../widgets/player_picture.js";
import { whenPointed } from "../../widgets/touch.js";

/**
 * @import { MapPalette } from "./inspector_maps.js"
 * @import { Skeleton } from "./inspector_maths.js"
 *
 * Points [x, y] of a curve; null is a gap.
 * @typedef {{ points: [number, number | null][], colour: string, width: number, alpha?: number }} Curve
 *
 * What a chart shows.
 * @typedef {object} Plot
 * @property {Curve[]} curves
 * @property {[number, number | null]} at where the reader is
 * @property {string} across what the axis shows
 * @property {string} up what the curves show
 * @property {number[]} span the ends of the axis
 * @property {[from: number, to: number, colour: string][]} [bands]
 * @property {Bar[]} [bars]
 *
 * @typedef {[from: number, to: number, row: number, colour: string]} Bar
 */

export class Stage extends Picture {
  /**
   * Look at a target from the side of the body, at a distance, unless the reader has rotated the view.
   * @param {number[]} target
   * @param {number} heading
   * @param {number} distance
   * @param {boolean} turned
   */
  look(target, heading, distance, turned) {
    const [wide, high] = this.clear();
    if (!turned) this.camera.yaw = heading - Math.PI / 2 + 0.5;
    this.camera.place(target, distance, wide, high);
    this.drawGround(target, distance);
  }

  /**
   * One body; a second clip's is dashed, a ghost is pale.
   * @param {Skeleton} skeleton
   * @param {number[][]} positions
   * @param {{ alpha?: number, dashed?: boolean, wide?: number }} how
   */
  body({ bones, head }, positions, { alpha = 1, dashed = false, wide = 0.036 } = {}) {
    const character = { bones };
    const pose = Float32Array.from(positions.flat());
    this.pen.setLineDash(dashed ? [7, 5] : []);
    [0, 1, 2].forEach((side) =>
      this.strokeBones(
        pose,
        sideOf(character, side),
        side ? this.sides[side] : this.palette.ink,
        wide,
        alpha,
      ),
    );
    this.pen.setLineDash([]);
    if (head !== null) this.disc(positions[head], 0.09, this.palette.ink, alpha * (dashed ? 0.45 : 1), false);
  }

  /**
   * @param {Skeleton} skeleton
   * @param {number[][]} positions
   */
  shadow({ bones }, positions) {
    this.strokeBones(Float32Array.from(positions.flat()), bones, this.palette.shadow, 0.05, 0.15, true);
  }

  /**
   * @param {number[][][]} pairs
   * @param {string} colour
   */
  threads(pairs, colour) {
    this.stroke(pairs, colour, 2, 0.9);
  }

  /**
   * The path of a foot: pale, strong up to now, thick during contacts.
   * @param {number[][]} positions
   * @param {number[]} contacts
   * @param {number} now
   * @param {number} side
   */
  traceFoot(positions, contacts, now, side) {
    const colour = this.sides[side];
    this.stroke([positions], colour, 1.5, 0.3);
    this.stroke([positions.slice(0, now + 1)], colour, 2.5, 0.9);
    positions.forEach((position, f) => {
      if (f <= now && contacts[f]) this.disc(position, 0.028, colour, 0.5, true);
    });
  }
}

// A chart: curves over one axis, with a mark where the reader is; a finger on it moves the mark.
export class Chart {
  /** @type {number[] | undefined} the ends of its axis */
  span;

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {(value: number) => void} move
   */
  constructor(canvas, move) {
    this.canvas = canvas;
    whenPointed(canvas, ({ offsetX }) => {
      if (this.span) {
        move(this.span[0] + ((offsetX - 46) / (canvas.clientWidth - 60)) * (this.span[1] - this.span[0]));
      }
    });
  }

  /**
   * @param {Plot} plot
   * @param {MapPalette} palette
   */
  draw({ curves, at, across, up, span, bands = [], bars = [] }, palette) {
    this.span = span;
    const { pen, wide, high } = sheet(this.canvas);
    const left = 46;
    const bottom = high - 32;
    const top = 12;
    const highest = Math.max(1e-9, ...curves.flatMap(({ points }) => points.map(([, y]) => y ?? 0))) * 1.08;
    /** @param {number} v */
    const x = (v) => left + ((wide - left - 14) * (v - span[0])) / (span[1] - span[0] || 1);
    /** @param {number} v */
    const y = (v) => bottom - ((bottom - top) * v) / highest;
    for (const [from, to, colour] of bands) {
      pen.globalAlpha = 0.2;
      pen.fillStyle = colour;
      pen.fillRect(x(from), top, x(to) - x(from), bottom - top);
      pen.globalAlpha = 1;
    }
    bars.forEach(([from, to, row, colour]) => {
      pen.fillStyle = colour;
      pen.fillRect(x(from), 1 + 5 * row, Math.max(1, x(to) - x(from)), 4);
    });
    const axes = [
      [left, top],
      [left, bottom],
      [wide - 14, bottom],
    ];
    paintLine(pen, axes, palette.ink, 1, 0.6);
    for (const { points, colour, width, alpha } of curves) {
      const seen = points.flatMap(([u, v]) => (v === null ? [] : [[x(u), y(v)]]));
      paintLine(pen, seen, colour, width, alpha);
    }
    pen.fillStyle = palette.ink;
    pen.textBaseline = "top";
    pen.textAlign = "center";
    for (const u of ticks(span, wide < 330 ? 4 : 6)) pen.fillText(spoken(u), x(u), bottom + 4);
    pen.fillText(across, left + (wide - left - 14) / 2, bottom + 18);
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    for (const v of ticks([0, highest], 3)) pen.fillText(spoken(v), left - 5, y(v));
    writeUpright(pen, up, (top + bottom) / 2);
    const here = x(at[0]);
    paintLine(
      pen,
      [top, bottom].map((end) => [here, end]),
      palette.ink,
      1,
      0.5,
    );
    if (at[1] !== null) paintDisc(pen, [here, y(at[1])], 4, palette.ink, palette.paper);
  }
}

/** @param {number} v */
const spoken = (v) => String(Number(v.toFixed(2))).replace("-", "−");

/**
 * Round numbers in a span, about `count` of them.
 * @param {number[]} span
 * @param {number} count
 */
function ticks([low, high], count) {
  const raw = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step =
    [45, 90].find((s) => high - low === 360 && s * count >= 360) ??
    [1, 2, 5].map((n) => n * power).find((s) => s >= raw) ??
    10 * power;
  const first = Math.ceil((low - 1e-9) / step);
  const last = Math.floor((high + 1e-9) / step);
  return Array.from({ length: last - first + 1 }, (_, k) => (first + k) * step);
}
