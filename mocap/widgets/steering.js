// Characters that obey one command, side by side. `steered_widget.py` answers the questions that are asked here.
//
// The pictures run on behind what Python has walked: where few seconds are left, the browser asks for a few more and says
// the command. How many are "few" goes by how long the last answers took; two questions may be under way. Where no
// answer comes, time runs slower and slower until it stands. Nothing is asked while nobody looks.

const PIECE = 0.05; // seconds of walking per question, at least
const MOST = 2; // questions under way; with more, a busy machine would only have more to do
const GENTLE = 0.03; // with fewer seconds left than this, time runs slower
const SILENT = 1000, LOST = 15000; // milliseconds without an answer until the page says that Python is busy, or may have ended
const DIRECTIONS = { ArrowUp: [0, 1], ArrowDown: [0, -1], ArrowLeft: [-1, 0], ArrowRight: [1, 0], w: [0, 1], s: [0, -1], a: [-1, 0], d: [1, 0] };

class Steering {
  constructor(root, model) {
    Object.assign(this, { root, model, scene: model.get("scene"), view: Math.random() });
    this.time = null; this.playing = false; this.visible = true; this.pictures = 0; this.scripted = 0;
    this.number = 0; this.asked = new Map(); this.trips = [50]; this.ways = []; this.under = null; this.held = new Set();
    this.shared = { yaw: VIEWS.behind[0], pitch: VIEWS.behind[1], zoom: 1 };
    this.build();
    this.listen();
    this.showCommand();
    this.ask();
    this.update();
  }

  // ---- the page ----

  build() {
    const { root, scene } = this, find = (what) => root.querySelector(what), [low, high] = scene.speeds;
    root.classList.add("mocap-player", "mocap-steering");
    root.dataset.started = "true";
    root.innerHTML = STEERING_PARTS;
    const names = ["panels", "pad", "play", "speed", "kind", "view", "under", "message"];
    for (const name of names) this[`${name}Part`] = find(`.${name}`);
    this.knob = find(".pad i"); this.speedSaid = find("output");
    this.panels = scene.members.map((member) => panel(member, this.shared));
    this.panelsPart.append(...this.panels.map((one) => one.root));
    this.panelsPart.setAttribute("aria-label", `${scene.alt} ${STEERING_KEYS}`);
    this.panelsPart.title = STEERING_KEYS;
    Object.assign(this.speedPart, { min: low, max: high });
    this.kindPart.replaceChildren(...scene.labels.map((label) => new Option(label || "any", label)));
    find(".kinds").hidden = !scene.labels.length;
    // JupyterLab takes keys away from whatever does not say this.
    for (const part of root.querySelectorAll(".panels, button, input, select")) part.dataset.lmSuppressShortcuts = "true";
    this.toggle(false);
  }

  say(text, wrong = false) {
    if (this.messagePart.textContent !== text) this.messagePart.textContent = text;
    this.messagePart.classList.toggle("error", wrong);
  }

  toggle(playing = !this.playing) {
    this.playing = playing;
    this.playPart.textContent = playing ? "❚❚" : "▶";
    this.playPart.setAttribute("aria-label", playing ? "pause" : "walk");
    this.update();
  }

