// Moves the recordings of experiments, on the site and on slides: a slider chooses one of the pictures beside it.
for (const moving of document.querySelectorAll(".moving")) {
  const slider = moving.querySelector("input"), label = moving.querySelector("output"), picture = moving.querySelector("img");
  const { labels, pictures } = JSON.parse(moving.querySelector("script").textContent);
  slider.addEventListener("input", () => {
    picture.src = "data:image/png;base64," + pictures[slider.value];
    label.textContent = labels[slider.value];
    slider.setAttribute("aria-valuetext", labels[slider.value]);
  });
}
