// What the reader's hand does on the canvas: turn, zoom, draw a path with the mouse, a finger or the keys.

const SHORTEST = 0.5, LONGEST = 100; // metres of a path that can be walked
const PEN_STEP = 0.25; // metres per press of an arrow key

class Hand {
  constructor(player) {
    this.player = player; this.pointers = new Map(); this.drawn = []; this.stroke = null; this.pen = false;
    const { canvas } = player;
    for (const kind of ["pointerdown", "pointermove", "pointerup", "pointercancel"]) {
      canvas.addEventListener(kind, (event) => this[kind](event));
    }
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    player.root.addEventListener("keydown", (event) => this.key(event));
  }

  get camera() { return this.player.camera; }
  get busy() { return this.stroke !== null || this.pen; } // then figure and view wait

  orbit(yaw, pitch) {
    this.player.chase = false;
    this.camera.yaw += yaw;
    this.camera.pitch = Math.min(1.55, Math.max(0.02, this.camera.pitch + pitch));
    this.player.update();
  }

  zoomBy(factor) { this.camera.zoom = Math.min(12, Math.max(0.2, this.camera.zoom * factor)); this.player.update(); }

  // Move what is looked at over the ground, in pixels.
  pan(across, down) {
    const { right, ahead, focus } = this.camera, metres = this.player.reach / (this.camera.zoom * focus), level = Math.hypot(ahead[0], ahead[2]) || 1;
    [0, 2].forEach((k, i) => { this.player.panned[i] += metres * (down * ahead[k] / level - across * right[k]); });
    this.player.update();
  }

  // ---- mouse and fingers ----

  // The wheel zooms where the canvas has the focus; elsewhere it scrolls the page.
  wheel(event) {
    if (!event.ctrlKey && document.activeElement !== this.player.canvas) return;
    event.preventDefault();
    this.zoomBy(Math.exp(-event.deltaY / 400));
  }

  pointerdown(event) {
    this.player.canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, event);
    this.before = { yaw: this.camera.yaw, pitch: this.camera.pitch };
    this.stroke = this.player.drawing && event.button === 0 && this.pointers.size === 1 ? event.pointerId : null;
    if (this.stroke !== null) this.drawn = [];
  }

  // One finger or the mouse turns the view; two fingers zoom and move it, as shift or the right button do. In drawing mode, one finger or the left button draws.
  pointermove(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const others = [...this.pointers.values()].filter((other) => other.pointerId !== event.pointerId);
    const from = (p, q) => Math.hypot(p.offsetX - q.offsetX, p.offsetY - q.offsetY);
    this.pointers.set(event.pointerId, event);
    const [across, down] = [event.offsetX - before.offsetX, event.offsetY - before.offsetY];
    if (others.length) {
      this.zoomBy(from(event, others[0]) / Math.max(1, from(before, others[0])));
      this.pan(across / 2, down / 2);
    } else if (event.shiftKey || event.buttons === 2) this.pan(across, down);
    else if (this.stroke === event.pointerId) this.draw(this.camera.ground(event.offsetX, event.offsetY));
    else this.orbit(-across / 150, down / 150);
  }

  pointerup(event) {
    this.pointers.delete(event.pointerId);
    if (this.stroke === event.pointerId) this.walk();
    this.stroke = null;
    this.player.update();
  }

  // The finger scrolls the page: what it turned until that was known is turned back.
  pointercancel(event) {
    this.pointers.delete(event.pointerId);
    this.stroke = null;
    Object.assign(this.camera, this.before);
    this.player.update();
  }

  // ---- the path that is drawn ----

  draw(place) {
    const last = this.drawn.at(-1);
    if (place && (!last || Math.hypot(place[0] - last[0], place[1] - last[1]) > 0.05)) this.drawn.push(place);
    this.player.update();
  }

  get metres() {
    return this.drawn.reduce((sum, [x, z], i) => sum + (i ? Math.hypot(x - this.drawn[i - 1][0], z - this.drawn[i - 1][1]) : 0), 0);
  }

  // Ask for a walk along what was drawn, or say why there is none.
  walk() {
    const { metres } = this;
    if (metres < SHORTEST) this.player.say(`That is ${metres.toFixed(1)} m. Drag over the ground for at least ${SHORTEST} m.`);
    else if (metres > LONGEST) this.player.say(`That is ${metres.toFixed(0)} m. Draw at most ${LONGEST} m, or zoom in.`);
    else { this.yaw = this.camera.yaw; this.player.ask(this.drawn); return; }
    this.drawn = [];
    this.player.update();
  }

  // ---- keys ----

  key(event) {
    const { player } = this, onCanvas = event.target === player.canvas;
    const turn = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] }[event.key];
    if (onCanvas && this.pen && this.penKey(event.key, turn && !event.shiftKey && turn)) { /* the pen took it */ }
    else if (event.key === " " && (onCanvas || event.target === player.scrub)) player.toggle();
    else if (onCanvas && player.drawing && event.key === "p") this.takePen();
    else if (onCanvas && turn && event.shiftKey) this.orbit(...turn);
    else if (onCanvas && turn && event.altKey) this.pan(300 * turn[0], 300 * turn[1]);
    else if (onCanvas && turn && turn[0]) { player.toggle(false); player.seek((player.frame() + Math.sign(turn[0])) / player.scene.fps); }
    else if (onCanvas && (event.key === "+" || event.key === "-")) this.zoomBy(event.key === "+" ? 1.15 : 1 / 1.15);
    else if (onCanvas && event.key === "l") player.mark();
    else if (onCanvas && event.key === "Home") player.seek(0);
    else if (onCanvas && event.key === "End") player.seek(player.seconds);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  takePen() {
    const start = this.player.scene.asked[0] ?? [0, 0];
    this.pen = true;
    this.drawn = [[...start]];
    this.player.say(`The pen is down. ${PEN_KEYS}`);
    this.player.update();
  }

  // With the pen down, arrows draw: up is away from the camera. Returns whether the key was the pen's.
  penKey(key, turn) {
    const [x, z] = this.drawn.at(-1), { ahead, right } = this.camera, along = Math.hypot(ahead[0], ahead[2]) || 1;
    if (turn) {
      const [a, b] = [Math.sign(turn[0]) * PEN_STEP, (Math.sign(turn[1]) * PEN_STEP) / along];
      this.drawn.push([x + a * right[0] + b * ahead[0], z + a * right[2] + b * ahead[2]]);
      this.player.say(`${this.metres.toFixed(2)} m drawn. ${PEN_KEYS}`);
    } else if (key === "Backspace" && this.drawn.length > 1) this.drawn.pop();
    else if (key === "Enter") { this.pen = false; this.walk(); }
    else if (key === "Escape") { this.pen = false; this.drawn = []; this.player.say(""); }
    else return false;
    this.player.update();
    return true;
  }
}
