// The picture of a scene on a canvas: ground, paths, footprints, ghosts, and bodies with their shadows.

const NEAR = 0.1; // metres before the camera, from where on something is drawn
const APART = 3; // pixels between points of a line; nearer ones would cost time, and nobody would see them
const GAPS = [1, 2, 5, 10, 20, 50]; // metres between lines of the ground
const TRAIL = [[Infinity, 0.25], [2, 0.3], [1.5, 0.3], [1, 0.3], [0.5, 0.3]]; // seconds from now, how strong a line is drawn again
const GHOSTS = 6, GHOST_GAP = 0.25; // how many earlier poses, and the seconds between them

class Picture {
  constructor(canvas, camera) { this.canvas = canvas; this.camera = camera; }

  // Draw the characters at a time, seen from `distance` metres away from `target`. `asked` and `drawn` are paths on
  // the ground, `pen` is a place on it, `obstacles` are discs on it (x, z, radius), `sides` are the colours of a body's
  // sides, the ground reaches at least `reach` metres, and in a `light` of `bodies.js` bodies are shaded.
  draw({ characters, time, asked, drawn, pen, obstacles = [], sides, marks, palette, ghosts, target, distance, reach, light = null }) {
    Object.assign(this, { characters, time, sides, marks, palette, light });
    const [wide, high] = this.clear();
    this.camera.place(target, distance, wide, high);
    this.drawGround(target, reach);
    for (const disc of obstacles) this.drawObstacle(disc);
    const flat = (places) => places.map(([x, z]) => [x, 0, z]);
    this.stroke([flat(asked)], palette.asked, 6, 0.75);
    this.stroke([flat(drawn)], palette.asked, 3);
    if (pen) this.disc([pen[0], 0.005, pen[1]], 0.12, palette.asked, 0.8, true);
    for (const character of characters) this.drawTrail(character);
    if (ghosts) this.drawGhosts();
    this.drawBodies();
  }

  // Clear the canvas, give it as many pixels as the screen has there, and return its size on the page.
  clear() {
    const { canvas } = this, sharp = devicePixelRatio || 1, size = [canvas.clientWidth, canvas.clientHeight];
    const pixels = size.map((length) => Math.round(length * sharp));
    if (canvas.width !== pixels[0] || canvas.height !== pixels[1]) [canvas.width, canvas.height] = pixels;
    this.pen = canvas.getContext("2d");
    this.pen.setTransform(sharp, 0, 0, sharp, 0, 0);
    this.pen.clearRect(0, 0, ...size);
    if (this.light) this.paper(this.light, size);
    this.pen.lineCap = this.pen.lineJoin = "round";
    return size;
  }

  // What lies around the body: the sky, and a ground that gets brighter towards it.
  paper({ ground, sky }, [wide, high]) {
    const fill = this.pen.createLinearGradient(0, 0, 0, high);
    fill.addColorStop(0.25, sky); fill.addColorStop(1, ground);
    this.pen.fillStyle = fill;
    this.pen.fillRect(0, 0, wide, high);
  }

  // Lines which stay where they are in the world and fade with distance, one metre apart. Where so many would be grey
  // together, they are further apart, and a word says so.
  drawGround([x, , z], reach) {
    const wide = 1.3 * reach / Math.min(1, this.camera.zoom), gap = GAPS.find((metres) => wide <= 30 * metres) ?? GAPS.at(-1);
    const lines = Math.max(6, Math.ceil(wide / gap)), x0 = gap * Math.round(x / gap), z0 = gap * Math.round(z / gap), end = lines * gap;
    for (let i = 0; i <= lines; i++) {
      const both = [i * gap, -i * gap].slice(0, i ? 2 : 1);
      const along = both.map((off) => [[x0 + off, 0, z0 - end], [x0 + off, 0, z0 + end]]);
      const across = both.map((off) => [[x0 - end, 0, z0 + off], [x0 + end, 0, z0 + off]]);
      this.stroke([...along, ...across], this.palette.line, 1, 1 - i / (lines + 1));
    }
    if (gap > 1) this.write(`lines ${gap} m apart`);
  }

  // A disc on the ground, as a polygon: it may be large. Corners behind the camera are left out.
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

  // A line on the ground from above, small in the upper right corner, as one saw it from `yaw`, and who walks on it.
  drawInset(places, [x, , z], yaw, { asked, ink }) {
    const { pen, canvas } = this, size = Math.min(120, canvas.clientWidth / 4), [c, s] = [Math.cos(yaw), Math.sin(yaw)];
    const seen = [...places, [x, z]].map(([px, pz]) => [px * c - pz * s, px * s + pz * c]), last = seen.at(-1);
    const [[left, right], [top, bottom]] = [0, 1].map((k) => [Math.min(...seen.map((p) => p[k])), Math.max(...seen.map((p) => p[k]))]);
    const scale = size / Math.max(right - left, bottom - top, 1), put = ([px, py]) => [canvas.clientWidth - 16 - (right - px) * scale, 16 + (py - top) * scale];
    pen.beginPath();
    for (const place of seen.slice(0, -1)) pen.lineTo(...put(place));
    this.paintStroke(asked, 4, 0.5);
    pen.fillStyle = ink;
    pen.beginPath(); pen.arc(...put(last), 5, 0, 2 * Math.PI); pen.fill();
  }

