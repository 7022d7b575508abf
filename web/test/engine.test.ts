import assert from "node:assert/strict";
import { test } from "node:test";
import { type EngineParts, type EngineWorker, overWorker } from "../src/engine";
import { LiveSource } from "../src/live";
import type { Incoming } from "../src/source";

const kParts: EngineParts = { module: new ArrayBuffer(8), files: { "/scenes/a.toml": "" }, scene: "/scenes/a.toml" };

class FakeWorker {
  onmessage: EngineWorker["onmessage"] = null;
  onerror: EngineWorker["onerror"] = null;
  posted: unknown[] = [];
  postMessage(message: unknown): void {
    this.posted.push(message);
  }
  sends(message: unknown): void {
    this.call(this.onmessage, { data: JSON.stringify(message) });
  }
  fails(message: string): void {
    this.call(this.onerror, { message });
  }
  private call(listener: unknown, event: unknown): void {
    (listener as ((event: unknown) => void) | null)?.(event);
  }
}

async function connect(parts = Promise.resolve(kParts)): Promise<{ source: LiveSource; worker: FakeWorker; received: Incoming[] }> {
  const worker = new FakeWorker();
  const received: Incoming[] = [];
  const source = new LiveSource(overWorker(() => worker as unknown as EngineWorker, () => parts));
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

test("the reason of an ended engine is reported once", async () => {
  const { source, worker, received } = await connect();
  worker.sends({ kind: "busy", what: "" });
  const asked = source.request({ do: "play" });
  worker.sends({ kind: "ended", why: "out of memory" });
  await assert.rejects(asked, /connection/);
  worker.fails("again");
  assert.equal(texts(received).match(/out of memory/g)?.length, 1);
  assert.ok(!texts(received).includes("again"));
  await assert.rejects(source.request({ do: "play" }), /no connection/);
});

test("a script error and damaged parts are reported", async () => {
  const failing = await connect();
  failing.worker.fails("SyntaxError");
  assert.match(texts(failing.received), /SyntaxError/);
  const damaged = await connect(Promise.reject(new Error("truncated")));
  assert.match(texts(damaged.received), /engine in this page is damaged.*truncated/);
});
