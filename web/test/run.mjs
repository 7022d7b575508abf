// node test/run.mjs: bundles test/*.test.ts, also those of inverse/web, into a temporary folder and runs them.
import { build } from "esbuild";
import { spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { mathml } from "../mathml.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const folders = [here, join(here, "../../inverse/web/test")].filter((folder) => existsSync(folder));
const tests = folders.flatMap((folder) => readdirSync(folder).filter((name) => name.endsWith(".test.ts")).map((name) => join(folder, name)));
const out = mkdtempSync(join(tmpdir(), "aspic-page-"));
await build({
  entryPoints: Object.fromEntries(tests.map((file) => [basename(file, ".ts"), file])),
  nodePaths: [join(here, "../node_modules")],
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
const run = spawnSync(process.execPath, ["--test", ...tests.map((file) => join(out, `${basename(file, ".ts")}.mjs`))], { stdio: "inherit" });
rmSync(out, { recursive: true });
process.exit(run.status ?? 1);
