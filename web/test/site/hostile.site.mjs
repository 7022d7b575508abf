// Links whose author is unknown: whatever they contain, the page reports it in words and continues.
import assert from "node:assert/strict";
import { test } from "node:test";
import { gzipSync } from "node:zlib";
import { answered, pageModule, pressAndWait, settled, until } from "../e2e/harness.mjs";
import { loadScene, openSite, places, takeSteps } from "./site.mjs";

const { linkText } = await pageModule("share.ts");
const linkOf = (parts) => linkText({ aspic_workspace: 1, scene: "/scenes/cantilever.toml", overrides: [], settings: {}, compare: null, page: {}, ...parts });

const errors = (opened) => opened.page.locator(".notice.error span");
const change = (opened, hash) => opened.page.evaluate((text) => void (location.hash = text), hash);

// Random bytes, always the same.
function garbage(count, seed) {
  let state = seed;
  const next = () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) >>> 24;
  return Buffer.from(Array.from({ length: count }, next));
}

// Longer than the times after which notices vanish, so that none is missed.
const keepNotices = (page) => page.addInitScript(() => (window.setTimeout = ((set) => (work, time) => set(work, time >= 5000 ? 1e6 : time))(window.setTimeout)));

async function reported(opened, what, pattern) {
  let texts = [];
  const isReported = async () => {
    texts = await errors(opened).allTextContents();
    return pattern.test(texts.join("\n"));
  };
  await until(`a report about ${what}`, isReported, () => texts.join("\n")); // one about the link before it may be late
  assert.ok(texts.every((text) => text.length < 1000), `${what}: ${texts.join("\n").slice(0, 2000)}`);
  for (const dismiss of await opened.page.locator(".notice.error button").all()) await dismiss.click();
}

async function stillWorks(opened) {
  await loadScene(opened, "cantilever");
  await takeSteps(opened, 2);
  assert.equal(await opened.page.evaluate(() => window.isOvertaken), undefined);
}

test("damaged links are reported", async () => {
  const opened = await openSite(`${places["a file"]}#s=damaged`, "bunny", { prepare: keepNotices });
  await reported(opened, "damaged", /The link is damaged/);
  const whole = (await linkOf({ scene: "/scenes/twist.toml" })).slice(3);
  const damaged = ["", "%00", "<script>", whole.slice(0, -9), `${whole}%`, "A".repeat(100_000), ...Array.from({ length: 30 }, (_, i) => garbage(1 + 40 * i, i).toString("base64url"))];
  for (const text of damaged) {
    await change(opened, `#s=${text}`);
    await reported(opened, text, /The link is damaged|not JSON/);
  }
  await change(opened, await linkOf({ scene: "x".repeat(3_000_000) }));
  await reported(opened, "a link that unpacks to too much", /more than 1 MB/);
  for (const hash of ["#lecture/9999", "#lecture/-1", "#lecture/<b>", "#%%%", "#"]) await change(opened, hash);
  await stillWorks(opened);
  await opened.close();
});

