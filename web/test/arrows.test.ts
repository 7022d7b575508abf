// Arrows begin at their start and end at start plus vector.
import assert from "node:assert/strict";
import { test } from "node:test";
import * as THREE from "three";
import { arrowMatrices } from "../src/view/arrows";

test("matrices map the unit arrow to the vectors, also to zero and downward ones", () => {
  const vectors = [[1, 2, 3], [0, -2, 0], [0, 0, 0]];
  const matrices = arrowMatrices(Float32Array.from(vectors.flatMap((vector) => [5, 6, 7, ...vector])));
  vectors.forEach((vector, i) => {
    const tip = new THREE.Vector3(0, 1, 0).applyMatrix4(matrices[i]);
    const start = new THREE.Vector3().applyMatrix4(matrices[i]);
    assert.deepEqual(start.toArray(), [5, 6, 7]);
    tip.toArray().forEach((x, c) => assert.ok(Math.abs(x - start.getComponent(c) - vector[c]) < 1e-6));
  });
});
