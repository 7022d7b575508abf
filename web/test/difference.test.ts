// The sides of a comparison: their distance as a color, and their names.
import assert from "node:assert/strict";
import { test } from "node:test";
import { nameOfA } from "../src/presets";
import type { Scene, Setting } from "../src/protocol";
import type { Side } from "../src/store";
import { differenceOf, largestShown } from "../src/view/difference";

const side = (time: number, ...x: number[]): Side =>
  ({ geometry: { triangles: Uint32Array.of(0, 1, 2) }, picture: { time, positions: Float32Array.from(x) } }) as unknown as Side;

test("sides at one time have a distance per vertex", () => {
  const [a, b] = [side(1, 0, 0, 0, 1, 1, 1), side(1, 3, 4, 0, 1, 1, 1)];
  assert.deepEqual([...differenceOf(a, b)!], [5, 0]);
});

test("a side that has blown up does not set the range of the colors", () => {
  const scene = { lower: [0, 0, 0], upper: [3, 4, 0] } as unknown as Scene;
  assert.equal(largestShown(Float32Array.of(0, 7), scene), 7);
  assert.equal(largestShown(Float32Array.of(0, 2.5e13), scene), 50);
});

test("other times keep the distance, other surfaces have none", () => {
  assert.equal(differenceOf(side(1, 0, 0, 0), side(2, 0, 0, 0)), undefined);
  assert.equal(differenceOf(side(1, 0, 0, 0), side(1, 0, 0, 0, 1, 1, 1)), null);
  assert.equal(differenceOf(side(1, 0, 0, 0), null), null);
});

test("side A is named by what side B changes", () => {
  const scene = (settings: Partial<Setting>[]): Scene => ({ settings }) as unknown as Scene;
  const of = (key: string, label: string, value: number | string, unit = ""): Partial<Setting> => ({ key, label, value, unit });
  const test = (value: string): Partial<Setting> => of("solver.line_search.test", "Decrease test", value);
  assert.equal(nameOfA(scene([test("textbook")]), scene([test("none")])), "with line search");
  const step = (value: number): Partial<Setting> => of("time.step", "Time step h", value, "s");
  assert.equal(nameOfA(scene([step(0.01), test("slide")]), scene([step(0.005), test("slide")])), "h = 10 ms");
  assert.equal(nameOfA(scene([step(0.01)]), scene([step(0.01)])), "");
});
