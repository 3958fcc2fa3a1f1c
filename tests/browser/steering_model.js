// Stands for Python where steered characters are tested: all walk at the speed of the command, and turn at once.

/**
 * @import { PackedMember } from "../../mocap/widgets/steered_walker.js"
 *
 * @typedef {(...what: any[]) => void} Call
 * @typedef {{ view: number, number: number, seconds: number, command: [number, number, string] }} Question
 */

export class Model {
  /** @type {Record<string, Call[]>} what listens to a change */
  heard = {};
  /** @type {Question[]} */
  questions = [];
  /** @type {Question[]} those that wait while it is silent */
  kept = [];
  /** @type {number[][]} where each character is, [x, z] */
  places = [];
  /** @type {Record<string, any>} what its answers say instead */
  said = {};
  /** @type {number} milliseconds until it answers */
  delay = 10;
  silent = false;
  frames = 1;

  /** @param {{ scene: { members: PackedMember[] }, command: any[], [name: string]: any }} state */
  constructor(state) {
    this.state = state;
  }
  /** @param {string} name */
  get(name) {
    return this.state[name];
  }
  /**
   * @param {string} name
   * @param {any} value
   */
  set(name, value) {
    const same = JSON.stringify(value) === JSON.stringify(this.state[name]);
    this.state[name] = value;
    if (!same) this.tell(`change:${name}`);
  }
  /**
   * @param {string} name
   * @param {Call} call
   */
  on(name, call) {
    (this.heard[name] ??= []).push(call);
  }
  /**
   * @param {string} name
   * @param {Call} call
   */
  off(name, call) {
    this.heard[name] = this.heard[name].filter((other) => other !== call);
  }
  /**
   * @param {string} name
   * @param {any[]} what
   */
  tell(name, ...what) {
    (this.heard[name] ?? []).forEach((call) => call(...what));
  }
  save_changes() {}
  /** @param {Question} question */
  send(question) {
    this.questions.push(question);
    if (this.silent) this.kept.push(question);
    else setTimeout(() => this.answer(question), this.delay);
  }
  speak() {
    this.silent = false;
    this.kept.splice(0).forEach((question) => this.answer(question));
  }

  /** @param {Question} question */
  answer({ view, number, seconds, command: [heading, speed] }) {
    const count = Math.max(1, Math.round(30 * seconds));
    const first = this.frames;
    /** @param {unknown} value */
    const all = (value) => Array(count).fill(value);
    this.frames += count;
    const buffers = this.state.scene.members.map(({ joints }, k) => {
      this.places[k] ??= [0, 0];
      const place = this.places[k];
      const numbers = new Float32Array(count * joints * 3);
      for (let f = 0; f < count; f++) {
        place[0] += (speed * Math.sin(heading)) / 30;
        place[1] += (speed * Math.cos(heading)) / 30;
        for (let j = 0; j < joints; j++) {
          numbers.set([place[0], (1.8 * j) / joints, place[1]], 3 * (f * joints + j));
        }
      }
      return new DataView(numbers.buffer);
    });
    const members = this.places.map(() => ({
      first,
      waited: all(0.4),
      obeyed: all(false),
      blending: all(false),
      fault: "",
      delays: [1, 2],
      ...this.said.member,
    }));
    this.tell(
      "msg:custom",
      { kind: "walked", view, number, cost: 1, notes: [], ...this.said, members },
      buffers,
    );
  }
}
