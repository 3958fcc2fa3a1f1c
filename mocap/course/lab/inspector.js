// The transition inspector: point at a cell of a grid, an edge of a graph or a seam of a walk, and see the two
// windows, the turn that aligns them, the weights that mix them, and the seam.
//
// `showing.py` packs a scene; the scripts beside this file compute, draw maps, and draw bodies. All of it runs in the
// page, so it needs no Python. The hand on the bodies is the player's.

const TABS = { windows: "windows", turn: "turn θ", weights: "weights α", seam: "seam" };

class Inspector {
  constructor(root, scene) {
    this.root = root; this.scene = scene; this.camera = new Camera(); this.fps = scene.fps; this.window = scene.window;
    this.camera.reset(0.22);
    this.tab = scene.tab; this.kind = "cubic"; this.theta = null; this.time = 0; this.visible = true; this.pictures = 0;
    this.build();
    inflated(scene.data).then((bytes) => this.load(bytes));
  }

  get first() { return this.clips[this.pick.first]; }
  get second() { return this.clips[this.pick.second]; }

  build() {
    const { scene, root } = this, tabs = scene.tabs.map((tab) => `<button data-tab="${tab}">${TABS[tab]}</button>`).join("");
    root.classList.add("mocap-inspector");
    root.dataset.started = "true";
    root.innerHTML = `<style>${INSPECTOR_STYLE}</style>${INSPECTOR_PARTS}`;
    const find = (what) => root.querySelector(what);
    find(".tabs").innerHTML = tabs;
    find(".tabs").hidden = scene.tabs.length === 1;
    this.canvas = find(".bodies"); this.scrub = find(".scrub"); this.play = find(".play");
    this.status = find(".status"); this.now = find(".now"); this.weights = find(".kinds");
    for (const part of root.querySelectorAll("canvas, button, input, select")) part.dataset.lmSuppressShortcuts = "true";
    this.key = find(".names");
  }

  load(bytes) {
    const { scene, root } = this, find = (what) => root.querySelector(what);
    this.clips = scene.clips.map((clip) => new Clip(clip, scene.skeleton, bytes));
    this.stage = new Stage(this.canvas, this.camera);
    this.chart = new Chart(find(".chart"), (value) => this.drag(value));
    this.maps = {};
    for (const [kind, Kind] of [["walk", PathMap], ["graph", GraphMap], ["grid", GridMap]]) {
      const canvas = find(`.${kind}`);
      canvas.hidden = kind !== "grid" && !scene[kind];
      if (canvas.hidden) continue;
      this.maps[kind] = new Kind(canvas, this);
      canvas.setAttribute("aria-label", `${NAMES[kind]}${kind === "grid" && scene.grid ? " N goes to the next minimum." : ""}`);
      if (kind !== "grid") this.maps[kind].show(scene[kind], this.clips, this.fps);
    }
    root.classList.toggle("alone", !scene.graph && !scene.walk);
    root.classList.toggle("wide", scene.grid?.columns > 1.5 * scene.grid?.rows); // a long clip beside a short one gets the whole width
    if (scene.graph) find(".graph").style.height = `${Math.min(300, 60 + 34 * this.clips.length)}px`;
    if (scene.grid) {
      const shades = new Uint8Array(bytes, scene.grid.offset, scene.grid.rows * scene.grid.columns);
      this.maps.grid.show({ ...scene.grid, from: [0, 0], values: Float32Array.from(shades, (shade) => shade / 255) }, scene.grid.minima);
    }
    this.choose({ ...scene.pick, centre: [scene.pick.i, scene.pick.j] });
    this.hand = new Hand(this);
    this.listen();
    this.show(this.tab);
  }

  listen() {
    for (const button of this.root.querySelectorAll("[data-tab]")) button.onclick = () => this.show(button.dataset.tab);
    this.play.onclick = () => this.toggle();
    this.weights.onchange = () => { this.kind = this.weights.value; this.compute(); this.update(); };
    this.root.querySelector(".best").onclick = () => { this.theta = null; this.compute(); this.controls(); this.update(); };
    this.scrub.oninput = () => this.move(Number(this.scrub.value));
    this.resized = new ResizeObserver(() => this.update());
    for (const canvas of this.root.querySelectorAll("canvas")) this.resized.observe(canvas);
    this.seen = new IntersectionObserver((entries) => { this.visible = entries.at(-1).isIntersecting; this.update(); });
    this.seen.observe(this.root);
    this.orbit = this.hand.orbit.bind(this.hand);
    this.hand.orbit = (...angles) => { this.turned = true; this.orbit(...angles); };
  }

  // The slider's value: an angle in degrees, or a frame.
  move(value) {
    this.toggle(false);
    if (this.tab === "turn") { this.theta = (value * Math.PI) / 180; this.compute(); } else this.seek(value / this.fps);
    this.update();
  }

  // A finger on the chart, in the units of its axis: degrees, frames from 1, or seconds from the start of the window.
  drag(value) {
    const slid = { turn: value, seam: this.before + value * this.fps }[this.tab] ?? value - 1;
    this.move(Math.round(Math.min(Math.max(slid, this.scrub.min), this.scrub.max)));
  }

  // ---- what is looked at ----

  // Take a pair of windows; its best turn is the one that is shown until the reader drags another.
  choose(pick) {
    this.asked = performance.now();
    const other = !this.pick || String(pick.centre) !== String(this.pick.centre) || pick.number !== this.pick.number;
    this.pick = { before: this.scene.around, after: this.scene.around, ...pick };
    this.theta = null; this.turned &&= !other;
    this.compute();
    if (this.ready) this.controls();
    this.stale = other && !this.scene.grid;
    this.update();
  }

