// A player of stick figures on a canvas, without any library.
//
// `player.py` packs a scene, `player_scene.js` unpacks it, `Picture` in `player_picture.js` draws it, and this file
// holds the controls. The three scripts are joined to one module. On a page, `startAll` starts every
// `.mocap-player`; in JupyterLab, anywidget calls `render`, whose `model` shares `frame`, `scene` and `path` with
// Python.

const KEYS = "Space plays, arrows step, shift and arrows turn the view, plus and minus zoom.";

const STYLE = `
.mocap-player { max-width: 720px; background: #fff; color: #222; font: 13px/1.4 system-ui, sans-serif; color-scheme: light; }
.mocap-player canvas { display: block; width: 100%; height: 380px; touch-action: none; cursor: grab; border: 1px solid #ddd; }
.mocap-player canvas.drawing { cursor: crosshair; }
.mocap-player :focus-visible { outline: 3px solid #0072B2; outline-offset: 1px; }
.mocap-player .bar { display: flex; flex-wrap: wrap; gap: 4px 12px; align-items: center; padding: 4px 2px; }
.mocap-player button, .mocap-player select { font: inherit; min-width: 40px; height: 28px; padding: 0 8px; color: inherit;
  background: #f2f2f2; border: 1px solid #bbb; border-radius: 4px; cursor: pointer; }
.mocap-player button[aria-pressed="true"] { background: #cfe5f3; }
.mocap-player .scrub { flex: 1 1 200px; }
.mocap-player .scrub input { width: 100%; margin: 0; }
.mocap-player .scrub div { height: 5px; border-radius: 2px; }
.mocap-player output { font-variant-numeric: tabular-nums; min-width: 11em; }
.mocap-player .legend span { display: inline-block; width: 10px; height: 10px; margin: 0 4px 0 10px; }
.mocap-player .message:not(:empty) { padding: 4px 2px; } .mocap-player .message.error { color: #A00000; }`;

class Player {
  constructor(root, scene, model) {
    this.root = root; this.model = model; this.camera = new Camera();
    this.time = 0; this.speed = 1; this.playing = false; this.visible = true; this.pictures = 0; this.drawn = [];
    this.calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.build();
    this.picture = new Picture(this.canvas, this.camera);
    this.load(scene).then(() => this.listen());
  }

  // ---- the page ----

  build() {
    this.root.classList.add("mocap-player");
    this.root.dataset.started = "true"; // so that `startAll` does not start it a second time
    this.root.innerHTML = `<style>${STYLE}</style><canvas tabindex="0" role="img"></canvas>
      <div class="bar"><button class="play" aria-label="play"></button>
        <div class="scrub"><input type="range" min="0" step="1" aria-label="frame"><div></div></div><output></output></div>
      <div class="bar"><label>speed <select>${[0.1, 0.25, 0.5, 1, 2].map((s) => `<option value="${s}">${s}×</option>`).join("")}</select></label>
        <label><input type="checkbox" class="follow"> follow</label>
        <label><input type="checkbox" class="ghosts"> ghosts</label>
        <button class="reset">reset view</button><button class="draw" aria-pressed="false">draw a path</button>
        <span class="legend"></span></div><div class="message" role="status"></div>`;
    const find = (what) => this.root.querySelector(what);
    this.canvas = find("canvas"); this.play = find(".play"); this.scrub = find(".scrub input"); this.strip = find(".scrub div");
    this.clock = find("output"); this.select = find("select"); this.follow = find(".follow"); this.ghosts = find(".ghosts");
    this.drawButton = find(".draw"); this.legend = find(".legend"); this.message = find(".message");
    // JupyterLab takes keys away from whatever does not say this.
    for (const part of this.root.querySelectorAll("canvas, button, input, select")) part.dataset.lmSuppressShortcuts = "true";
    this.select.value = "1";
    find(".reset").onclick = () => { this.camera.reset(); this.update(); };
  }

  async load(scene) {
    this.latest = scene;
    const bytes = await inflated(scene.data), again = scene.drawable && this.scene;
    if (scene !== this.latest) return;
    this.scene = scene;
    this.characters = scene.characters.map((packed) => new Character(packed, bytes));
    this.seconds = (scene.frames - 1) / scene.fps;
    if (!again) this.follow.checked = scene.follow; // a reader who draws one path after the other keeps the view
    if (scene.drawable && !again) { this.drawing = true; this.camera.pitch = 0.9; }
    this.canvas.setAttribute("aria-label", `${scene.alt} ${KEYS}`);
    this.scrub.max = scene.frames - 1;
    this.drawButton.hidden = !scene.drawable;
    this.drawn = [];
    this.say(this.model?.get("message") ?? "");
    this.showSources();
    if (!again) this.frameAll();
    this.seek((this.model?.get("frame") ?? 0) / scene.fps);
    this.toggle(Boolean(scene.autoplay) && !this.calm);
  }

