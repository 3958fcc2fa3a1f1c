// Check all .glb files of a folder by Khronos's glTF validator.
//
//     NODE_PATH=.../node_modules node tests/elsewhere/validate.cjs FOLDER
//
// It reads every byte and every rule of the specification: what one viewer forgives, another does not. For each
// file a line is printed with the counts of errors, warnings, infos and hints, then each message. The command
// fails if a file has an error, a warning that is not named below, or if there is no file.
"use strict";

const fs = require("node:fs");
const path = require("node:path");
const validator = require("gltf-validator");

// Warnings that are right and stay, each with its reason: { CODE: "reason" }. There are none.
const ACCEPTED_WARNINGS = {};

const ERROR = 0;
const WARNING = 1;
const SEVERITIES = ["error", "warning", "info", "hint"];

/**
 * Whether a message of the validator fails the check.
 * @param {{ code: string, severity: number }} message
 */
function isWrong(message) {
  if (message.severity === WARNING) {
    return !(message.code in ACCEPTED_WARNINGS);
  }
  return message.severity === ERROR;
}

/**
 * Print the report on a file, and return whether it is right.
 * @param {string} file
 */
async function check(file) {
  const bytes = new Uint8Array(fs.readFileSync(file));
  const { issues } = await validator.validateBytes(bytes, { maxIssues: 0 });
  const counts = [issues.numErrors, issues.numWarnings, issues.numInfos, issues.numHints];
  const columns = counts.map((count) => String(count).padStart(8)).join(" ");
  console.log(`${path.basename(file).padEnd(20)} ${columns}`);
  for (const message of issues.messages) {
    const reason = ACCEPTED_WARNINGS[message.code];
    const note = reason ? ` (accepted: ${reason})` : "";
    console.log(`  ${SEVERITIES[message.severity]} ${message.code} at ${message.pointer}: ${message.message}${note}`);
  }
  return !issues.messages.some(isWrong);
}

async function main() {
  const folder = process.argv[2];
  const files = fs.readdirSync(folder).filter((name) => name.endsWith(".glb"));
  console.log(`Khronos glTF validator ${validator.version()}`);
  console.log(`${"file".padEnd(20)} ${SEVERITIES.map((name) => `${name}s`.padStart(8)).join(" ")}`);
  const wrong = [];
  for (const name of files.sort()) {
    if (!(await check(path.join(folder, name)))) {
      wrong.push(name);
    }
  }
  if (wrong.length > 0 || files.length === 0) {
    console.log(`Wrong for the validator: ${wrong.join(", ") || "no files"}`);
    process.exitCode = 1;
  }
}

main();
