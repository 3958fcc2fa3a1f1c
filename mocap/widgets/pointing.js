// An image to click on: a click, a drag or the arrow keys choose a row and a column.
//
// `pointing.py` sends the figure as a PNG, and `box`: left, top, width and height of the image in it, as shares of
// the figure's, from row 0 and column 0. Width or height is negative where they start at the right or the bottom.

const STYLE = `
.mocap-pointing { position: relative; cursor: crosshair; }
.mocap-pointing:focus-visible { outline: 3px solid #0072B2; outline-offset: -3px; }
.mocap-pointing img { display: block; width: 100%; }
.mocap-pointing i { position: absolute; width: 14px; height: 14px; margin: -8px; border: 2px solid #fff; border-radius: 50%;
  box-shadow: 0 0 0 2px #222; pointer-events: none; }`;

const STEPS = { ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] };

export default {
  render({ model, el }) {
    el.innerHTML = `<style>${STYLE}</style><div class="mocap-pointing" tabindex="0" role="application"
      data-lm-suppress-shortcuts="true"><img draggable="false"><i></i></div><div role="status"></div>`;
    const [, place, status] = el.children, [picture, ring] = place.children;
    const [left, top, wide, high] = model.get("box"), [rows, columns] = model.get("shape");
    picture.src = model.get("picture");
    picture.alt = "";
    place.setAttribute("aria-label", `${model.get("description")}: a click or the arrow keys choose, with shift ten at once.`);

    const show = () => {
      const [row, column] = model.get("value");
      ring.style.left = `${100 * (left + (wide * (column + 0.5)) / columns)}%`;
      ring.style.top = `${100 * (top + (high * (row + 0.5)) / rows)}%`;
      status.textContent = model.get("status");
    };

    const choose = (row, column) => {
      const inside = (k, count) => Math.min(count - 1, Math.max(0, Math.floor(k)));
      model.set("value", [inside(row, rows), inside(column, columns)]);
      model.save_changes();
    };

    const point = (event) => {
      place.focus({ preventScroll: true });
      const { x, y, width, height } = picture.getBoundingClientRect();
      const [across, down] = [(event.clientX - x) / width, (event.clientY - y) / height];
      choose((rows * (down - top)) / high, (columns * (across - left)) / wide);
    };

    whenPointed(place, point);
    place.onkeydown = (event) => {
      const step = STEPS[event.key], [row, column] = model.get("value"), far = event.shiftKey ? 10 : 1;
      if (!step) return;
      choose(row + far * Math.sign(high) * step[0], column + far * Math.sign(wide) * step[1]);
      event.preventDefault();
      event.stopPropagation();
    };
    model.on("change:value change:status", show);
    show();
    return () => model.off("change:value change:status", show);
  },
};