  // A few words in the lower left corner.
  write(text) {
    this.pen.font = "12px system-ui, sans-serif"; this.pen.fillStyle = this.palette.ink;
    this.pen.fillText(text, 8, this.canvas.clientHeight - 8);
  }

  // The root's path, its seams, and footprints: strong while the foot stands, pale afterwards.
  drawTrail(character) {
    for (const [seconds, alpha] of TRAIL) { // strong around the body, pale two seconds from it
      const near = (point) => !(Math.abs(point[3] - this.time) > seconds);
      for (const { colour, line } of character.trail) this.stroke([line.filter(near)], colour, 2.5, alpha);
    }
    this.discs(character.diamonds, 0.07, this.marks.seam, 1, true);
    const strong = this.sides.map(() => []), pale = this.sides.map(() => []);
    for (const [start, end, x, z, side] of character.prints) {
      if (this.time >= start) (this.time < end ? strong : pale)[side].push([x, 0.005, z]);
    }
    this.sides.forEach((colour, side) => { this.discs(pale[side], 0.055, colour, 0.25, true); this.discs(strong[side], 0.055, colour, 0.95, true); });
  }

  drawGhosts() {
    for (let k = GHOSTS; k > 0; k--) {
      const time = this.time - k * GHOST_GAP;
      if (time < 0) continue;
      for (const character of this.characters) {
        const pose = character.pose(time), colour = this.ink(character.colourAt(time)), alpha = 0.5 * (1 - k / (GHOSTS + 1));
        this.strokeBones(pose, character.bones, colour, 0.03, alpha);
        if (character.head !== null) this.disc(placeOf(pose, character.head), 0.095, colour, alpha, false);
      }
    }
  }

  // The colour of the middle of a body is dark on light, and light on dark.
  ink(colour) { return colour === "#333333" ? this.palette.ink : colour; }

  // Shadows first, then all bodies, the farthest first: of each the sides and the head, the farthest first. One stroke
  // for all bones of a side: with a stroke for each bone, twelve bodies would take three times as long.
  drawBodies() {
    const { camera } = this, bodies = this.characters.map((character) => ({ character, pose: character.pose(this.time) }));
    if (this.shade(bodies)) return;
    for (const { character, pose } of bodies) this.strokeBones(pose, character.bones, this.palette.shadow, 0.05, 0.15, true);
    for (const body of bodies) { camera.project(body.pose[0], body.pose[1], body.pose[2]); body.far = camera.far; }
    for (const { character, pose } of bodies.sort((a, b) => b.far - a.far)) this.drawBody(character, pose);
  }

  // Shaded bodies, where there is a light and the browser has WebGL 2.
  shade(bodies) {
    const { light } = this, most = bodies.reduce((sum, { character }) => sum + (character.pieces?.length ?? NaN), 0);
    const shading = light && most && Shading.of(most); // NaN where a scene was packed before bodies were
    if (!shading) return false;
    const { canvas } = this, several = bodies.length > 1, [, left, right] = this.sides, grey = light.body;
    const figures = bodies.map(({ character, pose }) => {
      const own = character.colourAt(this.time), middle = own === "#333333" ? grey : own;
      const colours = several ? { middle, near: blend(own, "#ffffff", 0.2), far: blend(own, "#000000", 0.2) } : { middle, near: blend(left, grey, 0.25), far: blend(right, grey, 0.25) };
      return { figure: character, pose, colours };
    });
    shading.draw(this.pen, this.camera, figures, light, [canvas.clientWidth, canvas.clientHeight]);
    return true;
  }

  drawBody(character, pose) {
    const own = this.ink(character.colourAt(this.time)), parts = [];
    this.sides.forEach((colour, side) => {
      const bones = sideOf(character, side);
      if (bones.length) parts.push({ far: this.distance(pose, bones), paint: () => this.strokeBones(pose, bones, side ? colour : own, 0.04) });
    });
    if (character.head !== null) {
      const place = placeOf(pose, character.head);
      parts.push({ far: this.camera.see(...place)[2], paint: () => this.disc(place, 0.095, own, 1, false) });
    }
    for (const part of parts.sort((a, b) => b.far - a.far)) part.paint();
  }

