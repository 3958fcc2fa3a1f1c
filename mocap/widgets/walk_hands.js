// Input to the page: drawing, rotating the view and pointing at a seam, by mouse, touch or keys.

import { bodyAt } from "./walk_body.js";
import { walkable } from "./walk_line.js";
import { compose } from "./walk_search.js";

/**
 * @import { Body } from "./walk_body.js"
 * @import { Page } from "./walk_page.js"
 * @import { Node, Transform } from "./walk_search.js"
 *
 * A moment of a clip.
 * @typedef {Pick<Node, "clip" | "frame">} Moment
 */

const ASIDE = 0.5; // metres of two bodies from the seam that joins them
const PEN_ANGLES = new Map([
  ["ArrowLeft", 0.26],
  ["ArrowRight", -0.26],
  ["ArrowUp", 0],
]); // radians by which the pen changes its heading
/** @type {Map<string, (page: Page) => void>} the actions of keys */
const KEYS = new Map([
  ["Enter", (page) => page.walkStroke()],
  ["Escape", (page) => page.discardStroke()],
  [" ", (page) => page.play(!page.playing)],
]);

/** @param {number} zoom */
const clampedZoom = (zoom) => Math.max(0.35, Math.min(4, zoom));

/**
 * The length of a line through points.
 * @param {number[][]} points
 */
const lengthOf = (points) =>
  points.slice(1).reduce((sum, [z, x], i) => sum + Math.hypot(z - points[i][0], x - points[i][1]), 0);

// A page is one of these.
export class Hands {
  /** @type {Map<number, PointerEvent>} the fingers on the page, or the mouse */
  touches = new Map();
  /** @type {number[][] | null} the points [z, x] of the line that is drawn */
  stroke = null;
  /** @type {boolean} whether the hand rotates the view */
  orbiting = false;
  /** @type {number} the heading of the pen that keys move */
  pen = 0;
  /** @type {{ bodies: Body[] } | null} what is shown while the walk stands still */
  shown = null;

  /** @this {Page} */
  listen() {
    const { canvas } = this;
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("pointerdown", (event) => {
      this.touches.set(event.pointerId, event);
      canvas.setPointerCapture(event.pointerId);
      if (this.touches.size > 1 || event.button === 2 || event.shiftKey) {
        this.stroke = null;
        this.orbiting = true;
        return;
      }
      const point = this.camera.ground(event.clientX, event.clientY);
      if (point) this.stroke = [point];
    });
    canvas.addEventListener("pointermove", (event) => this.drag(event));
    canvas.addEventListener("pointerup", (event) => this.lift(event));
    canvas.addEventListener("pointercancel", (event) => this.lift(event));
    canvas.addEventListener(
      "wheel",
      (event) => {
        this.camera.hand.zoom = clampedZoom(this.camera.hand.zoom * Math.exp(event.deltaY / 900));
        event.preventDefault();
      },
      { passive: false },
    );
    canvas.addEventListener("keydown", (event) => this.key(event));
    addEventListener("resize", () => {
      this.sharp = 1;
      this.fit();
    });
    addEventListener("hashchange", () => this.fromAddress());
  }

  /**
   * @this {Page}
   * @param {PointerEvent} event
   */
  drag(event) {
    const previous = this.touches.get(event.pointerId);
    const { hand } = this.camera;
    if (!previous) return;
    if (this.orbiting) {
      const others = [...this.touches.values()].filter((touch) => touch.pointerId !== event.pointerId);
      /** @param {PointerEvent} touch */
      const distance = (touch) =>
        Math.hypot(touch.clientX - others[0].clientX, touch.clientY - others[0].clientY);
      if (others.length) {
        hand.zoom = clampedZoom((hand.zoom * distance(previous)) / Math.max(distance(event), 1));
      }
      hand.yaw -= (event.clientX - previous.clientX) / 180;
      hand.pitch += (event.clientY - previous.clientY) / 250;
    } else if (this.stroke) {
      const parts = event.getCoalescedEvents?.() ?? [];
      for (const part of parts.length ? parts : [event]) {
        const point = this.camera.ground(part.clientX, part.clientY);
        const last = this.stroke[this.stroke.length - 1];
        if (point && Math.hypot(point[0] - last[0], point[1] - last[1]) > 0.01) this.stroke.push(point);
      }
    }
    this.touches.set(event.pointerId, event);
  }

