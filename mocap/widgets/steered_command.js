// What a command is on the picture: its heading as seen from the camera, its arrow on the ground, and the views of it.

/** @type {Record<string, [yaw: number, pitch: number]>} */
export const VIEWS = { behind: [Math.PI, 0.35], side: [Math.PI / 2, 0.25], above: [Math.PI, 1.5] }; // yaw and pitch of the camera

export const VIEW_OPTIONS = Object.keys(VIEWS)
  .map((name) => `<option>${name}</option>`)
  .join("");

/**
 * The heading of a direction on the picture: [to the right, up], where up is away from the reader.
 * @param {number[]} direction
 * @param {number} yaw of the camera
 */
export function headingOf([right, up], yaw) {
  return Math.atan2(right * Math.cos(yaw) - up * Math.sin(yaw), -right * Math.sin(yaw) - up * Math.cos(yaw));
}

/**
 * A command as an arrow on the ground, longer for a faster one.
 * @param {number[]} place
 * @param {number} heading
 * @param {number} speed
 */
export function arrowOf([x, , z], heading, speed) {
  const [s, c] = [Math.sin(heading), Math.cos(heading)];
  const far = 0.5 + 0.5 * speed;
  /**
   * @param {number} along
   * @param {number} aside
   */
  const at = (along, aside) => [x + along * s + aside * c, z + along * c - aside * s];
  return [at(0.3, 0), at(far, 0), at(far - 0.2, 0.14), at(far, 0), at(far - 0.2, -0.14)];
}
