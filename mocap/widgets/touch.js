const SLOP = 8; // pixels that a finger moves before its direction is known

/**
 * Call `point` where a mouse presses or drags, and where a finger taps or moves across. A finger that moves up or down
 * scrolls the page, so it points at nothing before its direction is known.
 * @param {HTMLElement} part
 * @param {(event: PointerEvent) => void} point
 */
export function whenPointed(part, point) {
  /** @type {PointerEvent | null} where a finger came down whose direction is not known yet */
  let from = null;
  part.style.touchAction = "pan-y";
  part.addEventListener("pointerdown", (event) => {
    part.setPointerCapture(event.pointerId);
    from = event.pointerType === "touch" ? event : null;
    if (!from) point(event);
  });
  part.addEventListener("pointermove", (event) => {
    const [across, down] = from
      ? [event.clientX - from.clientX, event.clientY - from.clientY].map(Math.abs)
      : [SLOP, 0];
    if (!event.buttons || across < Math.max(SLOP, down)) return;
    from = null;
    point(event);
  });
  part.addEventListener("pointerup", (event) => {
    if (from) point(event);
  });
}
