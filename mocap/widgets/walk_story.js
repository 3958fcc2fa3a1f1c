// The story below the page: four steps, from clips to the search, on the line and the walk of the page. Each has a card of
// words with one thing to do, and the stage shows what the card is about.

import { rgb } from "./bodies.js";
import { bodyAt } from "./walk_body.js";
import { arrays, meanDistance } from "./walk_line.js";
import { COLOURS } from "./walk_scene.js";
import { compose } from "./walk_search.js";
import { drawNet } from "./walk_small.js";
import { cutOf, jumpAt, piecesOf, randomTrack, SlowSearch } from "./walk_steps.js";

/**
 * @import { Body } from "./walk_body.js"
 * @import { Page } from "./walk_page.js"
 * @import { Walk } from "./walk_pieces.js"
 * @import { ClipPiece } from "./walk_steps.js"
 *
 * @typedef {{ at: number, frame: number }} Seam
 */

export const STEPS = /** @type {const} */ ({ none: 0, clips: 1, moments: 2, graph: 3, search: 4 });
const REACHED = 0.6; // of the page's height: a step begins where its card comes above
const LEAD = 20; // frames of the walk before a seam, and after it
const SLOWLY = 0.35; // speed of the walk at a seam
const PASSES = 2; // times that a seam is seen
const BESIDE = 0.95; // metres of the two moments from the figure between them
const REACH = 1.7; // metres from that figure that are seen
const STEP_OF_TRACK = 3; // frames between points of a coloured line
const MOST_TRACKS = 8; // walks at random that stay
const LONGEST_TRACK = 12; // metres of one
const BEAMS = [1, 3, 10, 30, 150];
const LAYER_TIME = 0.11; // seconds for which a layer is seen
const FOUND_TIME = 2.5; // seconds for which the walk is seen that was found
const THIN = 10; // points of a line for one that the camera holds

/** @param {string} name */
const spaced = (name) => name.replaceAll("_", " ");

/**
 * The element of the page with an id, of a class.
 * @template {HTMLElement} T
 * @param {string} id
 * @param {new () => T} kind
 * @returns {T}
 */
function part(id, kind) {
  const found = document.getElementById(id);
  if (!(found instanceof kind)) throw new Error(`The page has no #${id} that is a ${kind.name}.`);
  return found;
}

/**
 * The colour of a clip.
 * @param {number} clip
 */
export const colourOfClip = (clip) => COLOURS[clip % COLOURS.length];

export class Story {
  step = 0; // 0 above the story
  /** @type {ClipPiece[]} of the walk that is shown */
  pieces = [];
  /** @type {number[][][]} their points on the ground */
  tracks = [];
  clip = -1; // whose pieces are highlighted, -1 for all
  seam = 0; // the index of the seam that is seen
  passes = 0; // of it
  /** @type {number[][][]} walks at random */
  wandering = [];
  /** @type {SlowSearch | null} */
  search = null;
  waited = 0; // seconds since the last layer
  beam = BEAMS.length - 1; // the index of the beam width
  /** @type {unknown[]} what the walk was when the pieces were found */
  known = [];

  /** @param {Page} page */
  constructor(page) {
    this.page = page;
    this.sections = [...document.querySelectorAll("#story .step")];
    this.bars = part("clips", HTMLElement);
    this.net = part("net", HTMLCanvasElement);
    this.told = part("strayed", HTMLElement);
    this.result = part("kept", HTMLElement);
    this.listen();
    this.addClips();
  }

  listen() {
    addEventListener("scroll", () => this.scrolled(), { passive: true });
    part("how", HTMLButtonElement).onclick = () => this.sections[0].scrollIntoView();
    part("back", HTMLButtonElement).onclick = () => scrollTo({ top: 0 });
    part("chance", HTMLButtonElement).onclick = () => this.wander();
    const beam = part("beam", HTMLInputElement);
    beam.oninput = () => {
      this.beam = Number(beam.value);
      beam.setAttribute("aria-valuetext", this.beamWords());
      this.restartSearch();
      this.page.play(true);
    };
    beam.max = String(BEAMS.length - 1);
    beam.value = beam.max;
    beam.setAttribute("aria-valuetext", this.beamWords());
    this.listenToCut(part("cut", HTMLButtonElement));
  }