  /**
   * @this {Page}
   * @param {PointerEvent} event
   */
  lift(event) {
    const { stroke } = this;
    this.touches.delete(event.pointerId);
    if (!this.touches.size) this.orbiting = false;
    this.stroke = null;
    if (!stroke || event.type === "pointercancel") return;
    const length = lengthOf(stroke);
    if (length < 0.3) {
      this.tap(stroke[0]);
      return;
    }
    if (length < 1) {
      this.showMessage("Draw a longer line: a metre or more.");
      return;
    }
    this.set(walkable(stroke));
    this.view(false);
  }

  /**
   * Show the two moments that a seam joins, side by side, or walk on if there is no seam.
   * @this {Page}
   * @param {number[]} point
   */
  tap(point) {
    /** @param {number} frame */
    const distance = (frame) => {
      const [z, x] = this.positionAt(frame);
      return Math.hypot(z - point[0], x - point[1]);
    };
    const near = this.shown ? [] : this.seams().filter(({ frame }) => distance(frame) <= 0.35);
    const [seam] = near.sort((a, b) => distance(a.frame) - distance(b.frame));
    this.moments.hidden = true;
    this.shown = null;
    if (seam) this.showMoments(seam);
  }

  /**
   * @this {Page}
   * @param {{ at: number, frame: number }} seam
   */
  showMoments(seam) {
    const { walk, about } = this;
    const { at, frame } = seam;
    const edge = walk.edges[at];
    const transform = walk.transforms[at];
    const from = { clip: edge.start.clip, frame: edge.start.frame + 5 };
    const to = { clip: edge.end.clip, frame: edge.end.frame - 5 };
    const target = compose(transform, edge.transform);
    this.shown = { bodies: [this.still(from, transform, -ASIDE), this.still(to, target, ASIDE)] };
    this.time = frame;
    const [first, second] = [from, to].map(
      (moment) =>
        `${about.clips[moment.clip].name.replaceAll("_", " ")}, ${(moment.frame / about.fps).toFixed(1)} s`,
    );
    this.moments.textContent =
      `Two similar moments: ${first} and ${second}. ` +
      "Here the walk passes from one into the other. Tap to walk on.";
    this.moments.hidden = false;
  }

  /**
   * The body of a moment, some metres to the right on the picture.
   * @this {Page}
   * @param {Moment} moment
   * @param {Transform} transform
   * @param {number} aside
   */
  still(moment, transform, aside) {
    const { right } = this.camera;
    const [c, s, z, x] = transform;
    const shifted = [c, s, z + aside * right[2], x + aside * right[0]];
    const node = { ...moment, number: 0, out: [], ahead: this.walk.edges[0].track };
    const edge = { start: node, end: node, seam: false, frames: 1, transform: [1, 0, 0, 0] };
    return bodyAt(
      { graph: this.walk.graph, edges: [edge], transforms: [shifted], begins: [0], frames: 1 },
      0,
    );
  }

  /**
   * Move the pen by arrows, or do what `KEYS` lists.
   * @this {Page}
   * @param {KeyboardEvent} event
   */
  key(event) {
    const angle = PEN_ANGLES.get(event.key);
    const act = KEYS.get(event.key);
    if (angle === undefined && !act) return;
    if (angle !== undefined) this.penStep(angle);
    act?.(this);
    event.preventDefault();
  }

  /**
   * Walk along the line that the pen has drawn, if it is long enough.
   * @this {Page}
   */
  walkStroke() {
    if (!this.stroke || this.stroke.length < 5) return;
    const points = walkable(this.stroke);
    this.stroke = null;
    this.set(points);
  }

  /**
   * Discard the line that the pen has drawn, and continue the walk.
   * @this {Page}
   */
  discardStroke() {
    this.stroke = null;
    this.shown = null;
  }

  /**
   * Rotate the pen, and draw 30 cm.
   * @this {Page}
   * @param {number} angle
   */
  penStep(angle) {
    if (!this.stroke) {
      this.pen = this.camera.at.yaw + Math.PI;
      this.stroke = [this.walk.frames ? this.position() : [0, 0]];
    }
    this.pen += angle;
    const [z, x] = this.stroke[this.stroke.length - 1];
    this.stroke.push([z + 0.3 * Math.cos(this.pen), x + 0.3 * Math.sin(this.pen)]);
  }
}
