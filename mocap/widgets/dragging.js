// Handles to drag on a picture: by mouse, by touch, or by the arrow keys.
//
// `dragging.py` sends the picture as a PNG. `value` has a point for each handle, in the units of the axes; `limits` are
// the axes' [[left, right], [bottom, top]], and `box` is where these lie: [left, top, right, bottom], as fractions of the picture.

/** @import { Rendered } from "./player_page.js" */

const STYLE = `
.mocap-dragging { position: relative; width: max-content; max-width: 100%; }
.mocap-dragging img { display: block; max-width: 100%; }
.mocap-dragging button { position: absolute; width: 32px; height: 32px; margin: -16px; padding: 0; border: 0; background: none;
  touch-action: none; cursor: grab; font: bold 11px/18px sans-serif; color: #222; }
.mocap-dragging button:active { cursor: grabbing; }
.mocap-dragging button span { display: block; width: 18px; height: 18px; margin: 5px; border: 2px solid #222; border-radius: 50%;
  background: #fffc; }
@media (pointer: coarse) {
  .mocap-dragging button { width: 44px; height: 44px; margin: -22px; }
  .mocap-dragging button span { margin: 11px; }
}
.mocap-dragging button:focus-visible { outline: none; }
.mocap-dragging button:focus-visible span { outline: 3px solid #0072B2; outline-offset: 1px; }`;

/** @type {Record<string, number[]>} */
const STEPS = { ArrowUp: [0, 1], ArrowDown: [0, -1], ArrowLeft: [-1, 0], ArrowRight: [1, 0] };

export default {
  /** @param {Rendered} rendered */
  render({ model, el }) {
    el.innerHTML = `<style>${STYLE}</style><div class="mocap-dragging" role="group" data-lm-suppress-shortcuts="true"
      ><img draggable="false" alt=""></div><div role="status"></div>`;
    const [, place, status] = el.children;
    const picture = el.querySelector("img");
    if (!picture) throw new Error("There is no picture to drag on.");
    /** @type {() => number[][]} */
    const values = () => model.get("value");
    /** @type {() => number[][]} */
    const limits = () => model.get("limits");
    place.setAttribute(
      "aria-label",
      `${model.get("description")}: drag, or focus a handle and use the arrow keys, with shift ten steps at once.`,
    );

    const paint = () => {
      URL.revokeObjectURL(picture.src);
      picture.src = URL.createObjectURL(new Blob([model.get("picture")], { type: "image/png" }));
    };

    // A fraction of the picture is the same affine function of the value on both axes; the picture's y points down.
    const spans = () => {
      const [left, top, right, bottom] = model.get("box");
      const [across, up] = limits();
      return [
        [left, right, ...across],
        [bottom, top, ...up],
      ];
    };
    /**
     * @param {number} value
     * @param {number[]} span
     */
    const fraction = (value, [from, to, low, high]) => from + ((to - from) * (value - low)) / (high - low);
    /**
     * @param {number} at
     * @param {number[]} span
     */
    const value = (at, [from, to, low, high]) => low + ((high - low) * (at - from)) / (to - from);

    /**
     * @param {number} k
     * @param {number[]} point
     */
    const move = (k, point) => {
      const points = values().map((p) => [...p]);
      points[k] = limits().map((ends, axis) =>
        Math.min(Math.max(point[axis], Math.min(...ends)), Math.max(...ends)),
      );
      model.set("value", points);
      model.save_changes();
      const said = points[k].map((v, axis) => `${model.get("names")[axis]} ${v.toFixed(2)}`);
      status.textContent = `handle ${k + 1}: ${said.join(", ")}`;
    };

    const buttons = values().map((_, k) => {
      const button = document.createElement("button");
      button.type = "button";
      button.innerHTML = `<span>${k + 1}</span>`;
      button.setAttribute("aria-label", `handle ${k + 1}`);
      button.onpointerdown = (event) => {
        button.setPointerCapture(event.pointerId);
        button.focus({ preventScroll: true });
      };
      button.onpointermove = (event) => {
        if (!event.buttons) return;
        const { x, y, width, height } = picture.getBoundingClientRect();
        const [across, up] = spans();
        move(k, [value((event.clientX - x) / width, across), value((event.clientY - y) / height, up)]);
      };
      button.onkeydown = (event) => {
        const step = STEPS[event.key];
        const far = (event.shiftKey ? 10 : 1) * model.get("step");
        if (!step) return;
        const signs = limits().map(([low, high]) => Math.sign(high - low));
        const point = values()[k].map((v, axis) => v + far * signs[axis] * step[axis]);
        move(k, point);
        event.preventDefault();
        event.stopPropagation();
      };
      place.append(button);
      return button;
    });

    const show = () => {
      const [across, up] = spans();
      values().forEach(([x, y], k) => {
        buttons[k].style.left = `${100 * fraction(x, across)}%`;
        buttons[k].style.top = `${100 * fraction(y, up)}%`;
      });
    };

    model.on("change:picture", paint);
    model.on("change:value change:box", show);
    paint();
    show();
    return () => {
      model.off("change:picture", paint);
      model.off("change:value change:box", show);
      URL.revokeObjectURL(picture.src);
    };
  },
};
