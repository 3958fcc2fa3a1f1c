// The picture of a scene on a canvas: ground, paths, footprints, ghosts, and bodies with their shadows.

import { rgb } from "./bodies.js";
import { clearedPen, mapInto, paintDisc, paintLine, paintStroke } from "./canvas.js";
import { Shading } from "./player_body.js";

/**
 * @import { Look } from "./bodies.js"
 * @import { Palette } from "./player_page.js"
 * @import { Camera, Marks, PackedFigure, Trail } from "./player_scene.js"
 *
 * A body that moves, with what is drawn on its path: `Character` and `Walker` are such.
 * @typedef {object} Drawn
 * @property {number[][]} bones [from, to, side]
 * @property {number | null} head
 * @property {PackedFigure["parts"]} parts
 * @property {PackedFigure["pieces"]} pieces
 * @property {Trail[]} trail
 * @property {number[][]} diamonds
 * @property {number[][]} prints
 * @property {(time: number) => Float32Array} pose
 * @property {(time: number) => string} colourAt
 * @property {number[][][]} [bySide] the bones of each side
 *
 * @typedef {{ character: Drawn, pose: Float32Array, far: number }} Posed
 *
 * What a picture shows.
 * @typedef {object} Shown
 * @property {Drawn[]} characters
 * @property {number} time
 * @property {number[][]} asked a path [x, z] on the ground
 * @property {number[][]} drawn another one
 * @property {number[] | null} [pen] a position on it
 * @property {number[][]} [obstacles] discs on it (x, z, radius)
 * @property {number[][]} [boxes] x, y and z of the lowest corner, and of the highest one
 * @property {string[]} sides the colours of a body's sides
 * @property {Partial<Marks>} marks
 * @property {Palette} palette
 * @property {boolean} ghosts whether earlier poses are drawn
 * @property {number[]} target what is looked at
 * @property {number} distance metres from there to the camera
 * @property {number} reach metres that the ground reaches at least
 * @property {Look | null} [light] in which bodies are shaded
 */

export const NEAR = 0.1; // metres before the camera, from where on something is drawn
const APART = 3; // pixels between points of a line; nearer ones would cost time, and nobody would see them
const SPACINGS = [1, 2, 5, 10, 20, 50]; // metres between lines of the ground
// Seconds from now, how strong a line is drawn again.
const TRAIL = [
  [Infinity, 0.25],
  [2, 0.3],
  [1.5, 0.3],
  [1, 0.3],
  [0.5, 0.3],
];
const BRIGHTNESS = [0, 0.45, 0.2]; // of the faces of boxes that are perpendicular to x, y and z
// Of a face: whether the coordinate along its first and its second axis is the larger one.
const CORNERS = [
  [0, 0],
  [1, 0],
  [1, 1],
  [0, 1],
];
const DIAMOND = 0.1; // metres from the middle of a diamond to its corners
const GHOSTS = 6; // earlier poses
const GHOST_INTERVAL = 0.25; // seconds between them

export class Picture {
  /** @type {Drawn[]} */
  characters;
  /** @type {number} */
  time;
  /** @type {string[]} */
  sides;
  /** @type {Partial<Marks>} */
  marks;
  /** @type {Palette} */
  palette;
  /** @type {Look | null} */
  light = null;
  /** @type {number[][]} */
  boxes = [];
  /** @type {CanvasRenderingContext2D} */
  pen;

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {Camera} camera
   */
  constructor(canvas, camera) {
    this.canvas = canvas;
    this.camera = camera;
  }

  /**
   * Draw the characters at a time.
   * @param {Shown} shown
   */
  draw({
    characters,
    time,
    asked,
    drawn,
    pen,
    obstacles = [],
    boxes = [],
    sides,
    marks,
    palette,
    ghosts,
    target,
    distance,
    reach,
    light = null,
  }) {
    this.characters = characters;
    this.time = time;
    this.sides = sides;
    this.marks = marks;
    this.palette = palette;
    this.light = light;
    const [wide, high] = this.clear();
    this.camera.place(target, distance, wide, high);
    this.drawGround(target, reach);
    for (const disc of obstacles) this.drawObstacle(disc);
    this.boxes = boxes;
    this.drawBoxes(boxes);
    /** @param {number[][]} positions */
    const flat = (positions) => positions.map(([x, z]) => [x, 0, z]);
    this.stroke([flat(asked)], palette.asked, 6, 0.75);
    this.stroke([flat(drawn)], palette.asked, 3);
    if (pen) this.disc([pen[0], 0.005, pen[1]], 0.12, palette.asked, 0.8, true);
    for (const character of characters) this.drawTrail(character);
    if (ghosts) this.drawGhosts();
    this.drawBodies();
  }

