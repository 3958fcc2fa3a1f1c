// What each tab draws on the stage and in the chart, and what it says.

import { distanceAt, transformed, weightsOf } from "./inspector_maths.js";
import { DARK, LIGHT, isDark } from "../../widgets/player_page.js";

/**
 * @import { MapPalette, Lit } from "./inspector_maps.js"
 * @import { Inspector } from "./inspector.js"
 * @import { Clip } from "./inspector_maths.js"
 * @import { Bar, Plot } from "./inspector_stage.js"
 *
 * @typedef {"windows" | "turn" | "weights" | "seam"} Tab
 */

/**
 * @param {number} v
 * @param {number} digits
 */
const round = (v, digits = 1) => v.toFixed(digits).replace("-", "−");
/** @param {number} angle */
const degrees = (angle) => Math.round((angle * 180) / Math.PI);
/** @param {number} metres */
const centimetres = (metres) => round(100 * metres);
/**
 * @param {number[][]} cloud
 * @param {number[][]} other
 */
const paired = (cloud, other) => cloud.map((position, n) => [position, other[n]]);

const SEAM_KEY =
  "Chart: green is the jolt of the seam, grey that of each clip alone; the window is shaded; " +
  "bars show when each foot stands.";

/** @type {Record<Tab, (it: Inspector, p: number) => string>} */
const VIEWS = {
  // Both windows, aligned: the frame at the slider, the first and the last one as ghosts.
  windows(it, p) {
    for (const ghost of [0, it.window - 1]) drawPair(it, ghost, 0.18, 0.18);
    drawPair(it, p, 1, 0.75);
    it.stage.threads(threadsAt(it, p), paletteNow().thread);
    /** @type {[number, number][]} */
    const apart = it.cloud.map((_, f) => [f + 1, 100 * apartAt(it, f)]);
    drawCurve(it, apart, {
      at: apart[p],
      across: "frame of the window",
      up: "RMS (cm)",
      span: [1, it.window],
    });
    return `Frame ${p + 1} of ${it.window}: ${centimetres(apartAt(it, p))} cm apart.`;
  },

  turn(it) {
    const p = it.window >> 1;
    for (const ghost of [0, it.window - 1]) drawPair(it, ghost, 0.18, 0.18);
    drawPair(it, p, 1, 0.75);
    it.stage.threads(threadsAt(it, p), paletteNow().thread);
    /** @type {[number, number][]} */
    const points = Array.from({ length: 121 }, (_, k) => 3 * k - 180).map((v) => [
      v,
      100 * distanceAt(it.sums, (v * Math.PI) / 180),
    ]);
    const [now, best] = [it.angle, it.best].map((angle) => distanceAt(it.sums, angle));
    const here = (it.angle * 180) / Math.PI;
    drawCurve(it, points, {
      at: [here, 100 * now],
      across: "θ (degrees)",
      up: "RMS (cm)",
      span: [-180, 180],
    });
    return (
      `θ = ${round(degrees(it.angle), 0)}°: ${centimetres(now)} cm; ` +
      `at the best, ${round(degrees(it.best), 0)}°: ${centimetres(best)} cm.`
    );
  },

  // The blend, and how much of each clip it holds.
  weights(it, p) {
    const { alpha, positions } = it.seam[it.before + p];
    /** @type {[number, number][]} */
    const points = weightsOf(it.kind, it.window).map((v, f) => [f + 1, v]);
    drawPair(it, p, 0.12 + 0.55 * alpha, 0.12 + 0.55 * (1 - alpha));
    it.stage.shadow(it.scene.skeleton, positions);
    it.stage.body(it.scene.skeleton, positions, { wide: 0.045 });
    drawCurve(it, points, { at: points[p], across: "frame of the window", up: "α", span: [1, it.window] });
    const fractions = `${round(alpha, 2)} of ${it.first.name}, ${round(1 - alpha, 2)} of ${it.second.name}`;
    return `Frame ${p + 1} of ${it.window}: ${fractions}.`;
  },

  // The seam as it plays, the traces of the feet, and the jolts.
  seam(it, f) {
    const { positions } = it.seam[f];
    const { skeleton } = it.scene;
    const p = f - it.before;
    for (const [joint, side] of skeleton.feet) {
      it.stage.traceFoot(
        it.seam.map((frame) => frame.positions[joint]),
        it.seam.map(({ contacts }) => (contacts >> side) & 1),
        f,
        side,
      );
    }
    const path = it.seam.map((frame) => [frame.positions[0][0], 0, frame.positions[0][2]]);
    it.stage.stroke([path], it.scene.colours.path, 2.5);
    it.stage.body(skeleton, it.seam[0].positions, { alpha: 0.12 });
    it.stage.body(skeleton, it.seam[it.seam.length - 1].positions, { alpha: 0.12 });
    if (p >= 0 && p < it.window) drawPair(it, p, 0.22, 0.22);
    it.stage.shadow(skeleton, positions);
    it.stage.body(skeleton, positions, { wide: 0.045 });
    /**
     * @param {(number | null)[]} values
     * @param {number} from
     * @returns {[number, number | null][]}
     */
    const clock = (values, from) => values.map((v, k) => [(k + from) / it.fps, v]);
    const inside = [-it.before, it.window + it.after - 1].map((v) => v / it.fps);
    const result = clock(it.jolts, -it.before);
    it.chart.draw(
      {
        curves: [
          ...it.own.map(({ values, from }) => ({
            points: clock(values, from),
            colour: it.scene.colours.quiet,
            width: 1.2,
          })),
          { points: result, colour: it.scene.colours.curves[0], width: 2.2 },
        ],
        at: result[f],
        across: "seconds from the start of the window",
        up: "jolt (m/s)",
        span: inside,
        bands: [[0, (it.window - 1) / it.fps, it.scene.colours.seam]],
        bars: contactBars(it),
      },
      paletteNow(),
    );
    const [most, own] = [it.jolts, it.own.flatMap(({ values }) => values)].map((values) =>
      Math.max(...values.map((v) => v ?? 0)),
    );
    return (
      `${round(p / it.fps, 2)} s: largest jolt of the seam ${round(most, 2)} m/s, ` +
      `of the clips alone ${round(own, 2)} m/s.`
    );
  },
};

