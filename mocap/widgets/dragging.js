// Handles to drag on a picture: by mouse, by touch, or by the arrow keys.
//
// `dragging.py` sends the picture as a PNG. `value` has a point for each handle, in the units of the axes; `limits` are
// the axes' [[left, right], [bottom, top]], and `box` is where these lie: [left, top, right, bottom], shares of the picture.

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

const STEPS = { ArrowUp: [0, 1], ArrowDown: [0, -1], ArrowLeft: [-1, 0], ArrowRight: [1, 0] };

export default {
  render({ model, el }) {
    el.innerHTML = `<style>${STYLE}</style><div class="mocap-dragging" role="group" data-lm-suppress-shortcuts="true"
      ><img draggable="false" alt=""></div><div role="status"></div>`;
    const [, place, status] = el.children, [picture] = place.children;
    place.setAttribute("aria-label", `${model.get("description")}: drag, or focus a handle and use the arrow keys, with shift ten steps at once.`);

    const paint = () => {
      URL.revokeObjectURL(picture.src);
      picture.src = URL.createObjectURL(new Blob([model.get("picture")], { type: "image/png" }));
    };

    // A share of the picture is the same affine function of the value on both axes; the picture's y points down.
    const spans = () => {
      const [left, top, right, bottom] = model.get("box"), [across, up] = model.get("limits");
      return [[left, right, ...across], [bottom, top, ...up]];
    };
    const share = (value, [from, to, low, high]) => from + ((to - from) * (value - low)) / (high - low);
    const value = (at, [from, to, low, high]) => low + ((high - low) * (at - from)) / (to - from);

    const move = (k, point) => {
      const limits = model.get("limits"), points = model.get("value").map((p) => [...p]);
      points[k] = point.map((v, axis) => Math.min(Math.max(v, Math.min(...limits[axis])), Math.max(...limits[axis])));
      model.set("value", points);
      model.save_changes();
      const said = points[k].map((v, axis) => `${model.get("names")[axis]} ${v.toFixed(2)}`);
      status.textContent = `handle ${k + 1}: ${said.join(", ")}`;
    };

    const buttons = model.get("value").map((_, k) => {
      const button = document.createElement("button");
      button.type = "button";
      button.innerHTML = `<span>${k + 1}</span>`;
      button.setAttribute("aria-label", `handle ${k + 1}`);
      button.onpointerdown = (event) => { button.setPointerCapture(event.pointerId); button.focus({ preventScroll: true }); };
      button.onpointermove = (event) => {
        if (!event.buttons) return;
        const { x, y, width, height } = picture.getBoundingClientRect(), [across, up] = spans();
        move(k, [value((event.clientX - x) / width, across), value((event.clientY - y) / height, up)]);
      };
      button.onkeydown = (event) => {
        const step = STEPS[event.key], far = (event.shiftKey ? 10 : 1) * model.get("step");
        if (!step) return;
        const signs = model.get("limits").map(([low, high]) => Math.sign(high - low));
        move(k, model.get("value")[k].map((v, axis) => v + far * signs[axis] * step[axis]));
        event.preventDefault();
        event.stopPropagation();
      };
      place.append(button);
      return button;
    });

    const show = () => {
      const [across, up] = spans();
      model.get("value").forEach(([x, y], k) => {
        buttons[k].style.left = `${100 * share(x, across)}%`;
        buttons[k].style.top = `${100 * share(y, up)}%`;
      });
    };

    model.on("change:picture", paint);
    model.on("change:value change:box", show);
    paint();
    show();
    return () => { model.off("change:picture", paint); model.off("change:value change:box", show); URL.revokeObjectURL(picture.src); };
  },
};