  // Clear the canvas, give it as many pixels as the screen has there, and return its size on the page.
  clear() {
    const { pen, wide, high } = clearedPen(this.canvas);
    this.pen = pen;
    if (this.light) this.paper(this.light, [wide, high]);
    return [wide, high];
  }

  /**
   * The surroundings of the body: the sky, and a ground that gets brighter towards it.
   * @param {Look} light
   * @param {number[]} size
   */
  paper({ ground, sky }, [wide, high]) {
    const fill = this.pen.createLinearGradient(0, 0, 0, high);
    fill.addColorStop(0.25, sky);
    fill.addColorStop(1, ground);
    this.pen.fillStyle = fill;
    this.pen.fillRect(0, 0, wide, high);
  }

  /**
   * Lines which stay where they are in the world and fade with distance, one metre apart. Where so many would be grey
   * together, they are further apart, and a word says so.
   * @param {number[]} target
   * @param {number} reach
   */
  drawGround([x, , z], reach) {
    const wide = (1.3 * reach) / Math.min(1, this.camera.zoom);
    const spacing = SPACINGS.find((metres) => wide <= 30 * metres) ?? SPACINGS[SPACINGS.length - 1];
    const lines = Math.max(6, Math.ceil(wide / spacing));
    const x0 = spacing * Math.round(x / spacing);
    const z0 = spacing * Math.round(z / spacing);
    const end = lines * spacing;
    for (let i = 0; i <= lines; i++) {
      const both = [i * spacing, -i * spacing].slice(0, i ? 2 : 1);
      const along = both.map((off) => [
        [x0 + off, 0, z0 - end],
        [x0 + off, 0, z0 + end],
      ]);
      const across = both.map((off) => [
        [x0 - end, 0, z0 + off],
        [x0 + end, 0, z0 + off],
      ]);
      this.stroke([...along, ...across], this.palette.line, 1, 1 - i / (lines + 1));
    }
    if (spacing > 1) this.write(`lines ${spacing} m apart`);
  }

  /**
   * A disc on the ground, as a polygon: it may be large. Corners behind the camera are left out.
   * @param {number[]} disc
   */
  drawObstacle([x, z, radius]) {
    const { camera, pen } = this;
    pen.beginPath();
    for (let angle = 0; angle < 2 * Math.PI; angle += Math.PI / 24) {
      camera.project(x + radius * Math.sin(angle), 0, z + radius * Math.cos(angle));
      if (camera.far > NEAR) pen.lineTo(camera.across, camera.down);
    }
    pen.fillStyle = this.palette.line;
    pen.fill();
  }

  /**
   * The faces of boxes that are seen, the farthest box first, the faces on top brighter than those at the sides.
   * @param {number[][]} boxes
   */
  drawBoxes(boxes) {
    const { eye } = this.camera;
    /** @param {number[]} box */
    const far = (box) => Math.hypot(...eye.map((value, c) => value - (box[c] + box[c + 3]) / 2));
    for (const box of [...boxes].sort((a, b) => far(b) - far(a))) {
      for (const axis of [0, 1, 2]) {
        if (eye[axis] > box[axis + 3]) this.drawFace(box, axis, box[axis + 3]);
        else if (eye[axis] < box[axis]) this.drawFace(box, axis, box[axis]);
      }
    }
  }

  /**
   * The face of a box that is perpendicular to an axis.
   * @param {number[]} box
   * @param {number} axis
   * @param {number} value of the coordinate along this axis
   */
  drawFace(box, axis, value) {
    const { camera, pen, palette } = this;
    pen.beginPath();
    for (const [upper, right] of CORNERS) {
      const corner = [value, value, value];
      const [second, third] = [(axis + 1) % 3, (axis + 2) % 3];
      corner[second] = box[second + 3 * upper];
      corner[third] = box[third + 3 * right];
      camera.project(corner[0], corner[1], corner[2]);
      if (camera.far > NEAR) pen.lineTo(camera.across, camera.down);
    }
    pen.closePath();
    pen.fillStyle = blend(palette.line, "#ffffff", BRIGHTNESS[axis]);
    pen.fill();
  }

