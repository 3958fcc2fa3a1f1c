// Lets questions on a page mark themselves, and keeps bets in the browser. Each question brings this script along; the
// first that runs is used for all.
(() => {
  const STORE = "mocap-bets";

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

  function button(text, act, set = {}) {
    return make("button", { type: "button", class: "act", onclick: act, ...set }, text);
  }

  function rich(html) {
    const held = make("span");
    held.innerHTML = html;
    return held;
  }

  // The place for replies must be in the page before the first one, or screen readers do not say that.
  function replies(root) {
    const reply = make("p", { class: "reply", role: "status" });
    root.append(reply);
    return (right, html) => {
      reply.className = `reply ${right === null ? "" : right ? "right" : "wrong"}`;
      reply.innerHTML = (right === null ? "" : right ? "✓ Right. " : "✗ Not yet. ") + html;
    };
  }

  function number(text) {
    const plain = text.replace(/[\s\u2009\u202f]/g, "").replace("−", "-").replace(",", ".");
    const found = plain.match(/^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?/i);
    return found ? Number(found[0]) : NaN;
  }

  function field(label, unit, act) {
    const input = make("input", { inputmode: "decimal", autocomplete: "off", "aria-label": label + (unit ? `, in ${unit}` : "") });
    input.addEventListener("keydown", (event) => event.key === "Enter" && act());
    return input;
  }

  function choice(root, spec) {
    const reply = replies(root);
    const buttons = [...root.querySelectorAll("li")].map((item, index) => {
      const one = button("", () => {
        for (const other of buttons) other.setAttribute("aria-pressed", other === one);
        reply(!spec.hints[index], spec.hints[index] || spec.because);
      }, { class: "choice", "aria-pressed": "false" });
      one.append(...item.childNodes);
      item.append(one);
      return one;
    });
  }

  // Bets: null is "no bet". Where the browser keeps nothing, the page does while it is open.
  let inPage = {};
  function kept() {
    try { return { ...inPage, ...JSON.parse(localStorage.getItem(STORE) || "{}") }; } catch { return inPage; }
  }
  function keep(entered) {
    const all = { ...kept(), ...entered };
    for (const key of Object.keys(all)) if (all[key] === undefined) delete all[key];
    inPage = all;
    try { localStorage.setItem(STORE, JSON.stringify(all)); } catch { /* the page keeps them */ }
    document.dispatchEvent(new Event(STORE));
  }
  const settled = (spec) => spec.bets.every(({ key }) => key in kept());
  const written = (value, unit) => value === null ? "no bet" : typeof value === "string" ? value : `${value} ${unit}`.trim();

  function control(one, commit) {
    const name = rich(one.ask).textContent;
    if (one.choices.length) {
      let chosen = NaN;
      const all = one.choices.map((text) => button(text, (event) => {
        for (const other of all) other.setAttribute("aria-pressed", other === event.currentTarget);
        chosen = text;
      }, { "aria-pressed": "false" }));
      return [make("span", { class: "row", role: "group", "aria-label": name }, ...all), () => chosen];
    }
    if (one.low === null) {
      const input = field(name, one.unit, commit);
      return [make("span", { class: "row" }, input, one.unit), () => number(input.value)];
    }
    let moved = NaN;
    const out = make("span", {}, "move it"), set = { min: one.low, max: one.high, step: one.step, "aria-label": name };
    const slider = make("input", { type: "range", ...set, value: (one.low + one.high) / 2 });
    const take = () => {
      moved = Number(slider.value);
      out.textContent = `${slider.value} ${one.unit}`;
      slider.setAttribute("aria-valuetext", out.textContent);
    };
    for (const event of ["input", "click", "keyup"]) slider.addEventListener(event, take);
    return [make("span", { class: "row" }, slider, out), () => moved];
  }

  function bets(root, spec) {
    const reply = replies(root), place = root.querySelector("ul");
    root.mocapBets = { settled: () => settled(spec), ask() {
      reply(null, "The answer opens when you have kept a bet, or chosen “no bet”.");
      root.querySelector("button, input")?.focus();
    } };
    const show = () => {
      const now = kept();
      if (settled(spec)) {
        reply(null, "");
        return place.replaceChildren(...spec.bets.map((one) =>
          make("li", {}, rich(one.ask), one.ask.endsWith("?") ? " " : ": ", make("strong", {}, written(now[one.key], one.unit)))));
      }
      const commit = () => {
        const values = controls.map(([, value]) => value());
        if (values.some(Number.isNaN)) return reply(null, "Something is not entered yet.");
        close(values);
      };
      const close = (values) => {
        keep(Object.fromEntries(spec.bets.map(({ key }, at) => [key, values[at]])));
        answer(root)?.setAttribute("open", "");
      };
      const controls = spec.bets.map((one) => control(one, commit));
      place.replaceChildren(...spec.bets.map((one, at) => make("li", {}, rich(one.ask), controls[at][0])),
        make("li", { style: "list-style: none" }, make("span", { class: "row" }, button("Keep my bet", commit),
          button("no bet", () => close(spec.bets.map(() => null))))));
    };
    let before = null;
    const update = () => before !== settled(spec) && (before = settled(spec), show());
    document.addEventListener(STORE, update);
    update();
  }

  // The answer is the next folded part after a bet, if no other bet stands between.
  const parts = () => [...document.querySelectorAll(".mocap-question[data-awake=bets], details")];
  function answer(root) {
    const all = parts(), next = all[all.indexOf(root) + 1];
    return next?.matches("details") ? next : null;
  }
  function guard(event) {
    const folded = event.target.closest?.("summary")?.parentElement;
    if (!folded || folded.open) return;
    const all = parts(), bet = all[all.indexOf(folded) - 1]?.mocapBets;
    if (!bet || bet.settled()) return;
    event.preventDefault();
    bet.ask();
  }

  function summary(root, spec) {
    const cells = [...root.querySelectorAll("tbody tr")].map((row) => row.querySelectorAll("td"));
    const reply = replies(root);
    const again = () => keep(Object.fromEntries(spec.rows.map(({ key }) => [key, undefined])));
    root.append(make("p", {}, button("Remove these bets", again)));
    const show = () => {
      const now = kept();
      let count = 0, right = 0, choices = 0;
      spec.rows.forEach((row, at) => {
        const [mine, , off] = cells[at], kind = row.value === null ? "string" : "number";
        const thought = [kind, "object"].includes(typeof now[row.key]) ? now[row.key] : undefined; // as the bet is today
        mine.textContent = thought === undefined ? "–" : written(thought, row.unit);
        off.textContent = "–";
        if (thought === undefined || thought === null) return;
        count += 1;
        if (row.value === null && row.written) {
          choices += 1;
          right += thought === row.written;
          off.textContent = thought === row.written ? "✓ right" : "✗ no";
        } else if (row.value !== null) {
          const decimals = (String(row.step).split(".")[1] || "").length;
          off.textContent = `${Math.abs(thought - row.value).toFixed(decimals)} ${row.unit}`;
        }
      });
      const of = choices ? ` Choices that came out as you thought: ${right} of ${choices}.` : "";
      reply(null, `You have kept ${count} of ${spec.rows.length} bets.${of}`);
    };
    document.addEventListener(STORE, show);
    show();
  }

  const KINDS = { choice, bets, summary };
  function wake() {
    for (const root of document.querySelectorAll(".mocap-question:not([data-awake])")) {
      const spec = JSON.parse(atob(root.dataset.spec));
      root.dataset.awake = spec.kind;
      root.setAttribute("role", "group");
      root.setAttribute("aria-label", (root.querySelector(".asked") ?? root.querySelector(".head")).textContent);
      KINDS[spec.kind](root, spec);
    }
  }

  if (!window.mocapQuestions) {
    window.mocapQuestions = { wake };
    document.addEventListener("click", guard, true);
  }
  window.mocapQuestions.wake();
})();
