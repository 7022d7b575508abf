// node test/site/run.mjs [--all] [THEME ...]: tests the page of ./run site; tools/site_test starts it. A theme is a file
// THEME.site.mjs; all but speed without arguments. --all: every scene in Chromium and every page of the lecture, instead of samples.
import { spawnSync } from "node:child_process";
import { readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const chosen = process.argv.slice(2).filter((argument) => argument !== "--all");
const known = readdirSync(here).flatMap((name) => name.match(/^(.*)\.site\.mjs$/)?.[1] ?? []);
const unknown = chosen.filter((theme) => !known.includes(theme));
if (unknown.length > 0) throw new Error(`no such theme: ${unknown.join(", ")}; there are ${known.join(", ")}`);
const files = (chosen.length > 0 ? chosen : known.filter((theme) => theme !== "speed")).map((theme) => join(here, `${theme}.site.mjs`));
const env = { ...process.env, ASPIC_ALL: process.argv.includes("--all") ? "1" : "0" };
const run = spawnSync(process.execPath, ["--test", "--test-reporter=spec", "--test-concurrency=1", ...files], { stdio: "inherit", env });
process.exit(run.status ?? 1);
