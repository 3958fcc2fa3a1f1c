// The page around the canvas: its parts, their style, and colours for light and dark pages.

/**
 * The model of a widget, which anywidget shares with Python.
 * @typedef {object} Model
 * @property {(name: string) => any} get
 * @property {(name: string, value: unknown) => void} set
 * @property {(name: string, call: (...what: any[]) => void) => void} on
 * @property {(name: string, call: (...what: any[]) => void) => void} off
 * @property {() => void} save_changes
 * @property {(content: object) => void} send
 *
 * @typedef {{ model: Model, el: HTMLElement }} Rendered
 *
 * The colours of what is drawn on the ground.
 * @typedef {typeof LIGHT} Palette
 */

export const VIEW_KEYS =
  "Space plays, arrows step, shift and arrows turn the view, plus and minus zoom, alt and arrows move it";
export const KEYS = `${VIEW_KEYS}, L marks a part to play.`;
export const PEN_KEYS = "Arrows draw, Backspace takes back, Enter walks the path, Escape puts the pen away.";

export const STYLE = `
.mocap-player { max-width: 720px; background: #fff; color: #222; font: 13px/1.4 system-ui, sans-serif; color-scheme: light;
  forced-color-adjust: none; }
.mocap-player.dark { background: #1b1b1b; color: #ddd; color-scheme: dark; }
.mocap-player canvas { display: block; box-sizing: border-box; width: 100%; height: clamp(180px, calc(100svh - 150px), 380px);
  touch-action: pan-y; cursor: grab; border: 1px solid #8884; }
.mocap-player canvas.drawing { cursor: crosshair; touch-action: none; }
.mocap-player :focus-visible { outline: 3px solid #0072B2; outline-offset: 1px; }
.mocap-player canvas:focus-visible { outline-offset: -3px; }
.mocap-player .bar { display: flex; flex-wrap: wrap; gap: 4px 12px; align-items: center; padding: 4px 2px; }
.mocap-player button, .mocap-player select { font: inherit; min-width: 40px; height: 32px; padding: 0 8px; color: inherit;
  background: #8882; border: 1px solid #8888; border-radius: 4px; cursor: pointer; }
.mocap-player button[aria-pressed="true"] { background: #0072B244; }
.mocap-player option { background: #fff; color: #222; }
.mocap-player label { display: inline-flex; align-items: center; gap: 4px; min-height: 32px; }
.mocap-player .scrub { flex: 1 1 200px; position: relative; }
.mocap-player .scrub input { width: 100%; margin: 0; }
.mocap-player .scrub div { height: 5px; border-radius: 2px; position: relative; }
.mocap-player .scrub b { position: absolute; bottom: -4px; min-width: 2px; height: 4px; background: #0072B2; }
.mocap-player [hidden] { display: none !important; }
.mocap-player .scrub i { position: absolute; top: -2px; width: 2px; height: 9px; }
.mocap-player .clock { font-variant-numeric: tabular-nums; min-width: 11em; }
.mocap-player .legend span { display: inline-block; width: 10px; height: 10px; margin: 0 4px 0 10px; }
.mocap-player .message:not(:empty) { padding: 4px 2px; white-space: pre-line; }
.mocap-player .message.error { color: #A00000; } .mocap-player.dark .message.error { color: #FF9C8F; }
.mocap-player:fullscreen { max-width: none; display: flex; flex-direction: column; }
.mocap-player:fullscreen canvas { flex: 1; min-height: 0; height: auto; }
@media (pointer: coarse) {
  .mocap-player button, .mocap-player select, .mocap-player input[type="range"], .mocap-player label { min-height: 44px; min-width: 44px; }
  .mocap-player input[type="checkbox"] { width: 24px; height: 24px; }
}
@media (max-height: 450px) and (pointer: coarse) { .mocap-player .bar { flex-wrap: nowrap; overflow-x: auto; padding: 0 2px; } }`;

const SPEEDS = [0.1, 0.25, 0.5, 1, 2].map((speed) => `<option value="${speed}">${speed}×</option>`).join("");

export const PARTS = `<style>${STYLE}</style><canvas tabindex="0" role="application" aria-roledescription="player"></canvas>
  <div class="bar"><button class="play" aria-label="play"></button>
    <div class="scrub"><input type="range" min="0" step="1" aria-label="frame"><div></div><b hidden></b></div><span class="clock"></span></div>
  <div class="bar"><label>speed <select aria-label="speed">${SPEEDS}</select></label>
    <label><input type="checkbox" class="follow"> follow</label>
    <label><input type="checkbox" class="ghosts"> ghosts</label>
    <label class="aside"><input type="checkbox"> side by side</label>
    <button class="reset">reset view</button><button class="full">full screen</button>
    <button class="draw" aria-pressed="false">draw a path</button>
    <span class="legend"></span></div><div class="message" role="status"></div>`;

export const LIGHT = { ink: "#333333", asked: "#000000", line: "#bfb7a8", shadow: "#000000" };
export const DARK = { ink: "#dddddd", asked: "#ffffff", line: "#41465a", shadow: "#ffffff" };

// Whether the page around the player is dark: JupyterLab says so itself, a page of its own goes with the reader's system.
export function isDark() {
  const lab = document.body.dataset.jpThemeLight;
  if (lab) return lab === "false";
  return document.body.classList.contains("mocap-page") && matchMedia("(prefers-color-scheme: dark)").matches;
}

/**
 * @param {string} colour
 * @param {string} text
 */
export function coloured(colour, text) {
  const mark = document.createElement("span");
  mark.style.background = colour;
  return [mark, text];
}

/**
 * On a page: each output that appears starts the players, or what else shows itself there, that have not been started yet.
 * @param {new (root: HTMLElement, scene: any) => object} Kind
 */
export function start(Kind) {
  const name = Kind.name.toLowerCase();
  /** @type {NodeListOf<HTMLElement>} */
  const roots = document.querySelectorAll(`.mocap-${name}:not([data-started])`);
  for (const root of roots) {
    const scene = JSON.parse(partOf(root, "script", HTMLScriptElement).text);
    Object.assign(root, { [name]: new Kind(root, { ...scene, autoplay: true }) });
  }
}

/**
 * The part of a page that a selector names, which must be there.
 * @template {Element} T
 * @param {ParentNode} root
 * @param {string} selector
 * @param {new () => T} Kind
 * @returns {T}
 */
export function partOf(root, selector, Kind) {
  const found = root.querySelector(selector);
  if (!(found instanceof Kind)) throw new Error(`The page has no ${selector}.`);
  return found;
}

/**
 * Keep keys for parts of a page: JupyterLab takes them away from what does not say this.
 * @param {HTMLElement} root
 * @param {string} selector
 */
export function keepKeys(root, selector) {
  /** @type {NodeListOf<HTMLElement>} */
  const parts = root.querySelectorAll(selector);
  for (const part of parts) part.dataset.lmSuppressShortcuts = "true";
}
