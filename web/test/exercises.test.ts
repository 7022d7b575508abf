// Exercises beside the lecture: data, comparison of numbers, places of errors, progress.
import assert from "node:assert/strict";
import { test } from "node:test";
import { energyFormula } from "../src/exercises/cases";
import { callText, difference } from "../src/exercises/check";
import { exercises } from "../src/exercises/exercises";
import { keepProgress, progressFile, progressOf } from "../src/exercises/progress";
import { lineOf } from "../src/exercises/run";
import { formulasOf } from "../src/formulas";

const functionOf = (code: string, name: string): ((...values: unknown[]) => unknown) => new Function(`${code}; return ${name};`)();

test("each exercise has a page, hints and code that defines its function", () => {
  assert.equal(new Set(exercises.map(({ id }) => id)).size, exercises.length);
  for (const { id, lesson, formula, hints, entry, code, solution } of exercises) {
    assert.ok(formulasOf(lesson).length > 0 && (formula === "" || formulasOf(formula).length > 0), id);
    assert.ok(hints.length >= 2, id);
    for (const text of [code, solution]) assert.equal(typeof functionOf(text, entry), "function", id);
  }
});

test("the formula for the engine is E of the solution", () => {
  const { solution } = exercises.find(({ id }) => id === "energy")!;
  const q = [0.6, -0.9, 1.3, -1.2];
  const chain = { h: 0.05, g: 9.81, k: 200, L: 0.8, m: [0.5, 0.25], predicted: [0.7, -0.8, 1.2, -1.4] };
  const expected = functionOf(solution, "E")(q, chain) as number;
  for (const [i, j] of [[0, 1], [1, 2], [0, 3]] as const) {
    const formula = energyFormula(q, chain, i, j).replaceAll("^", "**").replaceAll("sqrt", "Math.sqrt");
    const value = new Function("x", "y", `return ${formula}`)(q[i], q[j]);
    assert.ok(Math.abs(value - expected) < 1e-12 * expected);
  }
});

test("the first wrong entry is named", () => {
  assert.equal(difference([[1, 2], [3, 4 + 1e-8]], [[1, 2], [3, 4]]), null);
  assert.match(difference([[1, 2], [3, 5]], [[1, 2], [3, 4]])!, /^your result\[1\]\[1\] is 5, expected: 4$/);
  assert.match(difference([1], [1, 2])!, /a list of 1, expected: a list of 2$/);
  assert.match(difference(null, 3)!, /is a return missing\?, expected: 3/);
  assert.match(difference("NaN", 3)!, /is NaN, expected: 3/);
  assert.match(difference({ x: 1 }, [1])!, /expected: a list of 1/);
});

test("a wrong result names all values", () => {
  const text = callText("E", [[0.9, -0.7], { h: 0.1, m: [0.5] }, "rosenbrock"]);
  assert.equal(text, "E([0.9, -0.7], { h: 0.1, m: [0.5] }, rosenbrock)");
});

test("the line of an error is that of the reader's code", () => {
  const chromium = "Error\n    at f (blob:null/1-2:40:3)\n    at psi (blob:null/1-2:3:15)";
  assert.equal(lineOf(chromium, 10), 3);
  assert.equal(lineOf("psi@blob:http://127.0.0.1:1/1-2:4:1", 10), 4);
  assert.equal(lineOf("no place", 10), null);
});

test("progress survives without storage and is exported", () => {
  const [first, second] = exercises;
  const none = { passing: "", tries: 0, hints: 0, solution: false };
  assert.deepEqual(progressOf(first!), { ...none, code: first!.code });
  keepProgress(first!, { ...none, passing: "right", tries: 2, hints: 1, code: "wrong" });
  assert.deepEqual(progressOf(first!), { ...none, passing: "right", tries: 2, hints: 1, code: "wrong" });
  keepProgress(second!, { ...none, code: "y" });
  assert.deepEqual(JSON.parse(progressFile("A B", exercises)), { aspic_exercises: 1, exercises: [{ name: "A B", exercise: first!.id, tries: 2, hints: 1, solution: false, passed: true, code: "right" }] });
});
