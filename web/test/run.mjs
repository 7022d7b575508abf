// node test/run.mjs: bundles test/*.test.ts into a temporary folder and runs them.
import { build } from "esbuild";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { mathml } from "../mathml.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const tests = readdirSync(here).filter((name) => name.endsWith(".test.ts"));
const out = mkdtempSync(join(tmpdir(), "aspic-page-"));
await build({
  entryPoints: tests.map((name) => join(here, name)),
  bundle: true,
  external: ["node:*"], // packages are those of browsers
  format: "esm",
  outdir: out,
  outExtension: { ".js": ".mjs" },
  define: { "import.meta.dirname": JSON.stringify(here) }, // folder of the tests, not of their bundles
  loader: { ".css": "empty" },
  plugins: [mathml],
  logLevel: "warning",
});
const run = spawnSync(process.execPath, ["--test", ...tests.map((name) => join(out, name.replace(/\.ts$/, ".mjs")))], { stdio: "inherit" });
rmSync(out, { recursive: true });
process.exit(run.status ?? 1);
