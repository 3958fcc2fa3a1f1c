// What the pages of the course can do: hide their code, keep a slider's place in the address, and search for words
// that are near to what was typed.

// ---- code ----

const kept = {
  get: () => {
    try {
      return localStorage.getItem("mocap-code");
    } catch {
      return null;
    }
  },
  set: (/** @type {string} */ value) => {
    try {
      localStorage.setItem("mocap-code", value);
    } catch {
      /* where nothing may be kept */
    }
  },
};
if (document.querySelector(".cell_input")) {
  const button = Object.assign(document.createElement("button"), { className: "code-toggle" });
  /** @param {boolean} hidden */
  const show = (hidden) => {
    document.body.classList.toggle("without-code", hidden);
    button.textContent = hidden ? "show code" : "hide code";
  };
  button.onclick = () => {
    show(!document.body.classList.contains("without-code"));
    kept.set(document.body.classList.contains("without-code") ? "hidden" : "shown");
  };
  show(kept.get() === "hidden");
  document.querySelector("article h1")?.after(button);
}

// ---- addresses: #experiment-name, and #experiment-name=label for a place of its slider ----

function goTo() {
  const [name, label] = decodeURIComponent(location.hash.slice(1)).split("=");
  const found = name && document.getElementById(name);
  if (!found || label === undefined) return;
  const slider = found.querySelector("input");
  const packed = found.querySelector("script");
  if (!slider || !packed || !found.querySelector(".moving")) return; // it stays still on this page
  /** @type {{ labels: string[] }} */
  const { labels } = JSON.parse(packed.text);
  if (!labels.includes(label)) return;
  slider.value = String(labels.indexOf(label));
  slider.dispatchEvent(new Event("input"));
  found.scrollIntoView();
}
// When the hand lets go of a slider.
document.addEventListener("change", ({ target }) => {
  if (!(target instanceof Element) || !target.closest(".moving")) return;
  const place = target.closest("[id^=experiment-]");
  const label = place?.querySelector("output")?.textContent ?? "";
  if (place) history.replaceState(null, "", `#${place.id}=${encodeURIComponent(label)}`);
});
addEventListener("hashchange", goTo);
goTo();

// ---- search ----

/**
 * How many letters differ, at least.
 * @param {string} a
 * @param {string} b
 */
function edits(a, b) {
  let row = Array.from({ length: b.length + 1 }, (_, k) => k);
  for (let i = 1; i <= a.length; i++) {
    const above = row;
    row = [i];
    for (let k = 1; k <= b.length; k++) {
      const changed = above[k - 1] + (a[i - 1] === b[k - 1] ? 0 : 1);
      row.push(Math.min(above[k] + 1, row[k - 1] + 1, changed));
    }
  }
  return row[b.length];
}

/**
 * Pages with words near to what was typed: each word, and the name and the title of a page.
 * @param {string} typed
 * @param {NonNullable<typeof Search._index>} index
 */
function suggest(typed, { terms, titles, docnames }) {
  const wanted = new Stemmer().stemWord(typed.toLowerCase());
  const far = Object.keys(terms)
    .filter((term) => term.length > 3)
    .map((term) => ({ term, off: wanted.includes(term) ? 1 - term.length / 100 : edits(wanted, term) }))
    .sort((a, b) => a.off - b.off);
  const near = far.filter(({ off }) => off <= Math.max(1, wanted.length / 4)).slice(0, 3);
  return near.flatMap(({ term }) => {
    const pages = [terms[term]].flat().slice(0, 4);
    return pages.map((page) => [term, docnames[page], titles[page]]);
  });
}

// ---- excerpts ----

const EXCERPT = 180; // letters
const BEFORE = 60; // letters before the first word that was typed

/**
 * The part of a paragraph around the first of some words, and these words.
 * @param {string} paragraph
 * @param {RegExp} words
 */