const set = (...overrides) => ({ overrides });
const young = (formula) => set(`body.0.material.young="${formula}"`);
const kRefused = [
  ["too many tets", set("body.0.shape.box.cells=[400, 400, 400]"), /tets/],
  ["endless cells", set("body.0.shape={box={upper=[1, 1, 1], size=1e-300}}"), /size|tets/],
  ["a huge sphere", set("body.0.shape={sphere={radius=1e9, size=1e-3}}"), /size|tets/],
  ["too many tets in the comparison", { compare: { label: "B", overrides: ["body.0.shape.box.cells=[400, 400, 400]"] } }, /tets/],
  ["a formula that is too long", young(`1e5${" + 1".repeat(600)}`), /characters; at most/],
  ["a formula of towers", young("9^9^9^9^9^9^9^9^9"), /young/],
  ["nested parentheses", young(`${"(".repeat(240)}1e5${")".repeat(240)}`), /young|nested|"\(/],
  ["an unknown function", young("while(1)"), /while/],
  ["nested lists", set(`gravity=${"[".repeat(4000)}`), /nested|nesting|depth/],
  ["nested tables", set(`gravity=${"{a=".repeat(1300)}`), /nested|nesting|depth/],
  ["nested keys", set(`${"body.".repeat(800)}x=1`), /unknown key/],
  ["a long key", set(`${"x".repeat(4000)}=1`), /unknown key/],
  ["a long override", set(`time.step=${"1".repeat(900_000)}`), /4096 bytes/],
  ["a key of objects", set("__proto__.polluted=1"), /__proto__/],
  ["ten thousand overrides", set(...Array.from({ length: 10_000 }, (_, i) => `k${i}=1`)), /at most 200/],
  ["a file outside of the page", { scene: "/etc/passwd" }, /./],
  ["a folder above", { scene: "../../../../proc/self/environ" }, /./],
  ["a mesh outside of the page", set('body.0.mesh="/etc/passwd"'), /./],
  ["files with names above", { scene: "a.toml", files: [{ name: "../../scenes/bunny.toml", gzip: gzipSync("x = 1").toString("base64") }] }, /name|path|\.\./],
  ["a gzip bomb", { scene: "a.obj", files: [{ name: "a.obj", gzip: gzipSync(Buffer.alloc(600e6)).toString("base64") }] }, /bytes/],
  ["files that are no gzip", { scene: "a.obj", files: [{ name: "a.obj", gzip: garbage(3000, 1).toString("base64") }] }, /gzip/],
  ["a scene of garbage", { scene: "a.toml", files: [{ name: "a.toml", gzip: gzipSync(garbage(30_000, 2)).toString("base64") }] }, /a\.toml/],
  ["a scene with code", { scene: "<img src=x onerror=isOvertaken=1>.toml" }, /img/],
];

test("links with hostile scenes are refused", async () => {
  const opened = await openSite(places["a file"], "bunny", { prepare: keepNotices });
  for (const [what, parts, why] of kRefused) {
    await change(opened, await linkOf(parts));
    await reported(opened, what, why);
  }
  await stillWorks(opened);
  await opened.close();
});

const kStrange = [
  ["a label with code", { compare: { label: "<img src=x onerror=isOvertaken=1>", overrides: ["time.step=0.02"] } }],
  ["settings without meaning", { settings: { __proto__: 1, constructor: "x", "time.step": "x".repeat(1e5), "material.young": [1e300], "solver.method": true } }],
  ["a page without meaning", { page: Object.fromEntries(["dock", "display", "camera", "sidebar", "theme", "__proto__"].map((key) => [key, { x: [NaN, "<b>", { y: -1e308 }] }])) }],
  ["steps without length", set("time.step=1e-300", "time.duration=1e300")],
  ["an infinite duration", set("time.duration=1e308")],
];

test("links with strange settings leave a page that works", async () => {
  const opened = await openSite(places["a file"], "bunny", { prepare: keepNotices });
  const isLoad = ({ do: what }) => what === "load";
  for (const [what, parts] of kStrange) {
    const hash = await linkOf(parts);
    await answered(opened, what, isLoad, () => change(opened, hash));
    await settled(opened);
    await stillWorks(opened);
  }
  await opened.close();
});

// Gradient descent that needs minutes for a step.
const kEndless = set("body.0.shape.box.cells=[41, 5, 5]", "solver.method=gradient_descent", "solver.tolerance=1e-12", "solver.max_iterations=1000000000");

test("a step without end is left for another link", async () => {
  const opened = await openSite(places["a file"] + (await linkOf(kEndless)), "cantilever");
  await opened.page.keyboard.press("s");
  await opened.until("the command", ({ sent }) => sent.some((text) => text.includes('"step"')));
  await change(opened, await linkOf({ scene: "/scenes/twist.toml" }));
  await opened.until("the scene twist", ({ scenes }) => scenes.a.name === "twist");
  await pressAndWait(opened, "s", "a step", ({ state }) => state.a.step === 1);
  await opened.close();
});
