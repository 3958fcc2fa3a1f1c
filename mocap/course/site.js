// What the pages of the course can do: hide their code, keep a slider's place in the address, and search for words
// that are near to what was typed.

// ---- code ----

const kept = { get: () => { try { return localStorage.getItem("mocap-code"); } catch { return null; } },
  set: (value) => { try { localStorage.setItem("mocap-code", value); } catch { /* where nothing may be kept */ } } };
if (document.querySelector(".cell_input")) {
  const button = Object.assign(document.createElement("button"), { className: "code-toggle" });
  const show = (hidden) => {
    document.body.classList.toggle("without-code", hidden);
    button.textContent = hidden ? "show code" : "hide code";
  };
  button.onclick = () => { show(!document.body.classList.contains("without-code")); kept.set(document.body.classList.contains("without-code") ? "hidden" : "shown"); };
  show(kept.get() === "hidden");
  document.querySelector("article h1")?.after(button);
}

// ---- addresses: #experiment-name, and #experiment-name=label for a place of its slider ----

function goTo() {
  const [name, label] = decodeURIComponent(location.hash.slice(1)).split("="), found = name && document.getElementById(name);
  if (!found || label === undefined) return;
  const slider = found.querySelector(".moving input"), { labels } = JSON.parse(found.querySelector("script").textContent);
  if (!slider || !labels.includes(label)) return;
  slider.value = labels.indexOf(label);
  slider.dispatchEvent(new Event("input"));
  found.scrollIntoView();
}
document.addEventListener("change", ({ target }) => { // when the hand lets go
  const place = target.closest?.(".moving") && target.closest("[id^=experiment-]");
  if (place) history.replaceState(null, "", `#${place.id}=${encodeURIComponent(place.querySelector("output").textContent)}`);
});
addEventListener("hashchange", goTo);
goTo();

// ---- search ----

function edits(a, b) { // how many letters differ, at least
  let row = Array.from({ length: b.length + 1 }, (_, k) => k);
  for (let i = 1; i <= a.length; i++) {
    const above = row;
    row = [i];
    for (let k = 1; k <= b.length; k++) row.push(Math.min(above[k] + 1, row[k - 1] + 1, above[k - 1] + (a[i - 1] !== b[k - 1])));
  }
  return row.at(-1);
}

function suggest(typed) {
  const { terms, titles, docnames } = Search._index, stem = new Stemmer(), wanted = stem.stemWord(typed.toLowerCase());
  const far = Object.keys(terms).filter((term) => term.length > 3).map((term) => [wanted.includes(term) ? 1 - term.length / 100 : edits(wanted, term), term]).sort(([a], [b]) => a - b);
  const near = far.filter(([much]) => much <= Math.max(1, wanted.length / 4)).slice(0, 3);
  return near.flatMap(([, term]) => [terms[term]].flat().slice(0, 4).map((page) => [term, docnames[page], titles[page]]));
}

function watchSearch() {
  const typed = new URLSearchParams(location.search).get("q")?.trim(), results = document.getElementById("search-results");
  if (!typed || !results || !/^\S+$/.test(typed)) return;
  const look = setInterval(() => {
    if (typeof Search === "undefined" || !Search._index || !/did not match|finished/i.test(results.textContent)) return;
    clearInterval(look);
    if (results.querySelector("li a")) return;
    const said = Object.assign(document.createElement("p"), { className: "note" }), found = suggest(typed), list = document.createElement("ul");
    said.textContent = found.length ? `No page has “${typed}”. These have words near it:` : `No page has “${typed}”, or a word near it.`;
    list.append(...found.map(([term, name, title]) => {
      const item = document.createElement("li"), link = Object.assign(document.createElement("a"), { href: `${name}.html?highlight=${term}`, textContent: title });
      item.append(link, ` (${term}…)`);
      return item;
    }));
    results.append(said, list);
  }, 100);
}
watchSearch();
