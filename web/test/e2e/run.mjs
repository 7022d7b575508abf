// node test/e2e/run.mjs ASPIC [THEME ...]: tests the page with its program in Chromium. Each theme is a file
// THEME.e2e.mjs. ASPIC_PICTURES=FOLDER saves pictures of the panels. Exits with 77 without Chromium.
import { spawnSync } from "node:child_process";
import { existsSync, mkdirSync, readdirSync } from "node:fs";
import { basename, dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { findChromium } from "./chromium.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const [aspic, ...chosen] = process.argv.slice(2);
if (!aspic || !existsSync(aspic)) throw new Error("node test/e2e/run.mjs ASPIC [THEME ...]");
if (!findChromium()) {
  console.log("skipped: there is no Chromium (Debian: apt-get install chromium)");
  process.exit(77);
}
const folders = [here, join(here, "../../../inverse/web/test/e2e")].filter((folder) => existsSync(folder));
const known = new Map(folders.flatMap((folder) => readdirSync(folder).filter((name) => name.endsWith(".e2e.mjs")).map((name) => [basename(name, ".e2e.mjs"), join(folder, name)])));
const unknown = chosen.filter((theme) => !known.has(theme));
if (unknown.length > 0) throw new Error(`no such theme: ${unknown.join(", ")}; there are ${[...known.keys()].join(", ")}`);
const files = (chosen.length > 0 ? chosen : [...known.keys()]).map((theme) => known.get(theme));
const env = { ...process.env, ASPIC: resolve(aspic) };
if (env.ASPIC_PICTURES) mkdirSync((env.ASPIC_PICTURES = resolve(env.ASPIC_PICTURES)), { recursive: true });
const run = spawnSync(process.execPath, ["--test", "--test-reporter=spec", "--test-concurrency=1", ...files], { stdio: "inherit", env });
process.exit(run.status ?? 1);
