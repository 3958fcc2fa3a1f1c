// The stage, where the bodies of two windows and of their blend stand, and the chart below it, on the same clock.
// `Picture` and its colours for light and dark pages are the player's.

class Stage extends Picture {
  // Look at a place from the side of the body, as far away as it takes; the reader's own turns come on top.
  look(target, heading, distance, turned) {
    const [wide, high] = this.clear();
    if (!turned) this.camera.yaw = heading - Math.PI / 2 + 0.5;
    this.camera.place(target, distance, wide, high);
    this.drawGround(target, distance);
  }

  // One body; a second clip's is dashed, a ghost is pale.
  body({ bones, head }, places, { alpha = 1, dashed = false, wide = 0.036 } = {}) {
    const ends = (side) => bones.filter((bone) => bone[2] === side).map(([from, to]) => [places[from], places[to]]);
    this.pen.setLineDash(dashed ? [7, 5] : []);
    [0, 1, 2].forEach((side) => this.stroke(ends(side), side ? this.sides[side] : this.palette.ink, wide, alpha, true));
    this.pen.setLineDash([]);
    if (head !== null) this.disc(places[head], 0.09, this.palette.ink, alpha * (dashed ? 0.45 : 1), false);
  }

  shadow({ bones }, places) {
    this.stroke(bones.map(([from, to]) => [from, to].map((j) => [places[j][0], 0, places[j][2]])), this.palette.shadow, 0.05, 0.15, true);
  }

  threads(pairs, colour) { this.stroke(pairs, colour, 2, 0.9); }

  // Where a foot goes: pale all along, strong up to now, thick while it stands.
  trace(places, plants, now, side) {
    const colour = this.sides[side];
    this.stroke([places], colour, 1.5, 0.3);
    this.stroke([places.slice(0, now + 1)], colour, 2.5, 0.9);
    places.forEach((place, f) => { if (f <= now && plants[f]) this.disc(place, 0.028, colour, 0.5, true); });
  }
}

// A chart: curves over one axis, with a mark where the reader is; a finger on it moves the mark.
class Chart {
  constructor(canvas, move) {
    this.canvas = canvas;
    whenPointed(canvas, ({ offsetX }) => {
      if (this.span) move(this.span[0] + ((offsetX - 46) / (canvas.clientWidth - 60)) * (this.span[1] - this.span[0]));
    });
  }

  draw({ curves, at, across, up, span, bands = [], bars = [] }, palette) {
    this.span = span;
    const { pen, wide, high } = sheet(this.canvas), left = 46, bottom = high - 32, top = 12;
    const highest = Math.max(1e-9, ...curves.flatMap(({ points }) => points.map(([, y]) => y ?? 0))) * 1.08;
    const x = (v) => left + ((wide - left - 14) * (v - span[0])) / (span[1] - span[0] || 1), y = (v) => bottom - ((bottom - top) * v) / highest;
    for (const [from, to, colour] of bands) { pen.globalAlpha = 0.2; pen.fillStyle = colour; pen.fillRect(x(from), top, x(to) - x(from), bottom - top); pen.globalAlpha = 1; }
    bars.forEach(([from, to, row, colour]) => { pen.fillStyle = colour; pen.fillRect(x(from), 1 + 5 * row, Math.max(1, x(to) - x(from)), 4); });
    line(pen, [[left, top], [left, bottom], [wide - 14, bottom]], palette.ink, 1, 0.6);
    for (const { points, colour, width, alpha } of curves) line(pen, points.filter(([, v]) => v !== null).map(([u, v]) => [x(u), y(v)]), colour, width, alpha);
    pen.fillStyle = palette.ink; pen.textBaseline = "top"; pen.textAlign = "center";
    for (const u of ticks(span, wide < 330 ? 4 : 6)) pen.fillText(spoken(u), x(u), bottom + 4);
    pen.fillText(across, left + (wide - left - 14) / 2, bottom + 18);
    pen.textAlign = "right"; pen.textBaseline = "middle";
    for (const v of ticks([0, highest], 3)) pen.fillText(spoken(v), left - 5, y(v));
    pen.save(); pen.translate(9, (top + bottom) / 2); pen.rotate(-Math.PI / 2); pen.textAlign = "center"; pen.fillText(up, 0, 0); pen.restore();
    line(pen, [[x(at[0]), top], [x(at[0]), bottom]], palette.ink, 1, 0.5);
    if (at[1] !== null) dot(pen, x(at[0]), y(at[1]), 4, palette.ink, palette.paper);
  }
}

const spoken = (v) => String(Number(v.toFixed(2))).replace("-", "−");

// Round numbers in a span, about `count` of them.
function ticks([low, high], count) {
  const raw = (high - low) / count, power = 10 ** Math.floor(Math.log10(raw));
  const step = [45, 90].find((s) => high - low === 360 && s * count >= 360) ?? [1, 2, 5, 10].map((n) => n * power).find((s) => s >= raw);
  return Array.from({ length: Math.floor((high + 1e-9) / step) - Math.ceil((low - 1e-9) / step) + 1 }, (_, k) => (Math.ceil((low - 1e-9) / step) + k) * step);
}