  // How far away the ends of bones are, on average.
  distance(pose, bones) {
    let sum = 0;
    for (const [, to] of bones) { this.camera.project(pose[3 * to], pose[3 * to + 1], pose[3 * to + 2]); sum += this.camera.far; }
    return sum / bones.length;
  }

  // Bones of a pose in one stroke, or what falls of them on the ground; `width` is in metres.
  strokeBones(pose, bones, colour, width, alpha = 1, flat = false) {
    const { camera, pen } = this, up = flat ? 0 : 1;
    let far = 0, count = 0;
    pen.beginPath();
    for (const [from, to] of bones) {
      camera.project(pose[3 * from], up * pose[3 * from + 1], pose[3 * from + 2]);
      const { across, down } = camera, near = camera.far;
      camera.project(pose[3 * to], up * pose[3 * to + 1], pose[3 * to + 2]);
      if (near < NEAR || camera.far < NEAR) continue; // a bone is short: it is left out where it passes the camera
      pen.moveTo(across, down); pen.lineTo(camera.across, camera.down);
      far += near; count++;
    }
    if (count) this.paintStroke(colour, Math.max(1, (width * camera.focus * count) / far), alpha);
  }

  // Lines through points of the world, in one stroke, so that they are not darker where they meet. Parts behind the
  // camera are cut off; points that fall beside the last one are left out. `width` is in pixels, or in metres.
  stroke(lines, colour, width, alpha = 1, metres = false) {
    const { camera, pen } = this;
    let far = 0;
    pen.beginPath();
    for (const line of lines) {
      let before = false, x = 0, y = 0; // whether the last point was seen, and where the pen is
      for (let i = 0; i < line.length; i++) {
        const [px, py, pz] = line[i];
        camera.project(px, py, pz);
        const seen = camera.far > NEAR;
        if (i && seen !== before) this.passNear(line[i - 1], line[i], before);
        before = seen;
        if (!seen) continue;
        const { across, down } = camera, last = i === line.length - 1;
        if (i && !last && Math.abs(across - x) + Math.abs(down - y) < APART) continue;
        if (i) pen.lineTo(across, down); else pen.moveTo(across, down);
        x = across; y = down; far = camera.far;
      }
    }
    if (far) this.paintStroke(colour, metres ? Math.max(1, (width * camera.focus) / far) : width, alpha);
  }

  // Where a line from a to b comes before the camera or leaves it; afterwards b is projected again.
  passNear(a, b, leaves) {
    const { camera, pen } = this, there = camera.see(...b)[2], share = (NEAR - there) / (camera.see(...a)[2] - there);
    camera.project(b[0] + share * (a[0] - b[0]), b[1] + share * (a[1] - b[1]), b[2] + share * (a[2] - b[2]));
    if (leaves) pen.lineTo(camera.across, camera.down); else pen.moveTo(camera.across, camera.down);
    camera.project(b[0], b[1], b[2]);
  }

  paintStroke(colour, width, alpha) {
    const { pen } = this;
    pen.globalAlpha = alpha; pen.strokeStyle = colour; pen.lineWidth = width;
    pen.stroke();
    pen.globalAlpha = 1;
  }

  // A ball, or, where `flat`, a disc on the ground.
  disc(place, radius, colour, alpha, flat) { this.discs([place], radius, colour, alpha, flat); }

  // Many of them at once, which is much quicker than one after the other.
  discs(places, radius, colour, alpha, flat) {
    if (!places.length) return;
    const { camera, pen } = this;
    pen.globalAlpha = alpha; pen.fillStyle = colour;
    pen.beginPath();
    for (const [x, y, z] of places) {
      camera.project(x, y, z);
      if (camera.far < NEAR) continue;
      const r = (radius * camera.focus) / camera.far;
      if (r < 1) { pen.rect(camera.across - r, camera.down - r, 2 * r, 2 * r); continue; }
      pen.moveTo(camera.across + r, camera.down);
      pen.ellipse(camera.across, camera.down, r, flat ? r * Math.sin(camera.pitch) + 0.5 : r, 0, 0, 2 * Math.PI);
    }
    pen.fill();
    pen.globalAlpha = 1;
  }
}

function blend(colour, other, share) {
  const [a, b] = [rgb(colour), rgb(other)];
  return `#${a.map((value, k) => Math.round(255 * (value + share * (b[k] - value))).toString(16).padStart(2, "0")).join("")}`;
}

function placeOf(pose, joint) { return [pose[3 * joint], pose[3 * joint + 1], pose[3 * joint + 2]]; }

// The bones of one side of a character; they are looked for once.
function sideOf(character, side) {
  character.bySide ??= [0, 1, 2].map((wanted) => character.bones.filter((bone) => bone[2] === wanted));
  return character.bySide[side];
}
