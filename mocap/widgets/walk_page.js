// The page: a reader draws, the walk grows while it is played, and what plays lights up. `walking_page.py` fills it.

import { prepare, unpack, Walk, nearest } from "./walk_search.js";
import { bodyAt, edgeAt, footprints } from "./walk_body.js";
import { arrays, firstLine, ledOnto, read, written } from "./walk_line.js";
import { Camera } from "./walk_camera.js";
import { Hands } from "./walk_hands.js";
import { LOOKS, rgb } from "./bodies.js";
import { COLOURS, Scene } from "./walk_scene.js";
import { drawSmall } from "./walk_small.js";
import { bvh, download, gif } from "./walk_saving.js";

const LAG = 34, MOST = 12; // frames from figure to figure of the parade
const $ = (id) => document.getElementById(id), clamp = (value, low, high) => Math.max(low, Math.min(value, high));
const asked = (query) => matchMedia(query).matches;

async function loaded() {
  const about = JSON.parse($("about").textContent), packed = Uint8Array.from(atob($("graph").textContent.trim()), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return prepare(unpack(about, new Uint8Array(await new Response(stream).arrayBuffer())));
}

class Page extends Hands {
  constructor(graph) {
    super();
    const { labels, figure } = graph.about, begun = Math.max(0, labels.indexOf("walk"));
    Object.assign(this, { graph, about: graph.about, kind: begun, figures: 1, time: 0, playing: !asked("(prefers-reduced-motion: reduce)") });
    Object.assign(this, { canvas: $("stage"), camera: new Camera(), look: LOOKS[asked("(prefers-color-scheme: dark)") ? "dark" : "light"] });
    Object.assign(this, { scene: new Scene($("stage"), figure, MOST), touches: new Map(), sharp: 1, slow: 0, before: performance.now() });
    this.listen();
    this.buttons();
    this.fit();
    if (!this.fromAddress()) this.set(firstLine(), false);
    this.aim(0, true);
    requestAnimationFrame((now) => this.picture(now));
  }

  get bits() { return 1 << this.kind; }

  // ---- a line, and the walk along it ----

  // Walk along points; where they begin near the figure, it goes on from where it is, and turns round where they lead back.
  set(points, told = true) {
    if (points.length < 80) { this.say("Draw a longer line: a metre or more."); return; }
    const near = this.walk?.frames && Math.hypot(points[0][0] - this.place()[0], points[0][1] - this.place()[1]) < 1.2;
    if (near) {
      const [[z, x], here] = [-8, 0].map((back) => this.placeAt(this.walk.turnFrom(this.time + 6) + back));
      points = ledOnto(points, here, Math.atan2(here[1] - x, here[0] - z));
    } else Object.assign(this, { walk: new Walk(this.graph), time: 0 });
    this.points = points;
    this.line = arrays(points);
    this.walk.labels = this.bits;
    this.walk.follow(this.line);
    Object.assign(this, { growing: null, ghost: null, prints: near ? this.prints.filter((print) => print.frame < this.walk.frames) : [], shown: null });
    this.begun = performance.now();
    $("moments").hidden = true;
    if (told) {
      history.replaceState(null, "", `#${this.about.labels[this.kind] ?? "any"}.${written(points)}`);
      document.body.classList.add("walking");
    }
  }

  fromAddress() {
    const [label, word] = location.hash.slice(1).split("."), kind = this.about.labels.indexOf(label), points = word && read(word);
    if (kind >= 0) this.choose(kind);
    if (points) this.set(points, false);
    return Boolean(points);
  }

  choose(kind) {
    this.kind = kind;
    this.about.labels.forEach((_, k) => $(`kind${k}`)?.setAttribute("aria-pressed", k === kind));
  }

  // Search on for some milliseconds, while less than three seconds of walk are left.
  grow(milliseconds) {
    const { walk } = this, end = performance.now() + milliseconds;
    while (!walk.done && walk.frames - this.time < 90 && performance.now() < end) {
      this.growing ??= walk.grow();
      const { value, done } = this.growing.next();
      if (value) this.ghost = value;
      if (done) this.grown();
    }
  }

  grown() {
    const known = this.prints.length ? this.prints.at(-1).frame + 4 : 0;
    this.growing = this.ghost = null;
    if (!this.walk.frames) { this.say(`No ${this.about.labels[this.kind]} in these clips goes along this line.`); return; }
    this.prints.push(...footprints(this.walk, this.about.feet, known).filter((print) => print.frame >= known));
    this.first ??= performance.now() - this.begun;
    if (this.walk.done) this.tell();
  }

  tell() {
    const { walk, about } = this, seams = walk.edges.filter((edge, at) => edge.seam && walk.begins[at] >= walk.since).length, offs = [];
    for (let frame = walk.since; frame < walk.frames; frame += 3) {
      const place = this.placeAt(frame), k = nearest(this.line, place);
      offs.push(Math.hypot(this.line.z[k] - place[0], this.line.x[k] - place[1]));
    }
    const off = (100 * offs.reduce((sum, one) => sum + one, 0)) / offs.length, names = [...new Set(walk.edges.map((edge) => about.clips[edge.start.clip].name))];
    this.say(`${(this.line.z.length / 100).toFixed(1)} m · ${seams} seams · ${off.toFixed(0)} cm off the line`);
    this.canvas.setAttribute("aria-label", `A figure walks ${(this.line.z.length / 100).toFixed(0)} metres along a line in ${((walk.frames - walk.since) / about.fps).toFixed(0)} seconds, from the clips ${names.join(", ")}, with ${seams} seams.`);
  }

  say(text) { $("told").textContent = text; }

  placeAt(frame) {
    const [at, i] = edgeAt(this.walk, clamp(Math.floor(frame), 0, this.walk.frames - 1)), [c, s, z, x] = this.walk.lays[at], { track } = this.walk.edges[at];
    return [c * track.z[i] - s * track.x[i] + z, s * track.z[i] + c * track.x[i] + x];
  }

  place(ahead = 0) { return this.placeAt(this.time + ahead); }

  // ---- pictures ----

  fit() {
    const ratio = Math.min(devicePixelRatio, 2) * this.sharp;
    Object.assign(this, { width: innerWidth, height: innerHeight });
    Object.assign(this.canvas, { width: innerWidth * ratio, height: innerHeight * ratio });
  }

  aim(seconds, snap) {
    const tall = this.width < this.height;
    if (this.stroke) return;
    if (this.above || !this.walk.frames) this.camera.hold(this.line, tall);
    else {
      const frame = Math.min(this.time, this.walk.frames - 1), [z, x] = this.placeAt(frame - (this.figures > 1 ? (this.figures * LAG) / 3 : 0)), [az, ax] = this.placeAt(frame - 15), [bz, bx] = this.placeAt(frame + 5);
      this.camera.follow(seconds, [z, x], Math.atan2(bx - ax, bz - az), tall, this.figures > 1 ? 2.2 : 0);
    }
    this.camera.step(seconds, snap);
  }

  picture(now) {
    const since = now - this.before, seconds = clamp(since / 1000, 0, 0.1), { walk } = this;
    this.before = now;
    this.grow(walk.frames - this.time < 15 ? clamp(since, 40, 250) : 10); // half of the time where the figure would wait, however slow pictures are
    if (this.playing && walk.frames && !this.stroke && !this.shown) {
      const last = walk.frames - 1 + (walk.done ? (this.figures - 1) * LAG : 0);
      this.time = Math.min(this.time + seconds * this.about.fps, last);
      if (walk.done && this.time >= last) this.rest = (this.rest ?? 0) + seconds; else this.rest = 0;
      if (this.rest > 1.5) { this.time = 0; this.rest = 0; }
    }
    this.slow = clamp(this.slow + (seconds > 0.04 ? 1 : -1), 0, 20); // too few pictures a second: fewer pixels
    if (this.slow === 20 && this.sharp > 0.5) { this.sharp *= 0.8; this.slow = 0; this.fit(); }
    this.aim(seconds);
    this.draw();
    requestAnimationFrame((next) => this.picture(next));
  }

  bodies() {
    const { walk, shown } = this;
    if (!walk.frames) return [];
    if (shown) return shown.bodies;
    const all = Array.from({ length: this.figures }, (_, n) => this.time - n * LAG).filter((time, n) => !n || time >= 0);
    return all.map((time) => bodyAt(walk, Math.min(time, walk.frames - 1)));
  }

  draw() {
    const { scene, walk, look, camera } = this, half = clamp(camera.at.far * camera.hand.zoom * 0.0055, 0.022, 0.06), line = rgb(look.line), ink = rgb(look.ink);
    const seen = camera.view(this.width, this.height);
    Object.assign(scene, { eye: seen.eye, reach: 1.2 * camera.at.far * camera.hand.zoom });
    if (this.stroke) scene.band(this.stroke, half, line, () => 1);
    else {
      const step = Math.max(3, Math.ceil(this.points.length / 700)), thin = this.points.filter((_, i) => i % step === 0), here = walk.frames ? nearest(this.line, this.place()) / step : 0;
      scene.band(thin, half, line, (i) => (i < here ? 0.35 : 0.95));
    }
    if (this.ghost) this.drawGhost(half, ink);
    if (walk.frames && !this.stroke) {
      this.drawTrail(half, ink);
      for (const print of this.prints) {
        const age = this.time - print.frame;
        if (age > 0 && age < 180) scene.disc([print.z, print.x], 0.12, 0.045, print.angle, ink, 0.3 * Math.min(1, age / 4) * (1 - age / 180), 0.005);
      }
      for (const { at, frame } of this.seams()) {
        const near = Math.max(0, 1 - Math.abs(this.time - frame) / 12), place = this.placeAt(frame), colour = rgb(COLOURS[walk.edges[at].end.clip % 7]);
        scene.disc(place, half * (1.5 + 2 * near), half * (1.5 + 2 * near), 0, colour, 0.95, 0.007);
        scene.disc(place, half * 0.7, half * 0.7, 0, rgb(look.ground), 0.95, 0.008);
      }
    }
    scene.draw(seen, look, this.stroke ? [] : this.bodies());
    if ((this.ticks = (this.ticks ?? 0) + 1) % 4 === 1) drawSmall(this, $("small"));
  }

  drawGhost(half, colour) { // the best walk of a search that is under way
    const points = [];
    for (let walk = this.ghost; walk.before; walk = walk.before) {
      const [c, s, z, x] = walk.before.lay, { track } = walk.edge;
      for (let i = track.z.length - 1; i >= 0; i -= 3) points.push([c * track.z[i] - s * track.x[i] + z, s * track.z[i] + c * track.x[i] + x]);
    }
    if (points.length > 1) this.scene.band(points, half * 0.4, colour, () => 0.4, 0.006);
  }

  drawTrail(half, colour) { // two seconds back and ahead
    const from = Math.max(0, Math.floor(this.time) - 60), to = Math.min(this.walk.frames - 1, Math.floor(this.time) + 60), points = [];
    for (let frame = from; frame <= to; frame += 2) points.push(this.placeAt(frame));
    this.scene.band(points, half * 0.4, colour, (i) => 0.6 * (1 - ((from + 2 * i - this.time) / 60) ** 2), 0.006);
  }

  seams() {
    const { walk } = this;
    return walk.edges.flatMap((edge, at) => (edge.seam ? [{ at, frame: walk.begins[at] + 5 }] : [])).filter(({ frame }) => frame < walk.frames);
  }

  play(on) {
    this.playing = on;
    $("play").textContent = on ? "stop" : "go";
  }

  view(above) {
    this.above = above;
    Object.assign(this.camera.hand, { yaw: 0, pitch: 0, zoom: 1 });
    $("above").setAttribute("aria-pressed", above);
  }

  buttons() {
    const { labels } = this.about;
    labels.forEach((name, kind) => {
      if (!this.about.going.includes(name)) return;
      const button = Object.assign(document.createElement("button"), { id: `kind${kind}`, textContent: name });
      button.onclick = () => { this.choose(kind); if (this.points) this.set(this.points); };
      $("kinds").append(button, " ");
    });
    this.choose(this.kind);
    this.play(this.playing);
    $("play").onclick = () => this.play(!this.playing);
    $("above").onclick = () => this.view(!this.above);
    $("parade").onclick = () => { this.figures = this.figures > 1 ? 1 : MOST; $("parade").setAttribute("aria-pressed", this.figures > 1); };
    $("bvh").onclick = () => { this.finish(); download(bvh(this.walk), "walk.bvh"); };
    $("gif").onclick = () => this.saveGif();
  }

  finish() { // search to the line's end
    const { time } = this;
    while (!this.walk.done) { this.time = this.walk.frames; this.grow(1000); }
    this.time = time;
  }

  saveGif() {
    this.finish();
    const { canvas, walk } = this, time = this.time, small = document.createElement("canvas"), width = 400, height = Math.round((width * this.height) / this.width), pictures = [];
    Object.assign(small, { width, height });
    const pen = small.getContext("2d", { willReadFrequently: true });
    for (let frame = 0; frame < Math.min(walk.frames, 20 * this.about.fps); frame += this.about.fps / 12.5) {
      this.time = frame;
      this.aim(0.08, frame === 0);
      this.draw();
      pen.drawImage(canvas, 0, 0, width, height);
      pictures.push(pen.getImageData(0, 0, width, height).data);
    }
    this.time = time;
    download(gif(pictures, width, height, 8), "walk.gif");
  }
}

loaded().then((graph) => { window.page = new Page(graph); });
