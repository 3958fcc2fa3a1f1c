// Moves the recordings of experiments, on the site and on slides: a slider chooses one of the pictures beside it.
for (const moving of document.querySelectorAll(".moving")) {
  const [slider, label] = [moving.querySelector("input"), moving.querySelector("output")];
  const [picture, packed] = [moving.querySelector("img"), moving.querySelector("script")];
  if (!slider || !label || !picture || !packed) continue;
  /** @type {{ labels: string[], pictures: string[] }} */
  const { labels, pictures } = JSON.parse(packed.text);
  slider.addEventListener("input", () => {
    const place = Number(slider.value);
    picture.src = pictures[place];
    label.textContent = labels[place];
    slider.setAttribute("aria-valuetext", labels[place]);
  });
}
