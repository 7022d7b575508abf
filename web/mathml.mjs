// Formulas as MathML, so that pages need no renderer, and the part of a font that they use. Their TeX comes from
// src/formulas.json by name, and from the literals R"tex(...)tex" of the materials, integrators and checks in C++.
import { readdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { basename, dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import subsetFont from "subset-font";
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
  const tex = new Set([...materials(), ...integrators(), ...literals("tests/verification", "_checks.cpp")].flatMap(([, list]) => list));
  return [...Object.entries(named).map(([name, list]) => [name, list.map(rendered)]), ...[...tex].map((one) => [one, [rendered(one)]])];
}

// Code point of the italic letter that browsers show for a letter alone in an <mi>.
function italic(letter) {
  const code = letter.codePointAt(0);
  const special = { h: 0x210e, "∇": 0x1d6fb, "∂": 0x1d715, "ϵ": 0x1d716, "ϑ": 0x1d717, "ϕ": 0x1d719, "ϱ": 0x1d71a, "ϖ": 0x1d71b }[letter];
  if (special) return special;
  for (const [first, last, to] of [["A", "Z", 0x1d434], ["a", "z", 0x1d44e], ["Α", "Ω", 0x1d6e2], ["α", "ω", 0x1d6fc]])
    if (letter >= first && letter <= last) return to + code - first.codePointAt(0);
  return code;
}

// Style of formulas: browsers place subscripts and stretch signs by the table MATH of a font, which many machines lack.
export async function mathStyle() {
  const formulas = programFormulas().flatMap(([, list]) => list).join("");
  const italics = [...formulas.matchAll(/<mi>(.)<\/mi>/gu)].map(([, letter]) => String.fromCodePoint(italic(letter)));
  const file = createRequire(import.meta.url).resolve("@fontsource/stix-two-math/files/stix-two-math-latin-400-normal.woff2");
  const font = await subsetFont(readFileSync(file), formulas.replace(/<[^>]*>/g, "") + italics.join(""), { targetFormat: "woff2" });
  const source = `url(data:font/woff2;base64,${font.toString("base64")}) format("woff2")`;
  return `@font-face{font-family:"STIX Two Math";src:${source}}math{font-family:"STIX Two Math","Latin Modern Math","Cambria Math",math,serif}`;
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
