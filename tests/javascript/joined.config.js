// For a module that is joined of several files: it must parse, and know every name that it uses.

import globals from "globals";

export default [{ languageOptions: { globals: globals.browser }, rules: { "no-undef": "error" } }];
