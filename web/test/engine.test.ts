import assert from "node:assert/strict";
import { test } from "node:test";
import { type EngineParts, judgeOver, overWorker } from "../src/engine";
import type { EngineWorker } from "../src/host";
import { LiveSource } from "../src/live";
import type { Incoming } from "../src/source";

const kParts: EngineParts = { script: "", module: "", workers: 0, files: "", task: { scene: "/scenes/a.toml" } };

class FakeWorker implements EngineWorker<EngineParts | string> {
  onmessage: ((message: string | ArrayBuffer) => void) | null = null;
  posted: (EngineParts | string)[] = [];
  stops = 0;
  ended = false;
  send(message: EngineParts | string, stops: boolean): void {
    this.posted.push(message);
    if (stops) ++this.stops;
  }
  end(): void {
    this.ended = true;
    this.onmessage = null;
  }
  sends(message: unknown): void {
    this.onmessage?.(JSON.stringify(message));
  }
}

async function connect(): Promise<{ source: LiveSource; worker: FakeWorker; received: Incoming[] }> {
  const worker = new FakeWorker();
  const received: Incoming[] = [];
  const source = new LiveSource(overWorker(() => worker, () => Promise.resolve(kParts)));
  source.start((incoming) => received.push(incoming));
  await new Promise((resolve) => setTimeout(resolve, 0));
  return { source, worker, received };
}

const texts = (received: Incoming[]): string => JSON.stringify(received);

test("the worker gets the engine, then messages", async () => {
  const { source, worker, received } = await connect();
  assert.deepEqual(worker.posted, [kParts]);
  await assert.rejects(source.request({ do: "play" }), /no connection/);
  worker.sends({ kind: "busy", what: "" });
  assert.deepEqual(received, [{ failures: 0 }, { message: { kind: "busy", what: "" } }]);
  const asked = source.ask<string>({ ask: "recording" });
  assert.deepEqual(JSON.parse(worker.posted[1] as string), { ask: "recording", id: 2 });
  worker.sends({ kind: "reply", id: 2, reply: "one" });
  assert.equal(await asked, "one");
});

test("early messages are shown until the engine's first", async () => {
  for (const isLate of [false, true]) {
    const worker = new FakeWorker();
    const received: Incoming[] = [];
    const early = async (): Promise<string[]> => ['{"kind":"busy","what":"early"}'];
    const source = new LiveSource(overWorker(() => worker, () => Promise.resolve(kParts), early));
    source.start((incoming) => received.push(incoming));
    if (isLate) worker.sends({ kind: "busy", what: "" });
    await new Promise((resolve) => setTimeout(resolve, 0));
    assert.equal(texts(received).includes("early"), !isLate);
    assert.equal(texts(received).includes("failures"), isLate, "the early messages do not connect the page");
  }
});

test("the reason of an ended engine is reported once", async () => {
  const { source, worker, received } = await connect();
  worker.sends({ kind: "busy", what: "" });
  const asked = source.request({ do: "play" });
  worker.sends({ kind: "ended", why: "out of memory" });
  await assert.rejects(asked, /connection/);
  worker.sends({ kind: "ended", why: "again" });
  assert.equal(texts(received).match(/out of memory/g)?.length, 1);
  assert.ok(!texts(received).includes("again"));
  await assert.rejects(source.request({ do: "play" }), /no connection/);
});

test("only urgent commands stop the work under way", async () => {
  const { source, worker } = await connect();
  worker.sends({ kind: "busy", what: "" });
  source.send({ do: "play" });
  void source.ask({ ask: "recording" });
  assert.equal(worker.stops, 0);
  source.send({ do: "pause" });
  void source.request({ do: "reset" });
  assert.equal(worker.stops, 2);
});

test("a judgment ends its worker", async () => {
  const workers = [new FakeWorker(), new FakeWorker(), new FakeWorker()] as const;
  const judgments = workers.map((worker) => judgeOver(() => worker, () => Promise.resolve(kParts)));
  workers[0].sends({ kind: "judged", result: { passes: true } });
  workers[1].sends({ kind: "ended", why: "out of memory" });
  assert.deepEqual(await judgments[0]!.result, { passes: true });
  await assert.rejects(judgments[1]!.result, /out of memory/);
  judgments[2]!.stop();
  await assert.rejects(judgments[2]!.result, /stopped/);
  assert.ok(workers.every(({ ended }) => ended));
});
