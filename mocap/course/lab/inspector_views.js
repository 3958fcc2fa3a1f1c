// What each tab draws on the stage and in the chart, and what it says.

const round = (v, digits = 1) => v.toFixed(digits).replace("-", "−");
const degrees = (angle) => Math.round((angle * 180) / Math.PI);
const centimetres = (metres) => round(100 * metres);
const paired = (cloud, other) => cloud.map((place, n) => [place, other[n]]);

const SEAM_KEY = "Chart: green is the jolt of the seam, grey that of each clip alone; the window is shaded; bars show when each foot stands.";

const VIEWS = {
  // Both windows, aligned: the frame at the slider, the first and the last one as ghosts.
  windows(it, p) {
    for (const ghost of [0, it.window - 1]) it.pairOfBodies(ghost, 0.18, 0.18);
    it.pairOfBodies(p, 1, 0.75);
    it.stage.threads(it.threadsAt(p), it.palette.thread);
    const apart = it.cloud.map((_, f) => [f + 1, 100 * it.apartAt(f)]);
    it.chartOf({ points: apart, colour: it.colours.curves[0], width: 2 }, apart[p], "frame of the window", "RMS (cm)", [1, it.window]);
    return `Frame ${p + 1} of ${it.window}: ${centimetres(it.apartAt(p))} cm apart.`;
  },

  turn(it) {
    const p = it.window >> 1, at = degrees(it.angle);
    for (const ghost of [0, it.window - 1]) it.pairOfBodies(ghost, 0.18, 0.18);
    it.pairOfBodies(p, 1, 0.75);
    it.stage.threads(it.threadsAt(p), it.palette.thread);
    const points = Array.from({ length: 121 }, (_, k) => 3 * k - 180).map((v) => [v, 100 * distanceAt(it.sums, (v * Math.PI) / 180)]);
    it.chartOf({ points, colour: it.colours.curves[0], width: 2 }, [(it.angle * 180) / Math.PI, 100 * distanceAt(it.sums, it.angle)], "θ (degrees)", "RMS (cm)", [-180, 180]);
    return `θ = ${round(at, 0)}°: ${centimetres(distanceAt(it.sums, it.angle))} cm; at the best, ${round(degrees(it.best), 0)}°: ${centimetres(distanceAt(it.sums, it.best))} cm.`;
  },

  // The blend, and how much of each clip it holds.
  weights(it, p) {
    const { alpha, places } = it.seam[it.before + p], points = weightsOf(it.kind, it.window).map((v, f) => [f + 1, v]);
    it.pairOfBodies(p, 0.12 + 0.55 * alpha, 0.12 + 0.55 * (1 - alpha));
    it.stage.shadow(it.scene.skeleton, places);
    it.stage.body(it.scene.skeleton, places, { wide: 0.045 });
    it.chartOf({ points, colour: it.colours.curves[0], width: 2 }, points[p], "frame of the window", "α", [1, it.window]);
    return `Frame ${p + 1} of ${it.window}: ${round(alpha, 2)} of ${it.first.name}, ${round(1 - alpha, 2)} of ${it.second.name}.`;
  },

  // The seam as it plays, the traces of the feet, and the jolts.
  seam(it, f) {
    const { places } = it.seam[f], { skeleton } = it.scene, p = f - it.before;
    for (const [joint, side] of skeleton.feet) it.stage.trace(it.seam.map((frame) => frame.places[joint]), it.seam.map(({ plants }) => (plants >> side) & 1), f, side);
    it.stage.stroke([it.seam.map((frame) => [frame.places[0][0], 0, frame.places[0][2]])], it.colours.path, 2.5);
    for (const end of [it.seam[0], it.seam.at(-1)]) it.stage.body(skeleton, end.places, { alpha: 0.12 });
    if (p >= 0 && p < it.window) it.pairOfBodies(p, 0.22, 0.22);
    it.stage.shadow(skeleton, places);
    it.stage.body(skeleton, places, { wide: 0.045 });
    const clock = (values, from) => values.map((v, k) => [(k + from) / it.fps, v]), inside = [-it.before, it.window + it.after - 1].map((v) => v / it.fps);
    const result = clock(it.jolts, -it.before);
    it.chart.draw({
      curves: [...it.own.map(({ values, from }) => ({ points: clock(values, from), colour: it.colours.quiet, width: 1.2 })),
        { points: result, colour: it.colours.curves[0], width: 2.2 }],
      at: result[f], across: "seconds from the start of the window", up: "jolt (m/s)", span: inside,
      bands: [[0, (it.window - 1) / it.fps, it.colours.seam]], bars: it.plantBars(),
    }, it.palette);
    const [most, own] = [it.jolts, it.own.flatMap(({ values }) => values)].map((values) => Math.max(...values.map((v) => v ?? 0)));
    return `${round(p / it.fps, 2)} s: largest jolt of the seam ${round(most, 2)} m/s, of the clips alone ${round(own, 2)} m/s.`;
  },
};

