// The picture of a scene on a canvas: ground, paths, footprints, ghosts, and bodies with their shadows.

const GHOSTS = 6, GHOST_GAP = 0.25; // how many earlier poses, and the seconds between them

class Picture {
  constructor(canvas, camera) { this.canvas = canvas; this.camera = camera; }

  // Draw the characters at a time, seen from `distance` metres away from `target`. `asked` and `drawn` are paths on
  // the ground, `pen` is a place on it, `sides` are the colours of a body's sides, and the ground reaches at least
  // `reach` metres.
  draw({ characters, time, asked, drawn, pen, sides, marks, palette, ghosts, target, distance, reach }) {
    Object.assign(this, { characters, time, sides, marks, palette });
    const [wide, high] = this.clear();
    this.camera.place(target, distance, wide, high);
    this.drawGround(target, reach);
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
    this.pen.lineCap = this.pen.lineJoin = "round";
    return size;
  }

  // Lines one metre apart, which stay where they are in the world and fade with distance.
  drawGround([x, , z], reach) {
    const lines = Math.max(6, Math.ceil(1.3 * reach / Math.min(1, this.camera.zoom)));
    const x0 = Math.round(x), z0 = Math.round(z);
    for (let i = -lines; i <= lines; i++) {
      const fade = 1 - Math.abs(i) / (lines + 1);
      const along = [[x0 + i, 0, z0 - lines], [x0 + i, 0, z0 + lines]];
      const across = [[x0 - lines, 0, z0 + i], [x0 + lines, 0, z0 + i]];
      this.stroke([along, across], this.palette.line, 1, fade);
    }
  }

  // The root's path, its seams, and footprints: strong while the foot stands, pale afterwards.
  drawTrail(character) {
    for (const { colour, line } of character.trail) this.stroke([line], colour, 2.5);
    for (const place of character.diamonds) this.disc(place, 0.07, this.marks.seam, 1, true);
    for (const [start, end, px, pz, side] of character.prints) {
      if (this.time >= start) this.disc([px, 0.005, pz], 0.055, this.sides[side], this.time < end ? 0.95 : 0.25, true);
    }
  }

  drawGhosts() {
    for (let k = GHOSTS; k > 0; k--) {
      const time = this.time - k * GHOST_GAP;
      if (time < 0) continue;
      for (const character of this.characters) {
        const bones = this.bones(character, time), lines = bones.map((bone) => bone.ends);
        const colour = this.ink(character.colourAt(time)), alpha = 0.5 * (1 - k / (GHOSTS + 1));
        this.stroke(lines, colour, 0.03, alpha, true);
        if (bones.head) this.disc(bones.head, 0.095, colour, alpha, false);
      }
    }
  }

  // The colour of the middle of a body is dark on light, and light on dark.
  ink(colour) { return colour === "#333333" ? this.palette.ink : colour; }

  bones(character, time) {
    const pose = character.pose(time), place = (joint) => Array.from(pose.subarray(3 * joint, 3 * joint + 3));
    const bones = character.bones.map(([from, to, side]) => ({ ends: [place(from), place(to)], side }));
    bones.head = character.head === null ? null : place(character.head);
    return bones;
  }

  // Shadows first, then all bones of all bodies, the farthest first.
  drawBodies() {
    const parts = [];
    for (const character of this.characters) {
      const bones = this.bones(character, this.time), own = this.ink(character.colourAt(this.time));
      this.stroke(bones.map(({ ends }) => ends.map(([x, , z]) => [x, 0, z])), this.palette.shadow, 0.05, 0.15, true);
      for (const { ends, side } of bones) {
        const far = this.camera.see(...ends[0])[2] + this.camera.see(...ends[1])[2];
        parts.push({ far: far / 2, paint: () => this.stroke([ends], side ? this.sides[side] : own, 0.04, 1, true) });
      }
      if (bones.head) parts.push({ far: this.camera.see(...bones.head)[2], paint: () => this.disc(bones.head, 0.095, own, 1, false) });
    }
    for (const part of parts.sort((a, b) => b.far - a.far)) part.paint();
  }

  // Lines through points of the world, in one stroke, so that they are not darker where they meet. Parts behind the
  // camera are cut off. `width` is in pixels, or in metres.
  stroke(lines, colour, width, alpha = 1, metres = false) {
    const { camera, pen } = this, near = 0.1;
    let far = 0;
    pen.beginPath();
    for (const line of lines) {
      const seen = line.map((point) => camera.see(...point));
      for (let i = 1; i < seen.length; i++) {
        let [a, b] = [seen[i - 1], seen[i]];
        if (a[2] < near && b[2] < near) continue;
        const cut = (p, q) => p.map((v, k) => v + (q[k] - v) * (near - p[2]) / (q[2] - p[2]));
        if (a[2] < near) a = cut(a, b); else if (b[2] < near) b = cut(b, a);
        far = (a[2] + b[2]) / 2;
        pen.moveTo(...camera.pixel(a)); pen.lineTo(...camera.pixel(b));
      }
    }
    if (!far) return;
    pen.globalAlpha = alpha; pen.strokeStyle = colour;
    pen.lineWidth = metres ? Math.max(1, (width * camera.focus) / far) : width;
    pen.stroke();
    pen.globalAlpha = 1;
  }

  // A ball, or, where `flat`, a disc on the ground.
  disc(place, radius, colour, alpha, flat) {
    const { camera, pen } = this, seen = camera.see(...place);
    if (seen[2] < 0.1) return;
    const r = (radius * camera.focus) / seen[2];
    pen.globalAlpha = alpha; pen.fillStyle = colour;
    pen.beginPath();
    pen.ellipse(...camera.pixel(seen), r, flat ? r * Math.sin(camera.pitch) + 0.5 : r, 0, 0, 2 * Math.PI);
    pen.fill();
    pen.globalAlpha = 1;
  }
}
