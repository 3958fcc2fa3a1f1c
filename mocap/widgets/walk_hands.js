// Input to the page: drawing, rotating the view and pointing at a seam, by mouse, touch or keys.

import { bodyAt } from "./walk_body.js";
import { smooth, walkable } from "./walk_line.js";
import { compose } from "./walk_search.js";

/**
 * @import { Body } from "./walk_body.js"
 * @import { Page } from "./walk_page.js"
 * @import { Node, Transform } from "./walk_search.js"
 * @import { Seam } from "./walk_story.js"
 *
 * A moment of a clip.
 * @typedef {Pick<Node, "clip" | "frame">} Moment
 */

const SLOP = 6; // pixels that a pen moves on a seam before it draws
const NEAR = 0.35; // metres from a tap to its seam
const FINEST = 0.02; // metres: what a drawn line is smoothed by, the trembling of a hand
const SHORT = "Draw a longer line: a metre or more.";
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
  /** @type {number[] | null} the pixel at which the pen came down */
  pressed = null;
  /** @type {boolean} whether the hand rotates the view */
  orbiting = false;
  /** @type {number} the heading of the pen that keys move */
  pen = 0;
  /** @type {{ bodies: Body[] } | null} what is shown while the walk stands still */
  shown = null;
  /** @type {{ bodies: Body[] } | null} the two moments of the seam under the mouse */
  pointed = null;

  /** @this {Page} */
  listen() {
    const { canvas } = this;
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("pointerdown", (event) => {
      this.touches.set(event.pointerId, event);
      canvas.setPointerCapture(event.pointerId);
      this.pointAt(undefined);
      if (this.story.step || this.touches.size > 1 || event.button === 2 || event.shiftKey) {
        this.endStroke();
        this.pressed = null;
        this.orbiting = true;
        return;
      }
      const point = this.camera.ground(event.clientX, event.clientY);
      this.pressed = [event.clientX, event.clientY];
      if (!this.shown && !(point && this.seamNear(point))) this.beginStroke(this.pressed);
    });
    canvas.addEventListener("pointermove", (event) => this.drag(event));
    canvas.addEventListener("pointerup", (event) => this.lift(event));
    canvas.addEventListener("pointercancel", (event) => this.lift(event));
    canvas.addEventListener(
      "wheel",
      (event) => {
        const { hand } = this.camera;
        if (!event.ctrlKey) return; // a wheel alone scrolls to the story
        if (!this.stroke) hand.zoom = clampedZoom(hand.zoom * Math.exp(event.deltaY / 900));
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
    addEventListener("keydown", (event) => {
      if (event.key !== "z" || !(event.ctrlKey || event.metaKey)) return;
      this.undo();
      event.preventDefault();
    });
  }

  /**
   * @this {Page}
   * @param {PointerEvent} event
   */
  drag(event) {
    const previous = this.touches.get(event.pointerId);
    if (!previous) {
      const point = this.camera.ground(event.clientX, event.clientY);
      this.pointAt(point && !this.story.step && !this.shown ? this.seamNear(point) : undefined);
      return;
    }
    if (this.orbiting) this.orbit(event, previous);
    else this.drawTo(event);
    this.touches.set(event.pointerId, event);
  }

  /**
   * Turn and zoom the view.
   * @this {Page}
   * @param {PointerEvent} event
   * @param {PointerEvent} previous
   */
  orbit(event, previous) {
    const { hand } = this.camera;
    const others = [...this.touches.values()].filter((touch) => touch.pointerId !== event.pointerId);
    /** @param {PointerEvent} touch */
    const distance = (touch) =>
      Math.hypot(touch.clientX - others[0].clientX, touch.clientY - others[0].clientY);
    if (others.length) {
      hand.zoom = clampedZoom((hand.zoom * distance(previous)) / Math.max(distance(event), 1));
    }
    hand.yaw -= (event.clientX - previous.clientX) / 180;
    hand.pitch += (event.clientY - previous.clientY) / 250;
  }

  /**
   * Draw on to where the pen is.
   * @this {Page}
   * @param {PointerEvent} event
   */
  drawTo(event) {
    const { pressed } = this;
    const moved = pressed && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) > SLOP;
    if (moved && !this.stroke) this.beginStroke(pressed);
    const { stroke } = this;
    if (stroke) {
      const parts = event.getCoalescedEvents?.() ?? [];
      for (const part of parts.length ? parts : [event]) {
        const point = this.camera.ground(part.clientX, part.clientY);
        const last = stroke[stroke.length - 1];
        if (point && Math.hypot(point[0] - last[0], point[1] - last[1]) > 0.01) stroke.push(point);
      }
    }
  }

  /**
   * @this {Page}
   * @param {PointerEvent} event
   */
  lift(event) {
    const { stroke, pressed } = this;
    this.touches.delete(event.pointerId);
    if (!this.touches.size) this.orbiting = false;
    this.pressed = null;
    this.endStroke();
    if (!pressed || event.type === "pointercancel") return;
    const length = stroke ? lengthOf(stroke) : 0;
    if (length < 0.3) {
      const point = stroke ? stroke[0] : this.camera.ground(event.clientX, event.clientY);
      if (point) this.tap(point);
      return;
    }
    if (length < 1) {
      this.showMessage(SHORT);
      return;
    }
    if (stroke) this.walkAlong(stroke);
  }

  /**
   * Look down on the ground, and begin a line at a pixel of the picture.
   * @this {Page}
   * @param {number[]} pixel
   */
  beginStroke(pixel) {
    this.shown = null;
    this.moments.hidden = true;
    this.camera.lookDown(this.figure(), pixel, this.width, this.height);
    const point = this.camera.ground(pixel[0], pixel[1]);
    this.stroke = point && [point];
    document.body.classList.add("drawing");
  }

  /**
   * Take the line away that is drawn. The camera goes back to the walk.
   * @this {Page}
   */
  endStroke() {
    this.stroke = null;
    document.body.classList.remove("drawing");
  }

  /**
   * Walk along a drawn line.
   * @this {Page}
   * @param {number[][]} stroke
   */
  walkAlong(stroke) {
    this.view(false);
    this.set(walkable(stroke), { drawn: smooth(stroke, FINEST) });
  }

  /**
   * The seam that is nearest to a point, if one is near.
   * @this {Page}
   * @param {number[]} point
   */
  seamNear(point) {
    const seams = this.seams().map((seam) => {
      const [z, x] = this.positionAt(seam.frame);
      return { ...seam, distance: Math.hypot(z - point[0], x - point[1]) };
    });
    return seams.filter(({ distance }) => distance <= NEAR).sort((a, b) => a.distance - b.distance)[0];
  }

  /**
   * Show the two moments of the seam under the mouse, while the walk goes on.
   * @this {Page}
   * @param {Seam | undefined} seam
   */
  pointAt(seam) {
    this.canvas.style.cursor = seam ? "pointer" : "";
    if (!seam && !this.pointed) return;
    const moments = seam && this.momentsOf(seam, ASIDE);
    this.pointed = moments ?? null;
    this.moments.hidden = !seam;
    if (moments) this.moments.textContent = `Two similar moments, from ${moments.words}.`;
  }

  /**
   * Show the two moments that a seam joins, side by side, or walk on if there is no seam.
   * @this {Page}
   * @param {number[]} point
   */
  tap(point) {
    const seam = this.shown ? undefined : this.seamNear(point);
    this.moments.hidden = true;
    this.shown = null;
    if (seam) this.showMoments(seam);
  }

  /**
   * @this {Page}
   * @param {Seam} seam
   */
  showMoments(seam) {
    const { words, bodies } = this.momentsOf(seam, ASIDE);
    this.shown = { bodies };
    this.time = seam.frame;
    this.moments.textContent =
      `Two similar moments: ${words}. ` + "Here the walk passes from one into the other. Tap to walk on.";
    this.moments.hidden = false;
    document.body.classList.add("walking"); // the words at the top make room
  }

  /**
   * The two moments that a seam joins: their bodies, some metres aside from it, and their clips and times.
   * @this {Page}
   * @param {Seam} seam
   * @param {number} aside
   */
  momentsOf(seam, aside) {
    const { walk, about } = this;
    const { at, frame } = seam;
    const edge = walk.edges[at];
    const transform = compose(walk.bending.carried[frame], walk.transforms[at]);
    const from = { clip: edge.start.clip, frame: edge.start.frame + 5 };
    const to = { clip: edge.end.clip, frame: edge.end.frame - 5 };
    const target = compose(transform, edge.transform);
    const [first, second] = [from, to].map(
      (moment) =>
        `${about.clips[moment.clip].name.replaceAll("_", " ")}, ${(moment.frame / about.fps).toFixed(1)} s`,
    );
    return {
      bodies: [this.still(from, transform, -aside), this.still(to, target, aside)],
      words: `${first}, to ${second}`,
    };
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
    const { stroke } = this;
    if (!stroke) return;
    if (stroke.length < 5) {
      this.showMessage(SHORT);
      return;
    }
    this.endStroke();
    this.walkAlong(stroke);
  }

  /**
   * Discard the line that the pen has drawn, and continue the walk.
   * @this {Page}
   */
  discardStroke() {
    this.endStroke();
    this.shown = null;
    this.moments.hidden = true;
    this.showMessage("");
  }

  /**
   * Rotate the pen, and draw 30 cm.
   * @this {Page}
   * @param {number} angle
   */
  penStep(angle) {
    if (!this.stroke) {
      const start = this.figure() ?? [0, 0];
      this.beginStroke([this.width / 2, this.height / 2]);
      this.camera.keepInView(start, this.width, this.height);
      this.pen = this.camera.at.yaw + Math.PI;
      this.stroke = [start];
      this.showMessage("Arrow keys draw. Enter starts the walk, Escape discards the line.");
    }
    this.pen += angle;
    const [z, x] = this.stroke[this.stroke.length - 1];
    const point = [z + 0.3 * Math.cos(this.pen), x + 0.3 * Math.sin(this.pen)];
    this.stroke.push(point);
    this.camera.keepInView(point, this.width, this.height);
  }
}
