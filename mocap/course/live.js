// Small experiments of the course that run on its pages, without Python: sliders, what they compute, and a drawing.
// `live_experiments.py` computes the same in Python, and fills the pages with data.

(() => {
  /**
   * @typedef {number[]} Vector
   * @typedef {Record<string, number>} Values
   *
   * An experiment: what is computed from the values of its controls, and how it is drawn.
   * @typedef {{
   *   compute: (values: Values, data: any) => Record<string, any>,
   *   draw: (sheet: Sheet, found: Record<string, any>, data: any) => void,
   * }} Live
   */

  const BLUE = "#0072b2";
  const ORANGE = "#d55e00";
  const GREEN = "#009e73";
  const GREY = "#8a8f98";
  const SIZE = [640, 330]; // of a drawing, in its units
  const BALL = 120; // radius of a ball, in these units
  const WAYS = ["slerp", "quaternions on a line", "Euler angles"];
  const COLOURS = [BLUE, ORANGE, GREEN];
  const YELLOW = "#f0c04a";

  // ---- rotations, quaternions (w, x, y, z) ----

  /** @param {number} degrees */
  const radians = (degrees) => (degrees * Math.PI) / 180;
  /** @param {number} angle */
  const degrees = (angle) => (angle * 180) / Math.PI;

  /**
   * @param {Vector} p
   * @param {Vector} q
   */
  const times = ([w, x, y, z], [s, u, v, t]) => [
    w * s - x * u - y * v - z * t,
    w * u + x * s + y * t - z * v,
    w * v - x * t + y * s + z * u,
    w * t + x * v - y * u + z * s,
  ];

  /**
   * The rotation about an axis of length 1.
   * @param {Vector} axis
   * @param {number} angle radians
   */
  const about = (axis, angle) => [Math.cos(angle / 2), ...axis.map((value) => value * Math.sin(angle / 2))];

  /**
   * @param {Vector} q
   * @param {Vector} v
   */
  const rotated = (q, v) => times(times(q, [0, ...v]), [q[0], -q[1], -q[2], -q[3]]).slice(1);

  /**
   * The angle between two rotations, radians.
   * @param {Vector} p
   * @param {Vector} q
   */
  function angleBetween(p, q) {
    const [w, ...u] = times([p[0], -p[1], -p[2], -p[3]], q);
    return 2 * Math.atan2(Math.hypot(...u), Math.abs(w));
  }

  /**
   * The rotation Rz Rx Ry of Euler angles, radians.
   * @param {Vector} angles
   */
  const fromEuler = ([z, x, y]) =>
    times(times(about([0, 0, 1], z), about([1, 0, 0], x)), about([0, 1, 0], y));

  /** @type {Record<string, Vector>} */
  const AXES = { X: [1, 0, 0], Y: [0, 1, 0], Z: [0, 0, 1] };

  /**
   * The rotation by the same angle about each of three axes, the last of `order` first.
   * @param {string} order such as ZXY
   * @param {number} angle radians
   */
  const inOrder = (order, angle) =>
    [...order].map((axis) => about(AXES[axis], angle)).reduce((product, turn) => times(product, turn));

  /**
   * Spherical linear interpolation, along the shorter arc.
   * @param {Vector} p
   * @param {Vector} q
   * @param {number} fraction
   */
  function slerp(p, q, fraction) {
    const cosine = p.reduce((sum, value, k) => sum + value * q[k], 0);
    const angle = Math.acos(Math.min(1, Math.abs(cosine)));
    const sine = Math.sin(angle) || 1;
    const [a, b] =
      angle < 1e-9
        ? [1 - fraction, fraction]
        : [1 - fraction, fraction].map((u) => Math.sin(u * angle) / sine);
    return p.map((value, k) => a * value + (cosine < 0 ? -b : b) * q[k]);
  }

  // ---- drawing ----

  /** A drawing on a canvas, in units of which it is 640 wide. */
  class Sheet {
    /**
     * @param {HTMLCanvasElement} canvas
     * @param {HTMLElement} words beside it, which `say` fills
     */
    constructor(canvas, words) {
      words.replaceChildren();
      this.words = words;
      const pen = canvas.getContext("2d");
      if (!pen) throw new Error("The browser draws on no canvas.");
      const sharp = Math.max(1, (canvas.clientWidth * devicePixelRatio) / SIZE[0]);
      canvas.width = SIZE[0] * sharp;
      canvas.height = SIZE[1] * sharp;
      pen.scale(sharp, sharp);
      pen.lineCap = "round";
      pen.lineJoin = "round";
      // Letters are 13 pixels high on the page, also where it is narrow.
      this.letters = Math.max(13, (13 * SIZE[0]) / (canvas.clientWidth || SIZE[0]));
      pen.font = `${this.letters}px system-ui, sans-serif`;
      this.ink = getComputedStyle(canvas).color;
      this.pen = pen;
    }

    /**
     * @param {Vector[]} points
     * @param {string} colour
     * @param {number} width
     * @param {number[]} dashes
     */
    line(points, colour, width = 2, dashes = []) {
      const { pen } = this;
      pen.beginPath();
      for (const [x, y] of points) pen.lineTo(x, y);
      pen.strokeStyle = colour;
      pen.lineWidth = width;
      pen.setLineDash(dashes);
      pen.stroke();
      pen.setLineDash([]);
    }

    /**
     * @param {Vector} centre
     * @param {number} radius
     * @param {string} colour
     */
    dot([x, y], radius, colour) {
      const { pen } = this;
      pen.beginPath();
      pen.arc(x, y, radius, 0, 2 * Math.PI);
      pen.fillStyle = colour;
      pen.fill();
    }

    /**
     * @param {Vector} centre
     * @param {number} radius
     * @param {string} colour
     */
    circle([x, y], radius, colour) {
      const points = Array.from({ length: 73 }, (_, k) => radians(5 * k)).map((a) => [
        x + radius * Math.cos(a),
        y + radius * Math.sin(a),
      ]);
      this.line(points, colour, 1.2, [3, 5]);
    }

    /**
     * Write beside the drawing, where words wrap.
     * @param {string} text
     * @param {string} colour of a line in front of it, if there is one
     */
    say(text, colour = "") {
      const words = document.createElement("span");
      words.textContent = text;
      if (colour) words.style.borderLeft = `.8em solid ${colour}`;
      if (colour) words.style.paddingLeft = ".4em";
      this.words.append(words);
    }

    /**
     * @param {string} text
     * @param {Vector} position
     * @param {CanvasTextAlign} align
     * @param {string} colour
     */
    text(text, [x, y], align = "left", colour = this.ink) {
      this.pen.textAlign = align;
      this.pen.fillStyle = colour;
      this.pen.fillText(text, x, y);
    }

    /**
     * Axes with a number at each end; return the map of a point into them.
     * @param {Vector} box left, top, width and height
     * @param {Vector} ranges x from, to, y from, to
     * @param {string[]} labels
     * @returns {(x: number, y: number) => Vector}
     */
    axes([left, top, wide, high], [x0, x1, y0, y1], [across, up]) {
      this.line(
        [
          [left, top],
          [left, top + high],
          [left + wide, top + high],
        ],
        this.ink,
        1.2,
      );
      const below = top + high + 1.3 * this.letters;
      this.text(String(x0), [left, below], "center");
      this.text(String(x1), [left + wide, below], "center");
      this.text(across, [left + wide / 2, below], "center");
      this.text(String(y0), [left - 6, top + high], "right");
      this.text(String(y1), [left - 6, top + 5], "right");
      this.text(up, [left, top - 10]);
      return (x, y) => [left + (wide * (x - x0)) / (x1 - x0), top + high - (high * (y - y0)) / (y1 - y0)];
    }
  }

  /**
   * A view of points [x, y, z], y up, from an angle: pixels around a centre.
   * @param {Vector} centre
   * @param {number} scale
   * @param {{ yaw?: number, pitch?: number }} angles
   * @returns {(point: Vector) => Vector}
   */
  function viewOf([cx, cy], scale, { yaw = 0.6, pitch = 0.25 } = {}) {
    return ([x, y, z]) => {
      const right = Math.cos(yaw) * x - Math.sin(yaw) * z;
      const depth = Math.sin(yaw) * x + Math.cos(yaw) * z;
      return [cx + scale * right, cy - scale * (Math.cos(pitch) * y - Math.sin(pitch) * depth)];
    };
  }

  /**
   * Draw a body by its bones.
   * @param {Sheet} sheet
   * @param {(point: Vector) => Vector} see
   * @param {{ positions: Vector[], parents: number[] }} body
   * @param {{ rotation: Vector, root: Vector, colour: string, width?: number }} pose
   */
  function drawBody(sheet, see, { positions, parents }, { rotation, root, colour, width = 4 }) {
    const moved = positions.map((position) => rotated(rotation, position).map((value, c) => value + root[c]));
    parents.forEach((parent, joint) => {
      if (parent >= 0) sheet.line([see(moved[parent]), see(moved[joint])], colour, width);
    });
  }

  // ---- points and polylines ----

  /**
   * The map of points that turns them about the y axis.
   * @param {number} angle radians
   * @returns {(point: Vector) => Vector}
   */
  function turnedBy(angle) {
    const [cosine, sine] = [Math.cos(angle), Math.sin(angle)];
    return ([x, y, z]) => [cosine * x + sine * z, y, cosine * z - sine * x];
  }

  /**
   * @param {Vector[]} points
   * @param {number} axis
   */
  const mean = (points, axis) => points.reduce((sum, point) => sum + point[axis], 0) / points.length;

  /**
   * @param {Vector} p
   * @param {Vector} q
   */
  const apart = (p, q) => Math.hypot(...p.map((value, c) => value - q[c]));

  /** @param {Vector[]} points of a polyline */
  const lengthOf = (points) => points.slice(1).reduce((sum, point, k) => sum + apart(point, points[k]), 0);

  /**
   * The point of a polyline at an arc length.
   * @param {Vector[]} points
   * @param {number} along
   */
  function pointAt(points, along) {
    let left = along;
    for (let k = 1; k < points.length; k++) {
      const far = apart(points[k], points[k - 1]);
      if (left <= far) {
        return points[k].map((value, c) => points[k - 1][c] + (left / far) * (value - points[k - 1][c]));
      }
      left -= far;
    }
    return points[points.length - 1];
  }

  /**
   * @param {Vector[]} points
   * @param {Vector} place
   */
  const nearestOf = (points, place) =>
    points.reduce((best, point) => (apart(point, place) < apart(best, place) ? point : best));

  // ---- the experiments ----

  /** @type {Record<string, Live>} */
  const EXPERIMENTS = {
    "01-skeletons-and-clips:placed": {
      compute({ joint }, { root, rotations, offsets, parents, names }) {
        /** @type {Vector[]} */
        const places = [root];
        const world = [rotations[0]];
        for (let j = 1; j <= joint; j++) {
          const parent = parents[j];
          world.push(times(world[parent], rotations[j]));
          places.push(rotated(world[parent], offsets[j]).map((value, c) => value + places[parent][c]));
        }
        const parent = parents[joint];
        const whose = joint ? `its parent is ${parent}, ${names[parent]}` : "it has no parent";
        return { places, message: `joint ${joint}, ${names[joint]}: ${whose}` };
      },
      draw(sheet, { places, message, values }, data) {
        const { compute } = EXPERIMENTS["01-skeletons-and-clips:placed"];
        const all = compute({ joint: data.parents.length - 1 }, data).places;
        /** @param {Vector} place */
        const put = ([, y, z]) => [320 + 165 * (z - data.root[2]), 312 - 165 * y];
        const bones = (
          /** @type {Vector[]} */ some,
          /** @type {string} */ colour,
          /** @type {number} */ width,
        ) =>
          some.forEach((place, j) => {
            if (j) sheet.line([put(all[data.parents[j]]), put(place)], colour, width);
          });
        bones(all, GREY, 1);
        bones(places, BLUE, 5);
        for (const place of places) sheet.dot(put(place), 4, BLUE);
        const joint = values.joint;
        if (joint) sheet.line([put(all[data.parents[joint]]), put(all[joint])], ORANGE, 6);
        sheet.dot(put(all[joint]), 8, ORANGE);
        sheet.say(message, ORANGE);
      },
    },
    "01b-motion-files:wrong_order": {
      compute({ angle }, { orders }) {
        const [right, ...wrong] = orders.map((/** @type {string} */ order) => inOrder(order, radians(angle)));
        const errors = wrong.map((/** @type {Vector} */ q) => degrees(angleBetween(right, q)));
        return { worst: Math.max(...errors), best: Math.min(...errors) };
      },
      draw(sheet, { worst, best, values }, data) {
        const put = sheet.axes([90, 50, 480, 230], [0, 60, 0, 100], ["each angle (°)", "error (°)"]);
        const { compute } = EXPERIMENTS["01b-motion-files:wrong_order"];
        const from = values.angle;
        const angles = Array.from({ length: 61 - from }, (_, k) => from + k);
        const errors = angles.map((angle) => compute({ angle }, data));
        ["worst", "best"].forEach((name, k) => {
          sheet.line(
            angles.map((angle, n) => put(angle, errors[n][name])),
            COLOURS[k],
            3,
          );
          const error = [worst, best][k];
          sheet.dot(put(from, error), 6, COLOURS[k]);
          sheet.say(`the ${name} wrong order: off by ${error.toFixed(1)}°`, COLOURS[k]);
        });
      },
    },
    "02-matching:turn": {
      compute({ degrees: angle }, { first, second }) {
        const turned = second.flat().map(turnedBy(radians(angle)));
        const points = first.flat();
        const shift = [0, 2].map((c) => mean(points, c) - mean(turned, c));
        const squares = points.map((/** @type {Vector} */ [x, y, z], /** @type {number} */ n) => {
          const [u, v, w] = turned[n];
          return (x - u - shift[0]) ** 2 + (y - v) ** 2 + (z - w - shift[1]) ** 2;
        });
        const sum = squares.reduce((/** @type {number} */ a, /** @type {number} */ b) => a + b, 0);
        return { shift, distance: 100 * Math.sqrt(sum / squares.length) };
      },
      draw(sheet, { shift, distance, values }, { first, second, bones }) {
        const turn = turnedBy(radians(values.degrees));
        const laid = second.map((/** @type {Vector[]} */ pose) =>
          pose.map(turn).map(([x, y, z]) => [x + shift[0], y, z + shift[1]]),
        );
        const [x, z] = [0, 2].map((c) => mean(first.flat(), c));
        /** @param {Vector} place seen from above, x to the left */
        const put = (place) => [160 - 240 * (place[0] - x), 170 - 240 * (place[2] - z)];
        const middle = first.length >> 1;
        first[middle].forEach((/** @type {Vector} */ place, /** @type {number} */ j) =>
          sheet.line([put(place), put(laid[middle][j])], GREY, 1),
        );
        [first, laid].forEach((poses, k) => {
          for (const pair of bones) {
            sheet.line(
              pair.map((/** @type {number} */ j) => put(poses[middle][j])),
              COLOURS[k],
              4,
            );
          }
        });
        const axes = sheet.axes([380, 60, 230, 220], [-180, 180, 0, 60], ["θ (°)", "RMS distance (cm)"]);
        const { compute } = EXPERIMENTS["02-matching:turn"];
        const angles = Array.from({ length: 61 }, (_, k) => 6 * k - 180);
        sheet.line(
          angles.map((angle) => axes(angle, compute({ degrees: angle }, { first, second }).distance)),
          GREEN,
          3,
        );
        sheet.dot(axes(values.degrees, distance), 7, GREEN);
        sheet.say("the first window", BLUE);
        sheet.say("the second one, turned and shifted", ORANGE);
        sheet.say(`${values.degrees}°: ${distance.toFixed(1)} cm RMS`.replace("-", "−"), GREEN);
      },
    },
    "08c-judging-a-search:distances": {
      compute({ step }, { path, walk, moments }) {
        const [length, far] = [lengthOf(walk), lengthOf(path)];
        const count = Math.round(100 * far);
        const fine = Array.from({ length: count + 1 }, (_, k) => pointAt(path, (k * far) / count));
        const along = Array.from({ length: step + 1 }, (_, k) => (k * length) / (moments - 1));
        const here = along.map((s) => pointAt(walk, s));
        const equal = along.map((s) => pointAt(path, s));
        const nearest = here.map((point) => nearestOf(fine, point));
        const off = [equal, nearest].map((points) => points.map((point, k) => 100 * apart(point, here[k])));
        return { here, equal, distances: off, nearest, along };
      },
      draw(sheet, { here, equal, distances, nearest, along }, { path, walk }) {
        /** @param {Vector} place from above, x to the left */
        const put = ([x, z]) => [300 - 78 * x, 300 - 78 * z];
        sheet.line(path.map(put), GREY, 8);
        sheet.line(walk.map(put), sheet.ink, 3);
        [equal, nearest].forEach((points, k) =>
          points.forEach((/** @type {Vector} */ point, /** @type {number} */ n) => {
            sheet.line([put(here[n]), put(point)], COLOURS[k], 2);
            sheet.dot(put(point), 4, COLOURS[k]);
          }),
        );
        for (const place of here) sheet.dot(put(place), 6, sheet.ink);
        const length = Math.round(10 * lengthOf(walk)) / 10;
        const axes = sheet.axes([400, 60, 200, 220], [0, length, 0, 110], ["m walked", "distance (cm)"]);
        ["at equal arc length", "to the nearest point"].forEach((name, k) => {
          const curve = along.map((/** @type {number} */ s, /** @type {number} */ n) =>
            axes(s, distances[k][n]),
          );
          sheet.line(curve, COLOURS[k], 3);
          for (const point of curve) sheet.dot(point, 4, COLOURS[k]);
          sheet.say(`${name}: ${distances[k].at(-1).toFixed(0)} cm`, COLOURS[k]);
        });
      },
    },
    "03b-angles:lean": {
      compute({ tip, towards, facing }) {
        const axis = rotated(about([0, 1, 0], radians(towards)), [1, 0, 0]);
        const root = times(about([0, 1, 0], radians(facing)), about(axis, radians(tip)));
        const [w, x, y, z] = root;
        const heading = Math.atan2(2 * w * y, w * w - y * y);
        const homework = Math.atan2(2 * (w * y - x * z), 1 - 2 * (y * y + z * z));
        return { root, heading: degrees(heading), homework: degrees(homework) };
      },
      draw(sheet, { root, heading, homework }, data) {
        const see = viewOf([170, 250], 105, { yaw: 0.5 });
        sheet.line(
          [
            [-1, 0, -1],
            [1, 0, -1],
            [1, 0, 1],
            [-1, 0, 1],
            [-1, 0, -1],
          ].map(see),
          GREY,
          1,
        );
        drawBody(sheet, see, data, { rotation: root, root: [0, 1, 0], colour: sheet.ink });
        const centre = [480, 185];
        sheet.circle(centre, BALL, GREY);
        ["0°", "90°", "±180°", "−90°"].forEach((label, k) => {
          const angle = radians(90 * k);
          const reach = BALL + 16;
          const at = [centre[0] - reach * Math.sin(angle), centre[1] - reach * Math.cos(angle) + 5];
          sheet.text(label, at, "center");
        });
        [heading, homework].forEach((angle, k) => {
          const end = [Math.sin(radians(angle)), Math.cos(radians(angle))].map((value) => -BALL * value);
          const name = ["heading", "homework_heading"][k];
          sheet.line([centre, [centre[0] + end[0], centre[1] + end[1]]], COLOURS[k], k ? 3 : 9);
          sheet.say(`${name}: ${Math.round(angle)}°`.replace("-", "−"), COLOURS[k]);
        });
      },
    },
    "03b-angles:gimbals": {
      compute({ z, x, y }) {
        const angles = [z, x, y].map(radians);
        const ghost = fromEuler([0, angles[1], 0]);
        const solid = fromEuler(angles);
        const carried = [
          [0, 0, 1],
          rotated(about([0, 0, 1], angles[0]), [1, 0, 0]),
          rotated(times(about([0, 0, 1], angles[0]), about([1, 0, 0], angles[1])), [0, 1, 0]),
        ];
        return { ghost, solid, carried, turned: degrees(angleBetween(ghost, solid)) };
      },
      draw(sheet, { ghost, solid, carried, turned }, data) {
        const see = viewOf([250, 270], 110);
        const root = [0, 1.1, 0];
        drawBody(sheet, see, data, { rotation: ghost, root, colour: GREY, width: 2 });
        drawBody(sheet, see, data, { rotation: solid, root, colour: sheet.ink });
        ["z, fixed", "x, carried by z", "y, carried by both"].forEach((name, k) => {
          const ends = [-0.9, 0.9].map((far) =>
            carried[k].map((/** @type {number} */ v, /** @type {number} */ c) => root[c] + far * v),
          );
          sheet.line(ends.map(see), COLOURS[k], 3);
          sheet.say(name, COLOURS[k]);
        });
        sheet.say(`rotated by ${Math.round(turned)}°`);
      },
    },
    "04-blending:ways": {
      compute({ fraction }, { first, last }) {
        const start = fromEuler(first);
        const end = fromEuler(last);
        const line = start.map((value, k) => (1 - fraction) * value + fraction * end[k]);
        const length = Math.hypot(...line);
        const euler = first.map(
          (/** @type {number} */ a, /** @type {number} */ k) => (1 - fraction) * a + fraction * last[k],
        );
        const ways = [slerp(start, end, fraction), line.map((value) => value / length), fromEuler(euler)];
        const turned = ways.map((way) => degrees(angleBetween(start, way)));
        return { tips: ways.map((way) => rotated(way, [0, 0, 1])), turned, fraction };
      },
      draw(sheet, { tips, turned, fraction }, data) {
        const see = viewOf([160, 170], BALL, { yaw: 0.4 });
        const put = sheet.axes(
          [370, 70, 240, 200],
          [0, 1, 0, 180],
          ["fraction", "rotated from the start (°)"],
        );
        sheet.circle([160, 170], BALL, GREY);
        const { compute } = EXPERIMENTS["04-blending:ways"];
        const paths = Array.from({ length: 51 }, (_, k) => compute({ fraction: k / 50 }, data));
        WAYS.forEach((name, n) => {
          const width = n ? 2 : 5;
          sheet.line(
            paths.map((path) => see(path.tips[n])),
            COLOURS[n],
            width,
          );
          sheet.line(
            paths.map((path) => put(path.fraction, path.turned[n])),
            COLOURS[n],
            width,
          );
          sheet.dot(see(tips[n]), 6, COLOURS[n]);
          sheet.dot(put(fraction, turned[n]), 6, COLOURS[n]);
          sheet.say(`${name}: ${Math.round(turned[n])}°`, COLOURS[n]);
        });
      },
    },
    "04b-feet:leg": {
      compute({ ahead, height }, { thigh, shank, hip }) {
        const away = [ahead, height - hip];
        const far = Math.hypot(...away);
        const distance = Math.min(far, thigh + shank);
        const along = away.map((value) => value / far);
        const cosine = (distance ** 2 - thigh ** 2 - shank ** 2) / (2 * thigh * shank);
        const bend = Math.acos(Math.max(-1, Math.min(cosine, 1)));
        const forward = [1, 0.3];
        const dot = forward[0] * along[0] + forward[1] * along[1];
        const side = forward.map((value, k) => value - dot * along[k]);
        const across = side.map((value) => value / Math.hypot(...side));
        const share = thigh / distance;
        const knee = along.map(
          (value, k) =>
            share * ((thigh + shank * Math.cos(bend)) * value + shank * Math.sin(bend) * across[k]),
        );
        const lift = (/** @type {Vector} */ [z, y]) => [z, hip + y];
        const ankle = lift(along.map((value) => distance * value));
        return { knee: lift(knee), ankle, bend: degrees(bend), reached: far <= thigh + shank + 1e-9 };
      },
      draw(sheet, { knee, ankle, bend, reached, values }, { thigh, shank, hip }) {
        const put = sheet.axes([150, 50, 330, 236], [-0.7, 0.9, -0.1, 1.05], ["z (m)", "y (m)"]);
        const scale = 330 / 1.6;
        sheet.circle(put(0, hip), scale * (thigh + shank), GREY);
        sheet.line(
          [[0, hip], knee, ankle].map(([z, y]) => put(z, y)),
          BLUE,
          6,
        );
        for (const [z, y] of [[0, hip], knee, ankle]) sheet.dot(put(z, y), 7, BLUE);
        const [x, y] = put(values.ahead, values.height);
        sheet.line(
          [
            [x - 8, y - 8],
            [x + 8, y + 8],
          ],
          sheet.ink,
          3,
        );
        sheet.line(
          [
            [x - 8, y + 8],
            [x + 8, y - 8],
          ],
          sheet.ink,
          3,
        );
        const words = `knee bent by ${Math.round(bend)}°${reached ? "" : ", out of reach"}`;
        sheet.say(words);
      },
    },
    "06-pruning:tarjan": {
      compute({ step }, { successors }) {
        const states = tarjanStates(successors);
        return states[Math.min(step, states.length - 1)];
      },
      draw(sheet, { message, node, numbers, lows, stack, components, values }, data) {
        const put = eightNodes(sheet, data, []);
        numbers.forEach((/** @type {number} */ number, /** @type {number} */ n) => {
          const part = components[n];
          const [x, y] = put(data.places[n]);
          const onStack = stack.includes(n + 1);
          const plain = onStack ? YELLOW : "#fff";
          sheet.dot([x, y], 17, n + 1 === node ? ORANGE : "#222");
          sheet.dot([x, y], 14, part < 0 ? plain : PARTS[part]);
          sheet.text(String(n + 1), [x, y + 5], "center", part < 0 ? "#222" : "#fff");
          if (number >= 0) sheet.text(`${number} / ${lows[n]}`, [x + 19, y + 22]);
        });
        sheet.say(`step ${values.step}: ${message}`);
        const waiting = stack.filter((/** @type {number} */ other) => other >= 0);
        sheet.say(waiting.length ? `stack: ${waiting.join(" ")}` : "the stack is empty", YELLOW);
        sheet.say("beside a node: its number / its low link");
      },
    },
    "07-walks-and-search:eight_nodes": {
      compute({ step }, { lengths }) {
        const events = searchEvents(lengths, 6, 2, 8).slice(0, step);
        const complete = events.filter(({ fate }) => fate === "complete");
        const best = complete.sort((a, b) => a.cost - b.cost)[0];
        const last = events.at(-1);
        const message = last
          ? `${last.walk.join(" → ")} (${last.cost.toFixed(1)}): ${last.fate}`
          : "start at 6";
        return {
          costs: events.map(({ cost }) => cost),
          best: best?.walk ?? [],
          walk: last?.walk ?? [6],
          message,
          events,
        };
      },
      draw(sheet, { events, best, walk, message, values }, data) {
        const put = eightNodes(sheet, data, [
          [walk, GREY, 9],
          [best, ORANGE, 4],
        ]);
        data.places.forEach((/** @type {Vector} */ place, /** @type {number} */ n) => {
          const [x, y] = put(place);
          sheet.dot([x, y], 17, "#222");
          sheet.dot([x, y], 14, [6, 2].includes(n + 1) ? YELLOW : "#fff");
          sheet.text(String(n + 1), [x, y + 5], "center", "#222");
        });
        sheet.say(`step ${values.step}: ${message}`);
        const left = events.filter((/** @type {any} */ event) => event.fate === "cut").length;
        sheet.say(`${events.length} walks looked at, ${left} cut by the bound`);
        sheet.say(best.length ? "the best walk so far" : "no walk to 2 yet", best.length ? ORANGE : "");
      },
    },
  };

  // ---- the eight nodes ----

  const PARTS = [BLUE, GREEN, "#aa3377", "#666"];

  /**
   * Tarjan's algorithm: the state after each step, with numbers, low links and components by node, -1 for none.
   * @param {number[][]} successors of the nodes 1, 2, ...
   */
  function tarjanStates(successors) {
    const count = successors.length;
    const [numbers, lows, components] = [0, 1, 2].map(() => Array.from({ length: count }, () => -1));
    /** @type {number[]} */
    const stack = [];
    /** @type {Record<string, any>[]} */
    const states = [];
    let found = 0;
    let entered = 0;
    /**
     * @param {string} message
     * @param {number} node
     */
    const note = (message, node) => {
      const padded = [...stack, ...Array.from({ length: count - stack.length }, () => -1)];
      states.push({
        message,
        node,
        numbers: [...numbers],
        lows: [...lows],
        stack: padded,
        components: [...components],
      });
    };
    /** @param {number} node */
    const visit = (node) => {
      const n = node - 1;
      numbers[n] = entered;
      lows[n] = entered;
      entered += 1;
      stack.push(node);
      note(`enter ${node}`, node);
      for (const child of successors[n]) {
        if (numbers[child - 1] < 0) {
          visit(child);
          lows[n] = Math.min(lows[n], lows[child - 1]);
          note(`back in ${node} from ${child}`, node);
        } else if (stack.includes(child)) {
          lows[n] = Math.min(lows[n], numbers[child - 1]);
          note(`${node} → ${child} closes a cycle`, node);
        } else {
          note(`${child} has left the stack`, node);
        }
      }
      if (lows[n] !== numbers[n]) return;
      for (const other of stack.splice(stack.indexOf(node))) components[other - 1] = found;
      found += 1;
      note(`${node} is the first of its component`, node);
    };
    for (let node = 1; node <= count; node++) if (numbers[node - 1] < 0) visit(node);
    return states;
  }

  /**
   * Depth-first branch and bound for the shortest walk, the cheapest edge first: what happens to each walk.
   * @param {number[][][]} lengths for each node [successor, length]
   * @param {number} from
   * @param {number} goal
   * @param {number} longest
   */
  function searchEvents(lengths, from, goal, longest) {
    /** @type {{ walk: number[], cost: number, fate: string }[]} */
    const events = [];
    const waiting = [{ cost: 0, walk: [from] }];
    let best = Infinity;
    for (let next = waiting.pop(); next; next = waiting.pop()) {
      const { cost, walk } = next;
      const node = walk[walk.length - 1];
      const isShort = walk.length <= longest;
      let fate = "cut";
      if (cost < best && node === goal) {
        fate = "complete";
        best = cost;
      } else if (cost < best) {
        const added = isShort
          ? lengths[node - 1].map(([child, more]) => ({ cost: cost + more, walk: [...walk, child] }))
          : [];
        const ended = isShort ? "a dead end" : "too long";
        fate = added.length ? "expanded" : ended;
        waiting.push(...added.sort((a, b) => b.cost - a.cost));
      }
      events.push({ walk, cost, fate });
    }
    return events;
  }

  /**
   * Draw the arrows of the eight nodes, below walks through them; return the map of their places.
   * @param {Sheet} sheet
   * @param {{ places: Vector[], successors: number[][] }} graph
   * @param {[number[], string, number][]} walks
   * @returns {(place: Vector) => Vector}
   */
  function eightNodes(sheet, { places, successors }, walks) {
    const [xs, ys] = [0, 1].map((c) => places.map((place) => place[c]));
    const [left, right, low, high] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
    const scale = Math.min(480 / (right - left), 210 / (high - low));
    /** @param {Vector} place */
    const put = ([x, y]) => [320 + scale * (x - (left + right) / 2), 168 - scale * (y - (low + high) / 2)];
    for (const [walk, colour, width] of walks) {
      const points = walk.map((node) => put(places[node - 1]));
      sheet.line(points, colour, width);
    }
    successors.forEach((children, n) => {
      const from = put(places[n]);
      for (const child of children) {
        const to = put(places[child - 1]);
        const far = Math.hypot(to[0] - from[0], to[1] - from[1]);
        if (!far) {
          sheet.circle([from[0], from[1] - 20], 14, sheet.ink);
          continue;
        }
        const [ux, uy] = [(to[0] - from[0]) / far, (to[1] - from[1]) / far];
        const tip = [to[0] - 18 * ux, to[1] - 18 * uy];
        const barbs = [-1, 1].map((side) => [
          tip[0] - 9 * ux - 5 * side * uy,
          tip[1] - 9 * uy + 5 * side * ux,
        ]);
        sheet.line([from, tip], sheet.ink, 1.4);
        sheet.line([barbs[0], tip, barbs[1]], sheet.ink, 1.8);
      }
    });
    return put;
  }

  // ---- on a page ----

  /**
   * Put sliders and a drawing in the place of a still picture.
   * @param {HTMLElement} place
   */
  function begin(place) {
    const experiment = EXPERIMENTS[place.dataset.live ?? ""];
    const packed = place.querySelector("script");
    if (!experiment || !packed) return;
    /** @type {{ controls: Record<string, number[]>, data: any, alt: string }} */
    const { controls, data, alt } = JSON.parse(packed.text);
    const canvas = document.createElement("canvas");
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", alt);
    /** @type {Values} */
    const values = {};
    const words = document.createElement("p");
    words.className = "said";
    const show = () => {
      const found = { ...experiment.compute(values, data), values };
      experiment.draw(new Sheet(canvas, words), found, data);
    };
    const rows = Object.entries(controls).map(([name, [low, high, step, initial]]) => {
      const label = document.createElement("label");
      const output = document.createElement("output");
      const slider = document.createElement("input");
      Object.assign(slider, { type: "range", min: String(low), max: String(high), step: String(step) });
      slider.value = String(initial);
      values[name] = initial;
      output.textContent = slider.value;
      slider.addEventListener("input", () => {
        values[name] = Number(slider.value);
        output.textContent = slider.value;
        show();
      });
      label.append(name, slider, output);
      return label;
    });
    place.querySelector(".mocap-still")?.remove();
    place.append(...rows, words, canvas);
    addEventListener("resize", show);
    show();
  }

  for (const place of document.querySelectorAll("[data-live]")) {
    if (place instanceof HTMLElement) begin(place);
  }
  Object.assign(window, { liveExperiments: EXPERIMENTS });
})();
