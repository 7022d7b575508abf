// Formulas as MathML, so that pages need neither fonts nor a renderer. Their TeX comes from src/formulas.json by name, and
// from the literals R"tex(...)tex" of the materials, integrators and checks in C++.
import { readdirSync, readFileSync } from "node:fs";
import { basename, dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import temml from "temml";

const root = dirname(dirname(fileURLToPath(import.meta.url)));
const named = JSON.parse(readFileSync(join(root, "web/src/formulas.json"), "utf8"));

const rendered = (tex) => temml.renderToString(tex, { displayMode: true, throwOnError: true });

// [file name without its extension, text] of the sources in a folder.
function sources(folder, extension) {
  return readdirSync(join(root, folder))
    .filter((file) => file.endsWith(extension))
    .map((file) => [basename(file, extension), readFileSync(join(root, folder, file), "utf8")]);
}

// [file name without its extension, its TeX literals] of the sources that have some.
function literals(folder, extension) {
  return sources(folder, extension)
    .map(([name, text]) => [name, [...text.matchAll(/R"tex\((.*?)\)tex"/gs)].map((match) => match[1])])
    .filter(([, list]) => list.length > 0);
}

// Each material is a header of its name.
const materials = () => literals("src/material", ".h");

// Integrators by their name in IntegratorFacts; several are in one file.
function integrators() {
  const texts = [".h", ".cpp"].flatMap((extension) => sources("src/dynamics", extension));
  return texts.flatMap(([, text]) =>
    [...text.matchAll(/\.name = "(\w+)",\s*\.tex =\s*R"tex\((.*?)\)tex"/gs)].map(([, name, tex]) => [name, [tex]]),
  );
}

// Formulas of the program as [key, list of MathML]: named ones by name, the others by their TeX.
export function programFormulas() {
  const tex = new Set([...materials(), ...integrators(), ...literals("verification", "_checks.cpp")].flatMap(([, list]) => list));
  return [...Object.entries(named).map(([name, list]) => [name, list.map(rendered)]), ...[...tex].map((one) => [one, [rendered(one)]])];
}

// A plugin for esbuild: formulas.json, the materials and the integrators are bundled as MathML by name.
export const mathml = {
  name: "mathml",
  setup: (build) =>
    build.onLoad({ filter: /formulas\.json$/ }, () => ({
      contents: JSON.stringify(Object.fromEntries([...Object.entries(named), ...materials(), ...integrators()].map(([name, list]) => [name, list.map(rendered)]))),
      loader: "json",
    })),
};
