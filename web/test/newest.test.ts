import assert from "node:assert/strict";
import { test } from "node:test";
import { Newest } from "../src/newest";

const turn = (): Promise<void> => new Promise((resolve) => setImmediate(resolve));

test("sends only the newest value after each answer", async () => {
  const sent: number[] = [];
  let answer: () => void = () => {};
  let rests = 0;
  const newest = new Newest<number>(
    (value) => {
      sent.push(value);
      return new Promise<void>((resolve) => (answer = resolve));
    },
    () => assert.fail(),
    () => (rests += 1),
  );
  for (const value of [1, 2, 3]) newest.push(value);
  assert.deepEqual(sent, [1]);
  answer();
  await turn();
  assert.deepEqual(sent, [1, 3]);
  assert.equal(newest.busy, true);
  answer();
  await turn();
  assert.equal(newest.busy, false);
  assert.equal(rests, 1);
});

test("a refusal is reported, the next value sent", async () => {
  const failures: unknown[] = [];
  const newest = new Newest<number>(
    (value) => (value < 0 ? Promise.reject(new Error("negative")) : Promise.resolve()),
    (reason) => failures.push(reason),
  );
  newest.push(-1);
  await turn();
  newest.push(1);
  await turn();
  assert.equal(failures.length, 1);
  assert.equal(newest.busy, false);
});