/** @returns {MapPalette} */
function paletteNow() {
  return isDark()
    ? { ...DARK, paper: "#1b1b1b", thread: "#ffffff" }
    : { ...LIGHT, paper: "#ffffff", thread: "#000000" };
}

/**
 * Draw everything, and say what is seen.
 * @param {Inspector} it
 */
export function drawInspector(it) {
  const { scene, tab, stage } = it;
  const palette = paletteNow();
  const p = it.frame();
  it.root.classList.toggle("dark", isDark());
  stage.palette = palette;
  stage.sides = scene.colours.sides;
  const roots =
    tab === "seam" ? it.seam.map(({ positions }) => positions[0]) : it.cloud.map(([root]) => root);
  const [[x0, , z0], [x1, , z1]] = [roots[0], roots[roots.length - 1]];
  const [x, z] = it.panned;
  it.reach = 3.3 + 0.75 * Math.hypot(x1 - x0, z1 - z0);
  stage.look([(x0 + x1) / 2 + x, 0.9, (z0 + z1) / 2 + z], it.heading, it.reach, it.turned);
  const text = VIEWS[tab](it, p);
  const path = [0, it.window - 1].map((f) => [it.pick.i + f, it.pick.j + f]);
  const lit = litAt(it, tab === "seam" ? p - it.before : p);
  for (const map of Object.values(it.maps)) {
    map.draw(palette, { pick: it.pick, lit, fps: it.fps, path, colours: scene.colours });
  }
  describe(it, text);
}

