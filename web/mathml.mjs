// A plugin for esbuild: formulas.json, formulas in TeX by name, is bundled as MathML, so that the page needs neither
// fonts nor a renderer.
import { readFileSync } from "node:fs";
import temml from "temml";

const rendered = (tex) => temml.renderToString(tex, { displayMode: true, throwOnError: true });

// The formulas of a file as [name, list of MathML].
export function formulasIn(path) {
  return Object.entries(JSON.parse(readFileSync(path, "utf8"))).map(([name, list]) => [name, list.map(rendered)]);
}

export const mathml = {
  name: "mathml",
  setup: (build) =>
    build.onLoad({ filter: /formulas\.json$/ }, ({ path }) => ({
      contents: JSON.stringify(Object.fromEntries(formulasIn(path))),
      loader: "json",
    })),
};
