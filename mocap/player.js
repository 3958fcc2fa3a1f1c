// A player of stick figures on a canvas, without any library.
//
// `player.py` packs a scene: characters whose joints' places are 16-bit numbers, low + step · number metres. Sent
// are their second differences over time, a coordinate after the other, deflated: less than half as much.
// The same module runs in two shells: a page starts every `.mocap-player` in it (`startAll`), and anywidget
// calls `render`, whose `model` shares `frame`, `scene` and `path` with Python.
// World: y up, metres, seconds. A camera goes round a target; `Camera.see` is all the projection there is.

const KEYS = "Space plays, arrows step, shift and arrows turn the view, plus and minus zoom.";
const GHOSTS = 6, GHOST_GAP = 0.25; // how many earlier poses, and the seconds between them

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

class Camera {
  constructor() { this.reset(); }
  reset() { this.yaw = 0.7; this.pitch = 0.25; this.zoom = 1; }

  // Stand `distance` away from `target`, on a canvas of width × height pixels.
  place(target, distance, width, height) {
    const d = distance / this.zoom, cy = Math.cos(this.yaw), sy = Math.sin(this.yaw);
    const cp = Math.cos(this.pitch), sp = Math.sin(this.pitch);
    this.eye = [target[0] + d * sy * cp, target[1] + d * sp, target[2] + d * cy * cp];
    this.right = [cy, 0, -sy];
    this.up = [-sy * sp, cp, -cy * sp];
    this.ahead = [-sy * cp, -sp, -cy * cp];
    this.focus = 1.5 * Math.min(width, height);
    this.middle = [width / 2, height / 2];
  }

  // Where a point is for the eye: [to the right, up, ahead], metres.
  see(x, y, z) {
    const a = x - this.eye[0], b = y - this.eye[1], c = z - this.eye[2];
    const along = (v) => a * v[0] + b * v[1] + c * v[2];
    return [along(this.right), along(this.up), along(this.ahead)];
  }

  pixel([right, up, ahead]) {
    const scale = this.focus / ahead;
    return [this.middle[0] + right * scale, this.middle[1] - up * scale];
  }

  // The point of the ground under a pixel, or null above the horizon.
  ground(px, py) {
    const r = (px - this.middle[0]) / this.focus, u = (this.middle[1] - py) / this.focus;
    const ray = [0, 1, 2].map((i) => this.ahead[i] + r * this.right[i] + u * this.up[i]);
    const far = -this.eye[1] / ray[1];
    return far > 0 && far < 100 ? [this.eye[0] + far * ray[0], this.eye[2] + far * ray[2]] : null;
  }
}

async function inflated(data) {
  const fromBase64 = (text) => Uint8Array.fromBase64?.(text) ?? Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const bytes = typeof data === "string" ? fromBase64(data) : data;
  return new Response(new Response(bytes).body.pipeThrough(new DecompressionStream("deflate"))).arrayBuffer();
}

// A character: where its joints are at any time.
class Character {
  constructor(packed, bytes) {
    Object.assign(this, packed);
    this.numbers = new Uint16Array(bytes, packed.offset, packed.frames * packed.joints * 3);
    this.sum();
    this.seconds = (packed.frames - 1) / packed.fps;
    this.path = this.pathOnGround();
  }

  // Undo the differences, which wrap round at 2¹⁶.
  sum() {
    for (let i = 0, change = 0, number = 0; i < this.numbers.length; i++) {
      if (i % this.frames === 0) change = number = 0;
      change = (change + this.numbers[i]) & 65535;
      this.numbers[i] = number = (number + change) & 65535;
    }
  }

  // All joints at a time, between two frames on straight lines: x, y, z, x, y, z, ...
  pose(time) {
    const at = Math.min(Math.max(time, 0), this.seconds) * this.fps;
    const frame = Math.min(Math.floor(at), this.frames - 1), share = at - frame;
    const next = Math.min(frame + 1, this.frames - 1), places = new Float32Array(this.joints * 3);
    for (let i = 0; i < places.length; i++) places[i] = this.place(i, frame) * (1 - share) + this.place(i, next) * share;
    return places;
  }

  place(coordinate, frame) {
    return this.low[coordinate % 3] + this.step[coordinate % 3] * this.numbers[coordinate * this.frames + frame];
  }

  // [time, x, z] of the root, at most about a thousand times.
  pathOnGround() {
    const every = Math.max(1, Math.floor(this.frames / 1000)), path = [];
    for (let frame = 0; frame < this.frames; frame += every) path.push([frame / this.fps, this.place(0, frame), this.place(2, frame)]);
    return path;
  }