  listen() {
    this.playPart.onclick = () => this.toggle();
    this.speedPart.oninput = () => this.order({ speed: Number(this.speedPart.value) });
    this.kindPart.onchange = () => this.order({ label: this.kindPart.value });
    this.viewPart.onchange = () => { [this.shared.yaw, this.shared.pitch] = VIEWS[this.viewPart.value]; this.update(); };
    this.padPart.onpointerdown = this.padPart.onpointermove = (event) => this.onPad(event);
    for (const one of this.panels) whenPointed(one.canvas, (event) => this.onGround(event, one));
    this.root.onkeydown = (event) => this.key(event);
    this.root.onkeyup = (event) => this.held.delete(keyName(event));
    this.root.onfocusout = () => this.held.clear();
    this.panelsPart.onwheel = (event) => this.wheel(event);
    this.resized = new ResizeObserver(() => this.update());
    this.resized.observe(this.panelsPart);
    this.seen = new IntersectionObserver((entries) => { this.visible = entries.at(-1).isIntersecting; this.update(); });
    this.seen.observe(this.panelsPart);
    this.answers = (content, buffers) => this.answered(content, buffers);
    this.commands = () => { this.commanded(); this.showCommand(); this.update(); };
    this.ended = () => { this.gone = true; this.toggle(false); this.say("Python has ended: run the cell again to steer.", true); };
    this.model.on("msg:custom", this.answers);
    this.model.on("change:command", this.commands);
    this.model.on("comm_live_update", this.ended);
  }

  end() {
    this.resized.disconnect(); this.seen.disconnect(); cancelAnimationFrame(this.waiting);
    this.model.off("msg:custom", this.answers); this.model.off("change:command", this.commands); this.model.off("comm_live_update", this.ended);
  }

  // ---- the command ----

  get command() { const [heading, speed, label] = this.model.get("command"); return { heading, speed, label }; }

  order(change) {
    const { heading, speed, label } = { ...this.command, ...change }, [low, high] = this.scene.speeds;
    this.model.set("command", [heading, Math.round(20 * Math.min(high, Math.max(low, speed))) / 20, label]);
    if (!this.playing && !this.gone) this.toggle(true);
  }

  // A new command is under way from now on, until the first frames that know it are seen; what was said of the last one goes.
  commanded() { this.steered = this.warned = true; this.under ??= { since: performance.now(), number: null, start: null }; }

  // The heading of a direction on the picture: [to the right, up], where up is away from the reader.
  heading([right, up]) {
    const { yaw } = this.shared;
    return Math.atan2(right * Math.cos(yaw) - up * Math.sin(yaw), -right * Math.sin(yaw) - up * Math.cos(yaw));
  }

  onPad(event) {
    if (event.type === "pointerdown") { this.padPart.setPointerCapture(event.pointerId); this.panelsPart.focus({ preventScroll: true }); }
    else if (!event.buttons) return;
    const { x, y, width } = this.padPart.getBoundingClientRect(), [low, high] = this.scene.speeds;
    const right = (2 * (event.clientX - x)) / width - 1, up = 1 - (2 * (event.clientY - y)) / width, far = Math.hypot(right, up);
    if (far > 0.1) this.order({ heading: this.heading([right, up]), speed: low + (high - low) * Math.min(1, Math.max(0, (far - 0.3) / 0.6)) });
    event.preventDefault();
  }

  onGround(event, { camera, walker }) {
    this.panelsPart.focus({ preventScroll: true });
    const place = walker.frames.length && camera.eye && camera.ground(event.offsetX, event.offsetY);
    if (!place) return;
    const [x, , z] = walker.pose(this.time), right = place[0] - x, ahead = place[1] - z;
    if (Math.hypot(right, ahead) > 0.2) this.order({ heading: Math.atan2(right, ahead) });
  }

  key(event) { // wherever the focus is in the widget; a slider and a list keep their own keys, and so does space on a button
    const name = keyName(event), way = DIRECTIONS[name], { heading, speed } = this.command;
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.matches("input, select") || (name === " " && event.target === this.playPart)) return;
    if (way && event.shiftKey && name.startsWith("Arrow")) this.orbit(way);
    else if (way) {
      this.held.add(name);
      const sum = [...this.held].map((key) => DIRECTIONS[key]).reduce(([a, b], [c, d]) => [a + c, b + d], [0, 0]);
      if (!event.repeat && (sum[0] || sum[1])) this.order({ heading: this.heading(sum) });
    } else if (name === "q" || name === "e") this.order({ heading: heading + (name === "q" ? 1 : -1) * (Math.PI / 12) });
    else if (name === "+" || name === "-") this.order({ speed: speed + (name === "+" ? 0.1 : -0.1) });
    else if (name === " ") this.toggle();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  orbit([right, up]) {
    this.shared.yaw += 0.1 * right;
    this.shared.pitch = Math.min(1.55, Math.max(0.05, this.shared.pitch + 0.1 * up));
    this.update();
  }

