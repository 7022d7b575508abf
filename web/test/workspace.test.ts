import assert from "node:assert/strict";
import { test } from "node:test";
import { fileName } from "../src/video";
import { isWorkspace, parseRecording, parseWorkspace } from "../src/workspace";

test("a workspace reads back what was saved", () => {
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

test("what a workspace has wrong or too much is left out", () => {
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

test("a file that is no workspace is refused in words", () => {
  assert.throws(() => parseWorkspace("solid cube"), /no JSON/);
  assert.throws(() => parseWorkspace("[1, 2]"), /no workspace/);
  assert.throws(() => parseWorkspace("{}"), /no workspace of Aspic/);
  assert.throws(() => parseWorkspace('{"aspic_workspace": 2, "scene": "x"}'), /version 2/);
  assert.throws(() => parseWorkspace('{"aspic_workspace": 1}'), /no scene/);
});

test("a file that is no recording is refused in words", () => {
  assert.throws(() => parseRecording('{"scene": "x", "events": {}}'), /no recording/);
  assert.equal(parseRecording('{"scene": "x", "overrides": [], "compare": null, "events": [], "steps": 3}').steps, 3);
});

test("the name of a scene becomes the name of a file", () => {
  assert.equal(fileName("bunny", "png"), "bunny.png");
  assert.equal(fileName("../a b/c", "webm"), "a_b_c.webm");
  assert.equal(fileName("", "png"), "aspic.png");
});