  compute() {
    const { first, second, pick, window, scene } = this, { i, j } = pick;
    const room = (wish, have) => Math.max(0, Math.min(wish, have));
    this.before = room(pick.before, Math.min(i, first.frames)); this.after = room(pick.after, second.frames - j - window);
    this.cloud = first.cloud(i, window); this.other = second.cloud(j, window);
    this.sums = sums(this.cloud, this.other);
    this.best = bestAngle(this.sums); this.angle = this.theta ?? this.best;
    this.transform = bestShift(this.sums, this.angle);
    this.known = {};
    this.heading = facing(this.cloud, scene.skeleton, first.joints(i + Math.floor(window / 2)));
  }

  // What only some tabs show is computed when it is first asked for: the seam, its jolts, and those of each clip alone.
  once(what, compute) { return (this.known[what] ??= compute()); }

  get seam() {
    const { first, second, pick, transform, window, before, after, kind } = this;
    return this.once("seam", () => seamOf(first, pick.i, second, pick.j, { transform, window, before, after, kind }));
  }

  get jolts() { return this.once("jolts", () => jolts(this.seam, this.scene.skeleton.points, this.fps)); }

  // The jolts of each clip by itself, with the frame of the window at which they start.
  get own() {
    const { first, second, pick, window, before, after } = this;
    const alone = (clip, at, from, to) => {
      const frames = Array.from({ length: Math.min(to, clip.frames - at) - Math.max(from, -at) }, (_, f) => clip.joints(at + Math.max(from, -at) + f));
      return { from: Math.max(from, -at), values: jolts(frames, this.scene.skeleton.points, this.fps) };
    };
    return this.once("own", () => [alone(first, pick.i, -before, window + after), alone(second, pick.j, -before, window + after)]);
  }

  // The second clip's joints at a frame of the window, aligned.
  aligned(p) { return this.second.joints(this.pick.j + p).map((place) => moved(this.transform, place)); }

  // ---- the player's words, which `Hand` uses ----

  get frames() { return this.tab === "seam" ? this.seam.length : this.window; }
  get seconds() { return (this.frames - 1) / this.fps; }
  frame() { return Math.min(this.frames - 1, Math.max(0, Math.round(this.time * this.fps))); }
  seek(time) { this.time = Math.min(Math.max(time, 0), this.seconds); this.update(); }

  toggle(playing = !this.playing) {
    this.playing = playing && this.tab !== "turn"; this.last = null;
    this.play.textContent = this.playing ? "❚❚" : "▶";
    this.play.setAttribute("aria-label", this.playing ? "pause" : "play");
    this.update();
  }

  show(tab) {
    this.tab = tab;
    this.time = tab === "seam" ? 0 : (this.window >> 1) / this.fps;
    this.controls();
    this.toggle(tab === "seam" && !matchMedia("(prefers-reduced-motion: reduce)").matches);
    this.ready = true;
  }

  controls() {
    const turn = this.tab === "turn", set = (what, hidden) => { this.root.querySelector(what).hidden = hidden; };
    for (const button of this.root.querySelectorAll("[data-tab]")) button.setAttribute("aria-pressed", button.dataset.tab === this.tab);
    set(".play", turn); set(".best", !turn); set(".kind", !["weights", "seam"].includes(this.tab));
    const [low, high] = turn ? [-180, 180] : [0, this.frames - 1];
    Object.assign(this.scrub, { min: low, max: high, step: 1 });
    this.scrub.setAttribute("aria-label", turn ? "θ, degrees" : "frame");
  }

  update() { this.waiting ??= requestAnimationFrame((now) => this.tick(now)); }

  tick(now) {
    this.waiting = null;
    if (!this.root.isConnected || !this.visible) { this.last = null; return; }
    if (this.playing) {
      if (this.last !== null) this.time += Math.min(0.25, (now - this.last) / 1000) * (this.tab === "seam" ? 0.5 : 0.25);
      if (this.time > this.seconds) this.time = 0;
      this.last = now;
      this.update();
    }
    this.draw();
    if (this.asked) { this.took = performance.now() - this.asked; this.asked = null; }
    if (this.stale) { this.stale = false; requestAnimationFrame(() => { this.look(); this.update(); }); }
  }

  // Measure the distances around a transition, after its picture has been drawn.
  look() {
    const { first, second, pick, window } = this, [i, j] = pick.centre, every = Math.max(1, Math.round(this.fps / 30));
    const grid = gridAround(first, i, second, j, window, this.scene.cells, every), known = grid.values.filter((v) => !Number.isNaN(v));
    const low = Math.min(...known), high = Math.max(...known);
    this.maps.grid.show({ ...grid, values: grid.values.map((v) => (v - low) / (high - low || 1)) }, [[i, j]]);
  }
}

// Where a body faces: across the line from its right to its left side, which is the mean of its points on each.
function facing(cloud, { bones }, places) {
  const mean = (side) => bones.filter((bone) => bone[2] === side).reduce(([x, z, n], [, to]) => [x + places[to][0], z + places[to][2], n + 1], [0, 0, 0]);
  const [left, right] = [1, 2].map(mean).map(([x, z, n]) => [x / (n || 1), z / (n || 1)]);
  return Math.atan2(-(left[1] - right[1]), left[0] - right[0]);
}