  say(text) { this.message.textContent = text; this.message.classList.toggle("error", /^\w+Error:/.test(text)); }

  // The coloured bar under the slider, and the names of its colours.
  showSources() {
    const [{ sources }] = this.characters;
    const stops = sources.map((s, i) => {
      const end = i + 1 < sources.length ? sources[i + 1].start : this.seconds;
      return `${s.colour} ${(100 * s.start) / this.seconds}% ${(100 * end) / this.seconds}%`;
    });
    this.strip.style.background = stops.length ? `linear-gradient(to right, ${stops.join(", ")})` : "none";
    const named = sources.length ? sources : this.characters.length > 1 ? this.characters : [];
    const colours = new Map(named.map((s) => [s.name, s.colour]));
    this.legend.replaceChildren(...[...colours].flatMap(([name, colour]) => {
      const mark = document.createElement("span");
      mark.style.background = colour;
      return [mark, name];
    }));
  }

  // Where the camera looks when it does not follow, and how far away it is.
  frameAll() {
    const places = [...this.characters.flatMap((c) => c.path.map(([, x, z]) => [x, z])), ...this.scene.asked];
    const span = (i) => [Math.min(...places.map((p) => p[i])), Math.max(...places.map((p) => p[i]))];
    const [[x0, x1], [z0, z1]] = [span(0), span(1)];
    this.centre = [(x0 + x1) / 2, this.scene.drawable ? 0 : 0.8, (z0 + z1) / 2];
    this.reach = Math.max(3.2, 1.1 * Math.hypot(x1 - x0, z1 - z0) + 1.5);
  }

  listen() {
    this.play.onclick = () => this.toggle();
    this.scrub.oninput = () => { this.toggle(false); this.seek(Number(this.scrub.value) / this.scene.fps); };
    this.select.onchange = () => { this.speed = Number(this.select.value); };
    this.follow.onchange = this.ghosts.onchange = () => this.update();
    this.drawButton.onclick = () => { this.drawing = !this.drawing; this.update(); };
    this.root.addEventListener("keydown", (event) => this.key(event));
    this.canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    this.pointers = new Map();
    for (const kind of ["pointerdown", "pointermove", "pointerup", "pointercancel"]) {
      this.canvas.addEventListener(kind, (event) => this[kind](event));
    }
    this.resized = new ResizeObserver(() => this.update());
    this.resized.observe(this.canvas);
    this.seen = new IntersectionObserver(([entry]) => { this.visible = entry.isIntersecting; this.update(); });
    this.seen.observe(this.canvas);
    if (this.model) this.link();
  }

  // ---- Python ----

  link() {
    this.model.on("change:frame", () => {
      if (this.scene === this.latest && this.model.get("frame") !== this.frame()) { this.toggle(false); this.seek(this.model.get("frame") / this.scene.fps); }
    });
    this.model.on("change:scene", () => this.load(this.model.get("scene")));
    this.model.on("change:message", () => this.say(this.model.get("message")));
  }

  // Send Python the frame, at most twenty times per second.
  report() {
    if (!this.model || this.reporting) return;
    this.reporting = setTimeout(() => {
      this.reporting = null;
      if (this.model.get("frame") === this.frame()) return;
      this.model.set("frame", this.frame());
      this.model.save_changes();
    }, 50);
  }

  // ---- time ----

  frame() { return Math.round(this.time * this.scene.fps); }

  seek(time) {
    this.time = Math.min(Math.max(time, 0), this.seconds);
    this.report();
    this.update();
  }

  toggle(playing = !this.playing) {
    this.playing = playing;
    this.last = null;
    this.play.textContent = this.playing ? "❚❚" : "▶";
    this.play.setAttribute("aria-label", this.playing ? "pause" : "play");
    this.update();
  }

  update() { this.waiting ??= requestAnimationFrame((now) => this.tick(now)); }

  tick(now) {
    this.waiting = null;
    if (!this.root.isConnected || !this.visible) { this.last = null; return; }
    if (this.playing) {
      if (this.last !== null) this.time += Math.min(0.25, (now - this.last) / 1000) * this.speed;
      if (this.time > this.seconds) this.time = this.seconds > 0 ? this.time % this.seconds : 0;
      this.last = now;
      this.report();
      this.update();
    }
    this.draw();
  }

  // ---- keys, mouse, fingers ----

