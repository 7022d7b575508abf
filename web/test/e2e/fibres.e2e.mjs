// Fibres are drawn on the surface and can be hidden.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join, relative } from "node:path";
import { test } from "node:test";
import { frames, keepPicture, openSession, root, settled, startProgram, temporaryFolder } from "./harness.mjs";

const folder = temporaryFolder();
writeFileSync(
  join(folder, "plate.toml"),
  `gravity = [0, 0, 0]
[[body]]
name = "plate"
shape = { box = { upper = [1, 1, 0.2], cells = [4, 4, 1] } }
[[body.pin]]
where = "x < 0.1"
[[body.fibre]]
stiffness = 1e3
direction = [1, 1, 0]
`,
);
const program = await startProgram(relative(root, join(folder, "plate.toml")));

// Number of red pixels in the 3-D picture.
const red = (page) =>
  page.locator("#views canvas").first().evaluate((canvas) => {
    const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d");
    copy.drawImage(canvas, 0, 0);
    const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) if (data[i] > 1.5 * data[i + 1] && data[i] > 1.2 * data[i + 2] && data[i] > 60) ++count;
    return count;
  });

test("fibres are lines on the surface", async () => {
  const opened = await openSession(program, { keepsPixels: true });
  const { page, heard, close } = opened;
  await settled(opened);
  const message = heard.messages.find(({ kind }) => kind === "fibres");
  assert.equal(message.lines.length % 3, 0);
  assert.ok(message.lines.length >= 3 * 64, "upper and lower side");
  await frames(page);
  for (const label of ["Wires", "Pins"]) {
    const box = page.locator("#right .lil-controller.lil-boolean").filter({ hasText: new RegExp(`^${label}$`) }).locator("input");
    assert.equal(await box.evaluate((input) => input.checked), false, `fibres are visible without ${label}`);
  }
  const shown = await red(page);
  await keepPicture(page, "fibres");
  await page.locator("#right .lil-controller").filter({ hasText: "Fibres" }).locator("input").first().evaluate((box) => box.click());
  await frames(page);
  const hidden = await red(page);
  assert.ok(shown > hidden + 100, `${shown} red pixels with fibres, ${hidden} without`);
  await close();
});
