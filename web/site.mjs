// node site.mjs PAGE ENGINE ROOT OUT: writes OUT, the page with the engine, the shipped scenes and the bunny. ENGINE is the
// script engine.js of the compiler, beside engine.wasm. OUT needs no server: it works from a file, too.
import { build, transform } from "esbuild";
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join, relative } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const here = dirname(fileURLToPath(import.meta.url));
const [page, engine, root, out] = process.argv.slice(2);
if (!out) throw new Error("node site.mjs PAGE ENGINE ROOT OUT");

const kFolders = ["scenes", "scenes/lecture"];

function shippedFiles() {
  const files = {};
  for (const folder of kFolders)
    for (const name of readdirSync(join(root, folder)))
      if (name.endsWith(".toml")) files[`/${folder}/${name}`] = readFileSync(join(root, folder, name), "utf8");
  for (const text of Object.values({ ...files }))
    for (const [, path] of text.matchAll(/^[^#\n]*"(?:\.\.\/)+(assets\/[\w.]+)"/gm)) files[`/${path}`] = readFileSync(join(root, path), "utf8");
  return files;
}

async function workerScript() {
  const bundled = await build({ entryPoints: [join(here, "src/worker.ts")], bundle: true, minify: true, format: "iife", target: "es2022", write: false });
  const { code } = await transform(readFileSync(engine, "utf8"), { minify: true });
  return code + bundled.outputFiles[0].text;
}

const packed = (bytes) => gzipSync(bytes, { level: 9 }).toString("base64");
// Every "<" is escaped, because a script element ends at the first "</script", wherever it is.
const element = (id, text) => `<script type="application/json" id="${id}">${JSON.stringify(text).replaceAll("<", "\\u003c")}</script>`;

const parts = {
  engine: await workerScript(),
  "engine-module": packed(readFileSync(engine.replace(/\.js$/, ".wasm"))),
  "engine-files": packed(JSON.stringify(shippedFiles())),
};
const html = readFileSync(page, "utf8").replace("<!-- recording -->", () => Object.entries(parts).map(([id, text]) => element(id, text)).join("\n"));
mkdirSync(dirname(out), { recursive: true });
writeFileSync(out, html);

const size = (name, text) => `  ${name}: ${(Buffer.byteLength(text) / 1e6).toFixed(2)} MB`;
console.log(`${relative(process.cwd(), out) || out}: ${(Buffer.byteLength(html) / 1e6).toFixed(2)} MB, ${(gzipSync(html).length / 1e6).toFixed(2)} MB compressed by gzip`);
console.log(size("engine, compressed", Buffer.from(parts["engine-module"], "base64")));
console.log(size("scenes and meshes, compressed", Buffer.from(parts["engine-files"], "base64")));
