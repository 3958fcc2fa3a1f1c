// A walk as a file: BVH for other programs, a film or a GIF for friends.

import { poseAt } from "./walk_body.js";

/** @import { Walk } from "./walk_pieces.js" */

/** @param {number} value */
const degrees = (value) => ((value * 180) / Math.PI).toFixed(4);

/**
 * The angles of rotations about Z, X and Y, in this order.
 * @param {number[]} quaternion
 */
function angles([w, x, y, z]) {
  const lift = Math.asin(Math.max(-1, Math.min(2 * (y * z + w * x), 1)));
  return [
    Math.atan2(2 * (w * z - x * y), 1 - 2 * (x * x + z * z)),
    lift,
    Math.atan2(2 * (w * y - x * z), 1 - 2 * (x * x + y * y)),
  ];
}

/** @param {Walk} walk */
export function bvh(walk) {
  const { joints, parents, offsets, fps } = walk.graph.about;
  /** @type {number[]} the joints, as they are written */
  const order = [];
  const lines = ["HIERARCHY"];
  /** @param {number[]} values */
  const numbers = (values) => values.map((value) => (100 * value).toFixed(4)).join(" ");
  /**
   * @param {number} j
   * @param {string} indent
   */
  const joint = (j, indent) => {
    const children = parents.flatMap((parent, child) => (parent === j && child ? [child] : []));
    order.push(j);
    lines.push(
      `${indent}${j ? "JOINT" : "ROOT"} ${joints[j]}`,
      `${indent}{`,
      `${indent}  OFFSET ${numbers(offsets[j])}`,
    );
    lines.push(
      `${indent}  CHANNELS ${j ? "3" : "6 Xposition Yposition Zposition"} Zrotation Xrotation Yrotation`,
    );
    for (const child of children) joint(child, `${indent}  `);
    if (!children.length) {
      lines.push(`${indent}  End Site`, `${indent}  {`, `${indent}    OFFSET 0 0 0`, `${indent}  }`);
    }
    lines.push(`${indent}}`);
  };
  joint(0, "");
  lines.push("MOTION", `Frames: ${walk.frames}`, `Frame Time: ${(1 / fps).toFixed(8)}`);
  for (let frame = 0; frame < walk.frames; frame++) {
    const { root, rotations } = poseAt(walk, frame);
    lines.push(
      [
        numbers(root.map((value, c) => value - (offsets[0][c] ?? 0))),
        ...order.map((j) => angles(rotations[j]).map(degrees).join(" ")),
      ].join(" "),
    );
  }
  return `${lines.join("\n")}\n`;
}

/**
 * LZW as GIF has it: codes grow from nine bits, and the table begins anew when it is full.
 * @param {Uint8Array} pixels
 */
function squeezed(pixels) {
  const bytes = [];
  const CLEAR = 256;
  let bits = 0;
  let held = 0;
  let size = 9;
  let table = new Map();
  let next = 258;
  let word = pixels[0];
  /** @param {number} code */
  const put = (code) => {
    held |= code << bits;
    for (bits += size; bits >= 8; bits -= 8) {
      bytes.push(held & 255);
      held >>= 8;
    }
  };
  put(CLEAR);
  for (let i = 1; i < pixels.length; i++) {
    const longer = (word << 8) | pixels[i];
    const code = table.get(longer);
    if (code !== undefined) {
      word = code;
      continue;
    }
    put(word);
    table.set(longer, next++);
    if (next > 1 << size && size < 12) size++;
    if (next === 4096) {
      put(CLEAR);
      table = new Map();
      next = 258;
      size = 9;
    }
    word = pixels[i];
  }
  put(word);
  put(257);
  if (bits) bytes.push(held & 255);
  const blocks = [8];
  for (let at = 0; at < bytes.length; at += 255) {
    blocks.push(Math.min(255, bytes.length - at), ...bytes.slice(at, at + 255));
  }
  return [...blocks, 0];
}

/** @param {number} value */
const short = (value) => [value & 255, value >> 8];

/** The 256 colours of a GIF: 6 reds, 7 greens and 6 blues. */
const PALETTE = Array.from({ length: 256 }, (_, n) =>
  [(n % 6) * 51, (Math.floor(n / 6) % 7) * 42.5, Math.floor(n / 42) * 51].map((v) =>
    Math.min(255, Math.round(v)),
  ),
);
const GRAIN = [0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5]; // ordered dots hide the steps between colours

// A film as a GIF, picture by picture.
export class Gif {
  /**
   * @param {number} width
   * @param {number} height
   * @param {number} hundredths of a second for which a picture is shown
   */
  constructor(width, height, hundredths) {
    this.width = width;
    this.height = height;
    this.hundredths = hundredths;
    /** @type {ArrayLike<number>[]} */
    this.parts = [
      [..."GIF89a"].map((c) => c.charCodeAt(0)),
      [...short(width), ...short(height), 0xf7, 0, 0],
      PALETTE.flat(),
      [0x21, 0xff, 11, ...[..."NETSCAPE2.0"].map((c) => c.charCodeAt(0)), 3, 1, 0, 0, 0],
    ];
  }

  /**
   * Add a picture, of pixels (RGBA).
   * @param {ArrayLike<number>} picture
   */
  add(picture) {
    const { width, height, hundredths } = this;
    const pixels = new Uint8Array(width * height);
    for (let i = 0; i < pixels.length; i++) {
      const lift = (GRAIN[(Math.floor(i / width) % 4) * 4 + ((i % width) % 4)] + 0.5) / 16;
      const at = 4 * i;
      pixels[i] =
        Math.min(5, Math.floor(picture[at] / 51 + lift)) +
        6 * Math.min(6, Math.floor(picture[at + 1] / 42.5 + lift)) +
        42 * Math.min(5, Math.floor(picture[at + 2] / 51 + lift));
    }
    this.parts.push(
      [0x21, 0xf9, 4, 4, ...short(hundredths), 0, 0, 0x2c, 0, 0, 0, 0, ...short(width), ...short(height), 0],
      squeezed(pixels),
    );
  }

  blob() {
    return new Blob(
      [...this.parts, [0x3b]].map((part) => new Uint8Array(part)),
      { type: "image/gif" },
    );
  }
}

const FILM_TYPES = ["video/mp4", "video/webm"]; // the first one that the browser writes
const FILM_RATE = 6_000_000; // bits per second
const NO_FILM = "This browser records no films: save a GIF.";

// A film of what a canvas shows, from now until it is stopped.
export class Film {
  /** @type {Blob[]} */
  parts = [];

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {number} fps
   */
  constructor(canvas, fps) {
    const type = FILM_TYPES.find((other) => window.MediaRecorder?.isTypeSupported(other));
    if (!type) throw new Error(NO_FILM);
    this.type = type;
    const options = { mimeType: type, videoBitsPerSecond: FILM_RATE };
    this.recorder = new MediaRecorder(canvas.captureStream(fps), options);
    this.recorder.ondataavailable = ({ data }) => this.parts.push(data);
    this.recorder.start(1000);
  }

  get name() {
    return `walk.${this.type.split("/")[1]}`;
  }

  /** @returns {Promise<Blob>} */
  stop() {
    return new Promise((resolve) => {
      this.recorder.onstop = () => resolve(new Blob(this.parts, { type: this.type }));
      this.recorder.stop();
      for (const track of this.recorder.stream.getTracks()) track.stop();
    });
  }
}

/**
 * @param {string | Blob} content
 * @param {string} name
 */
export function download(content, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content instanceof Blob ? content : new Blob([content]));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
