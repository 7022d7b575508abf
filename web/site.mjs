// node site.mjs PAGE ENGINE ROOT OUT [THREADS]: writes OUT, the page with the engine, the shipped scenes and the bunny.
// ENGINE is the script engine.js of the compiler, beside engine.wasm. OUT needs no server: it works from a file, too.
// THREADS is ENGINE with threads, for a file of its own beside OUT: a page from a file cannot use it.
import { build, transform } from "esbuild";
import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, relative, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const here = dirname(fileURLToPath(import.meta.url));
const [page, engine, root, out, threads] = process.argv.slice(2);
if (!out) throw new Error("node site.mjs PAGE ENGINE ROOT OUT [THREADS]");

const kFolders = ["scenes", "scenes/gallery", "scenes/lecture"];

function shippedFiles() {
  const files = {};
  for (const folder of kFolders)
    for (const name of readdirSync(join(root, folder)))
      if (name.endsWith(".toml")) files[`/${folder}/${name}`] = readFileSync(join(root, folder, name), "utf8");
  for (const [scene, text] of Object.entries({ ...files }))
    for (const [, mesh] of text.matchAll(/^[^#\n]*"([\w.]+\.(?:mesh|obj))"/gm)) {
      const path = `${dirname(scene)}/${mesh}`;
      files[path] = readFileSync(join(root, path), "utf8");
    }
  return files;
}

// Pictures of scenes for the dialog, in base64: the first frames of the animated WebP files.
function stillPictures() {
  const names = readdirSync(join(root, "scenes/gallery")).filter((name) => name.endsWith(".webp"));
  return Object.fromEntries(names.map((name) => [`/scenes/gallery/${name}`, firstFrame(readFileSync(join(root, "scenes/gallery", name))).toString("base64")]));
}

// A frame is a chunk ANMF: tag, size, 16 bytes of placement, then the picture's own chunks.
function firstFrame(animation) {
  const start = animation.indexOf("ANMF");
  const frame = animation.subarray(start + 24, start + 8 + animation.readUInt32LE(start + 4));
  const head = Buffer.from("RIFF    WEBP");
  head.writeUInt32LE(4 + frame.length, 4);
  return Buffer.concat([head, frame]);
}

// As web/src/xz.ts unpacks it. Neither code nor texts have a period of 4 bytes, which LZMA would expect (pb). The dictionary
// is allocated when unpacking.
const kXz = ["--format=xz", "--check=crc32", "--lzma2=preset=9e,lc=4,pb=0,dict=8MiB", "--stdout"];
const packed = (bytes) => execFileSync("xz", kXz, { input: bytes, maxBuffer: 1e9 }).toString("base64");

async function workerScript() {
  const bundled = await build({ entryPoints: [join(here, "src/worker.ts")], bundle: true, minify: true, format: "iife", target: "es2022", write: false });
  return bundled.outputFiles[0].text;
}

const minified = async (path) => (await transform(readFileSync(path, "utf8"), { minify: true })).code;
const program = async (script) => ({ script: await minified(script), module: packed(readFileSync(script.replace(/\.js$/, ".wasm"))) });

// The first scene (web/src/engine.ts) as this engine shows it; the page shows it while its engine starts.
async function opening(script, files) {
  const [texts, pictures] = [[], []];
  const post = (message) => void (typeof message === "string" ? texts.push(message) : pictures.push(Buffer.from(message).toString("base64")));
  const wasmBinary = readFileSync(script.replace(/\.js$/, ".wasm"));
  const made = await createRequire(import.meta.url)(resolve(script))({ wasmBinary, post, isStopRequested: () => false });
  for (const [path, text] of Object.entries(files)) {
    made.FS.mkdirTree(dirname(path));
    made.FS.writeFile(path, text);
  }
  if (!made.ccall("engine_open", "boolean", ["string"], ["/scenes/bunny.toml"])) throw new Error(texts.at(-1));
  made.ccall("engine_run", "boolean", ["boolean"], [true]);
  const scene = texts.find((text) => JSON.parse(text).kind === "scene");
  return gzipSync(JSON.stringify({ scene, pictures }), { level: 9 }).toString("base64");
}

// Returns the name of the file, which differs for every version of the engine.
async function writeThreads() {
  const text = JSON.stringify({ ...(await program(threads)), threadScript: await minified(threads.replace(/\.js$/, ".worker.js")) });
  const name = `threads-${createHash("sha256").update(text).digest("hex").slice(0, 12)}.json`;
  writeFileSync(join(dirname(out), name), text);
  return name;
}

mkdirSync(dirname(out), { recursive: true });
for (const name of readdirSync(dirname(out))) if (/^threads-\w+\.json$/.test(name)) rmSync(join(dirname(out), name));
// Every "<" is escaped, because a script element ends at the first "</script", wherever it is.
const element = (id, content) => `<script type="application/json" id="${id}">${JSON.stringify(content).replaceAll("<", "\\u003c")}</script>`;

const files = shippedFiles();
const parts = {
  "engine-opening": await opening(engine, files),
  engine: await workerScript(),
  "engine-program": await program(engine),
  "engine-files": packed(Buffer.from(JSON.stringify({ ...files, ...stillPictures() }))),
  ...(threads ? { "engine-threads": await writeThreads() } : {}),
};
const html = readFileSync(page, "utf8").replace("<!-- recording -->", () => Object.entries(parts).map(([id, content]) => element(id, content)).join("\n"));
writeFileSync(out, html);

const size = (name, bytes) => `  ${name}: ${(bytes / 1e6).toFixed(2)} MB`;
console.log(`${relative(process.cwd(), out) || out}: ${(Buffer.byteLength(html) / 1e6).toFixed(2)} MB, ${(gzipSync(html).length / 1e6).toFixed(2)} MB compressed by gzip`);
const sizeOf = (base64) => (base64.length * 3) / 4;
console.log(size("engine, compressed", sizeOf(parts["engine-program"].module)));
console.log(size("first picture", sizeOf(parts["engine-opening"])));
console.log(size("scenes and meshes, compressed", sizeOf(parts["engine-files"])));
