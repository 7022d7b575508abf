// Transport of messages to the engine: the program as WebAssembly in a worker of this page (worker.ts). build.mjs embeds
// its parts; without them the page talks to a program over a WebSocket.
import { type EngineWorker, startWorker } from "./host";
import type { Transport, TransportListener } from "./live";
import { bytesOf, embedded, unpacked } from "./pack";
import type { Judgment } from "./protocol";

interface Program {
  script: string; // of the compiler
  module: string; // WebAssembly, in base64 of xz
  threadScript?: string; // script of its threads; absent: there is one thread
}

// First message to the worker.
export interface EngineParts extends Program {
  workers: number; // threads beside the first
  files: string; // JSON, texts by paths, of pictures base64, in base64 of xz
  task: { scene: string } | { judge: string }; // path of a scene; id of a lesson
}

export type Opener = () => EngineWorker<EngineParts | string>;

const kFirstScene = "/scenes/bunny.toml";

// Commands that stop the step under way, as those of a server: apps/viewer/server_room.cpp.
const kUrgent = /^\{"do":"(pause|reset|load|set|rewind|lesson|replay|compare|end_compare|stop_fit)"/;

// Processors without that of the page, which draws: threads that wait for one make a step slower, not faster.
const kMostThreads = 8;
const threadCount = (): number => Math.min(navigator.hardwareConcurrency - 1, kMostThreads);

// The program with threads is a file beside the page. Only isolated pages can run it.
async function threadedProgram(): Promise<Program | null> {
  const name = embedded("engine-threads");
  if (name === null || !crossOriginIsolated || threadCount() < 2) return null;
  return fetch(name).then((response) => response.json() as Promise<Program>).catch(() => null);
}

async function partsFor(task: EngineParts["task"]): Promise<EngineParts> {
  const program = (await threadedProgram()) ?? embedded<Program>("engine-program")!;
  return { ...program, workers: threadCount() - 1, files: embedded("engine-files")!, task };
}

export const hasEngine = (): boolean => document.getElementById("engine") !== null;
const openWorker: Opener = () => startWorker(embedded<string>("engine")!);

export const embeddedEngine = (): Transport => overWorker(openWorker, () => partsFor({ scene: kFirstScene }), opening);

// Messages about the first scene that the page shows before the engine has started. None if it opens with another scene.
async function opening(): Promise<(string | ArrayBuffer)[]> {
  const packed = embedded("engine-opening");
  if (packed === null || location.hash !== "" || embedded("workspace") !== null) return [];
  const { scene, pictures } = JSON.parse(new TextDecoder().decode(await unpacked(packed))) as { scene: string; pictures: string[] };
  return [scene, ...pictures.map((picture) => bytesOf(picture).buffer)];
}

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
    void parts().then((ready) => worker.send(ready, false));
  });
  return { result: result.finally(() => worker.end()), stop };
}

type Early = () => Promise<(string | ArrayBuffer)[]>; // messages to show until the worker's first one

export function overWorker(open: Opener, parts: () => Promise<EngineParts>, early: Early = () => Promise.resolve([])): Transport {
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
    void parts().then((ready) => opened.send(ready, false));
    void early().then((messages) => worker ?? messages.forEach(listener.received));
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