  // The colour of the clip that a time comes from.
  colourAt(time) {
    let colour = this.colour;
    for (const source of this.sources) if (source.start <= time + 1e-9) colour = source.colour;
    return colour;
  }
}

class Player {
  constructor(root, scene, model) {
    this.root = root; this.model = model; this.camera = new Camera();
    this.time = 0; this.speed = 1; this.playing = false; this.visible = true; this.pictures = 0; this.drawn = [];
    this.calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.build();
    this.load(scene).then(() => this.listen());
  }

  // ---- the page ----

  build() {
    this.root.classList.add("mocap-player");
    this.root.dataset.started = "true"; // so that no page's script takes a live player for one of its own
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
    if (!again) this.follow.checked = scene.follow; // who has drawn a path keeps the view for the next one
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

  // The bar under the slider, and the words that go with its colours.
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

  // Where the camera looks when it follows nobody, and from how far.
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

  // Tell Python the frame, at most twenty times a second.
  tell() {
    if (!this.model || this.telling) return;
    this.telling = setTimeout(() => {
      this.telling = null;
      if (this.model.get("frame") === this.frame()) return;
      this.model.set("frame", this.frame());
      this.model.save_changes();
    }, 50);
  }

  // ---- time ----

  frame() { return Math.round(this.time * this.scene.fps); }

  seek(time) {
    this.time = Math.min(Math.max(time, 0), this.seconds);
    this.tell();
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
      this.tell();
      this.update();
    }
    this.draw();
  }

  // ---- hands ----

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

  // A wheel over a picture that nobody has chosen scrolls the page.
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

