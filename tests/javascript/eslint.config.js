// How the scripts of the pages and widgets are checked. Python joins those of a page to one module, without comments,
// imports and the word `export` (`joined` in `mocap/widgets/embedding.py`): what would break that is an error here.

import js from "@eslint/js";
import globals from "globals";

const RENAMED = "The joined module knows a name only as its file declares it.";

const sameName = {
  meta: { type: "problem" },
  create: (context) => ({
    ImportSpecifier(node) {
      if (node.imported.name !== node.local.name) context.report({ node, message: RENAMED });
    },
  }),
};

const JOINED = [
  { selector: "ImportDefaultSpecifier, ImportNamespaceSpecifier", message: RENAMED },
  {
    selector: "ExportNamedDeclaration[declaration=null], ExportAllDeclaration, ExportSpecifier",
    message: "Write `export` before the declaration: the joined module drops the word.",
  },
  {
    selector: "TemplateElement[value.raw=/^ *(\\u002f\\u002f|\\u002f\\*\\*|import |export )/m]",
    message:
      "No line of a template may start like a comment, an import or an export: the joined module drops it.",
  },
];

export default [
  js.configs.recommended,
  {
    languageOptions: { globals: globals.browser },
    plugins: { joined: { rules: { "same-name": sameName } } },
    linterOptions: { reportUnusedDisableDirectives: "error" },
    rules: {
      complexity: ["error", 12],
      curly: ["error", "multi-line"],
      eqeqeq: "error",
      "max-depth": ["error", 4],
      "max-params": ["error", 7],
      "max-statements-per-line": ["error", { max: 1 }],
      "no-implicit-coercion": ["error", { boolean: true, number: true, string: true }],
      "no-multi-assign": "error",
      "no-nested-ternary": "error",
      "no-return-assign": "error",
      "no-sequences": "error",
      "no-shadow": "error",
      "no-unused-vars": ["error", { argsIgnorePattern: "^_" }],
      "no-var": "error",
      "one-var": ["error", "never"],
      "prefer-const": "error",
    },
  },
  {
    files: ["mocap/**", "tests/browser/**"],
    rules: { "joined/same-name": "error", "no-restricted-syntax": ["error", ...JOINED] },
  },
  {
    // Node runs these.
    files: ["**/*.cjs"],
    languageOptions: { globals: globals.node },
  },
  {
    // These run as they are, not as modules; the search page has three names ready for them.
    files: ["mocap/course/*.js", "mocap/course/lab/questions.js"],
    languageOptions: {
      sourceType: "script",
      globals: { Search: "readonly", Stemmer: "readonly", TEXTS: "readonly" },
    },
  },
];
