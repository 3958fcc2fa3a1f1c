// The page: a reader draws, the walk grows while it plays, and the current clip is highlighted. `walking_page.py` fills it.

import { nearest, prepare, unpack } from "./walk_search.js";
import { carry } from "./walk_bending.js";
import { bodyAt, edgeAt, footprints } from "./walk_body.js";
import {
  arrays,
  firstLine,
  meanDistance,
  pathOnto,
  read,
  roundedBy,
  walkable,
  written,
} from "./walk_line.js";
import { Walk } from "./walk_pieces.js";
import { Camera } from "./walk_camera.js";
import { Hands } from "./walk_hands.js";
import { LOOKS, rgb } from "./bodies.js";
import { penOf } from "./canvas.js";
import { COLOURS, Scene } from "./walk_scene.js";
import { drawSmall } from "./walk_small.js";
import { cutOf, trackOfWalk } from "./walk_steps.js";
import { colourOfClip, Story } from "./walk_story.js";
import { bvh, download, Film, Gif } from "./walk_saving.js";

/**
 * @import { Print } from "./walk_body.js"
 * @import { Graph, Line, SearchedWalk } from "./walk_search.js"
 *
 * A walk, the line that was drawn, the one that is walked, the footprints, and the frame that is shown.
 * @typedef {{
 *   walk: Walk, drawn: number[][], points: number[][], line: Line, prints: Print[], time: number, kind: number,
 * }} Shown
 */

const LAG = 34; // frames from figure to figure of the parade
const PARADE = 12; // figures of it
const RESTS = 1.5; // seconds at the end of a walk until it begins anew
const LONGEST = 20; // seconds of a walk that are saved as pictures
const FILM_FPS = 30; // pictures of a film per second
const FILM_END = 0.7; // seconds of the walk's end in a film
const MOST_UNDONE = 50; // lines before
const SEARCH_SHARE = 0.2; // of the time of a picture for the search, while the walk goes on
const SEEN = 0.05; // metres: a line that is rounded by less is not called rounded

/**
 * A part of the page.
 * @param {string} id
 */
function $(id) {
  const found = document.getElementById(id);
  if (!found) throw new Error(`The page has no #${id}.`);
  return found;
}

/**
 * @param {number} value
 * @param {number} low
 * @param {number} high
 */
const clamp = (value, low, high) => Math.max(low, Math.min(value, high));
/** @param {string} query */
const asked = (query) => matchMedia(query).matches;

/** @param {string} id */
function canvasOf(id) {
  const found = $(id);
  if (!(found instanceof HTMLCanvasElement)) throw new Error(`#${id} is no canvas.`);
  return found;
}

