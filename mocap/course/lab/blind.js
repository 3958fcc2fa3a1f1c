// The blind test: pairs of films side by side, of which the reader chooses the one with the seam. The player's scripts,
// which stand before this one, draw the bodies.

import { Picture } from "../../widgets/player_picture.js";
import { Camera, Character, inflated } from "../../widgets/player_scene.js";

/**
 * @import { Packed, PackedCharacter } from "../../widgets/player_scene.js"
 *
 * What the test shows, as `blind_tests.py` packs it: of each pair the film with the seam comes first.
 * @typedef {object} BlindScene
 * @property {string} about
 * @property {Omit<PackedCharacter, "frames" | "offset" | "low">} body
 * @property {Pick<PackedCharacter, "frames" | "offset" | "low">[]} films
 * @property {Packed} data
 * @property {{ below_cm: number, window: number, seed: number }} plan
 * @property {boolean[]} onLeft whether the seam is on the left
 * @property {string[]} sides
 * @property {string[]} sentences by the number of right answers
 */

/** @type {Record<string, string>} */
const SIDES = { ArrowLeft: "left", ArrowRight: "right" };

const PAPER = { ink: "#333333", asked: "#000000", line: "#bbbbbb", shadow: "#000000" };
const PAUSE = 0.5; // seconds of empty canvas between two showings
const SOONEST = 0.4; // seconds into a pair from which on answers count, so that no key counts twice

/**
 * A part of a page, with its attributes and what it listens to, and what is inside.
 * @template {keyof HTMLElementTagNameMap} K
 * @param {K} name
 * @param {Record<string, any>} set
 * @param {(Node | string)[]} inside
 * @returns {HTMLElementTagNameMap[K]}
 */
function part(name, set = {}, ...inside) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(set)) {
    if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else made.setAttribute(key, value);
  }
  if (/^(button|input)$/.test(name)) made.dataset.lmSuppressShortcuts = "true"; // JupyterLab leaves their keys alone
  made.append(...inside);
  return made;
}

const TEST_STYLE = `
.mocap-blindtest { box-sizing: border-box; max-width: 46rem; margin: .6rem 0; padding: .5rem .9rem; color: inherit;
  font: 15px/1.5 system-ui, sans-serif; border: 1px solid #8886; border-left: 4px solid #CC79A7; border-radius: 4px; }
.mocap-blindtest p { margin: .35rem 0; }
.mocap-blindtest img { max-width: 100%; background: #fff; }
.mocap-blindtest .pair { display: grid; grid-template-columns: 1fr 1fr; gap: .6rem; }
.mocap-blindtest canvas { display: block; width: 100%; aspect-ratio: 1; max-height: 45vh; background: #fff; border: 1px solid #8886; }
.mocap-blindtest button, .mocap-blindtest input { font: inherit; color: inherit; background: transparent; min-height: 44px;
  border: 1px solid #888; border-radius: 4px; padding: .2rem .8rem; }
.mocap-blindtest button { cursor: pointer; }
.mocap-blindtest .pair button { width: 100%; margin-top: .4rem; }
.mocap-blindtest button:hover { background: #8882; }
.mocap-blindtest :focus-visible { outline: 3px solid #0072B2; outline-offset: 1px; }
@media print { .mocap-blindtest :is(button, canvas) { display: none; } }`;

export class BlindTest {
  /** @type {{ side: string, right: boolean, seconds: number }[]} */
  answers = [];
  /** @type {Character[]} */
  films;
  /** @type {Character[]} */
  shown;
  /** @type {number | null} when the pair began */
  since = null;
  /** @type {HTMLButtonElement[]} */
  buttons;
  /** @type {Picture[]} */
  pictures;

  /**
   * @param {HTMLElement} root
   * @param {BlindScene} scene
   */
  constructor(root, scene) {
    this.root = root;
    this.spec = scene;
    this.count = scene.onLeft.length;
    root.append(part("style", {}, TEST_STYLE), part("p", {}, scene.about));
    this.status = part("p", { role: "status" });
    this.stage = part(
      "div",
      {},
      part("button", { type: "button", onclick: () => this.start() }, "Start the test"),
    );
    root.append(this.stage, this.status);
  }