  // One finger or the mouse turns the view, two fingers zoom; while drawing, the pen goes over the ground.
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
    const { canvas, camera } = this, sharp = devicePixelRatio || 1, wide = canvas.clientWidth, high = canvas.clientHeight;
    const pixels = [wide, high].map((size) => Math.round(size * sharp));
    if (canvas.width !== pixels[0] || canvas.height !== pixels[1]) [canvas.width, canvas.height] = pixels;
    this.pen2d = canvas.getContext("2d");
    this.pen2d.setTransform(sharp, 0, 0, sharp, 0, 0);
    this.pen2d.clearRect(0, 0, wide, high);
    this.pen2d.lineCap = this.pen2d.lineJoin = "round";
    const target = this.target();
    camera.place(target, this.follow.checked ? 4.2 : this.reach, wide, high);
    this.drawGround(target);
    const flat = (places) => places.map(([x, z]) => [x, 0, z]);
    this.stroke([flat(this.scene.asked)], "#000000", 6, 0.75);
    this.stroke([flat(this.drawn)], "#000000", 3);
    for (const character of this.characters) this.drawTrail(character);
    if (this.ghosts.checked) this.drawGhosts();
    this.drawBodies();
    this.showState();
  }

  // The ground under the first character, smoothed over a second so that the view does not rock with each step.
  target() {
    if (!this.follow.checked) return this.centre;
    const mean = [0, 0.85, 0];
    for (let i = -4; i <= 4; i++) {
      const pose = this.characters[0].pose(this.time + i / 8);
      mean[0] += pose[0] / 9; mean[2] += pose[2] / 9;
    }
    return mean;
  }

  // Lines a metre apart that stay where they are in the world and fade with distance.
  drawGround([x, , z]) {
    const reach = Math.max(6, Math.ceil(1.3 * this.reach / Math.min(1, this.camera.zoom)));
    const x0 = Math.round(x), z0 = Math.round(z);
    for (let i = -reach; i <= reach; i++) {
      const fade = 1 - Math.abs(i) / (reach + 1);
      const along = [[x0 + i, 0, z0 - reach], [x0 + i, 0, z0 + reach]];
      const across = [[x0 - reach, 0, z0 + i], [x0 + reach, 0, z0 + i]];
      this.stroke([along, across], "#bbbbbb", 1, fade);
    }
  }

  // The root's path in the colours of its sources, and footprints: strong while the foot stands, pale once it left.
  drawTrail(character) {
    const { path } = character;
    for (let i = 1, start = 0; i <= path.length; i++) {
      const colour = character.colourAt(path[start][0]);
      if (i < path.length && character.colourAt(path[i][0]) === colour) continue;
      const end = Math.min(i + 1, path.length);
      const line = path.slice(start, end).map(([, px, pz]) => [px, 0, pz]);
      this.stroke([line], character.sources.length ? colour : character.path_colour, 2.5);
      start = i;
    }
    for (const [start, end, px, pz, side] of character.prints) {
      if (this.time >= start) this.disc([px, 0.005, pz], 0.055, this.scene.sides[side], this.time < end ? 0.95 : 0.25, true);
    }
  }

  drawGhosts() {
    for (let k = GHOSTS; k > 0; k--) {
      const time = this.time - k * GHOST_GAP;
      if (time < 0) continue;
      for (const character of this.characters) {
        const lines = this.bones(character, time).map((bone) => bone.ends);
        this.stroke(lines, character.colourAt(time), 0.03, 0.5 * (1 - k / (GHOSTS + 1)), true);
      }
    }
  }

  bones(character, time) {
    const pose = character.pose(time), place = (joint) => Array.from(pose.subarray(3 * joint, 3 * joint + 3));
    const bones = character.bones.map(([from, to, side]) => ({ ends: [place(from), place(to)], side }));
    bones.head = character.head === null ? null : place(character.head);
    return bones;
  }

  // Shadows first, then all bones of all bodies from the farthest to the nearest.
  drawBodies() {
    const parts = [];
    for (const character of this.characters) {
      const bones = this.bones(character, this.time), own = character.colourAt(this.time);
      this.stroke(bones.map(({ ends }) => ends.map(([x, , z]) => [x, 0, z])), "#000000", 0.05, 0.15, true);
      for (const { ends, side } of bones) {
        const far = this.camera.see(...ends[0])[2] + this.camera.see(...ends[1])[2];
        parts.push({ far: far / 2, paint: () => this.stroke([ends], side ? this.scene.sides[side] : own, 0.04, 1, true) });
      }
      if (bones.head) parts.push({ far: this.camera.see(...bones.head)[2], paint: () => this.disc(bones.head, 0.095, own, 1, false) });
    }
    for (const part of parts.sort((a, b) => b.far - a.far)) part.paint();
  }

  // Lines through points of the world, in one go, so that where they meet they are no darker; what lies behind
  // the eye is cut off. Widths are pixels, or metres.
  stroke(lines, colour, width, alpha = 1, metres = false) {
    const { camera, pen2d } = this, near = 0.1;
    let far = 0;
    pen2d.beginPath();
    for (const line of lines) {
      const seen = line.map((point) => camera.see(...point));
      for (let i = 1; i < seen.length; i++) {
        let [a, b] = [seen[i - 1], seen[i]];
        if (a[2] < near && b[2] < near) continue;
        const cut = (p, q) => p.map((v, k) => v + (q[k] - v) * (near - p[2]) / (q[2] - p[2]));
        if (a[2] < near) a = cut(a, b); else if (b[2] < near) b = cut(b, a);
        far = (a[2] + b[2]) / 2;
        pen2d.moveTo(...camera.pixel(a)); pen2d.lineTo(...camera.pixel(b));
      }
    }
    if (!far) return;
    pen2d.globalAlpha = alpha; pen2d.strokeStyle = colour;
    pen2d.lineWidth = metres ? Math.max(1, (width * camera.focus) / far) : width;
    pen2d.stroke();
    pen2d.globalAlpha = 1;
  }

  // A ball, or, where it lies flat, a disc on the ground.
  disc(place, radius, colour, alpha, flat) {
    const { camera, pen2d } = this, seen = camera.see(...place);
    if (seen[2] < 0.1) return;
    const r = (radius * camera.focus) / seen[2];
    pen2d.globalAlpha = alpha; pen2d.fillStyle = colour;
    pen2d.beginPath();
    pen2d.ellipse(...camera.pixel(seen), r, flat ? r * Math.sin(camera.pitch) + 0.5 : r, 0, 0, 2 * Math.PI);
    pen2d.fill();
    pen2d.globalAlpha = 1;
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

  end() { this.resized?.disconnect(); this.seen?.disconnect(); clearTimeout(this.telling); cancelAnimationFrame(this.waiting); }
}

// Shell one: a page. Each output that comes starts the players that have not been started yet.
export function startAll() {
  for (const root of document.querySelectorAll(".mocap-player:not([data-started])")) {
    root.player = new Player(root, JSON.parse(root.querySelector("script").textContent), null);
  }
}

// Shell two: anywidget.
export default {
  render({ model, el }) {
    el.player = new Player(el, model.get("scene"), model);
    return () => el.player.end();
  },
};
