import assert from "node:assert/strict";
import { test } from "node:test";
import type { Vec3 } from "../../../web/src/protocol";
import type { Lens } from "../../../web/src/view/lens";
import type { Hit } from "../../../web/src/view/picking";
import type { TouchedView } from "../../../web/src/view/viewTool";
import { ForceCurve } from "../bench/curve";
import { columnsOf, inMillimeters, inNewtons } from "../bench/panel";
import { depthOf, inwardNormal, wayIn } from "../bench/pressing";
import type { IndenterState } from "../bench/protocol";
import { IndenterTool } from "../bench/tool";

const kTop = { positions: [0, 0, 1, 2, 0, 1, 0, 2, 1], triangles: [0, 1, 2] }; // seen from above
const kFront: Lens = { eye: [0, -10, 0], right: [1, 0, 0], up: [0, 0, 1], forward: [0, 1, 0], slope: 0.5, extent: 0, width: 400, height: 200 };

function indenter(change: Partial<IndenterState> = {}): IndenterState {
  const tip = { shape: "sphere", contact: "bonded", radius: 0.01, stiffness: 1e6 } as const;
  const place = { begun: [0, 0, 1] as Vec3, center: [0, 0, 1] as Vec3, axis: [0, 0, -1] as Vec3 };
  return { ...tip, ...place, depth: 0, wanted: 0, force: 0, ...change };
}

test("pressing follows the inward normal, or drags down", () => {
  const inward = inwardNormal(kTop.positions, kTop.triangles, 0);
  assert.ok(inward[2] < -0.99);
  const way = wayIn(kFront, [0, 0, 0], inward);
  assert.ok(Math.abs(way.direction[1] - 1) < 1e-9); // down on the screen
  assert.ok(Math.abs(depthOf(way, [5, 20]) - 20 * 0.05) < 1e-9); // 10 m high, 200 pixels
  const along = wayIn(kFront, [0, 0, 0], [0, 1, 0]);
  assert.deepEqual(along.direction, [0, 1]);
  assert.ok(depthOf(along, [0, 10]) > 0);
});

test("the curve keeps the latest force per depth", () => {
  const curve = new ForceCurve();
  assert.equal(curve.add(null), false);
  assert.ok(curve.add(indenter({ depth: 0.002, force: 2 })));
  assert.ok(curve.add(indenter({ depth: 0.001, force: 1 })));
  assert.equal(curve.add(indenter({ depth: 0.001, force: 1 })), false);
  assert.ok(curve.add(indenter({ depth: 0.002, force: 3 })));
  assert.deepEqual(curve.sorted(), [[0.001, 1], [0.002, 3]]);
  curve.add(indenter({ begun: [1, 0, 1], depth: 0, force: -4 }));
  assert.deepEqual(curve.sorted(), [[0, -4]]); // it pulls
});

test("a drag on the indenter presses it deeper", () => {
  const sent: Record<string, unknown>[] = [];
  const viewOf = (tool: IndenterState | null): TouchedView => {
    const source = { send: (command: Record<string, unknown>) => sent.push(command) };
    return { store: { source, state: { playing: true, a: { tool } } }, side: "a", lens: () => kFront, surface: () => kTop } as unknown as TouchedView;
  };
  const tool = new IndenterTool();
  const held = viewOf(indenter({ center: [0, 0, 0], wanted: 0.5 }));
  const gesture = tool.begin(held, [200, 100], null)!;
  gesture.flush();
  assert.deepEqual(sent, []); // it has not moved
  gesture.move(0, 10);
  gesture.flush();
  assert.equal(sent[0]!.do, "press");
  assert.ok(Math.abs((sent[0]!.depth as number) - 1) < 1e-9); // 10 pixels of 0.05 m

  assert.equal(tool.begin(held, [10, 10], null), null); // beside it, so the camera turns
  tool.choice.radius = 0.02;
  const hit: Hit = { triangle: 0, weights: [1, 0, 0], point: [0, 0, 1] } as Hit;
  tool.begin(viewOf(null), [200, 100], hit);
  assert.deepEqual(sent[1], { do: "touch", side: "a", triangle: 0, weights: [1, 0, 0], shape: "sphere", contact: "bonded", radius: 0.02 });
});

test("readings keep one unit at any size", () => {
  assert.deepEqual([0.0000012, 0.0234, 1.5].map(inMillimeters), ["0.0012 mm", "23.4 mm", "1500 mm"]);
  assert.deepEqual([0.0123, 4.567, 12345].map(inNewtons), ["0.0123 N", "4.57 N", "12345 N"]);
});

test("readings of one depth stay apart in the chart", () => {
  const reading = (force: number) => ({ name: "poke", radius: 0.01, depth: 0.006, force });
  const { depths, live, kept } = columnsOf([[0, 0], [0.006, 3]], [reading(3), reading(4)]);
  assert.ok(depths.every((depth, i) => i === 0 || depth > depths[i - 1]!));
  assert.deepEqual(live, [0, 3, null, null]);
  assert.deepEqual(kept, [null, null, 3, 4]);
});
