import assert from "node:assert/strict";
import { test } from "node:test";
import { backTo, History, toLoaded } from "../src/history";
import type { Scene, Setting } from "../src/protocol";

const setting = (key: string, value: Setting["value"]): Setting => ({ key, value }) as Setting;
const scene = (overrides: string[], loaded: string[] = []): Scene =>
  ({
    overrides,
    loaded_overrides: loaded,
    settings: [setting("material.young", 2e5), setting("time.step", 0.01), setting("gravity", [0, -9.81, 0])],
  }) as unknown as Scene;

test("undo of a first change removes its override", () => {
  assert.deepEqual(backTo(scene([]), "material.young"), { key: "material.young", value: null });
});

test("undo of a second change restores the first", () => {
  assert.deepEqual(backTo(scene(["material.young=2e+05"]), "material.young", "b"), { key: "material.young", value: 2e5, side: "b" });
});

test("a reset undoes the latest change first", () => {
  const changed = scene(["mesh=\"bunny.mesh\"", "time.step=0.02", "material.young=2e+05"], ["mesh=\"bunny.mesh\"", "time.step=5e-4"]);
  assert.deepEqual(toLoaded(changed), [
    { key: "material.young", value: null },
    { key: "time.step", value: 5e-4 },
  ]);
});

test("a reset restores loaded vectors and texts", () => {
  const changed = scene(["gravity=[0, 0, 0]", "material.young=1e6"], ["gravity=[0, 1e+01, 0]", 'material.young="1e5 * X"']);
  assert.deepEqual(toLoaded(changed, "a"), [
    { key: "material.young", value: "1e5 * X", side: "a" },
    { key: "gravity", value: [0, 10, 0], side: "a" },
  ]);
});

test("a reset without changes does nothing", () => {
  assert.deepEqual(toLoaded(scene(["time.step=0.02"], ["time.step=0.02"])), []);
});

test("history returns the newest change first", () => {
  const history = new History();
  history.add([{ key: "material.young", value: null }]);
  history.add([]);
  history.add([{ key: "time.step", value: 0.01 }]);
  assert.deepEqual(history.pop(), [{ key: "time.step", value: 0.01 }]);
  history.clear();
  assert.equal(history.pop(), undefined);
});