  /**
   * A line on the ground from above, small in the upper right corner, as one saw it from `yaw`, and who walks on it.
   * @param {number[][]} positions
   * @param {ArrayLike<number> & Iterable<number>} walker
   * @param {number} yaw
   * @param {Palette} palette
   */
  drawInset(positions, [x, , z], yaw, { asked, ink }) {
    const { pen, canvas } = this;
    const size = Math.min(120, canvas.clientWidth / 4);
    const [c, s] = [Math.cos(yaw), Math.sin(yaw)];
    const seen = [...positions, [x, z]].map(([px, pz]) => [px * c - pz * s, px * s + pz * c]);
    const box = [canvas.clientWidth - 16 - size, 16, size, size];
    const put = mapInto(seen, box, { least: 1, align: [1, 0] });
    paintLine(pen, seen.slice(0, -1).map(put), asked, 4, 0.5);
    paintDisc(pen, put(seen[seen.length - 1]), 5, ink);
  }

  /**
   * A few words in the lower left corner.
   * @param {string} text
   */
  write(text) {
    this.pen.font = "12px system-ui, sans-serif";
    this.pen.fillStyle = this.palette.ink;
    this.pen.fillText(text, 8, this.canvas.clientHeight - 8);
  }

  /**
   * The root's path, its seams, and footprints: strong while the foot stands, pale afterwards.
   * @param {Drawn} character
   */
  drawTrail(character) {
    for (const [seconds, alpha] of TRAIL) {
      /**
       * Whether a point is near enough: a line is strong around the body, pale two seconds from it.
       * @param {number[]} point
       */
      const near = (point) => !(Math.abs(point[3] - this.time) > seconds);
      for (const { colour, line } of character.trail) this.stroke([line.filter(near)], colour, 2.5, alpha);
    }
    if (this.marks.seam) this.drawDiamonds(character.diamonds, this.marks.seam);
    /** @type {number[][][]} */
    const strong = this.sides.map(() => []);
    /** @type {number[][][]} */
    const pale = this.sides.map(() => []);
    for (const [start, end, x, z, side] of character.prints) {
      if (this.time >= start) (this.time < end ? strong : pale)[side].push([x, 0.005, z]);
    }
    this.sides.forEach((colour, side) => {
      this.discs(pale[side], 0.055, colour, 0.25, true);
      this.discs(strong[side], 0.055, colour, 0.95, true);
    });
  }

  /**
   * Diamonds on the ground, upright as the camera sees them.
   * @param {number[][]} positions
   * @param {string} colour
   */
  drawDiamonds(positions, colour) {
    const { camera, pen } = this;
    const [right, , back] = camera.right.map((value) => DIAMOND * value);
    pen.beginPath();
    for (const [x, y, z] of positions) {
      const corners = [
        [x + right, y, z + back],
        [x - back, y, z + right],
        [x - right, y, z - back],
        [x + back, y, z - right],
      ];
      if (corners.some((corner) => camera.see(corner[0], corner[1], corner[2])[2] < NEAR)) continue;
      corners.forEach((corner, k) => {
        camera.project(corner[0], corner[1], corner[2]);
        if (k) pen.lineTo(camera.across, camera.down);
        else pen.moveTo(camera.across, camera.down);
      });
      pen.closePath();
    }
    pen.fillStyle = colour;
    pen.fill();
  }

  drawGhosts() {
    for (let k = GHOSTS; k > 0; k--) {
      const time = this.time - k * GHOST_INTERVAL;
      if (time < 0) continue;
      for (const character of this.characters) {
        const pose = character.pose(time);
        const colour = this.ink(character.colourAt(time));
        const alpha = 0.5 * (1 - k / (GHOSTS + 1));
        this.strokeBones(pose, character.bones, colour, 0.03, alpha);
        if (character.head !== null) this.disc(positionOf(pose, character.head), 0.095, colour, alpha, false);
      }
    }
  }

  /**
   * The colour of the middle of a body is dark on light, and light on dark.
   * @param {string} colour
   */
  ink(colour) {
    return colour === "#333333" ? this.palette.ink : colour;
  }