  /**
   * Cut in place of blending while a button or the key C is held.
   * @param {HTMLButtonElement} button
   */
  listenToCut(button) {
    /** @param {boolean} on */
    const cut = (on) => {
      this.page.cut = on;
      button.setAttribute("aria-pressed", String(on));
    };
    const hold = () => {
      cut(true);
      this.page.play(true);
    };
    button.addEventListener("pointerdown", hold);
    button.addEventListener("contextmenu", (event) => event.preventDefault());
    for (const end of ["pointerup", "pointercancel", "pointerleave", "blur"]) {
      button.addEventListener(end, () => cut(false));
    }
    addEventListener("keydown", (event) => {
      const pressed = event.target === button && (event.key === " " || event.key === "Enter");
      if (pressed) event.preventDefault();
      if (pressed || (event.key === "c" && !event.ctrlKey && !event.metaKey)) hold();
    });
    addEventListener("keyup", () => cut(false));
  }

  // A button for each clip: its name, and a bar with the frames that the walk uses.
  addClips() {
    const { clips } = this.page.about;
    const longest = Math.max(...clips.map(({ frames }) => frames));
    clips.forEach(({ name, frames }, n) => {
      const button = document.createElement("button");
      const bar = document.createElement("i");
      const words = document.createElement("span");
      words.textContent = spaced(name);
      bar.style.width = `${(100 * frames) / longest}%`;
      button.style.setProperty("--clip", colourOfClip(n));
      button.setAttribute("aria-pressed", "false");
      button.append(words, bar);
      button.onclick = () => this.chooseClip(this.clip === n ? -1 : n);
      this.bars.append(button);
    });
  }

  /**
   * Highlight the pieces of a clip, and go to the first one.
   * @param {number} clip
   */
  chooseClip(clip) {
    this.clip = clip;
    [...this.bars.children].forEach((button, n) => button.setAttribute("aria-pressed", String(n === clip)));
    const piece = this.pieces.find((other) => other.clip === clip);
    if (piece) this.page.time = piece.begin;
  }

  // Find the step that is read.
  scrolled() {
    const line = REACHED * innerHeight;
    const step = this.sections.filter((section) => section.getBoundingClientRect().top < line).length;
    if (step === this.step) return;
    this.step = step;
    const { page } = this;
    page.endStroke();
    page.shown = null;
    page.pointed = null;
    page.moments.hidden = true;
    page.view(false);
    document.body.classList.toggle("story", step > 0);
    this.fit();
    if (step === STEPS.moments) this.showSeam(this.seam);
    if (step === STEPS.search) this.restartSearch();
  }

  // Leave room for the cards: beside the picture, or below it on a page that is tall.
  fit() {
    const { goal } = this.page.camera;
    const card = document.querySelector("#story .card");
    const box = card?.getBoundingClientRect();
    const tall = innerWidth < innerHeight;
    goal.aside = this.step && box && !tall ? 1 - box.left / innerWidth : 0;
    goal.below = this.step && box && tall ? Math.min(0.55, box.height / innerHeight) : 0;
  }

  // Find the pieces anew where there is another walk.
  refresh() {
    const { walk, line } = this.page;
    const known = [walk, line, walk.frames];
    if (known.every((value, k) => value === this.known[k])) return;
    const sameLine = this.known[1] === line;
    this.known = known;
    this.pieces = piecesOf(walk, walk.since);
    this.tracks = this.pieces.map((piece) => this.trackOf(piece));
    this.fillBars();
    if (sameLine) return;
    this.wandering = [];
    this.told.textContent = "";
    this.seam = 0;
    if (this.step === STEPS.search) this.restartSearch();
    if (this.step === STEPS.moments) this.showSeam(0);
  }

