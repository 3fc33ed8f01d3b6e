import js from "@eslint/js";
import globals from "globals";

export default [
  js.configs.recommended,
  {
    rules: {
      eqeqeq: "error",
      "no-implicit-coercion": "error",
      "no-shadow": ["error", { allow: ["error", "reply"] }],
      "no-var": "error",
      "object-shorthand": "error",
      "prefer-const": "error",
      "prefer-template": "error",
    },
  },
  { files: ["src/page/*.js"], languageOptions: { globals: globals.browser } },
  { files: ["tests/page/*.js"], languageOptions: { globals: globals.node } },
];
