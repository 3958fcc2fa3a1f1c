// The parts of the page for steered characters, and their style; what they share with the player is in its files.

import { STYLE, partOf } from "./player_page.js";
import { Picture } from "./player_picture.js";
import { Camera } from "./player_scene.js";
import { VIEW_OPTIONS } from "./steered_command.js";
import { Walker } from "./steered_walker.js";

/**
 * @import { PackedMember } from "./steered_walker.js"
 *
 * The view that all pictures share: angles of the camera, and how near it is.
 * @typedef {{ yaw: number, pitch: number, zoom: number }} View
 *
 * @typedef {ReturnType<typeof panel>} Panel
 */

export const STEERING_KEYS =
  "Arrows or W, A, S, D choose the direction, two together one between; Q and E turn it by 15 degrees; plus and " +
  "minus change the speed; space pauses; shift and arrows turn the view.";

const STEERING_STYLE = `
.mocap-steering { max-width: 1080px; }
.mocap-steering .panels { display: flex; flex-wrap: wrap; gap: 6px; padding: 4px; }
.mocap-steering .panels:focus-visible { outline-offset: -3px; }
.mocap-steering [hidden] { display: none !important; }
.mocap-steering figure { flex: 1 1 260px; min-width: 0; margin: 0; }
.mocap-steering figure canvas { height: clamp(150px, calc(100svh - 260px), 300px); cursor: crosshair; }
.mocap-steering figcaption { padding: 2px; min-height: 2.8em; font-variant-numeric: tabular-nums; }
.mocap-steering figcaption i { display: inline-block; width: 10px; height: 10px; margin-right: 6px; }
.mocap-steering figcaption .fault { display: block; color: #A00000; } .mocap-steering.dark figcaption .fault { color: #FF9C8F; }
.mocap-steering .pad { flex: none; position: relative; width: 120px; height: 120px; border: 1px solid #8888; border-radius: 50%; touch-action: none;
  background: #8882; cursor: pointer; }
.mocap-steering .pad i { position: absolute; left: 50%; top: 50%; width: 26px; height: 26px; margin: -13px; border-radius: 50%; background: #0072B2; }
.mocap-steering .beside { flex: 1 1 200px; }
.mocap-steering .beside .bar { padding: 0 2px 4px; }
.mocap-steering .under { color: inherit; opacity: 0.85; padding: 0 2px; min-height: 1.4em; font-variant-numeric: tabular-nums; }
.mocap-steering output { display: inline-block; min-width: 5em; font-variant-numeric: tabular-nums; }
@media (max-width: 600px) {
  .mocap-steering figure { flex-basis: 100%; display: flex; gap: 6px; }
  .mocap-steering figure canvas { height: clamp(110px, 18svh, 160px); flex: 1 1 60%; min-width: 0; }
  .mocap-steering .beside { flex-basis: 120px; } .mocap-steering .speed { width: 80px; }
  .mocap-steering figcaption { flex: 1 1 35%; align-self: center; }
}`;

export const STEERING_PARTS = `<style>${STYLE}${STEERING_STYLE}</style><div class="panels" tabindex="0" role="application"></div>
  <div class="bar"><div class="pad"><i></i></div><div class="beside">
    <div class="bar"><button class="play"></button>
      <label>speed <input class="speed" type="range" step="0.05" aria-label="speed, metres per second"><output></output></label>
      <label class="kinds">kind <select class="kind" aria-label="kind of motion"></select></label>
      <label>view <select class="view" aria-label="view">${VIEW_OPTIONS}</select></label></div>
    <div class="under"></div></div></div><div class="message" role="status"></div>`;

/**
 * A picture of one character: its canvas, its name, and what it is doing.
 * @param {PackedMember} member
 * @param {View} shared
 */
export function panel(member, shared) {
  const root = document.createElement("figure");
  root.innerHTML =
    '<canvas></canvas><figcaption><i></i><b></b> <span class="state"></span><span class="fault"></span></figcaption>';
  const canvas = partOf(root, "canvas", HTMLCanvasElement);
  const camera = new Camera();
  partOf(root, "i", HTMLElement).style.background = member.colour;
  partOf(root, "b", HTMLElement).textContent = member.name;
  Object.assign(camera, shared);
  return {
    root,
    canvas,
    camera,
    picture: new Picture(canvas, camera),
    walker: new Walker(member),
    state: partOf(root, ".state", HTMLElement),
    fault: partOf(root, ".fault", HTMLElement),
  };
}