  // The wheel zooms where the pictures have the focus; elsewhere it scrolls the page.
  wheel(event) {
    if (document.activeElement !== this.panelsPart) return;
    event.preventDefault();
    this.shared.zoom = Math.min(4, Math.max(0.3, this.shared.zoom * Math.exp(-event.deltaY / 400)));
    this.update();
  }

  // ---- Python ----

  get ahead() { return Math.min(...this.panels.map(({ walker }) => walker.end)) - this.time; }

  // The seconds that must be ahead when a question is asked: as long as nearly all answers take, and a little more.
  get lead() { return Math.min(0.5, [...this.trips].sort((a, b) => b - a)[this.trips.length >> 3] / 1000 + GENTLE); }

  // The seconds that Python has been asked for, and has not sent.
  get promised() { return [...this.asked.values()].reduce((sum, { seconds }) => sum + seconds, 0); }

  ask() {
    const missing = this.time === null ? PIECE : this.lead - this.ahead - this.promised, seconds = Math.max(PIECE, missing);
    if (missing <= 0 || this.asked.size >= MOST || this.gone) return;
    this.asked.set(++this.number, { at: performance.now(), seconds });
    if (this.under && this.under.number === null) this.under.number = this.number;
    try {
      this.model.send({ kind: "ask", view: this.view, number: this.number, seconds, command: this.model.get("command") });
      this.model.save_changes(); // after the question, which carries the command as well, and is in a hurry
    } catch { this.ended(); }
  }

  answered(content, buffers) {
    if (this.gone) return; // an answer that was under way would take back what was said of the end
    if (content.kind === "refused") { this.say(content.why, true); this.asked.clear(); return; }
    if (content.view === this.view) this.timeTrip(content);
    content.members.forEach((member, k) => this.panels[k].walker.add(member, numbersOf(buffers[k])));
    if (content.notes.length) this.say(content.notes.join("\n"));
    else if (this.late || this.warned) this.say("");
    this.late = false; this.warned = false;
    this.cost = content.cost;
    const start = Math.min(...this.panels.map(({ walker }) => walker.end));
    this.time ??= start;
    if (this.time < start - 1) this.time = start - 0.1; // after a long pause in another view
    this.update();
  }

  // Remember how long the answer took, and where the frames begin that know a new command.
  timeTrip({ number, members }) {
    if (this.asked.has(number)) this.trips = [...this.trips.slice(-19), performance.now() - this.asked.get(number).at];
    this.asked.delete(number);
    if (this.under?.number === number) this.under.start = members[0].first / this.panels[0].walker.fps;
  }

  // ---- time and pictures ----

  update() { this.waiting ??= requestAnimationFrame((now) => this.tick(now)); }

  tick(now) {
    this.waiting = null;
    if (!this.root.isConnected || !this.visible || this.time === null) { this.last = null; return; }
    const seconds = this.last ? Math.min(0.1, (now - this.last) / 1000) : 0, before = performance.now();
    this.last = this.playing ? now : null;
    if (this.playing) {
      const ahead = Math.max(0, this.ahead);
      this.time += Math.min(ahead, seconds * Math.min(1, ahead / GENTLE));
      this.ask();
      this.arrived();
      this.update();
    }
    this.draw(seconds);
    this.scripted += performance.now() - before;
  }

