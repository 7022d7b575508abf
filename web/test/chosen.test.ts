import assert from "node:assert/strict";
import { test } from "node:test";
import { Chosen } from "../src/plots/chosen";
import { Page } from "../src/page";
import type { IterationReply, Query, Scene, ServerMessage, StepRow } from "../src/protocol";
import { Refusal, type Incoming, type Source } from "../src/source";
import { Store } from "../src/store";
import { iterationRow, stepRow } from "./rowsOfSteps";

interface Asked {
  step: number;
  iteration: number;
  answer: (reason?: string | Error) => void; // the program refuses
}

class Stub implements Source {
  readonly live = true;
  readonly asked: Asked[] = [];
  receive: (incoming: Incoming) => void = () => {};
  start(receive: (incoming: Incoming) => void): void {
    this.receive = receive;
  }
  send(): void {}
  request(): Promise<unknown> {
    return Promise.resolve();
  }
  ask<Reply>(query: Query): Promise<Reply> {
    const { step, iteration } = query as { step: number; iteration: number };
    return new Promise((resolve, reject) => {
      const answer = (why?: string | Error): void =>
        why ? reject(typeof why === "string" ? new Error(why) : why) : resolve({ step, iteration } as IterationReply as Reply);
      this.asked.push({ step, iteration, answer });
    });
  }
  ready(): void {}
  emit(message: ServerMessage): void {
    this.receive({ message });
  }
}

const rows = (from: number, count: number): StepRow[] =>
  Array.from({ length: count }, (_, i) =>
    stepRow({ step: from + i + 1, iterations: [iterationRow(), iterationRow(), iterationRow()] }),
  );
const settled = (): Promise<void> => new Promise((resolve) => setTimeout(resolve));

function opened(): { source: Stub; chosen: Chosen } {
  const source = new Stub();
  const store = new Store(source);
  const chosen = new Chosen(store, new Page());
  store.start();
  source.emit({ kind: "scene", side: "a", generation: 1, potentials: [] } as unknown as Scene);
  source.emit({ kind: "steps", side: "a", from: 0, steps: rows(0, 5) });
  return { source, chosen };
}

test("the newest step is chosen by default", () => {
  const { source, chosen } = opened();
  assert.equal(chosen.step, 5);
  chosen.choose("a", 2, 1);
  source.emit({ kind: "steps", side: "a", from: 5, steps: rows(5, 3) });
  assert.deepEqual([chosen.step, chosen.iteration, chosen.following], [2, 1, false]);
  chosen.follow(true);
  assert.equal(chosen.step, 8);
});

test("walking crosses steps and stops at the ends", () => {
  const { chosen } = opened();
  chosen.choose("a", 2, 2);
  chosen.walk(1);
  assert.deepEqual([chosen.step, chosen.iteration], [3, 0]);
  chosen.walk(-1);
  assert.deepEqual([chosen.step, chosen.iteration], [2, 2]);
  chosen.choose("a", 5, 2);
  chosen.walk(1);
  assert.deepEqual([chosen.step, chosen.iteration], [5, 2]);
});

test("only the newest question follows an answer", async () => {
  const { source, chosen } = opened();
  for (const step of [1, 2, 3]) {
    chosen.choose("a", step, 0);
    chosen.request();
    chosen.request();
  }
  assert.deepEqual(
    source.asked.map((q) => q.step),
    [1],
  );
  source.asked[0]!.answer();
  await settled();
  assert.deepEqual(
    source.asked.map((q) => q.step),
    [1, 3],
  );
  assert.ok(chosen.seen?.reply && !chosen.isSeen());
  source.asked[1]!.answer();
  await settled();
  assert.ok(chosen.isSeen());
});

const playing = { kind: "state", playing: true, a: { step: 5, time: 0.05, iteration: -1 }, b: null };

test("automatic questions pause, a reader's choice does not", async () => {
  const { source, chosen } = opened();
  source.emit(playing as unknown as ServerMessage);
  chosen.request();
  await new Promise((resolve) => setTimeout(resolve, 30));
  source.asked[0]!.answer();
  await settled();
  source.emit({ kind: "steps", side: "a", from: 5, steps: rows(5, 1) });
  chosen.follow(true);
  chosen.request();
  assert.equal(source.asked.length, 1);
  chosen.choose("a", 3, 1);
  chosen.request();
  assert.equal(source.asked.length, 2);
});

test("an interrupted question is repeated", async () => {
  const { source, chosen } = opened();
  chosen.choose("a", 2, 0);
  chosen.request();
  source.asked[0]!.answer(new Refusal("something else is to be done", true));
  await settled();
  assert.equal(chosen.seen, null);
  chosen.request();
  assert.equal(source.asked.length, 2);
});

test("answers are cached until a rewind", async () => {
  const { source, chosen } = opened();
  const request = async (step: number, why?: string): Promise<void> => {
    chosen.choose("a", step, 0);
    chosen.request();
    source.asked.at(-1)!.answer(why);
    await settled();
  };
  await request(4);
  await request(2, "too long ago");
  assert.equal(chosen.seen!.why, "too long ago");
  await request(4);
  assert.equal(source.asked.length, 2);
  source.emit({ kind: "steps", side: "a", from: 3, steps: rows(3, 2) });
  chosen.request();
  assert.equal(source.asked.length, 3);
});

test("the step under way is last, with iterations", () => {
  const { source, chosen } = opened();
  const a = { step: 5, time: 0.05, iteration: 1, iterations: [iterationRow(), iterationRow()] };
  source.emit({ kind: "state", a, b: null } as unknown as ServerMessage);
  assert.deepEqual([chosen.step, chosen.iteration, chosen.rows().length], [6, 1, 6]);
  assert.ok(chosen.isUnderWay());
  source.emit({ kind: "steps", side: "a", from: 5, steps: rows(5, 1) });
  source.emit({
    kind: "state",
    a: { ...a, step: 6, iteration: -1, iterations: undefined },
    b: null,
  } as unknown as ServerMessage);
  assert.ok(!chosen.isUnderWay());
  assert.equal(chosen.row()!.iterations.length, 3);
});

test("a rewind chooses the newest remaining step", () => {
  const { source, chosen } = opened();
  chosen.choose("a", 5, 1);
  source.emit({ kind: "steps", side: "a", from: 2, steps: [] });
  assert.equal(chosen.step, 2);
});