async function loaded() {
  const about = JSON.parse($("about").textContent ?? "");
  const packed = Uint8Array.from(atob(($("graph").textContent ?? "").trim()), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return prepare(unpack(about, new Uint8Array(await new Response(stream).arrayBuffer())));
}

export class Page extends Hands {
  /** @type {Walk} */
  walk;
  /** @type {number[][]} of the line, [z, x] */
  points;
  /** @type {number[][]} the line as it was drawn, [z, x] */
  drawn;
  /** @type {number} metres by which its corners were rounded */
  rounded = 0;
  /** @type {Line} that is walked along */
  line;
  /** @type {Shown | null} the walk before, which stays until there is a new one */
  previous = null;
  /** @type {boolean} whether the walk is being saved as pictures */
  saving = false;
  /** @type {Film | null} the film that is recorded while the walk plays */
  film = null;
  /** @type {{ drawn: number[][], kind: number }[]} the lines before this one */
  past = [];
  /** @type {Generator<SearchedWalk, void> | null} the search that is under way */
  growing = null;
  /** @type {SearchedWalk | null} the best walk of it so far */
  ghost = null;
  /** @type {Print[]} */
  prints = [];
  /** @type {number} when the line was drawn */
  begun = 0;
  /** @type {number | undefined} milliseconds from there to the first walk of the page */
  first;
  /** @type {number} width of the page, pixels */
  width = 0;
  /** @type {number} height of the page, pixels */
  height = 0;
  time = 0; // the frame that is shown
  figures = 1;
  above = false; // whether all of the line is seen
  rest = 0; // seconds since the walk is at its end
  sharp = 1; // as a fraction of the screen's pixels
  slow = 0; // pictures that came late, at most 20
  ticks = 0; // pictures
  cut = false; // whether seams are cut in place of blended

  /** @param {Graph} graph */
  constructor(graph) {
    super();
    this.graph = graph;
    this.about = graph.about;
    const { labels, moving } = this.about;
    this.kind = labels.indexOf(moving.includes("walk") ? "walk" : (moving[0] ?? ""));
    this.playing = !asked("(prefers-reduced-motion: reduce)");
    this.look = asked("(prefers-color-scheme: dark)") ? LOOKS.dark : LOOKS.light;
    this.moments = $("moments");
    this.canvas = canvasOf("stage");
    this.small = canvasOf("small");
    this.now = $("now");
    this.camera = new Camera();
    this.scene = new Scene(this.canvas, this.about.figure, PARADE + 2); // and the two moments of a seam
    this.story = new Story(this);
    this.before = performance.now();
    document.body.classList.toggle("embedded", window !== window.top); // in a frame there is no room for the story
    this.listen();
    this.buttons();
    this.fit();
    if (!this.fromAddress()) this.set(firstLine(), { announced: false });
    this.aim(0, true);
    requestAnimationFrame((now) => this.picture(now));
  }

  get bits() {
    return this.kind < 0 ? -1 : 1 << this.kind; // any kind where none has a button
  }

  // ---- a line, and the walk along it ----

  /**
   * Walk along points. If they begin near the figure, it continues from its position, and turns around if they lead back.
   * The walk before stays until the new one has begun.
   * @param {number[][]} points
   * @param {{ announced?: boolean, drawn?: number[][], anew?: boolean }} how whether the reader asks for it, the line as
   *   it was drawn, and whether the walk begins at the start of the line in any case
   */
  set(points, { announced = true, drawn = points, anew = false } = {}) {
    if (points.length < 80) {
      this.showMessage("Draw a longer line: a metre or more.");
      return;
    }
    if (announced && this.drawn && this.drawn !== drawn) this.remember();
    this.points = this.begin(points, anew);
    this.line = arrays(this.points);
    this.drawn = drawn;
    this.rounded = roundedBy(drawn, points);
    this.walk.labels = this.bits;
    this.walk.follow(this.line);
    this.growing = null;
    this.ghost = null;
    this.shown = null;
    this.begun = performance.now();
    this.moments.hidden = true;
    this.showMessage("");
    if (announced) {
      history.replaceState(null, "", `#${this.about.labels[this.kind] ?? "any"}.${written(drawn)}`);
      document.body.classList.add("walking");
      this.play(true); // also where motion is reduced: the reader asks for this walk
    }
  }

  // Keep the line that is walked, for an undo.
  remember() {
    this.past = [...this.past, { drawn: this.drawn, kind: this.kind }].slice(-MOST_UNDONE);
    $("undo").hidden = false;
  }

  // Walk along the line before this one again.
  undo() {
    const before = this.past.pop();
    $("undo").hidden = !this.past.length;
    if (!before) return;
    const { past } = this;
    this.choose(before.kind);
    this.set(walkable(before.drawn), { drawn: before.drawn, anew: true });
    this.past = past; // an undo is no stroke
    $("undo").hidden = !past.length;
  }

  /**
   * Begin a walk at the start of a line, or return a path from the figure onto the line if it is near.
   * @param {number[][]} points
   * @param {boolean} anew
   */
  begin(points, anew) {
    const { walk, line, prints, time, drawn } = this;
    if (!anew && walk?.frames && walk.labels === this.bits && this.isNear(points[0])) {
      this.previous = null;
      return this.redirect(points);
    }
    if (walk?.frames) {
      const kind = walk.labels < 0 ? -1 : Math.log2(walk.labels);
      this.previous = { walk, drawn, points: this.points, line, prints, time, kind };
    }
    this.walk = new Walk(this.graph);
    this.time = 0;
    this.prints = [];
    return points;
  }

  /**
   * Whether the figure is near a point.
   * @param {number[]} point
   */
  isNear([pz, px]) {
    const [z, x] = this.position();
    return Math.hypot(pz - z, px - x) < 1.2;
  }

  /**
   * Cut the walk soon after the current frame, and return a path from its new end onto a line.
   * @param {number[][]} points
   */
  redirect(points) {
    const end = this.walk.cutAfter(this.time + 6);
    this.prints = this.prints.filter((print) => print.frame < this.walk.frames);
    const [z, x] = this.positionAt(end - 8);
    const position = this.positionAt(end);
    return pathOnto(points, position, Math.atan2(position[1] - x, position[0] - z));
  }

  fromAddress() {
    const [label, word] = location.hash.slice(1).split(".");
    const kind = this.about.labels.indexOf(label);
    const points = word && read(word);
    if (kind >= 0 && this.about.moving.includes(label)) this.choose(kind);
    if (points) this.set(walkable(points), { announced: false, drawn: points });
    $("gift").hidden = !points;
    return Boolean(points);
  }

  /** @param {number} kind */
  choose(kind) {
    this.kind = kind;
    for (const button of $("kinds").querySelectorAll("button")) {
      button.setAttribute("aria-pressed", String(button.id === `kind${kind}`));
    }
  }

  /**
   * Search on for some milliseconds, while less than three seconds of walk are left.
   * @param {number} milliseconds
   */
  grow(milliseconds) {
    const { walk } = this;
    const end = performance.now() + milliseconds;
    const whole = this.story.step > 0; // the story tells of all of the walk
    while (!walk.done && (whole || walk.frames - this.time < 90) && performance.now() < end) {
      this.growing ??= walk.grow();
      const { value, done } = this.growing.next();
      if (value) this.ghost = value;
      if (done) this.grown();
    }
  }

  grown() {
    const last = this.prints.at(-1);
    const begin = last ? last.frame + 4 : 0;
    this.growing = null;
    this.ghost = null;
    if (!this.walk.frames) {
      this.restore();
      return;
    }
    this.previous = null;
    this.prints.push(
      ...footprints(this.walk, this.about.feet, begin).filter((print) => print.frame >= begin),
    );
    this.first ??= performance.now() - this.begun;
    if (this.walk.done) this.report();
  }

  // Show the walk before again, because there is none of the kind that was asked for, and say so.
  restore() {
    const name = this.about.labels[this.kind] ?? "motion";
    const { previous } = this;
    this.previous = null;
    this.showMessage(`These clips have no ${name} along this line.`);
    if (!previous) return;
    const { kind, ...shown } = previous;
    Object.assign(this, shown);
    this.rounded = roundedBy(this.drawn, this.points);
    this.choose(kind);
    this.showMessage(`These clips have no ${name} along this line. The walk before stays.`);
  }

  report() {
    const { walk, about } = this;
    const seams = walk.edges.filter((edge, at) => edge.seam && walk.begins[at] >= walk.since).length;
    const walked = Array.from({ length: walk.frames - walk.since }, (_, i) =>
      this.positionAt(walk.since + i),
    );
    const off = Math.round(100 * meanDistance(this.drawn, walked));
    const names = [...new Set(walk.edges.map((edge) => about.clips[edge.start.clip].name))];
    const metres = this.line.z.length / 100;
    const seconds = (walk.frames - walk.since) / about.fps;
    const rounded = this.rounded > SEEN ? ` · rounded by ${Math.max(0.1, this.rounded).toFixed(1)} m` : "";
    this.showMessage(`${metres.toFixed(1)} m · ${seams} seams · ${off} cm off the line${rounded}`);
    this.canvas.setAttribute(
      "aria-label",
      `A figure walks ${metres.toFixed(0)} metres along a line in ${seconds.toFixed(0)} seconds, ` +
        `from the clips ${names.join(", ")}, with ${seams} seams.`,
    );
  }

  /** @param {string} text */
  showMessage(text) {
    $("message").textContent = text;
  }

  /** @param {number} frame */
  positionAt(frame) {
    const [at, i] = edgeAt(this.walk, clamp(Math.floor(frame), 0, this.walk.frames - 1));
    const [c, s, z, x] = this.walk.transforms[at];
    const { track } = this.walk.edges[at];
    const position = [c * track.z[i] - s * track.x[i] + z, s * track.z[i] + c * track.x[i] + x];
    return carry(this.walk.bending.carried[this.walk.begins[at] + i], position);
  }

  position() {
    return this.positionAt(this.time);
  }

  // Where the figure is, null if there is none.
  figure() {
    return this.walk.frames ? this.position() : null;
  }

  // ---- pictures ----

  fit() {
    const ratio = Math.min(devicePixelRatio, 2) * this.sharp;
    this.width = this.canvas.clientWidth;
    this.height = this.canvas.clientHeight;
    Object.assign(this.canvas, { width: this.width * ratio, height: this.height * ratio });
    this.story.fit();
  }

  /**
   * Let the camera follow the walk, or hold all of the line.
   * @param {number} seconds
   * @param {boolean} snap
   */
  aim(seconds, snap = false) {
    const tall = this.width < this.height;
    if (this.stroke) return;
    if (this.story.step && this.walk.frames) this.story.aim();
    else if (this.above) this.camera.holdAbove(this.line, this.width, this.height);
    else if (!this.walk.frames) this.camera.hold(this.line, tall);
    else {
      const frame = Math.min(this.time, this.walk.frames - 1);
      const [z, x] = this.positionAt(frame - (this.figures > 1 ? (this.figures * LAG) / 3 : 0));
      const [az, ax] = this.positionAt(frame - 15);
      const [bz, bx] = this.positionAt(frame + 5);
      this.camera.follow(seconds, [z, x], Math.atan2(bx - ax, bz - az), tall, this.figures > 1 ? 2.2 : 0);
    }
    this.camera.step(seconds, snap);
  }

  /** @param {number} now */
  picture(now) {
    const since = now - this.before;
    const seconds = clamp(since / 1000, 0, 0.1);
    const { walk } = this;
    this.before = now;
    if (this.saving) {
      requestAnimationFrame((next) => this.picture(next));
      return;
    }
    // Half of the time where the figure would wait, however slow pictures are.
    this.grow(walk.frames - this.time < 15 ? clamp(since, 40, 250) : clamp(SEARCH_SHARE * since, 4, 40));
    if (this.story.step && walk.frames) this.story.refresh();
    if (this.playing && walk.frames && !this.stroke && !this.shown) this.story.walkOn(seconds);
    this.sharpen(seconds);
    this.aim(seconds);
    this.draw();
    if (this.film) this.watchFilm();
    requestAnimationFrame((next) => this.picture(next));
  }

  /**
   * Draw fewer pixels if there are too few pictures a second.
   * @param {number} seconds since the last one
   */
  sharpen(seconds) {
    this.slow = clamp(this.slow + (seconds > 0.04 ? 1 : -1), 0, 20);
    if (this.slow < 20 || this.sharp <= 0.5 || this.film) return;
    this.sharp *= 0.8;
    this.slow = 0;
    this.fit();
  }

  /**
   * Go on by some seconds, and begin anew a while after the end.
   * @param {number} seconds
   */
  walkOn(seconds) {
    const { walk } = this;
    const last = walk.frames - 1 + (walk.done ? (this.figures - 1) * LAG : 0);
    this.time = Math.min(this.time + seconds * this.about.fps, last);
    this.rest = walk.done && this.time >= last ? this.rest + seconds : 0;
    if (this.rest <= RESTS) return;
    this.time = 0;
    this.rest = 0;
  }

  bodies() {
    const { walk, shown, previous } = this;
    if (!walk.frames) return previous ? [bodyAt(previous.walk, previous.time)] : [];
    const told = this.story.bodies();
    if (told) return told;
    if (shown) return shown.bodies;
    const played = this.cut ? cutOf(walk) : walk;
    const all = Array.from({ length: this.figures }, (_, n) => this.time - n * LAG).filter(
      (time, n) => !n || time >= 0,
    );
    /** @param {number} time */
    const bodyOf = (time) => bodyAt(played, Math.min(this.cut ? Math.floor(time) : time, walk.frames - 1));
    return [...all.map(bodyOf), ...(this.pointed?.bodies ?? [])];
  }

  draw() {
    const { scene, walk, look, camera } = this;
    const half = clamp(camera.at.far * camera.hand.zoom * 0.0055, 0.022, 0.12);
    const line = rgb(look.line);
    const ink = rgb(look.ink);
    const seen = camera.view(this.width, this.height);
    scene.eye = seen.eye;
    scene.reach = 1.2 * camera.at.far * camera.hand.zoom;
    const step = Math.max(3, Math.ceil(this.points.length / 700));
    const thin = this.points.filter((_, i) => i % step === 0);
    const here = walk.frames ? nearest(this.line, this.position()) / step : 0;
    const told = this.story.step > 0 && walk.frames > 0;
    const pale = this.stroke || told ? 0.3 : 0.95; // beside the line that is drawn now, and what is told
    if (this.rounded > SEEN) scene.band(this.drawn, half * 0.5, ink, () => 0.3, 0.003);
    scene.band(thin, half, line, (i) => (i < here ? 0.35 * pale : pale));
    if (this.stroke) scene.band(this.stroke, half, line, () => 1, 0.009);
    if (told) this.story.draw(half);
    else this.drawWalk(half, ink);
    scene.draw(seen, look, this.bodies());
    this.ticks += 1;
    if (this.ticks % 4 === 1 && !told) this.drawMap();
  }

  /**
   * The search that is under way, and what the walk leaves on the ground.
   * @param {number} half
   * @param {number[]} ink
   */
  drawWalk(half, ink) {
    if (this.ghost) this.drawGhost(this.ghost, half, ink);
    if (!this.walk.frames) return;
    this.drawTrail(half, ink);
    this.drawPrints(ink);
    this.drawSeams(half);
  }

  // The map, and the name of the clip that is played.
  drawMap() {
    const { walk, about } = this;
    drawSmall(this, this.small);
    if (!walk.frames) return;
    const [at, frame] = edgeAt(walk, Math.floor(this.time));
    const { start, end, seam, frames } = walk.edges[at];
    const { clip } = seam && 2 * frame >= frames ? end : start;
    const name = about.clips[clip].name.replaceAll("_", " ");
    if (this.now.textContent === name) return;
    this.now.textContent = name;
    this.now.style.setProperty("--clip", colourOfClip(clip));
  }

  /**
   * Footprints of the last six seconds.
   * @param {number[]} ink
   */
  drawPrints(ink) {
    for (const print of this.prints) {
      const age = this.time - print.frame;
      if (age <= 0 || age >= 180) continue;
      const alpha = 0.3 * Math.min(1, age / 4) * (1 - age / 180);
      this.scene.disc([print.z, print.x], 0.12, 0.045, print.angle, ink, alpha, 0.005);
    }
  }

  /**
   * A ring for each seam, larger while it plays.
   * @param {number} half
   */
  drawSeams(half) {
    for (const { at, frame } of this.seams()) {
      const near = Math.max(0, 1 - Math.abs(this.time - frame) / 12);
      const radius = half * (1.5 + 2 * near);
      const position = this.positionAt(frame);
      const colour = rgb(COLOURS[this.walk.edges[at].end.clip % COLOURS.length]);
      const ground = rgb(this.look.ground); // around it, because the line is of another colour
      this.scene.disc(position, radius + 0.5 * half, radius + 0.5 * half, 0, ground, 1, 0.007);
      this.scene.disc(position, radius, radius, 0, colour, 1, 0.008);
      this.scene.disc(position, half * 0.7, half * 0.7, 0, ground, 1, 0.0085);
    }
  }

  /**
   * The best walk of a search that is under way.
   * @param {SearchedWalk} ghost
   * @param {number} half
   * @param {number[]} colour
   */
  drawGhost(ghost, half, colour) {
    const points = trackOfWalk(ghost, 3);
    if (points.length > 1) this.scene.band(points, half * 0.4, colour, () => 0.4, 0.006);
  }

  /**
   * Two seconds back and ahead.
   * @param {number} half
   * @param {number[]} colour
   */
  drawTrail(half, colour) {
    const from = Math.max(0, Math.floor(this.time) - 60);
    const to = Math.min(this.walk.frames - 1, Math.floor(this.time) + 60);
    const points = [];
    for (let frame = from; frame <= to; frame += 2) points.push(this.positionAt(frame));
    /** @param {number} i */
    const alpha = (i) => 0.6 * (1 - ((from + 2 * i - this.time) / 60) ** 2);
    this.scene.band(points, half * 0.4, colour, alpha, 0.006);
  }

  seams() {
    const { walk } = this;
    return walk.edges
      .flatMap((edge, at) => (edge.seam ? [{ at, frame: walk.begins[at] + 5 }] : []))
      .filter(({ frame }) => frame < walk.frames);
  }

  /** @param {boolean} on */
  play(on) {
    this.playing = on;
    $("play").textContent = on ? "pause" : "play";
    $("play").setAttribute("aria-label", on ? "pause the walk" : "play the walk");
  }

  /** @param {boolean} above */
  view(above) {
    this.above = above;
    Object.assign(this.camera.hand, { yaw: 0, pitch: 0, zoom: 1 });
    $("above").setAttribute("aria-pressed", String(above));
  }

  buttons() {
    const { labels, moving, clips } = this.about;
    $("made").textContent =
      `Its motion is new: pieces of ${clips.length} clips, joined by seams at similar moments, the dots. Tap one!`;
    moving.forEach((name) => {
      const kind = labels.indexOf(name);
      const button = Object.assign(document.createElement("button"), {
        id: `kind${kind}`,
        textContent: name,
      });
      button.onclick = () => {
        this.choose(kind);
        this.set(walkable(this.drawn), { drawn: this.drawn, anew: true });
      };
      $("kinds").append(button);
    });
    this.choose(this.kind);
    this.play(this.playing);
    $("play").onclick = () => this.play(!this.playing);
    $("above").onclick = () => this.view(!this.above);
    $("parade").onclick = () => {
      this.figures = this.figures > 1 ? 1 : PARADE;
      $("parade").setAttribute("aria-pressed", String(this.figures > 1));
    };
    $("undo").onclick = () => this.undo();
    $("bvh").onclick = () => {
      this.finish();
      download(bvh(this.walk), "walk.bvh");
    };
    $("gif").onclick = () => this.saveGif();
    $("film").onclick = () => (this.film ? this.endFilm() : this.beginFilm());
    for (const name of ["bvh", "gif", "film"]) {
      $(name).addEventListener("click", () => $("save").removeAttribute("open"));
    }
    $("copy").onclick = () => this.copyLink();
  }

  async copyLink() {
    history.replaceState(null, "", `#${this.about.labels[this.kind] ?? "any"}.${written(this.drawn)}`);
    try {
      await navigator.clipboard.writeText(location.href);
      this.showMessage("The link to this line is copied.");
    } catch {
      this.showMessage("Copy the address of this page: it is the link to this line.");
    }
  }

  // Search to the line's end.
  finish() {
    const { time } = this;
    while (!this.walk.done) {
      this.time = this.walk.frames;
      this.grow(1000);
    }
    this.time = time;
  }

  // Record the walk from its beginning while it plays.
  beginFilm() {
    if (this.saving) return;
    this.finish();
    try {
      this.film = new Film(this.canvas, FILM_FPS);
    } catch (error) {
      this.showMessage(error instanceof Error ? error.message : String(error));
      return;
    }
    $("film").textContent = "stop the film";
    this.shown = null;
    this.time = 0;
    this.rest = 0;
    this.aim(0, true);
    this.play(true);
  }

  // Show how much of the walk is recorded, and end the film with the walk.
  watchFilm() {
    const last = this.walk.frames - 1;
    if (!this.walk.frames) return;
    this.showMessage(`recording: ${Math.min(100, Math.round((100 * this.time) / last))} %`);
    if (this.walk.done && this.time >= last && this.rest > FILM_END) this.endFilm();
  }

  async endFilm() {
    const { film } = this;
    if (!film) return;
    this.film = null;
    $("film").textContent = "film";
    download(await film.stop(), film.name);
    this.showMessage(`saved ${film.name}`);
  }

  async saveGif() {
    if (this.saving || this.film) return;
    this.finish();
    this.saving = true;
    const { canvas, walk, time } = this;
    const small = document.createElement("canvas");
    const width = 400;
    const height = Math.round((width * this.height) / this.width);
    const frames = Math.min(walk.frames, LONGEST * this.about.fps);
    const film = new Gif(width, height, 8);
    Object.assign(small, { width, height });
    const pen = penOf(small, { willReadFrequently: true });
    for (let frame = 0; frame < frames; frame += this.about.fps / 12.5) {
      this.time = frame;
      this.aim(0.08, frame === 0);
      this.draw();
      pen.drawImage(canvas, 0, 0, width, height);
      film.add(pen.getImageData(0, 0, width, height).data);
      this.showMessage(`saving: ${Math.round((100 * frame) / frames)} %`);
      await new Promise((resolve) => setTimeout(resolve)); // the page goes on
    }
    this.time = time;
    this.saving = false;
    download(film.blob(), "walk.gif");
    this.showMessage(frames < walk.frames ? `saved the first ${LONGEST} seconds` : "saved walk.gif");
  }
}

loaded().then((graph) => {
  Object.assign(window, { page: new Page(graph) });
});
