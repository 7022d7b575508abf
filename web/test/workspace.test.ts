import assert from "node:assert/strict";
import { test } from "node:test";
import { fileName } from "../src/dom";
import { isWorkspace, parseRecording, parseWorkspace } from "../src/workspace";

test("a saved workspace reads back equal", () => {
  const saved = {
    aspic_workspace: 1,
    scene: "scenes/bunny.toml",
    overrides: ["time.step=0.005"],
    settings: { "material.young": 1e6, gravity: [0, -9.81, 0], "solver.method": "newton" },
    compare: { overrides: ["time.step=0.01"], label: "h" },
    page: { camera: { any: "thing" } },
  };
  const text = JSON.stringify(saved);
  assert.ok(isWorkspace(text));
  assert.deepEqual(parseWorkspace(text), saved);
});

test("a workspace keeps the files of its scene", () => {
  const files = [{ name: "bunny.toml", gzip: "H4sI" }];
  const read = (more: unknown) => parseWorkspace(JSON.stringify({ aspic_workspace: 1, scene: "bunny.toml", files: more }));
  assert.deepEqual(read(files).files, files);
  assert.equal(read([{ name: 3 }]).files, undefined);
});

test("a workspace ignores wrong and unknown parts", () => {
  const read = parseWorkspace(
    '{"aspic_workspace": 1, "scene": "x.toml", "overrides": [1], "settings": {"a": null, "b": {"c": 1}, "d": 2}, ' +
      '"compare": 7, "page": [], "more": 1}',
  );
  assert.deepEqual(read, {
    aspic_workspace: 1,
    scene: "x.toml",
    overrides: [],
    settings: { d: 2 },
    compare: null,
    page: {},
  });
});

test("rejects files that are no workspace", () => {
  assert.throws(() => parseWorkspace("solid cube"), /not JSON/);
  assert.throws(() => parseWorkspace("[1, 2]"), /not a workspace/);
  assert.throws(() => parseWorkspace("{}"), /not a workspace of Aspic/);
  assert.throws(() => parseWorkspace('{"aspic_workspace": 2, "scene": "x"}'), /version 2/);
  assert.throws(() => parseWorkspace('{"aspic_workspace": 1}'), /no scene/);
});

test("rejects files that are no recording", () => {
  assert.throws(() => parseRecording('{"scene": "x", "events": {}}'), /not a mouse recording/);
  assert.equal(parseRecording('{"scene": "x", "overrides": [], "compare": null, "events": [], "steps": 3}').steps, 3);
});

test("scene names become file names", () => {
  assert.equal(fileName("bunny", "png"), "bunny.png");
  assert.equal(fileName("../a b/c", "webm"), "a_b_c.webm");
  assert.equal(fileName("", "png"), "aspic.png");
});
