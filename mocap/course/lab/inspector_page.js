// The page around the inspector's canvases: its parts and their style.

import { WEIGHTS } from "./inspector_maths.js";
import { VIEW_KEYS } from "../../widgets/player_page.js";

export const NAMES = {
  grid: "Distances of all pairs of windows. A click or the arrow keys choose a pair, with shift ten frames at once.",
  graph:
    "A motion graph along time. A click chooses a transition; left and right go along time, up and down by cost.",
  walk: "A walk from above. A click or the arrow keys choose a seam.",
};

export const INSPECTOR_STYLE = `
.mocap-inspector { container-type: inline-size; max-width: 1000px; background: #fff; color: #222; font: 13px/1.4 system-ui, sans-serif;
  color-scheme: light; forced-color-adjust: none; padding: 4px; box-sizing: border-box; }
.mocap-inspector.dark { background: #1b1b1b; color: #ddd; color-scheme: dark; }
.mocap-inspector .both { display: grid; grid-template-columns: 1fr; gap: 8px 14px; }
.mocap-inspector .maps { display: contents; } .mocap-inspector:not(.alone) .grid { order: 2; } .mocap-inspector .shown { min-width: 0; order: 1; }
@container (min-width: 620px) { .mocap-inspector .both { grid-template-columns: 2fr 3fr; } .mocap-inspector .maps { display: block; min-width: 0; } .mocap-inspector.alone .grid { height: 400px; } .mocap-inspector.wide .both { grid-template-columns: 1fr; } }
.mocap-inspector canvas { display: block; box-sizing: border-box; width: 100%; }
.mocap-inspector canvas[hidden] { display: none; }
.mocap-inspector :focus-visible { outline: 3px solid #0072B2; outline-offset: 1px; }
.mocap-inspector .maps canvas { cursor: crosshair; margin-bottom: 6px; }
.mocap-inspector .grid { height: 290px; } .mocap-inspector .walk { height: 220px; } .mocap-inspector .graph { height: 180px; }
.mocap-inspector .bodies { height: 300px; border: 1px solid #8884; cursor: grab; touch-action: pan-y; }
.mocap-inspector .chart { height: 130px; margin-top: 4px; cursor: ew-resize; }
.mocap-inspector .bar { display: flex; flex-wrap: wrap; gap: 4px 8px; align-items: center; padding: 4px 0; }
.mocap-inspector button, .mocap-inspector select { font: inherit; min-width: 36px; min-height: 32px; padding: 0 8px; color: inherit;
  background: #8882; border: 1px solid #8888; border-radius: 4px; cursor: pointer; }
.mocap-inspector button[aria-pressed="true"] { background: #0072B244; }
.mocap-inspector option { background: #fff; color: #222; }
.mocap-inspector .scrub { flex: 1 1 140px; margin: 0; min-height: 32px; }
.mocap-inspector .now { min-width: 100%; font-variant-numeric: tabular-nums; min-height: 1.4em; }
.mocap-inspector .names { opacity: 0.8; }
.mocap-inspector [hidden] { display: none; }
@media (pointer: coarse) { .mocap-inspector button, .mocap-inspector select, .mocap-inspector .scrub { min-height: 44px; min-width: 44px; } }`;

const KINDS = Object.keys(WEIGHTS)
  .map((kind) => `<option>${kind}</option>`)
  .join("");

export const INSPECTOR_PARTS = `<div class="both"><div class="maps">
    <canvas class="walk" tabindex="0" role="application"></canvas><canvas class="graph" tabindex="0" role="application"></canvas>
    <canvas class="grid" tabindex="0" role="application"></canvas></div>
  <div class="shown"><div class="bar tabs" role="group" aria-label="what to look at"></div>
    <canvas class="bodies" tabindex="0" role="application" aria-label="The bodies. ${VIEW_KEYS}."></canvas>
    <canvas class="chart" role="img" aria-label="The chart of what is looked at, on the same clock."></canvas>
    <div class="bar"><button class="play" aria-label="play">▶</button><input class="scrub" type="range"><button class="best">best turn</button>
      <label class="kind">weights <select class="kinds">${KINDS}</select></label><span class="now"></span></div></div></div>
  <div class="status" role="status"></div><div class="names"></div>`;
