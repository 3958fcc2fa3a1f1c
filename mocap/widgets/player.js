// A player of bodies on a canvas, without any library.
//
// `player.py` packs a scene. `player_scene.js` unpacks it, `player_picture.js` draws it, `player_page.js` has the
// parts of the page, `player_hand.js` the keys, mouse and fingers, and this file ties them together. The scripts
// are joined to one module. On a page, `start` starts every `.mocap-player`; in JupyterLab, anywidget calls
// `render`. Its `model` shares with Python: `scene`, with a number; `move`, which Python sets, and `at`, which the
// player sets: the number of a scene and a frame; `path`; and `best`, the line of a search that is under way.

const FOLLOWED = 15; // metres of ground around a character that the camera follows

class Player {
  constructor(root, scene, model) {
    this.root = root; this.model = model; this.camera = new Camera();
    this.time = 0; this.speed = 1; this.range = []; this.panned = [0, 0]; this.playing = false; this.visible = true; this.pictures = 0;
    this.near = 1; this.chase = false; this.looking = null; // how far the view has come to the figure, whether it turns with it, since when Python looks for a walk
    this.calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.build();
    this.picture = new Picture(this.canvas, this.camera);
    this.hand = new Hand(this);
    this.load(scene).then(() => this.listen());
  }

  // ---- the page ----

  build() {
    this.root.classList.add("mocap-player");
    this.root.dataset.started = "true"; // so that `start` does not start it a second time
    this.root.innerHTML = PARTS;
    const find = (what) => this.root.querySelector(what);
    this.canvas = find("canvas"); this.play = find(".play"); this.scrub = find(".scrub input"); this.strip = find(".scrub div");
    this.clock = find(".clock"); this.select = find("select"); this.part = find(".scrub b"); this.aside = find(".aside input"); this.follow = find(".follow"); this.ghosts = find(".ghosts");
    this.drawButton = find(".draw"); this.legend = find(".legend"); this.message = find(".message");
    // JupyterLab takes keys away from whatever does not say this.
    for (const part of this.root.querySelectorAll("canvas, button, input, select")) part.dataset.lmSuppressShortcuts = "true";
    this.select.value = "1";
    find(".reset").onclick = () => this.frameAll();
    find(".full").hidden = !document.fullscreenEnabled;
    find(".full").onclick = () => (document.fullscreenElement ? document.exitFullscreen() : this.root.requestFullscreen());
    this.root.onfullscreenchange = () => { find(".full").textContent = document.fullscreenElement ? "leave full screen" : "full screen"; };
  }

  async load(scene) {
    this.latest = scene;
    const bytes = await inflated(scene.data), again = scene.drawable && this.scene;
    if (scene !== this.latest) return;
    this.scene = scene;
    this.characters = scene.characters.map((packed) => new Character(packed, bytes, scene.marks));
    this.seconds = (scene.frames - 1) / scene.fps;
    if (!again) this.follow.checked = scene.follow; // a reader who draws one path after the other keeps the view
    if (scene.drawable && !again) this.drawing = true;
    this.looking = null;
    if (again && scene.autoplay && !this.calm) { this.near = this.follow.checked ? this.near : 0; this.chase = this.follow.checked = true; } // after a stroke
    this.canvas.setAttribute("aria-label", `${scene.alt} ${KEYS}${scene.drawable ? " P takes the pen to draw a path." : ""}`);
    this.scrub.max = scene.frames - 1;
    this.drawButton.hidden = !scene.drawable;
    this.aside.parentElement.hidden = scene.characters.length < 2;
    this.range = []; this.showRange();
    this.hand.drawn = []; this.hand.pen = false;
    this.say(this.model?.get("message") ?? "");
    this.showSources();
    if (!again) this.frameAll();
    this.seek(this.firstFrame() / scene.fps);
    this.toggle(Boolean(scene.autoplay) && !this.calm);
  }

  // Where the reader was, or Python put it, in this scene: an older scene's frames do not count.
  firstFrame() {
    const placed = [this.model?.get("at"), this.model?.get("move")].find((pair) => pair?.[0] === this.scene.number);
    return placed ? placed[1] : 0;
  }

  say(text) { this.message.textContent = text; this.message.classList.toggle("error", /^\w+Error:/.test(text)); }

  // The coloured bar under the slider with a tick per seam, and the names of its colours.
  showSources() {
    const [{ sources, seams, astray }] = this.characters, { marks } = this.scene, percent = (time) => `${(100 * time) / this.seconds}%`;
    const stops = sources.map((s, i) => `${s.colour} ${percent(s.start)} ${percent(sources[i + 1]?.start ?? this.seconds)}`);
    this.strip.style.background = stops.length ? `linear-gradient(to right, ${stops.join(", ")})` : "none";
    this.strip.replaceChildren(...seams.map((time) => {
      const tick = document.createElement("i");
      Object.assign(tick.style, { left: percent(time), background: marks.seam });
      return tick;
    }));
    const named = sources.length ? sources : this.characters.length > 1 ? this.characters : [];
    const colours = new Map(named.map((s) => [s.name, s.colour]));
    if (seams.length) colours.set("seam", marks.seam);
    if (astray.length) colours.set("off the path", marks.astray);
    this.legend.replaceChildren(...[...colours].flatMap(([name, colour]) => coloured(colour, name)));
  }