  // Shadows first, then all bodies, the farthest first: of each the sides and the head, the farthest first. One stroke
  // for all bones of a side: with a stroke for each bone, twelve bodies would take three times as long.
  drawBodies() {
    const { camera } = this;
    const bodies = this.characters.map((character) => ({
      character,
      pose: character.pose(this.time),
      far: 0,
    }));
    if (this.shade(bodies)) return;
    for (const { character, pose } of bodies) {
      this.strokeBones(pose, character.bones, this.palette.shadow, 0.05, 0.15, true);
    }
    for (const body of bodies) {
      camera.project(body.pose[0], body.pose[1], body.pose[2]);
      body.far = camera.far;
    }
    for (const { character, pose } of bodies.sort((a, b) => b.far - a.far)) this.drawBody(character, pose);
  }

  /**
   * Shaded bodies, where there is a light and the browser has WebGL 2.
   * @param {Posed[]} bodies
   */
  shade(bodies) {
    const { light } = this;
    const most = bodies.reduce((sum, { character }) => sum + (character.pieces?.length ?? NaN), 0);
    const shading = light && most && Shading.of(most); // NaN where a scene was packed before bodies were
    if (!shading) return false;
    const { canvas } = this;
    const several = bodies.length > 1;
    const [, left, right] = this.sides;
    const grey = light.body;
    const figures = bodies.map(({ character, pose }) => {
      const own = character.colourAt(this.time);
      const middle = own === "#333333" ? grey : own;
      const colours = several
        ? { middle, near: blend(own, "#ffffff", 0.2), far: blend(own, "#000000", 0.2) }
        : { middle, near: blend(left, grey, 0.25), far: blend(right, grey, 0.25) };
      return { figure: character, pose, colours };
    });
    const size = [canvas.clientWidth, canvas.clientHeight];
    shading.draw(this.pen, this.camera, figures, light, size, this.boxes);
    return true;
  }

  /**
   * @param {Drawn} character
   * @param {Float32Array} pose
   */
  drawBody(character, pose) {
    const own = this.ink(character.colourAt(this.time));
    /** @type {{ far: number, paint: () => void }[]} */
    const parts = [];
    this.sides.forEach((colour, side) => {
      const bones = sideOf(character, side);
      if (bones.length) {
        parts.push({
          far: this.distance(pose, bones),
          paint: () => this.strokeBones(pose, bones, side ? colour : own, 0.04),
        });
      }
    });
    if (character.head !== null) {
      const position = positionOf(pose, character.head);
      parts.push({
        far: this.camera.see(...position)[2],
        paint: () => this.disc(position, 0.095, own, 1, false),
      });
    }
    for (const part of parts.sort((a, b) => b.far - a.far)) part.paint();
  }

  /**
   * How far away the ends of bones are, on average.
   * @param {Float32Array} pose
   * @param {number[][]} bones
   */
  distance(pose, bones) {
    let sum = 0;
    for (const [, to] of bones) {
      this.camera.project(pose[3 * to], pose[3 * to + 1], pose[3 * to + 2]);
      sum += this.camera.far;
    }
    return sum / bones.length;
  }

  /**
   * Bones of a pose in one stroke, or what falls of them on the ground; `width` is in metres.
   * @param {Float32Array} pose
   * @param {number[][]} bones
   * @param {string} colour
   * @param {number} width
   * @param {number} alpha
   * @param {boolean} flat
   */
  strokeBones(pose, bones, colour, width, alpha = 1, flat = false) {
    const { camera, pen } = this;
    const up = flat ? 0 : 1;
    let far = 0;
    let count = 0;
    pen.beginPath();
    for (const [from, to] of bones) {
      camera.project(pose[3 * from], up * pose[3 * from + 1], pose[3 * from + 2]);
      const { across, down } = camera;
      const near = camera.far;
      camera.project(pose[3 * to], up * pose[3 * to + 1], pose[3 * to + 2]);
      if (near < NEAR || camera.far < NEAR) continue; // a bone is short: it is left out where it passes the camera
      pen.moveTo(across, down);
      pen.lineTo(camera.across, camera.down);
      far += near;
      count++;
    }
    if (count) paintStroke(this.pen, colour, Math.max(1, (width * camera.focus * count) / far), alpha);
  }

  /**
   * Lines through points of the world, in one stroke, so that they are not darker where they meet. Parts behind the
   * camera are cut off; points that fall beside the last one are left out. `width` is in pixels, or in metres.
   * @param {number[][][]} lines
   * @param {string} colour
   * @param {number} width
   * @param {number} alpha
   * @param {boolean} metres
   */
  stroke(lines, colour, width, alpha = 1, metres = false) {
    const { camera, pen } = this;
    let far = 0;
    pen.beginPath();
    for (const line of lines) far = this.trace(line) || far;
    if (far) paintStroke(this.pen, colour, metres ? Math.max(1, (width * camera.focus) / far) : width, alpha);
  }