  /** @param {ClipPiece} piece */
  trackOf({ begin, end }) {
    const points = [];
    for (let frame = begin; frame < end; frame += STEP_OF_TRACK) points.push(this.page.positionAt(frame));
    points.push(this.page.positionAt(end));
    return points;
  }

  // Fill the parts of the bars that the walk uses.
  fillBars() {
    const { clips } = this.page.about;
    [...this.bars.querySelectorAll("i")].forEach((bar, n) => {
      const all = clips[n].frames / 100;
      const used = this.pieces.filter(({ clip }) => clip === n);
      const stripes = used.map(({ from, begin, end }) => {
        const stripe = document.createElement("b");
        stripe.style.left = `${from / all}%`;
        stripe.style.width = `${(end - begin) / all}%`;
        return stripe;
      });
      bar.replaceChildren(...stripes);
    });
  }

  // ---- what moves ----

  /**
   * Advance by some seconds.
   * @param {number} seconds
   */
  walkOn(seconds) {
    const { page, step } = this;
    if (step === STEPS.moments && this.seams().length) this.passSeam(seconds);
    else if (step === STEPS.search) this.searchOn(seconds);
    else page.walkOn(seconds);
  }

  seams() {
    const { page } = this;
    return page.seams().filter(({ frame }) => frame >= page.walk.since);
  }

  /**
   * Walk slowly over a seam, some times, and then over the next one.
   * @param {number} seconds
   */
  passSeam(seconds) {
    const { page } = this;
    const { frame } = this.currentSeam();
    page.time += SLOWLY * seconds * page.about.fps;
    if (page.time < Math.min(frame + LEAD, page.walk.frames - 1)) return;
    this.passes += 1;
    if (this.passes < PASSES || page.cut) page.time = Math.max(0, frame - LEAD);
    else this.showSeam(this.seam + 1);
  }

  /** @returns {Seam} */
  currentSeam() {
    const seams = this.seams();
    return seams[this.seam % seams.length];
  }

  /** @param {number} seam */
  showSeam(seam) {
    this.seam = seam;
    this.passes = 0;
    const told = part("jump", HTMLElement);
    if (!this.seams().length) {
      told.textContent = "The walk along this line has no seam.";
      return;
    }
    const { page } = this;
    const { frame } = this.currentSeam();
    page.time = Math.max(0, frame - LEAD);
    const centimetres = Math.max(1, Math.round(100 * jumpAt(page.walk, frame)));
    const { words } = page.momentsOf(this.currentSeam(), BESIDE);
    told.textContent = `From ${words}. Without the blend, a joint jumps here by ${centimetres} cm.`;
  }

  wander() {
    const { page } = this;
    const { walk, line } = page;
    const at = walk.begins.findIndex((begin) => begin >= walk.since);
    if (at < 0) return;
    const metres = Math.min(LONGEST_TRACK, line.z.length / 100);
    const transform = compose(walk.bending.carried[walk.begins[at]], walk.transforms[at]);
    const track = randomTrack(
      page.graph,
      { node: walk.edges[at].start, transform },
      { labels: page.bits, metres },
    );
    if (track.length < 2) return;
    this.wandering = [...this.wandering, track].slice(-MOST_TRACKS);
    const followed = page.points.slice(0, Math.round(100 * metres));
    const off = this.wandering.map((wandered) => meanDistance(followed, wandered));
    /** @param {number} distance */
    const metresOf = (distance) => `${distance.toFixed(1)} m`;
    this.told.textContent =
      `This one is ${metresOf(off[off.length - 1])} off the line on average` +
      (off.length > 1 ? `, and the nearest of ${off.length} is ${metresOf(Math.min(...off))} off.` : ".");
  }