  // Look at all characters' paths and the path asked for, from so far away that figures and paths are in the picture.
  frameAll() {
    this.camera.reset(this.scene.drawable ? 0.9 : 0.25);
    this.panned = [0, 0];
    const places = [...this.characters.flatMap((c) => c.path.map(([, x, z]) => [x, z])), ...this.scene.asked];
    const span = (i) => places.reduce(([low, high], p) => [Math.min(low, p[i]), Math.max(high, p[i])], [Infinity, -Infinity]);
    const [[x0, x1], [z0, z1]] = [span(0), span(1)];
    this.centre = [(x0 + x1) / 2, 0.8, (z0 + z1) / 2];
    const corners = places.flatMap(([x, z]) => [-0.3, 0.3].flatMap((d) => [[x + d, 0, z + d], [x + d, 1.9, z + d]]));
    const wide = this.canvas.clientWidth || 720, high = this.canvas.clientHeight || 380;
    const outside = ([x, y]) => Math.abs(x / wide - 0.5) > 0.47 || Math.abs(y / high - 0.5) > 0.47;
    const fits = () => {
      this.camera.place(this.centre, this.reach, wide, high);
      return corners.every((point) => { const seen = this.camera.see(...point); return seen[2] > 0.1 && !outside(this.camera.pixel(seen)); });
    };
    for (this.reach = 3.2; !fits() && this.reach < 1000; this.reach *= 1.1);
    this.update();
  }

  listen() {
    this.play.onclick = () => this.toggle();
    this.scrub.oninput = () => { this.toggle(false); this.seek(Number(this.scrub.value) / this.scene.fps); };
    this.select.onchange = () => { this.speed = Number(this.select.value); };
    this.follow.onchange = () => { this.near = 1; this.chase = false; this.update(); };
    this.ghosts.onchange = () => this.update();
    this.aside.onchange = () => this.beside();
    this.drawButton.onclick = () => { this.drawing = !this.drawing; this.update(); };
    this.resized = new ResizeObserver(() => this.update());
    this.resized.observe(this.canvas);
    this.seen = new IntersectionObserver((entries) => { this.visible = entries.at(-1).isIntersecting; this.update(); });
    this.seen.observe(this.canvas);
    if (this.model) this.link();
  }

  // ---- Python ----

  link() {
    const follow = ([number, frame]) => {
      if (this.scene !== this.latest || number !== this.scene.number || frame === this.frame()) return;
      this.toggle(false);
      this.seek(frame / this.scene.fps);
    };
    this.model.on("change:move", () => follow(this.model.get("move")));
    this.model.on("change:at", () => follow(this.model.get("at"))); // another view of the same player has moved
    this.model.on("change:scene", () => this.load(this.model.get("scene")));
    this.model.on("change:best", () => { this.best = this.model.get("best"); this.update(); });
    this.model.on("change:message", () => { if (this.model.get("message")) { this.looking = null; this.say(this.model.get("message")); } });
  }

  // Send Python the frame, at most twenty times per second, where somebody there wants to know.
  report() {
    if (!this.model || !this.scene.reports || this.reporting) return;
    this.reporting = setTimeout(() => {
      this.reporting = null;
      const [number, frame] = this.model.get("at");
      if (number === this.scene.number && frame === this.frame()) return;
      this.model.set("at", [this.scene.number, this.frame()]);
      this.model.save_changes();
    }, 50);
  }

  ask(path) {
    this.say("Looking for a walk …");
    this.looking = performance.now(); this.best = [];
    this.update();
    this.model.set("message", ""); // or the same message twice would be no change
    this.model.set("path", path);
    this.model.save_changes();
  }

  // ---- time ----

  frame() { return Math.round(this.time * this.scene.fps); }

  seek(time) {
    this.time = Math.min(Math.max(time, 0), this.seconds);
    this.report();
    this.update();
  }

  // The first call marks where what is played begins, the second where it ends, the third takes both back.
  mark() {
    this.range = this.range.length === 2 ? [] : [...this.range, this.time].sort((a, b) => a - b);
    if (this.range.length === 2 && this.range[1] - this.range[0] < 0.1) this.range = [];
    this.showRange();
    this.say(["Plays all.", "Begins here. Press L where it shall end.", "Plays this part. L plays all."][this.range.length]);
  }

  showRange() {
    const percent = (time) => `${(100 * time) / this.seconds}%`, [begin = 0, end = begin] = this.range;
    Object.assign(this.part.style, { left: percent(begin), width: percent(end - begin) });
    this.part.hidden = !this.range.length;
  }