  /**
   * Add a line to the stroke, and return how far away its last point in sight is, or 0.
   * @param {number[][]} line
   */
  trace(line) {
    const { camera, pen } = this;
    let far = 0;
    let before = false; // whether the last point was seen
    let x = 0; // where the pen is
    let y = 0;
    line.forEach((point, i) => {
      camera.project(point[0], point[1], point[2]);
      const seen = camera.far > NEAR;
      if (i && seen !== before) this.passNear(line[i - 1], point, before);
      before = seen;
      if (!seen) return;
      const { across, down } = camera;
      const last = i === line.length - 1;
      if (i && !last && Math.abs(across - x) + Math.abs(down - y) < APART) return;
      if (i) pen.lineTo(across, down);
      else pen.moveTo(across, down);
      x = across;
      y = down;
      far = camera.far;
    });
    return far;
  }

  /**
   * Where a line from a to b comes before the camera or leaves it; afterwards b is projected again.
   * @param {number[]} a
   * @param {number[]} b
   * @param {boolean} leaves
   */
  passNear(a, b, leaves) {
    const { camera, pen } = this;
    const there = camera.see(b[0], b[1], b[2])[2];
    const fraction = (NEAR - there) / (camera.see(a[0], a[1], a[2])[2] - there);
    camera.project(
      b[0] + fraction * (a[0] - b[0]),
      b[1] + fraction * (a[1] - b[1]),
      b[2] + fraction * (a[2] - b[2]),
    );
    if (leaves) pen.lineTo(camera.across, camera.down);
    else pen.moveTo(camera.across, camera.down);
    camera.project(b[0], b[1], b[2]);
  }

  /**
   * A ball, or, where `flat`, a disc on the ground.
   * @param {number[]} position
   * @param {number} radius
   * @param {string} colour
   * @param {number} alpha
   * @param {boolean} flat
   */
  disc(position, radius, colour, alpha, flat) {
    this.discs([position], radius, colour, alpha, flat);
  }

  /**
   * Many of them at once, which is much quicker than one after the other.
   * @param {number[][]} positions
   * @param {number} radius
   * @param {string} colour
   * @param {number} alpha
   * @param {boolean} flat
   */
  discs(positions, radius, colour, alpha, flat) {
    if (!positions.length) return;
    const { camera, pen } = this;
    pen.globalAlpha = alpha;
    pen.fillStyle = colour;
    pen.beginPath();
    for (const [x, y, z] of positions) {
      camera.project(x, y, z);
      if (camera.far < NEAR) continue;
      const r = (radius * camera.focus) / camera.far;
      if (r < 1) {
        pen.rect(camera.across - r, camera.down - r, 2 * r, 2 * r);
        continue;
      }
      pen.moveTo(camera.across + r, camera.down);
      const upright = flat ? r * Math.sin(camera.pitch) + 0.5 : r;
      pen.ellipse(camera.across, camera.down, r, upright, 0, 0, 2 * Math.PI);
    }
    pen.fill();
    pen.globalAlpha = 1;
  }
}

/**
 * Blend a colour with a fraction of another one.
 * @param {string} colour
 * @param {string} other
 * @param {number} fraction
 */
function blend(colour, other, fraction) {
  const to = rgb(other);
  const mixed = rgb(colour).map((value, k) => Math.round(255 * (value + fraction * (to[k] - value))));
  return `#${mixed.map((value) => value.toString(16).padStart(2, "0")).join("")}`;
}

/**
 * The position of a joint of a pose.
 * @param {Float32Array} pose
 * @param {number} joint
 * @returns {[number, number, number]}
 */
export function positionOf(pose, joint) {
  return [pose[3 * joint], pose[3 * joint + 1], pose[3 * joint + 2]];
}

/**
 * The bones of one side of a character, computed once.
 * @param {{ bones: number[][], bySide?: number[][][] }} character
 * @param {number} side
 */
export function sideOf(character, side) {
  character.bySide ??= [0, 1, 2].map((wanted) => character.bones.filter((bone) => bone[2] === wanted));
  return character.bySide[side];
}
