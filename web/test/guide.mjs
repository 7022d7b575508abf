// node test/guide.mjs PAGE [--write]: the shortcuts in docs/viewer.md are those of the page. PAGE is what build.mjs made;
// needs Chromium. --write brings the guide up to date.
import { readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { findChromium, launchChromium } from "./e2e/chromium.mjs";

const [pagePath, write] = process.argv.slice(2);
const guidePath = join(dirname(fileURLToPath(import.meta.url)), "../../docs/viewer.md");
if (!findChromium()) {
  console.log("no Chromium: skipped");
  process.exit(77);
}

// The list that "?" opens: groups of rows of a key and what it does.
async function listedShortcuts() {
  const browser = await launchChromium();
  try {
    const page = await browser.newPage();
    const body = readFileSync(pagePath, "utf8");
    await page.route("http://aspic.test/**", (route) => route.fulfill({ contentType: "text/html", body }));
    await page.routeWebSocket(/session/, () => {});
    await page.goto("http://aspic.test/");
    await page.keyboard.press("?");
    return await page.locator("dialog.shortcuts section").evaluateAll((sections) =>
      sections.map((section) => ({
        group: section.querySelector("h3").textContent,
        rows: [...section.querySelectorAll("tr")].map((row) => [...row.children].map((cell) => cell.textContent)),
      })),
    );
  } finally {
    await browser.close();
  }
}

function markdown(groups) {
  const item = ({ group, rows }) => `* ${group}: ${rows.map(([key, does]) => `\`${key}\` ${does}`).join("; ")}`;
  return groups.map(item).join("\n");
}

const guide = readFileSync(guidePath, "utf8");
const [start, end] = ["<!-- shortcuts -->\n", "\n<!-- end of shortcuts -->"];
const before = guide.slice(0, guide.indexOf(start) + start.length);
const after = guide.slice(guide.indexOf(end));
const wanted = before + markdown(await listedShortcuts()) + after;
if (wanted === guide) process.exit(0);
if (write === "--write") writeFileSync(guidePath, wanted);
else {
  console.error("docs/viewer.md lists other shortcuts than the page: node web/test/guide.mjs PAGE --write");
  process.exit(1);
}
