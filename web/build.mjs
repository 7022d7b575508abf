// node build.mjs OUT: the whole page, scripts and styles included, as one HTML file, and for the program, beside it, the
// packed page as page.inc and the formulas as formulas.inc. Needs no server and no network.
import { build } from "esbuild";
import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { mathml, mathStyle, programFormulas } from "./mathml.mjs";

const root = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2] ?? join(root, "page.html");

// Extensions register before main.ts runs (src/extensions.ts).
const extension = join(root, "../inverse/web/index.ts");
const parts = [...(existsSync(extension) ? [extension] : []), join(root, "src/main.ts")];
const result = await build({
  stdin: { contents: parts.map((part) => `import ${JSON.stringify(part)};`).join("\n"), resolveDir: root },
  nodePaths: [join(root, "node_modules")], // for the extension
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
const octal = (byte) => `\\${byte.toString(8).padStart(3, "0")}`;
writeFileSync(join(dirname(out), "page.inc"), `"${Array.from(gzipSync(page, { level: 9 }), octal).join("")}"\n`);