  beamWords() {
    return BEAMS[this.beam] === 1 ? "1 walk kept" : `${BEAMS[this.beam]} walks kept`;
  }

  restartSearch() {
    const { page } = this;
    this.search = new SlowSearch(page.graph, page.line, page.bits, BEAMS[this.beam]);
    this.waited = 0;
    this.result.textContent = this.beamWords();
  }

  /**
   * Search one layer after the other.
   * @param {number} seconds
   */
  searchOn(seconds) {
    const { search } = this;
    this.waited += seconds;
    if (!search || this.waited < (search.done ? FOUND_TIME : LAYER_TIME)) return;
    this.waited = 0;
    if (search.done) {
      this.restartSearch();
      return;
    }
    search.step();
    if (search.done) this.result.textContent = `${this.beamWords()}: ${this.foundWords(search)}`;
  }

  /** @param {SlowSearch} search */
  foundWords({ found, line }) {
    if (!found) return "none comes to the end";
    const points = Array.from(line.z, (z, i) => [z, line.x[i]]);
    return `${Math.round(100 * meanDistance(points, found))} cm off the line, before the walk is bent onto it`;
  }

  // ---- what is seen ----

  /**
   * The bodies of a step, null where they are those of the page.
   * @returns {Body[] | null}
   */
  bodies() {
    const { page, step } = this;
    if (step === STEPS.search) return [bodyAt(page.walk, page.walk.since)];
    if (step !== STEPS.moments || !this.seams().length) return null;
    const seam = this.currentSeam();
    const walk = page.cut ? cutOf(page.walk) : page.walk;
    return [
      bodyAt(walk, page.cut ? Math.floor(page.time) : page.time),
      ...page.momentsOf(seam, BESIDE).bodies,
    ];
  }

  // Aim the camera.
  aim() {
    const { page, step } = this;
    const { camera, line } = page;
    if (step === STEPS.moments && this.seams().length) {
      const { frame } = this.currentSeam();
      const [[az, ax], [bz, bx]] = [frame - 15, frame + 15].map((other) => page.positionAt(other));
      camera.beside(page.positionAt(frame), Math.atan2(bx - ax, bz - az), REACH, [page.width, page.height]);
      return;
    }
    const points = Array.from(line.z, (z, i) => [z, line.x[i]]).filter((_, i) => i % THIN === 0);
    if (step === STEPS.graph) points.push(...this.wandering.flat().filter((_, i) => i % THIN === 0));
    const seen = step === STEPS.search ? points.slice(0, 70) : points;
    camera.holdAbove(arrays(seen), page.width, page.height, 0);
  }

  /**
   * Draw on the ground.
   * @param {number} half
   */
  draw(half) {
    const { page, step } = this;
    const ink = rgb(page.look.ink);
    if (step === STEPS.clips) this.drawPieces(half);
    if (step === STEPS.moments) page.drawSeams(half);
    if (step === STEPS.graph) {
      this.wandering.forEach((track, n) =>
        page.scene.band(track, half * 0.6, rgb(COLOURS[n % COLOURS.length]), () => 0.9, 0.008),
      );
      if (page.ticks % 4 === 0) drawNet(page, this.net);
    }
    if (step !== STEPS.search || !this.search) return;
    this.search.tracks.forEach((track, n) =>
      page.scene.band(track, half * 0.35, ink, () => (n ? 0.22 : 0.8), 0.007),
    );
    const { found, done } = this.search;
    if (found && done) page.scene.band(found, half * 0.6, rgb(COLOURS[0]), () => 0.95, 0.008);
  }

  /**
   * The walk in the colours of its clips.
   * @param {number} half
   */
  drawPieces(half) {
    const { scene } = this.page;
    this.pieces.forEach(({ clip }, n) => {
      const alpha = this.clip < 0 || this.clip === clip ? 1 : 0.12;
      scene.band(this.tracks[n], half * 1.1, rgb(colourOfClip(clip)), () => alpha, 0.0075);
    });
  }
}
