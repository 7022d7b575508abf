// Transport of messages to the engine: the program as WebAssembly in a worker of this page (worker.ts). build.mjs embeds
// its parts; without them the page talks to a program over a WebSocket.
import { type EngineWorker, startWorker } from "./host";
import type { Transport, TransportListener } from "./live";
import { embedded, unpacked } from "./pack";
import type { Judgment } from "./protocol";

// First message to the worker.
export interface EngineParts {
  module: ArrayBuffer; // WebAssembly
  files: Record<string, string>; // texts by paths
  task: { scene: string } | { judge: string }; // path of a scene; id of a lesson
}

export type Opener = () => EngineWorker<EngineParts | string>;

const kFirstScene = "/scenes/bunny.toml";

// Commands that stop the step under way, as those of a server: apps/viewer/server_room.cpp.
const kUrgent = /^\{"do":"(pause|reset|load|set|rewind|lesson|replay|compare|end_compare|stop_fit)"/;

async function partsFor(task: EngineParts["task"]): Promise<EngineParts> {
  return {
    module: await unpacked(embedded("engine-module") ?? ""),
    files: JSON.parse(new TextDecoder().decode(await unpacked(embedded("engine-files") ?? ""))) as EngineParts["files"],
    task,
  };
}

export const hasEngine = (): boolean => document.getElementById("engine") !== null;
const openWorker: Opener = () => startWorker(embedded("engine") ?? "");

export const embeddedEngine = (): Transport => overWorker(openWorker, () => partsFor({ scene: kFirstScene }));

export interface Judging {
  result: Promise<Judgment>;
  stop(): void; // rejects the result
}

// Judges a page of the lecture in a worker of its own.
export const judgeLesson = (id: string): Judging => judgeOver(openWorker, () => partsFor({ judge: id }));

export function judgeOver(open: Opener, parts: () => Promise<EngineParts>): Judging {
  const worker = open();
  let stop = (): void => {};
  const result = new Promise<Judgment>((resolve, reject) => {
    stop = () => reject(new Error("stopped"));
    worker.onmessage = (data) => {
      const why = typeof data === "string" ? endOf(data) : null;
      if (why !== null) reject(new Error(why));
      else resolve((JSON.parse(data as string) as { result: Judgment }).result);
    };
    parts().then((ready) => worker.send(ready, false), reject);
  });
  return { result: result.finally(() => worker.end()), stop };
}

export function overWorker(open: Opener, parts: () => Promise<EngineParts>): Transport {
  let worker: EngineWorker<EngineParts | string> | null = null;
  const start = (listener: TransportListener): void => {
    const opened = open();
    const end = (why: string): void => {
      opened.end();
      worker = null;
      listener.closed(why, Infinity); // it cannot reconnect
    };
    opened.onmessage = (data) => {
      const why = typeof data === "string" ? endOf(data) : null;
      if (why !== null) return end(why);
      if (!worker) {
        worker = opened;
        listener.opened();
      }
      listener.received(data);
    };
    parts().then(
      (ready) => opened.send(ready, false),
      (reason: unknown) => end(`the engine in this page is damaged (${String(reason)})`),
    );
  };
  const send = (text: string): boolean => {
    worker?.send(text, kUrgent.test(text));
    return worker !== null;
  };
  return { start, send };
}

// Reason if the message announces that the engine has ended.
function endOf(text: string): string | null {
  if (!text.startsWith('{"kind":"ended"')) return null;
  return (JSON.parse(text) as { why: string }).why;
}