  // The frames that know the new command are seen: note how long it was under way.
  arrived() {
    if (this.under?.start !== null && this.time >= this.under?.start) {
      this.ways = [...this.ways.slice(-8), performance.now() - this.under.since];
      this.under = null;
    }
    const silent = this.asked.size ? performance.now() - this.asked.values().next().value.at : 0;
    if (silent > LOST) this.say("Python does not answer. Has it ended? Then run the cell again.", true);
    else if (silent > SILENT) this.say("Python is busy: the figures wait until it answers.");
    this.late = silent > SILENT;
  }

  draw(seconds) {
    const dark = isDark(), palette = dark ? DARK : LIGHT, { sides, marks } = this.scene, { time } = this;
    this.root.classList.toggle("dark", dark);
    for (const { canvas, camera, picture, walker } of this.panels) {
      Object.assign(camera, this.shared);
      walker.trail = walker.trailUntil(time, marks.seam);
      const target = walker.target(time, seconds), asked = this.arrow(target);
      picture.draw({ characters: [walker], time, asked, drawn: [], pen: null, sides, marks, palette, ghosts: false, target, distance: 4.2, reach: 3, light: LOOKS[dark ? "dark" : "light"] });
    }
    this.pictures++;
    if (this.pictures % 6 === 1 || !this.playing) this.showState();
  }

  // The command as an arrow on the ground, longer for a faster one.
  arrow([x, , z]) {
    const { heading, speed } = this.command, [s, c] = [Math.sin(heading), Math.cos(heading)], far = 0.5 + 0.5 * speed;
    const at = (along, aside) => [x + along * s + aside * c, z + along * c - aside * s];
    return [at(0.3, 0), at(far, 0), at(far - 0.2, 0.14), at(far, 0), at(far - 0.2, -0.14)];
  }

  showCommand() {
    const { heading, speed, label } = this.command, [low, high] = this.scene.speeds, { yaw } = this.shared;
    const [s, c] = [Math.sin(heading), Math.cos(heading)], right = s * Math.cos(yaw) - c * Math.sin(yaw), up = -s * Math.sin(yaw) - c * Math.cos(yaw);
    const far = 46 * (0.3 + 0.6 * ((speed - low) / (high - low)));
    this.knob.style.transform = `translate(${(far * right).toFixed(1)}px, ${(-far * up).toFixed(1)}px)`;
    this.speedPart.value = speed; this.speedSaid.textContent = `${speed.toFixed(2)} m/s`;
    this.kindPart.value = label;
  }

  showState() {
    this.showCommand();
    for (const { walker, state, fault } of this.panels) {
      const { waited, obeyed } = walker.frame(this.time), { delays } = walker;
      const mean = delays.length ? ` · mean of ${delays.length}: ${(delays.reduce((a, b) => a + b) / delays.length).toFixed(2)} s` : "";
      const told = this.steered ? ` · ${obeyed ? "obeyed after" : "not yet, after"} ${waited.toFixed(2)} s${mean}` : ""; // nothing of what no reader asked for
      state.textContent = `${walker.speed(this.time).toFixed(1)} m/s${told}`;
      if (fault.textContent !== walker.fault) fault.textContent = walker.fault;
    }
    const ways = [...this.ways].sort((a, b) => a - b), way = ways.length ? (ways[ways.length >> 1] / 1000).toFixed(2) : null;
    this.underPart.textContent = way ? `A command is under way to Python and back for ${way} s, which are not counted above.` : "";
    Object.assign(this.root.dataset, { playing: this.playing, way: way ?? "" });
  }
}

function keyName(event) { return event.key.length === 1 ? event.key.toLowerCase() : event.key; }

// The numbers of a buffer, wherever its bytes begin.
function numbersOf(buffer) {
  const view = ArrayBuffer.isView(buffer) ? buffer : new DataView(buffer);
  return new Float32Array(view.buffer.slice(view.byteOffset, view.byteOffset + view.byteLength));
}

// In JupyterLab: called by anywidget.
export default {
  render({ model, el }) {
    el.steering = new Steering(el, model);
    return () => el.steering.end();
  },
};