  // Put the characters beside each other, seen from here, or back where they walk.
  beside() {
    const { right } = this.camera, gap = this.aside.checked ? 1.1 : 0, middle = (this.characters.length - 1) / 2;
    this.characters.forEach((character, k) => character.move(gap * (k - middle) * right[0], gap * (k - middle) * right[2], this.scene.marks));
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
    const seconds = this.last === null ? 0 : Math.min(0.25, (now - this.last) / 1000);
    if (this.playing && !this.hand.busy) {
      this.time += seconds * this.speed;
      const [begin, end] = this.range.length === 2 ? this.range : [0, this.seconds];
      if (this.time > end) this.time = end > begin ? begin + ((this.time - begin) % (end - begin)) : begin;
      this.last = now;
      this.report();
      this.update();
    } else this.last = null;
    if (this.looking) this.update();
    this.draw(seconds);
  }

  // ---- the picture ----

  draw(seconds = 0) {
    if (this.chase) this.swing(seconds);
    const { characters, time, reach, hand } = this, { asked, obstacles, sides, marks, drawable } = this.scene, target = this.target();
    const distance = this.follow.checked ? reach + this.near * (4.2 + 1.6 * this.spread() - reach) : reach, ghosts = this.ghosts.checked, dark = isDark();
    this.root.classList.toggle("dark", dark);
    const palette = dark ? DARK : LIGHT, drawn = hand.drawn, pen = hand.pen ? drawn.at(-1) : null;
    const ground = this.follow.checked ? Math.min(reach, FOLLOWED) : reach;
    this.picture.draw({ characters, time, asked, drawn, pen, obstacles, sides, marks, palette, ghosts, target, distance, reach: ground, light: LOOKS[dark ? "dark" : "light"] });
    if (this.looking) this.showLooking(palette.asked);
    if (drawable && (this.follow.checked || this.looking)) this.picture.drawInset(drawn.length ? drawn : asked, characters[0].pose(time), hand.yaw ?? 0.7, palette);
    this.showState();
  }

  // After a stroke: come near, to a view from three quarters in front, and turn slowly with the walk, until the reader turns it.
  swing(seconds) {
    const { camera, characters: [first], time } = this, share = (rate) => 1 - Math.exp(-rate * seconds);
    const [a, b] = [first.pose(time - 0.5), first.pose(time + 0.2)], turn = Math.atan2(b[0] - a[0], b[2] - a[2]) + 0.75 - camera.yaw;
    camera.yaw += share(this.near < 0.9 ? 2 : 0.5) * Math.atan2(Math.sin(turn), Math.cos(turn));
    camera.pitch += share(2) * (0.3 - camera.pitch);
    camera.zoom += share(2) * (1 - camera.zoom);
    this.near += share(2) * (1 - this.near);
  }

  // While Python looks for a walk: the best one so far, a place that runs along the reader's line, and the seconds.
  showLooking(colour) {
    const { drawn } = this.hand, seconds = (performance.now() - this.looking) / 1000;
    this.picture.stroke([this.best.map(([x, z]) => [x, 0, z])], this.scene.marks.seam, 4);
    this.picture.write(`looking for a walk: ${seconds.toFixed(1)} s`);
    if (!drawn.length || this.calm || this.best.length) return;
    const [x, z] = drawn[Math.floor(20 * seconds) % drawn.length];
    this.picture.disc([x, 0.01, z], 0.15, colour, 0.9, true);
  }

  // Above the ground amid the characters, averaged over a second so that the view does not rock with each step.
  target() {
    const { panned: [x, z], near } = this, whole = [this.centre[0] + x, this.centre[1], this.centre[2] + z];
    if (!this.follow.checked) return whole;
    const mean = [x, 0.85, z], share = 1 / (9 * this.characters.length);
    for (const character of this.characters) {
      for (let i = -4; i <= 4; i++) {
        const pose = character.pose(this.time + i / 8);
        mean[0] += share * pose[0]; mean[2] += share * pose[2];
      }
    }
    return mean.map((value, k) => whole[k] + near * (value - whole[k]));
  }

  // How far the characters are from the middle between them, at most, in metres.
  spread() {
    const places = this.characters.map((character) => character.pose(this.time)), mean = (k) => places.reduce((sum, place) => sum + place[k] / places.length, 0);
    const [x, z] = [mean(0), mean(2)];
    return Math.max(...places.map((place) => Math.hypot(place[0] - x, place[2] - z)));
  }

  showState() {
    const frame = this.frame(), text = `frame ${frame} of ${this.scene.frames} · ${this.time.toFixed(2)} s`;
    if (document.activeElement !== this.scrub || this.playing) this.scrub.value = frame;
    this.scrub.setAttribute("aria-valuetext", text);
    this.clock.textContent = text;
    this.drawButton.setAttribute("aria-pressed", Boolean(this.drawing));
    this.canvas.classList.toggle("drawing", Boolean(this.drawing));
    Object.assign(this.root.dataset, { frame, playing: this.playing });
    this.pictures++;
    this.firstPicture ??= performance.now();
  }

  end() { this.resized?.disconnect(); this.seen?.disconnect(); clearTimeout(this.reporting); cancelAnimationFrame(this.waiting); }
}

// In JupyterLab: called by anywidget.
export default {
  render({ model, el }) {
    el.player = new Player(el, model.get("scene"), model);
    return () => el.player.end();
  },
};