/**
 * Where the seam stands, p frames after the window's start: which frames of both clips, and which part of the blend.
 * @param {Inspector} it
 * @param {number} p
 * @returns {Lit}
 */
function litAt({ pick, window }, p) {
  const played = p < window ? "window" : "after";
  const begun = pick.frame ?? -1;
  return {
    part: p < 0 ? "before" : played,
    cell: [pick.i + p, pick.j + p],
    fraction: Math.min(1, Math.max(0, p / Math.max(1, window - 1))),
    frame: begun < 0 ? -1 : begun + p,
  };
}

/**
 * Both bodies at a frame of the window.
 * @param {Inspector} it
 * @param {number} p
 * @param {number} alpha
 * @param {number} beta
 */
function drawPair(it, p, alpha, beta) {
  const { skeleton } = it.scene;
  it.stage.body(skeleton, it.first.joints(it.pick.i + p), { alpha });
  it.stage.body(skeleton, it.aligned(p), { alpha: beta, dashed: true, wide: 0.03 });
}

/**
 * The points of both in a frame of the window, as aligned.
 * @param {Inspector} it
 * @param {number} p
 */
function threadsAt(it, p) {
  const aligned = it.otherCloud[p].map((position) => transformed(it.transform, position));
  return paired(it.cloud[p], aligned);
}

/**
 * The RMS distance of these points.
 * @param {Inspector} it
 * @param {number} p
 */
function apartAt(it, p) {
  const squares = threadsAt(it, p).map(([a, b]) => a.reduce((sum, v, k) => sum + (v - b[k]) ** 2, 0));
  return Math.sqrt(squares.reduce((sum, square) => sum + square, 0) / squares.length);
}

/**
 * A chart of one curve.
 * @param {Inspector} it
 * @param {[number, number][]} points
 * @param {Omit<Plot, "curves">} plot
 */
function drawCurve(it, points, plot) {
  const curve = { points, colour: it.scene.colours.curves[0], width: 2 };
  it.chart.draw({ ...plot, curves: [curve] }, paletteNow());
}

/**
 * When each foot stands, seconds.
 * @param {Inspector} it
 */
function contactBars({ seam, before, fps, scene }) {
  return [1, 2].flatMap((side) => {
    /** @type {Bar[]} */
    const bars = [];
    seam.forEach(({ contacts }, f) => {
      if (!((contacts >> side) & 1)) return;
      const [from, to] = [f - before, f + 1 - before].map((frame) => frame / fps);
      const last = bars[bars.length - 1];
      if (last?.[1] === from) last[1] = to;
      else bars.push([from, to, side - 1, scene.colours.sides[side]]);
    });
    return bars;
  });
}

/**
 * Say what is looked at, and what is seen of it.
 * @param {Inspector} it
 * @param {string} text
 */
function describe(it, text) {
  const { first, second, pick, window, fps, scene } = it;
  const best = distanceAt(it.sums, it.best);
  /**
   * @param {Clip} clip
   * @param {number} at
   */
  const moment = (clip, at) =>
    `frames ${at} to ${at + window - 1} of ${clip.name} (from ${round(at / fps, 2)} s)`;
  const turn = scene.tabs.includes("turn") ? ` at θ = ${round(degrees(it.best), 0)}°` : ", aligned";
  const pair = `${moment(first, pick.i)} and ${moment(second, pick.j)}: RMS distance ${centimetres(best)} cm${turn}.`;
  const sentence = pair[0].toUpperCase() + pair.slice(1);
  if (it.status.textContent !== sentence) it.status.textContent = sentence;
  it.key.textContent = it.tab === "seam" ? SEAM_KEY : scene.key;
  const value = it.tab === "turn" ? degrees(it.angle) : it.frame();
  if (Number(it.scrub.value) !== value) it.scrub.value = String(value);
  it.showMessage(text);
  Object.assign(it.root.dataset, { shows: it.tab, playing: it.playing });
  it.pictures++;
}