  key(event) {
    const onCanvas = event.target === this.canvas;
    const turn = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] }[event.key];
    if (event.key === " " && (onCanvas || event.target === this.scrub)) this.toggle();
    else if (onCanvas && turn && event.shiftKey) this.orbit(...turn);
    else if (onCanvas && turn && turn[0]) { this.toggle(false); this.seek((this.frame() + Math.sign(turn[0])) / this.scene.fps); }
    else if (onCanvas && (event.key === "+" || event.key === "-")) this.zoomBy(event.key === "+" ? 1.15 : 1 / 1.15);
    else if (onCanvas && event.key === "Home") this.seek(0);
    else if (onCanvas && event.key === "End") this.seek(this.seconds);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  orbit(yaw, pitch) {
    this.camera.yaw += yaw;
    this.camera.pitch = Math.min(1.55, Math.max(0.02, this.camera.pitch + pitch));
    this.update();
  }

  zoomBy(factor) { this.camera.zoom = Math.min(12, Math.max(0.2, this.camera.zoom * factor)); this.update(); }

  // The wheel zooms where the canvas has the focus; elsewhere it scrolls the page.
  wheel(event) {
    if (!event.ctrlKey && document.activeElement !== this.canvas) return;
    event.preventDefault();
    this.zoomBy(Math.exp(-event.deltaY / 400));
  }

  pointerdown(event) {
    this.canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, event);
    if (this.drawing) this.drawn = [];
  }

  // One finger or the mouse turns the view, two fingers zoom; in drawing mode, one finger or the mouse draws.
  pointermove(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const others = [...this.pointers.values()].filter((other) => other.pointerId !== event.pointerId);
    const from = (p, q) => Math.hypot(p.offsetX - q.offsetX, p.offsetY - q.offsetY);
    this.pointers.set(event.pointerId, event);
    if (others.length) this.zoomBy(from(event, others[0]) / Math.max(1, from(before, others[0])));
    else if (this.drawing) this.pen(this.camera.ground(event.offsetX, event.offsetY));
    else this.orbit((before.offsetX - event.offsetX) / 150, (event.offsetY - before.offsetY) / 150);
  }

  pen(place) {
    const last = this.drawn.at(-1);
    if (place && (!last || Math.hypot(place[0] - last[0], place[1] - last[1]) > 0.05)) this.drawn.push(place);
    this.update();
  }

  pointerup(event) {
    this.pointers.delete(event.pointerId);
    if (!this.drawing || this.drawn.length < 2) return;
    this.say("Looking for a walk …");
    this.model.set("path", this.drawn);
    this.model.save_changes();
  }

  pointercancel(event) { this.pointers.delete(event.pointerId); }

  // ---- the picture ----

  draw() {
    const { characters, time, drawn, reach } = this, { asked, sides } = this.scene, target = this.target();
    const distance = this.follow.checked ? 4.2 : reach, ghosts = this.ghosts.checked;
    this.picture.draw({ characters, time, asked, drawn, sides, ghosts, target, distance, reach });
    this.showState();
  }

  // Above the ground under the first character, averaged over a second so that the view does not rock with each step.
  target() {
    if (!this.follow.checked) return this.centre;
    const mean = [0, 0.85, 0];
    for (let i = -4; i <= 4; i++) {
      const pose = this.characters[0].pose(this.time + i / 8);
      mean[0] += pose[0] / 9; mean[2] += pose[2] / 9;
    }
    return mean;
  }

  showState() {
    const frame = this.frame(), text = `frame ${frame} of ${this.scene.frames} · ${this.time.toFixed(2)} s`;
    if (document.activeElement !== this.scrub || this.playing) this.scrub.value = frame;
    this.scrub.setAttribute("aria-valuetext", text);
    this.clock.value = text;
    this.drawButton.setAttribute("aria-pressed", this.drawing);
    this.canvas.classList.toggle("drawing", this.drawing);
    Object.assign(this.root.dataset, { frame, playing: this.playing });
    this.pictures++;
    this.firstPicture ??= performance.now();
  }

  end() { this.resized?.disconnect(); this.seen?.disconnect(); clearTimeout(this.reporting); cancelAnimationFrame(this.waiting); }
}

// On a page: each output that appears starts the players that have not been started yet.
export function startAll() {
  for (const root of document.querySelectorAll(".mocap-player:not([data-started])")) {
    root.player = new Player(root, JSON.parse(root.querySelector("script").textContent), null);
  }
}

// In JupyterLab: called by anywidget.
export default {
  render({ model, el }) {
    el.player = new Player(el, model.get("scene"), model);
    return () => el.player.end();
  },
};
