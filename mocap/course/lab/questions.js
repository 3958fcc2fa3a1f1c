// Lets questions on a page mark themselves, and keeps bets in the browser. Each question brings this script along; the
// first that runs is used for all.

/**
 * @typedef {string | number | null} Bet
 *
 * A bet, as `asking.py` packs it: with choices, a slider from `low` to `high`, or a box.
 * @typedef {{
 *   key: string, ask: string, unit: string, choices: string[], low: number | null, high: number, step: number,
 * }} PackedBet
 *
 * What came out of a bet: a number, or the choice as it is written.
 * @typedef {{ key: string, unit: string, value: number | null, written: string, step: number }} Row
 *
 * @typedef {{ kind: "choice", hints: string[], because: string }} ChoiceSpec
 * @typedef {{ kind: "bets", bets: PackedBet[] }} BetsSpec
 * @typedef {{ kind: "summary", rows: Row[] }} SummarySpec
 */

(() => {
  const STORE = "mocap-bets";
  /** @type {Window & { mocapQuestions?: { wake: () => void } }} */
  const page = window;

  /**
   * A part of a page, with its attributes and what it listens to, and what is inside.
   * @template {keyof HTMLElementTagNameMap} K
   * @param {K} name
   * @param {Record<string, any>} set
   * @param {(Node | string)[]} inside
   * @returns {HTMLElementTagNameMap[K]}
   */
  function make(name, set = {}, ...inside) {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(set)) {
      if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
      else if (value !== null) made.setAttribute(key, value);
    }
    if (/^(button|input)$/.test(name)) made.dataset.lmSuppressShortcuts = "true"; // JupyterLab leaves their keys alone
    made.append(...inside);
    return made;
  }

  /**
   * @param {string} text
   * @param {(event: Event) => void} act
   * @param {Record<string, any>} set
   */
  function button(text, act, set = {}) {
    return make("button", { type: "button", class: "act", onclick: act, ...set }, text);
  }

  /** @param {string} html */
  function rich(html) {
    const held = make("span");
    held.innerHTML = html;
    return held;
  }

  /**
   * The place for replies must be in the page before the first one, or screen readers do not say that.
   * @param {HTMLElement} root
   * @returns {(right: boolean | null, html: string) => void}
   */
  function replies(root) {
    const reply = make("p", { class: "reply", role: "status" });
    root.append(reply);
    return (right, html) => {
      const [mark, words] = right ? ["right", "✓ Right. "] : ["wrong", "✗ Not yet. "];
      reply.className = right === null ? "reply " : `reply ${mark}`;
      reply.innerHTML = right === null ? html : words + html;
    };
  }

  /** @param {string} text */
  function number(text) {
    const plain = text
      .replace(/[\s\u2009\u202f]/g, "")
      .replace("−", "-")
      .replace(",", ".");
    const found = plain.match(/^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?/i);
    return found ? Number(found[0]) : NaN;
  }

  /**
   * @param {string} label
   * @param {string} unit
   * @param {() => void} act
   */
  function field(label, unit, act) {
    const input = make("input", {
      inputmode: "decimal",
      autocomplete: "off",
      "aria-label": label + (unit ? `, in ${unit}` : ""),
    });
    input.addEventListener("keydown", (event) => event.key === "Enter" && act());
    return input;
  }

  /**
   * @param {HTMLElement} root
   * @param {ChoiceSpec} spec
   */
  function choice(root, spec) {
    const reply = replies(root);
    /** @type {HTMLButtonElement[]} */
    const buttons = [...root.querySelectorAll("li")].map((item, index) => {
      const act = () => {
        press(one, buttons);
        reply(!spec.hints[index], spec.hints[index] || spec.because);
      };
      const one = button("", act, { class: "choice", "aria-pressed": "false" });
      one.append(...item.childNodes);
      item.append(one);
      return one;
    });
  }

  /**
   * Press one of some buttons.
   * @param {EventTarget | null} pressed
   * @param {HTMLButtonElement[]} all
   */
  function press(pressed, all) {
    for (const one of all) one.setAttribute("aria-pressed", String(one === pressed));
  }

  // Bets: null is "no bet". Where the browser keeps nothing, the page does while it is open.
  /** @type {Record<string, Bet>} */
  let inPage = {};
  /** @returns {Record<string, Bet>} */
  function kept() {
    try {
      return { ...inPage, ...JSON.parse(localStorage.getItem(STORE) || "{}") };
    } catch {
      return inPage;
    }
  }

  /** @param {Record<string, Bet>} entered */
  function keep(entered) {
    keepAll({ ...kept(), ...entered });
  }

  /** @param {Record<string, Bet>} all */
  function keepAll(all) {
    inPage = all;
    try {
      localStorage.setItem(STORE, JSON.stringify(all));
    } catch {
      /* the page keeps them */
    }
    document.dispatchEvent(new Event(STORE));
  }

  /** @param {BetsSpec} spec */
  const settled = (spec) => spec.bets.every(({ key }) => key in kept());

  /**
   * @param {Bet} value
   * @param {string} unit
   */
  function written(value, unit) {
    if (value === null) return "no bet";
    return typeof value === "string" ? value : `${value} ${unit}`.trim();
  }

  /**
   * What a bet is entered in, and what is entered there; NaN while nothing is.
   * @param {PackedBet} one
   * @param {() => void} commit
   * @returns {[HTMLElement, () => string | number]}
   */
  function control(one, commit) {
    const name = rich(one.ask).textContent ?? "";
    if (one.choices.length) return choices(one.choices, name);
    if (one.low === null) {
      const input = field(name, one.unit, commit);
      return [make("span", { class: "row" }, input, one.unit), () => number(input.value)];
    }
    return slide(one, one.low, name);
  }

  /**
   * @param {string[]} texts
   * @param {string} name
   * @returns {[HTMLElement, () => string | number]}
   */
  function choices(texts, name) {
    /** @type {string | number} */
    let chosen = NaN;
    /** @type {HTMLButtonElement[]} */
    const all = texts.map((text) => {
      const act = (/** @type {Event} */ event) => {
        press(event.currentTarget, all);
        chosen = text;
      };
      return button(text, act, { "aria-pressed": "false" });
    });
    return [make("span", { class: "row", role: "group", "aria-label": name }, ...all), () => chosen];
  }

  /**
   * @param {PackedBet} one
   * @param {number} low
   * @param {string} name
   * @returns {[HTMLElement, () => number]}
   */
  function slide(one, low, name) {
    let moved = NaN;
    const out = make("span", {}, "move it");
    const set = { min: low, max: one.high, step: one.step, "aria-label": name };
    const slider = make("input", { type: "range", ...set, value: (low + one.high) / 2 });
    const take = () => {
      moved = Number(slider.value);
      out.textContent = `${slider.value} ${one.unit}`;
      slider.setAttribute("aria-valuetext", out.textContent);
    };
    for (const event of ["input", "click", "keyup"]) slider.addEventListener(event, take);
    return [make("span", { class: "row" }, slider, out), () => moved];
  }

  // The bets of the page: whether one is settled, and how it asks for that.
  /** @type {WeakMap<Element, { settled: () => boolean, ask: () => void }>} */
  const asking = new WeakMap();

  /**
   * @param {HTMLElement} root
   * @param {BetsSpec} spec
   */
  function bets(root, spec) {
    const reply = replies(root);
    const place = root.querySelector("ul");
    asking.set(root, {
      settled: () => settled(spec),
      ask() {
        reply(null, "The answer opens when you have kept a bet, or chosen “no bet”.");
        /** @type {HTMLElement | null} */
        const first = root.querySelector("button, input");
        first?.focus();
      },
    });
    const showSettled = () => {
      const now = kept();
      reply(null, "");
      const items = spec.bets.map((one) => {
        const value = make("strong", {}, written(now[one.key], one.unit));
        return make("li", {}, rich(one.ask), one.ask.endsWith("?") ? " " : ": ", value);
      });
      place?.replaceChildren(...items);
    };
    const commit = () => {
      const values = controls.map(([, value]) => value());
      if (values.some(Number.isNaN)) reply(null, "Something is not entered yet.");
      else close(values);
    };
    const close = (/** @type {Bet[]} */ values) => {
      keep(Object.fromEntries(spec.bets.map(({ key }, at) => [key, values[at]])));
      answer(root)?.setAttribute("open", "");
    };
    /** @type {[HTMLElement, () => string | number][]} */
    let controls = [];
    const showOpen = () => {
      controls = spec.bets.map((one) => control(one, commit));
      const items = spec.bets.map((one, at) => make("li", {}, rich(one.ask), controls[at][0]));
      const none = button("no bet", () => close(spec.bets.map(() => null)));
      const row = make("span", { class: "row" }, button("Keep my bet", commit), none);
      place?.replaceChildren(...items, make("li", { style: "list-style: none" }, row));
    };
    /** @type {boolean | null} */
    let before = null;
    const update = () => {
      const now = settled(spec);
      if (now === before) return;
      before = now;
      if (now) showSettled();
      else showOpen();
    };
    document.addEventListener(STORE, update);
    update();
  }

  // The answer is the next folded part after a bet, if no other bet stands between.
  const parts = () => [...document.querySelectorAll(".mocap-question[data-awake=bets], details")];

  /** @param {Element} root */
  function answer(root) {
    const all = parts();
    const next = all[all.indexOf(root) + 1];
    return next?.matches("details") ? next : null;
  }

  /** @param {Event} event */
  function guard(event) {
    const folded = event.target instanceof Element ? event.target.closest("summary")?.parentElement : null;
    if (!(folded instanceof HTMLDetailsElement) || folded.open) return;
    const all = parts();
    const bet = asking.get(all[all.indexOf(folded) - 1]);
    if (!bet || bet.settled()) return;
    event.preventDefault();
    bet.ask();
  }

  /**
   * What was thought of a bet as it is today: a kept choice is none where numbers are asked for by now.
   * @param {Row} row
   * @param {Record<string, Bet>} now
   */
  function thoughtOf(row, now) {
    const thought = now[row.key];
    const kind = row.value === null ? "string" : "number";
    return thought === null || typeof thought === kind ? thought : undefined;
  }

  /**
   * How far off a bet was.
   * @param {Row} row
   * @param {Bet | undefined} thought
   */
  function offOf(row, thought) {
    if (typeof thought === "number" && row.value !== null) {
      const decimals = (String(row.step).split(".")[1] || "").length;
      return `${Math.abs(thought - row.value).toFixed(decimals)} ${row.unit}`;
    }
    if (typeof thought !== "string" || !row.written) return "–";
    return thought === row.written ? "✓ right" : "✗ no";
  }

  /**
   * @param {HTMLElement} root
   * @param {SummarySpec} spec
   */
  function summary(root, spec) {
    const cells = [...root.querySelectorAll("tbody tr")].map((row) => row.querySelectorAll("td"));
    const reply = replies(root);
    const ours = new Set(spec.rows.map(({ key }) => key));
    const again = () => keepAll(Object.fromEntries(Object.entries(kept()).filter(([key]) => !ours.has(key))));
    root.append(make("p", {}, button("Remove these bets", again)));
    const show = () => {
      const now = kept();
      let count = 0;
      let right = 0;
      let chosen = 0;
      spec.rows.forEach((row, at) => {
        const [mine, , off] = cells[at];
        const thought = thoughtOf(row, now);
        mine.textContent = thought === undefined ? "–" : written(thought, row.unit);
        off.textContent = offOf(row, thought);
        if (thought === undefined || thought === null) return;
        count += 1;
        if (row.value !== null || !row.written) return;
        chosen += 1;
        right += thought === row.written ? 1 : 0;
      });
      const of = chosen ? ` Choices that came out as you thought: ${right} of ${chosen}.` : "";
      reply(null, `You have kept ${count} of ${spec.rows.length} bets.${of}`);
    };
    document.addEventListener(STORE, show);
    show();
  }

  /**
   * @param {HTMLElement} root
   * @param {ChoiceSpec | BetsSpec | SummarySpec} spec
   */
  function start(root, spec) {
    if (spec.kind === "choice") choice(root, spec);
    else if (spec.kind === "bets") bets(root, spec);
    else summary(root, spec);
  }

  function wake() {
    /** @type {NodeListOf<HTMLElement>} */
    const roots = document.querySelectorAll(".mocap-question:not([data-awake])");
    for (const root of roots) {
      const spec = JSON.parse(atob(root.dataset.spec ?? ""));
      root.dataset.awake = spec.kind;
      root.setAttribute("role", "group");
      root.setAttribute(
        "aria-label",
        (root.querySelector(".asked") ?? root.querySelector(".head"))?.textContent ?? "",
      );
      start(root, spec);
    }
  }

  if (!page.mocapQuestions) {
    page.mocapQuestions = { wake };
    document.addEventListener("click", guard, true);
  }
  page.mocapQuestions.wake();
})();
