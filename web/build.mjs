// node build.mjs OUT: the whole page, scripts and styles included, as one HTML file, packed as OUT.gz, and beside it the
// formulas as formulas.inc. Needs no server and no network.
import { build } from "esbuild";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { mathml, mathStyle, programFormulas } from "./mathml.mjs";

const root = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2] ?? join(root, "page.html");

const result = await build({
  entryPoints: [join(root, "src/main.ts")],
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2022",
  loader: { ".css": "css" },
  plugins: [mathml],
  outdir: "memory",
  write: false,
  legalComments: "inline",
  logLevel: "warning",
});
const text = (extension) => result.outputFiles.find((file) => file.path.endsWith(extension)).text;
// A script element ends at the first "</script", wherever it is.
const script = text(".js").replaceAll("</script", "<\\/script");
const style = await mathStyle();
const page = readFileSync(join(root, "src/index.html"), "utf8")
  .replace("<!-- style -->", () => `<style>${style}${text(".css")}</style>`)
  .replace("<!-- script -->", () => `<script>${script}</script>`);
mkdirSync(dirname(out), { recursive: true });
// For the pages that the program writes itself: the entries of a table in C++.
const literal = (text) => `R"math(${text})math"`;
const entries = [["style", [`<style>${style}</style>`]], ...programFormulas()].map(([key, list]) => `{${literal(key)}, {${list.map(literal).join(", ")}}},\n`);
writeFileSync(join(dirname(out), "formulas.inc"), entries.join(""));
writeFileSync(out, page);
writeFileSync(`${out}.gz`, gzipSync(page, { level: 9 }));
