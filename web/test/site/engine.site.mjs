// The engine of the page under Node.js.
import assert from "node:assert/strict";
import { test } from "node:test";
import { gzipSync } from "node:zlib";
import { element, engineInNode, html } from "./site.mjs";

// Sends each command, then takes a step. Returns the refusals.
function refusals({ messages, handle }, commands) {
  return commands.flatMap((command) => {
    messages.length = 0;
    handle({ ...command, id: 1 });
    handle({ do: "step" });
    const { kind, why } = messages.find(({ id }) => id === 1);
    return kind === "refused" ? [`${JSON.stringify(command)}: ${why}`] : [];
  });
}

test("the engine runs every scene and every page of the lecture", async () => {
  const engine = await engineInNode("/scenes/bunny.toml");
  const { lessons } = engine.messages.find(({ kind }) => kind === "hello");
  engine.handle({ ask: "gallery", id: 2 });
  const { scenes } = engine.messages.find(({ id }) => id === 2).reply;
  assert.ok(scenes.length >= 20 && lessons.length >= 20, `${scenes.length} scenes, ${lessons.length} lessons`);
  assert.deepEqual(lessons.filter(({ missing }) => missing), []);
  const failed = refusals(engine, [
    ...scenes.map(({ path }) => ({ do: "load", scene: path })),
    ...lessons.map(({ id }) => ({ do: "lesson", lesson: id })),
  ]);
  assert.deepEqual(failed, []);
});

const [kMostEngine, kMostPage] = [1e6, 1.8e6]; // bytes, compressed: the engine as in the page, the page by gzip

test("commands are refused in words, with threads as without", async () => {
  for (const workers of [0, 3]) {
    const opened = await engineInNode("/scenes/cantilever.toml", workers);
    const commands = [{ do: "load", scene: "/scenes/cantilever.toml", overrides: ["nonsense=1"] }, { do: "set", side: "a", key: "time.step", value: -1 }];
    assert.equal(refusals(opened, commands).length, 2, `${workers} workers`);
    opened.engine.PThread?.terminateAllThreads();
  }
});

test("the sizes are within their limits", () => {
  const engine = element("engine-program").module.length * 0.75;
  const page = gzipSync(html, { level: 9 }).length;
  console.log(`engine: ${(engine / 1e6).toFixed(2)} MB, page: ${(page / 1e6).toFixed(2)} MB, both compressed`);
  assert.ok(engine <= kMostEngine && page <= kMostPage);
});

test("a thousand resets do not grow the memory", async () => {
  const { messages, bytes, handle } = await engineInNode("/scenes/cantilever.toml");
  const reset = (count) => {
    for (let i = 0; i < count; ++i) {
      handle({ do: "step" });
      handle({ do: "reset" });
      messages.length = 0;
    }
    return bytes();
  };
  const before = reset(100);
  assert.equal(reset(1000), before);
});

test("an exhausted memory is reported in words", async () => {
  const { engine, messages, handle } = await engineInNode("/scenes/cantilever.toml");
  const taken = [];
  for (const bytes of [256, 16, 1].map((mebibytes) => mebibytes << 20))
    for (let place; (place = engine._malloc(bytes)) !== 0; ) taken.push(place);
  handle({ do: "load", scene: "/scenes/bunny.toml", id: 1 });
  assert.match(messages.find(({ id }) => id === 1).why, /not enough memory/);
  taken.forEach((place) => engine._free(place));
  handle({ do: "step" });
  assert.equal(messages.findLast(({ kind }) => kind === "state").a.step, 1, "the scene before it continues");
});
