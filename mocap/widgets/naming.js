// Gives the parts of an experiment the names that screen readers say: sliders that of their label, the picture its
// sentence. ipywidgets sets neither.

/** @import { Rendered } from "./player_page.js" */

/**
 * Name the parts of an experiment.
 * @param {Element} box
 * @param {string} alt
 */
function name(box, alt) {
  for (const slider of box.querySelectorAll(".widget-slider")) {
    const label = slider.querySelector(".widget-label")?.textContent ?? "";
    for (const handle of slider.querySelectorAll(".noUi-handle")) handle.setAttribute("aria-label", label);
  }
  for (const picture of box.querySelectorAll(".mocap-picture")) picture.setAttribute("alt", alt);
}

export default {
  /** @param {Rendered} rendered */
  render({ model, el }) {
    el.style.display = "none";
    const watch = new MutationObserver(() => find());
    const find = () => {
      const box = el.closest(".mocap-live");
      if (box) name(box, model.get("alt"));
      if (box?.querySelector(".mocap-picture")) watch.disconnect();
    };
    watch.observe(document.body, { childList: true, subtree: true });
    find();
    return () => watch.disconnect();
  },
};
