// Lines of fibres on the surface.
import assert from "node:assert/strict";
import { test } from "node:test";
import { FibreLines, fibreEnds } from "../src/view/fibres";

const triangles = Uint32Array.of(0, 1, 2);
const positions = Float32Array.of(0, 0, 0, 3, 0, 0, 0, 3, 0);

test("a line lies about the centroid, slightly above the surface", () => {
  const ends = fibreEnds([0, 0.5, 0], triangles, positions);
  const expected = [0.25, 1, 0.09, 1.75, 1, 0.09];
  ends.forEach((x, i) => assert.ok(Math.abs(x - expected[i]!) < 1e-6, `${i}: ${x}`));
});

test("a line moves with its triangle", () => {
  const turned = Float32Array.of(0, 0, 0, 0, 3, 0, -3, 0, 0); // by 90 degrees about z
  const [before, after] = [positions, turned].map((x) => fibreEnds([0, 0.2, 0.4], triangles, x));
  for (let end = 0; end < 6; end += 3) {
    assert.ok(Math.abs(after![end]! + before![end + 1]!) < 1e-6);
    assert.ok(Math.abs(after![end + 1]! - before![end]!) < 1e-6);
  }
});

test("lines of another surface are not drawn", () => {
  const lines = new FibreLines();
  lines.set([5, 0.1, 0.1], triangles);
  lines.show(triangles, positions);
  assert.equal(lines.geometry.getAttribute("position"), undefined);
  lines.set([0, 0.1, 0.1], triangles);
  lines.show(triangles, positions);
  assert.equal(lines.geometry.drawRange.count, 2);
});
