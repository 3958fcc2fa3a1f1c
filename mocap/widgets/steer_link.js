// The link of the page for steering to Python: it asks for the next frames while the last ones are played.
//
// A request is made when few seconds are left to play, and has the command of that moment. How many are "few" depends
// on how long the last answers took. If no answer comes, time runs slower and slower until it stands.

/**
 * @import { Told, Walker } from "./steered_walker.js"
 *
 * Heading in radians, speed in metres per second, and a label.
 * @typedef {[heading: number, speed: number, label: string]} Order
 *
 * @typedef {{ why: string }} Refused
 *
 * The answer to a request for frames, as `SteeredSession.walk` returns it: positions are of all joints of a frame.
 * @typedef {Told & { positions: number[][], notes: string[] }} NextFrames
 */

const PIECE = 0.05; // seconds of walking per request, at least
const GENTLE = 0.03; // seconds; with fewer left to play, time runs slower
const LONGEST_LEAD = 0.5; // seconds
const REMEMBERED = 20; // durations of answers
const GONE = "mocap steer has ended. Start it again: it opens a new page.";

export class Link {
  /** @type {number | null} the second that is shown */
  time = null;
  /** @type {number[]} the milliseconds that the last answers took */
  trips = [50];
  asking = false;
  /** @type {boolean} whether Python has ended */
  gone = false;
  /** @type {string} the message of the last answer: an error or a warning */
  message = "";

  /** @param {Walker} walker */
  constructor(walker) {
    this.walker = walker;
  }

  // The seconds that are walked, and not yet shown.
  get ahead() {
    return this.time === null ? 0 : this.walker.end - this.time;
  }

  // The seconds that must be ahead when the next ones are asked for: as long as nearly all answers take, and a little more.
  get lead() {
    const slow = [...this.trips].sort((a, b) => b - a)[this.trips.length >> 3];
    return Math.min(LONGEST_LEAD, slow / 1000 + GENTLE);
  }

  // The number of the frame that is shown.
  get frame() {
    return Math.floor((this.time ?? 0) * this.walker.fps + 1e-6);
  }

  /**
   * Let time pass, as far as frames were walked.
   * @param {number} seconds
   */
  play(seconds) {
    if (this.time === null) return;
    const ahead = Math.max(0, this.ahead);
    this.time += Math.min(ahead, seconds * Math.min(1, ahead / GENTLE));
  }

  /**
   * Ask for the next frames, if few are left.
   * @param {Order} command
   */
  async ask(command) {
    if (this.asking || this.gone || this.ahead > this.lead) return;
    this.asking = true;
    const start = performance.now();
    const seconds = Math.min(LONGEST_LEAD, this.lead - this.ahead + PIECE);
    /** @type {NextFrames | Refused} */
    const frames = await this.post("walk", { command, seconds });
    this.asking = false;
    if ("why" in frames) {
      this.message = frames.why;
      return;
    }
    this.trips = [...this.trips.slice(1 - REMEMBERED), performance.now() - start];
    this.walker.add(frames, new Float32Array(frames.positions.flat()));
    this.message = frames.fault || frames.notes.join("\n");
    this.time ??= this.walker.end;
    if (this.time < this.walker.first / this.walker.fps) this.time = this.walker.end; // another page has walked on
  }

  /**
   * Send a request. Its answer is a reason if Python has refused it, or has ended.
   * @param {string} word
   * @param {object} content
   */
  async post(word, content) {
    try {
      const response = await fetch(word, {
        method: "POST",
        headers: { "Content-Type": "application/json" },
        body: JSON.stringify(content),
      });
      return await response.json();
    } catch {
      this.gone = true;
      return { why: GONE };
    }
  }
}
