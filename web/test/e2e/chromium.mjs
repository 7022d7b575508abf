// Browser of the tests: Debian's Chromium, which renders without a graphics card.
import { existsSync } from "node:fs";

const kArguments = [
  "--no-sandbox",
  "--use-gl=angle",
  "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
  "--no-first-run",
];

export function findChromium() {
  return ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(existsSync);
}

export async function launchChromium(more = []) {
  const { chromium } = await import("playwright-core");
  return chromium.launch({ executablePath: findChromium(), args: [...kArguments, ...more] });
}
