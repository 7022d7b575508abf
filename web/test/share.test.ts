import assert from "node:assert/strict";
import { test } from "node:test";
import { linkText, pageText, workspaceOfLink } from "../src/share";
import type { Workspace } from "../src/workspace";
import { Duplex } from "node:stream";
import { createDeflateRaw, createInflateRaw } from "node:zlib";

// Node.js 18, that of Debian 12, lacks this format of browsers.
try {
  new CompressionStream("deflate-raw");
} catch {
  const streams = globalThis as unknown as Record<string, unknown>;
  streams.CompressionStream = function () {
    return Duplex.toWeb(createDeflateRaw());
  };
  streams.DecompressionStream = function () {
    return Duplex.toWeb(createInflateRaw());
  };
}

const kWorkspace: Workspace = {
  aspic_workspace: 1,
  scene: "/scenes/bunny.toml",
  overrides: ["time.step=0.02"],
  settings: { "material.young": 2e5, "name": "</script><b>é" },
  compare: { overrides: ["time.integrator=symplectic_euler"], label: "B" },
  page: { dock: "energy" },
};

test("a link holds its workspace in address characters", async () => {
  const link = await linkText(kWorkspace);
  assert.match(link, /^#s=[\w-]+$/);
  assert.deepEqual(await workspaceOfLink(link), kWorkspace);
  assert.equal(await workspaceOfLink("#lecture/33"), null);
});

test("damaged and foreign links are refused", async () => {
  const link = await linkText(kWorkspace);
  for (const damaged of [link.slice(0, -12), "#s=", "#s=%%%", `#s=${"A".repeat(400)}`, `${link}!`])
    await assert.rejects(workspaceOfLink(damaged), /damaged|not JSON/, damaged);
  await assert.rejects(workspaceOfLink(await linkText({ aspic_workspace: 7 } as unknown as Workspace)), /version 7/);
});

test("a link that unpacks to too much is refused", async () => {
  const bomb = await linkText({ ...kWorkspace, scene: "x".repeat(3_000_000) });
  assert.ok(bomb.length < 8000);
  await assert.rejects(workspaceOfLink(bomb), /more than 1 MB/);
});

test("a saved page has one workspace that cannot end its element", () => {
  const html = '<body><script type="application/json" id="engine">"x"</script></body>';
  const once = pageText(html, kWorkspace);
  const twice = pageText(once, { ...kWorkspace, scene: "/scenes/twist.toml" });
  const element = /<script type="application\/json" id="workspace">(.*?)<\/script>/;
  assert.deepEqual(JSON.parse(JSON.parse(element.exec(once)![1]) as string), kWorkspace);
  assert.equal(twice.match(/id="workspace"/g)?.length, 1);
  assert.ok(twice.includes("twist") && !twice.includes("bunny"));
  assert.ok(once.endsWith('id="engine">"x"</script></body>'));
});
