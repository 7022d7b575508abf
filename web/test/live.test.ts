import assert from "node:assert/strict";
import { test } from "node:test";
import type { TestContext } from "node:test";
import { LiveSource } from "../src/live";
import { overSocket, type Socket } from "../src/socket";
import type { Incoming } from "../src/source";

// Node.js 18 accepts the list itself, newer versions an object that contains it.
function mockTimeouts(context: TestContext): void {
  const enable = context.mock.timers.enable.bind(context.mock.timers) as (what: unknown) => void;
  const isOld = Number(process.versions.node.split(".")[0]) < 20;
  enable(isOld ? ["setTimeout"] : { apis: ["setTimeout"] });
}

class FakeSocket {
  binaryType: BinaryType = "blob";
  readyState = 0;
  sent: string[] = [];
  onopen: Socket["onopen"] = null;
  onmessage: Socket["onmessage"] = null;
  onclose: Socket["onclose"] = null;
  send(text: string): void {
    this.sent.push(text);
  }
  close(): void {}
  opened(): void {
    this.readyState = 1;
    this.call(this.onopen, {});
  }
  sends(message: unknown): void {
    this.call(this.onmessage, { data: JSON.stringify(message) });
  }
  closed(reason = ""): void {
    this.readyState = 3;
    this.call(this.onclose, { reason });
  }
  private call(listener: unknown, event: unknown): void {
    (listener as (event: unknown) => void)(event);
  }
}

function connect(): { source: LiveSource; sockets: FakeSocket[]; received: Incoming[] } {
  const sockets: FakeSocket[] = [];
  const received: Incoming[] = [];
  const open = (): Socket => {
    const socket = new FakeSocket();
    sockets.push(socket);
    return socket as unknown as Socket;
  };
  const source = new LiveSource(overSocket("ws://here/session", open));
  source.start((incoming) => received.push(incoming));
  sockets[0].opened();
  return { source, sockets, received };
}

test("each answer reaches only its question", async () => {
  const { source, sockets, received } = connect();
  const first = source.ask<string>({ ask: "worst", side: "a" });
  const second = source.request({ do: "reset" });
  const ids = sockets[0].sent.map((text) => (JSON.parse(text) as { id: number }).id);
  sockets[0].sends({ kind: "reply", id: ids[1], reply: "two" });
  sockets[0].sends({ kind: "reply", id: ids[0], reply: "one" });
  assert.deepEqual(await Promise.all([first, second]), ["one", "two"]);
  assert.deepEqual(received, [{ failures: 0 }]);
});

test("a refusal rejects with the program's message", async () => {
  const { source, sockets, received } = connect();
  const asked = source.request({ do: "load", scene: "nowhere.toml" });
  sockets[0].sends({ kind: "refused", id: 1, why: "no such file" });
  await assert.rejects(asked, /no such file/);
  sockets[0].sends({ kind: "refused", id: null, why: "not now" });
  assert.deepEqual(received.at(-1), { message: { kind: "refused", id: null, why: "not now" } });
});

test("a lost connection rejects open requests and reconnects", async (context) => {
  mockTimeouts(context);
  const { source, sockets, received } = connect();
  const asked = source.ask({ ask: "recording" });
  sockets[0].closed();
  await assert.rejects(asked, /connection/);
  assert.deepEqual(received.at(-1), { failures: 1 });
  await assert.rejects(source.request({ do: "play" }), /no connection/);
  context.mock.timers.tick(250);
  assert.equal(sockets.length, 2);
  sockets[1].closed();
  context.mock.timers.tick(250);
  assert.equal(sockets.length, 2, "the second pause is longer");
  context.mock.timers.tick(250);
  assert.equal(sockets.length, 3);
  sockets[2].opened();
  assert.deepEqual(received.at(-1), { failures: 0 });
});

test("the reason of a closed connection is reported", (context) => {
  mockTimeouts(context);
  const { sockets, received } = connect();
  sockets[0].closed("too slow");
  assert.match(JSON.stringify(received), /closed the connection: too slow/);
});

test("a command without a connection is refused", () => {
  const sockets: FakeSocket[] = [];
  const received: Incoming[] = [];
  const open = (): Socket => {
    sockets.push(new FakeSocket());
    return sockets[0] as unknown as Socket;
  };
  const source = new LiveSource(overSocket("ws://here/session", open));
  source.start((incoming) => received.push(incoming));
  source.send({ do: "play" });
  assert.deepEqual(sockets[0].sent, []);
  assert.match(JSON.stringify(received), /no connection/);
});