Object.assign(Inspector.prototype, {
  draw() {
    const { scene, tab } = this, dark = isDark(), p = this.frame();
    this.root.classList.toggle("dark", dark);
    this.colours = scene.colours;
    this.palette = dark ? { ...DARK, paper: "#1b1b1b", thread: "#ffffff" } : { ...LIGHT, paper: "#ffffff", thread: "#000000" };
    Object.assign(this.stage, { palette: this.palette, sides: scene.colours.sides });
    const [[x0, , z0], [x1, , z1]] = tab === "seam" ? [this.seam[0], this.seam.at(-1)].map(({ places }) => places[0]) : [this.cloud[0], this.cloud.at(-1)].map(([root]) => root);
    this.stage.look([(x0 + x1) / 2, 0.9, (z0 + z1) / 2], this.heading, 3.3 + 0.75 * Math.hypot(x1 - x0, z1 - z0), this.turned);
    const said = VIEWS[tab](this, p);
    const lit = this.lit(tab === "seam" ? p - this.before : p);
    for (const map of Object.values(this.maps)) map.draw(this.palette, { pick: this.pick, lit, fps: this.fps, path: this.steps(), colours: this.colours });
    this.say(said);
  },

  // The frames of the window on the grid, from its first to its last pair.
  steps() { return [0, this.window - 1].map((p) => [this.pick.i + p, this.pick.j + p]); },

  // Where the seam stands, p frames after the window's start: which frames of both clips, and which part of the blend.
  lit(p) {
    const { pick, window } = this, part = p < 0 ? "before" : p < window ? "window" : "after";
    return { part, cell: [pick.i + p, pick.j + p], share: Math.min(1, Math.max(0, p / Math.max(1, window - 1))), frame: (pick.frame ?? -1) < 0 ? -1 : pick.frame + p };
  },

  pairOfBodies(p, alpha, beta) {
    this.stage.body(this.scene.skeleton, this.first.joints(this.pick.i + p), { alpha });
    this.stage.body(this.scene.skeleton, this.aligned(p), { alpha: beta, dashed: true, wide: 0.03 });
  },

  threadsAt(p) { return paired(this.cloud[p], this.other[p].map((place) => moved(this.transform, place))); },

  // The RMS distance of the points in one frame of the window, as aligned.
  apartAt(p) {
    const gaps = this.threadsAt(p).map(([a, b]) => a.reduce((sum, v, k) => sum + (v - b[k]) ** 2, 0));
    return Math.sqrt(gaps.reduce((sum, gap) => sum + gap, 0) / gaps.length);
  },

  chartOf(curve, at, across, up, span) { this.chart.draw({ curves: [curve], at, across, up, span }, this.palette); },

  // When each foot stands: [from, to, row, colour], seconds.
  plantBars() {
    return [1, 2].flatMap((side) => {
      const bars = [], at = (f) => (f - this.before) / this.fps;
      this.seam.forEach(({ plants }, f) => { if ((plants >> side) & 1) { if (bars.at(-1)?.[1] === at(f)) bars.at(-1)[1] = at(f + 1); else bars.push([at(f), at(f + 1), side - 1, this.colours.sides[side]]); } });
      return bars;
    });
  },

  say(said) {
    const { first, second, pick, window, fps } = this, best = distanceAt(this.sums, this.best);
    const place = (clip, at) => `frames ${at} to ${at + window - 1} of ${clip.name} (from ${round(at / fps, 2)} s)`;
    const turn = this.scene.tabs.includes("turn") ? ` at θ = ${round(degrees(this.best), 0)}°` : ", aligned";
    const text = `${place(first, pick.i)} and ${place(second, pick.j)}: RMS distance ${centimetres(best)} cm${turn}.`;
    const sentence = text[0].toUpperCase() + text.slice(1);
    if (this.status.textContent !== sentence) this.status.textContent = sentence;
    this.now.textContent = said;
    this.key.textContent = this.tab === "seam" ? SEAM_KEY : this.scene.key;
    const value = this.tab === "turn" ? degrees(this.angle) : this.frame();
    if (Number(this.scrub.value) !== value) this.scrub.value = value;
    this.scrub.setAttribute("aria-valuetext", said);
    Object.assign(this.root.dataset, { shows: this.tab, playing: Boolean(this.playing) });
    this.pictures++;
  },
});