function excerptOf(paragraph, words) {
  const first = Math.max(paragraph.search(words), 0);
  const begin = first > BEFORE ? paragraph.indexOf(" ", first - BEFORE) + 1 : 0;
  const end =
    begin + EXCERPT < paragraph.length ? paragraph.lastIndexOf(" ", begin + EXCERPT) : paragraph.length;
  const shown = Object.assign(document.createElement("p"), { className: "excerpt" });
  const text = paragraph.slice(begin, end);
  let last = 0;
  for (const { index, 0: word } of text.matchAll(words)) {
    shown.append(
      text.slice(last, index),
      Object.assign(document.createElement("mark"), { textContent: word }),
    );
    last = index + word.length;
  }
  shown.append(text.slice(last));
  if (begin) shown.prepend("… ");
  if (end < paragraph.length) shown.append(" …");
  return shown;
}

/**
 * Show below a result the paragraph of its page with the most of the words that were typed.
 * @param {HTMLLIElement} item
 * @param {Record<string, string[]>} texts
 * @param {string[]} words
 */
function showExcerpt(item, texts, words) {
  const address = item.querySelector("a")?.getAttribute("href") ?? "";
  const paragraphs = texts[address.replace(/\.html.*$/, "").replace(/^(\.\/)+/, "")];
  if (!paragraphs) return;
  const [phrase, ...others] = [words.join(" "), ...words];
  /** @param {string} paragraph */
  const score = (paragraph) => {
    const text = paragraph.toLowerCase();
    const found = others.filter((word) => text.includes(word)).length;
    return found + (text.includes(phrase) ? others.length : 0);
  };
  const best = paragraphs.reduce((a, b) => (score(b) > score(a) ? b : a));
  item.append(excerptOf(best, new RegExp(`\\b(?:${words.join("|")})`, "gi")));
}

// One result for each page and each function, with an excerpt.
function watchResults() {
  const words = (new URLSearchParams(location.search).get("q") ?? "").toLowerCase().match(/[\p{L}\p{N}_]+/gu);
  const results = document.getElementById("search-results");
  if (!words || !results) return;
  const script = Object.assign(document.createElement("script"), { src: "_static/texts.js" });
  script.onload = () => {
    const pages = new Set();
    const show = () => {
      for (const item of results.querySelectorAll("li")) {
        if (item.dataset.seen) continue;
        item.dataset.seen = "yes";
        const address = item.querySelector("a")?.getAttribute("href") ?? "";
        const page = address.startsWith("reference/") ? address : address.replace(/#.*/, "");
        if (pages.has(page)) item.hidden = true;
        else showExcerpt(item, TEXTS, words);
        pages.add(page);
      }
    };
    new MutationObserver(show).observe(results, { childList: true, subtree: true });
    show();
  };
  document.head.append(script);
}
watchResults();

function watchSearch() {
  const typed = new URLSearchParams(location.search).get("q")?.trim();
  const results = document.getElementById("search-results");
  if (!typed || !results || !/^\S+$/.test(typed)) return;
  const look = setInterval(() => {
    const index = typeof Search === "undefined" ? undefined : Search._index;
    if (!index || !/did not match|finished/i.test(results.textContent ?? "")) return;
    clearInterval(look);
    if (results.querySelector("li a")) return;
    const said = Object.assign(document.createElement("p"), { className: "note" });
    const found = suggest(typed, index);
    const list = document.createElement("ul");
    said.textContent = found.length
      ? `No page has “${typed}”. These have words near it:`
      : `No page has “${typed}”, or a word near it.`;
    list.append(
      ...found.map(([term, name, title]) => {
        const item = document.createElement("li");
        const link = Object.assign(document.createElement("a"), {
          href: `${name}.html?highlight=${term}`,
          textContent: title,
        });
        item.append(link, ` (${term}…)`);
        return item;
      }),
    );
    results.append(said, list);
  }, 100);
}
watchSearch();