  async start() {
    const bytes = await inflated(this.spec.data);
    this.films = this.spec.films.map((film) =>
      Object.assign(new Character({ ...this.spec.body, ...film }, bytes, {}), { trail: [] }),
    );
    /** @type {NodeListOf<HTMLElement>} */
    const stills = this.root.querySelectorAll(":scope > :is(img, p:not([role]))");
    for (const still of stills) still.hidden = true;
    const sides = [
      ["left", "←"],
      ["right", "→"],
    ];
    this.buttons = sides.map(([side, arrow]) =>
      part("button", { type: "button", onclick: () => this.answer(side) }, `${arrow} the ${side} one`),
    );
    this.pictures = sides.map(([side]) => {
      const camera = new Camera();
      camera.reset(0.2);
      camera.yaw = 1;
      return new Picture(part("canvas", { role: "img", "aria-label": `the ${side} film` }), camera);
    });
    const pair = part(
      "div",
      { class: "pair" },
      ...this.pictures.map((picture, at) => part("div", {}, picture.canvas, this.buttons[at])),
    );
    this.stage.replaceChildren(
      part("p", {}, "Which of the two has the seam? If you cannot see it, guess."),
      pair,
    );
    this.root.addEventListener("keydown", (event) => {
      const side = SIDES[event.key];
      if (!side || this.done()) return;
      event.preventDefault();
      event.stopPropagation();
      this.answer(side);
    });
    this.buttons[0].focus();
    this.next();
    requestAnimationFrame((now) => this.draw(now));
  }

  done() {
    return this.answers.length === this.count;
  }

  next() {
    this.since = null;
    const at = this.answers.length;
    const films = [this.films[2 * at], this.films[2 * at + 1]]; // the seam comes first
    this.shown = this.spec.onLeft[at] ? films : films.reverse();
    this.status.textContent = `Pair ${at + 1} of ${this.count}`;
  }

  /** @param {number} now */
  draw(now) {
    if (this.done() || !this.root.isConnected) return;
    this.since ??= now;
    const time = ((now - this.since) / 1000) % (this.shown[0].seconds + PAUSE);
    this.pictures.forEach((picture, at) => {
      const film = this.shown[at];
      if (time > film.seconds) return picture.clear();
      picture.draw({
        characters: [film],
        time,
        asked: [],
        drawn: [],
        pen: null,
        sides: this.spec.sides,
        marks: {},
        palette: PAPER,
        ghosts: false,
        target: this.target(film, time),
        distance: 3.8,
        reach: 6,
      });
    });
    requestAnimationFrame((later) => this.draw(later));
  }

  /**
   * The camera follows the root, averaged over a second, so that it hides no jerk by moving along.
   * @param {Character} film
   * @param {number} time
   */
  target(film, time) {
    const places = [-0.5, -0.25, 0, 0.25, 0.5].map((later) =>
      film.pose(Math.min(Math.max(time + later, 0), film.seconds)),
    );
    /** @param {number} k */
    const mean = (k) => places.reduce((sum, pose) => sum + pose[k], 0) / places.length;
    return [mean(0), 0.85, mean(2)];
  }

  /** @param {string} side */
  answer(side) {
    if (this.done() || this.since === null || (performance.now() - this.since) / 1000 < SOONEST) return;
    const right = (side === "left") === this.spec.onLeft[this.answers.length];
    this.answers.push({ side, right, seconds: (performance.now() - this.since) / 1000 });
    if (this.done()) this.end();
    else this.next();
  }

  end() {
    const right = this.answers.filter((answer) => answer.right).length;
    const left = this.answers.filter((answer) => answer.side === "left").length;
    this.status.textContent = `${this.spec.sentences[right]} You chose the left film ${left} times.`;
    const name = part("input", {
      autocomplete: "off",
      "aria-label": "a name or number for the file",
      value: `viewer-${Math.floor(Math.random() * 1e6)}`,
    });
    const save = part("button", { type: "button", onclick: () => this.save(name.value) }, "Save my answers");
    this.root.append(this.stage); // below the result
    this.stage.replaceChildren(part("p", {}, "A name or number for the file: ", name, " ", save));
    save.focus();
  }

  /** @param {string} name */
  save(name) {
    const observer = name.replace(/[^\p{L}\p{N}_-]+/gu, "-") || "viewer";
    const { below_cm, window, seed } = this.spec.plan;
    const rows = this.answers.map(({ right, side, seconds }, at) => [
      observer,
      below_cm,
      window,
      seed,
      at + 1,
      Number(right),
      side,
      seconds.toFixed(1),
    ]);
    const head = "observer,below_cm,window,seed,pair,right,chosen,seconds";
    const text = [head, ...rows.map((row) => row.join(",")), ""].join("\n");
    const link = part("a", {
      href: URL.createObjectURL(new Blob([text], { type: "text/csv" })),
      download: `blind-${observer}-${below_cm}cm-${window}.csv`,
    });
    link.click();
  }
}
