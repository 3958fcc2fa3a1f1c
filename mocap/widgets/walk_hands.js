// What a hand does to the page: it draws, turns the view, points at a seam; by mouse, by touch or by keys.

import { bodyAt } from "./walk_body.js";
import { walkable } from "./walk_line.js";

const clampedZoom = (zoom) => Math.max(0.35, Math.min(4, zoom)), moments = () => document.getElementById("moments");

export class Hands {
  listen() {
    const { canvas } = this, on = (name, act) => canvas.addEventListener(name, act);
    on("contextmenu", (event) => event.preventDefault());
    on("pointerdown", (event) => {
      this.touches.set(event.pointerId, event);
      canvas.setPointerCapture(event.pointerId);
      if (this.touches.size > 1 || event.button === 2 || event.shiftKey) { this.stroke = null; this.turning = [event.clientX, event.clientY]; return; }
      const point = this.camera.ground(event.clientX, event.clientY);
      if (point) this.stroke = [point];
    });
    on("pointermove", (event) => this.move(event));
    for (const name of ["pointerup", "pointercancel"]) on(name, (event) => this.lift(event));
    canvas.addEventListener("wheel", (event) => {
      this.camera.hand.zoom = clampedZoom(this.camera.hand.zoom * Math.exp(event.deltaY / 900));
      event.preventDefault();
    }, { passive: false });
    on("keydown", (event) => this.key(event));
    addEventListener("resize", () => { this.sharp = 1; this.fit(); });
    addEventListener("hashchange", () => this.fromAddress());
  }

  move(event) {
    const before = this.touches.get(event.pointerId), { hand } = this.camera;
    if (!before) return;
    if (this.turning) {
      const others = [...this.touches.values()].filter((touch) => touch.pointerId !== event.pointerId), far = (touch) => Math.hypot(touch.clientX - others[0].clientX, touch.clientY - others[0].clientY);
      if (others.length) hand.zoom = clampedZoom((hand.zoom * far(before)) / Math.max(far(event), 1));
      hand.yaw -= (event.clientX - before.clientX) / 180;
      hand.pitch += (event.clientY - before.clientY) / 250;
    } else if (this.stroke) {
      for (const part of event.getCoalescedEvents?.().length ? event.getCoalescedEvents() : [event]) {
        const point = this.camera.ground(part.clientX, part.clientY), last = this.stroke.at(-1);
        if (point && Math.hypot(point[0] - last[0], point[1] - last[1]) > 0.01) this.stroke.push(point);
      }
    }
    this.touches.set(event.pointerId, event);
  }

  lift(event) {
    const { stroke } = this;
    this.touches.delete(event.pointerId);
    if (!this.touches.size) this.turning = null;
    if (!stroke || event.type === "pointercancel") { this.stroke = null; return; }
    this.stroke = null;
    const length = stroke.reduce((sum, [z, x], i) => sum + (i ? Math.hypot(z - stroke[i - 1][0], x - stroke[i - 1][1]) : 0), 0);
    if (length < 0.3) { this.tap(stroke[0]); return; }
    if (length < 1) { this.say("Draw a longer line: a metre or more."); return; }
    this.set(walkable(stroke));
    this.view(false);
  }

  tap(point) { // on a seam: the two moments that it joins, side by side; anywhere else, walk on
    const near = this.shown ? [] : this.seams().map((seam) => ({ ...seam, off: Math.hypot(...this.placeAt(seam.frame).map((value, c) => value - point[c])) })).sort((a, b) => a.off - b.off);
    moments().hidden = true;
    this.shown = null;
    if (!near.length || near[0].off > 0.35) return;
    const { walk, about } = this, edge = walk.edges[near[0].at], moment = (clip, frame) => `${about.clips[clip].name.replaceAll("_", " ")}, ${(frame / about.fps).toFixed(1)} s`;
    const still = (start, lay) => bodyAt({ graph: walk.graph, edges: [{ start, end: start, frames: 1, seam: false }], lays: [lay], begins: [0], frames: 1 }, 0);
    const [c, s, z, x] = walk.lays[near[0].at], [d, t, y, w] = edge.lay, aside = 0.5, from = { clip: edge.start.clip, frame: edge.start.frame + 5 }, to = { clip: edge.end.clip, frame: edge.end.frame - 5 };
    const other = [c * d - s * t, s * d + c * t, c * y - s * w + z, s * y + c * w + x];
    const { right } = this.camera, shift = (lay, sign) => [lay[0], lay[1], lay[2] + sign * aside * right[2], lay[3] + sign * aside * right[0]];
    this.shown = { bodies: [still(from, shift(walk.lays[near[0].at], -1)), still(to, shift(other, 1))] };
    this.time = near[0].frame;
    moments().textContent = `Two moments that are alike: ${moment(from.clip, from.frame)} and ${moment(to.clip, to.frame)}. Here the walk passes from one into the other. Tap to walk on.`;
    moments().hidden = false;
  }

  key(event) {
    const turn = { ArrowLeft: 0.26, ArrowRight: -0.26, ArrowUp: 0 }[event.key];
    if (turn !== undefined) {
      if (!this.stroke) { this.pen = this.camera.at.yaw + Math.PI; this.stroke = [this.walk.frames ? this.place() : [0, 0]]; }
      this.pen += turn;
      const [z, x] = this.stroke.at(-1);
      this.stroke.push([z + 0.3 * Math.cos(this.pen), x + 0.3 * Math.sin(this.pen)]);
    } else if (event.key === "Enter" && this.stroke?.length > 4) {
      const points = walkable(this.stroke);
      this.stroke = null;
      this.set(points);
    } else if (event.key === "Escape") this.stroke = this.shown = null;
    else if (event.key === " ") this.play(!this.playing);
    else return;
    event.preventDefault();
  }
}
