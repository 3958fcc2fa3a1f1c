// Call `point` where a mouse presses or drags, and where a finger taps or moves across. A finger that moves up or down
// scrolls the page, so it points at nothing before its way is known.
function whenPointed(part, point) {
  const SLOP = 8; // pixels
  let from = null;
  part.style.touchAction = "pan-y";
  part.addEventListener("pointerdown", (event) => {
    part.setPointerCapture(event.pointerId);
    from = event.pointerType === "touch" ? event : null;
    if (!from) point(event);
  });
  part.addEventListener("pointermove", (event) => {
    const [across, down] = from ? [event.clientX - from.clientX, event.clientY - from.clientY].map(Math.abs) : [SLOP, 0];
    if (!event.buttons || across < Math.max(SLOP, down)) return;
    from = null;
    point(event);
  });
  part.addEventListener("pointerup", (event) => { if (from) point(event); });
}
