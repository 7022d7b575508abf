// Transport of messages to the engine: the program as WebAssembly in a worker of this page (worker.ts). build.mjs embeds
// its parts; without them the page talks to a program over a WebSocket.
import type { Transport, TransportListener } from "./live";
import { embedded, unpacked } from "./pack";

// First message to the worker.
export interface EngineParts {
  module: ArrayBuffer; // WebAssembly
  files: Record<string, string>; // texts by paths
  scene: string; // path
}

export type EngineWorker = Pick<Worker, "postMessage" | "onmessage" | "onerror">;

const kFirstScene = "/scenes/bunny.toml";

function startWorker(script: string): Worker {
  return new Worker(URL.createObjectURL(new Blob([script], { type: "text/javascript" })));
}

// Null: the page has no engine.
export function embeddedEngine(): Transport | null {
  const script = embedded("engine");
  if (script === null) return null;
  const parts = async (): Promise<EngineParts> => ({
    module: await unpacked(embedded("engine-module") ?? ""),
    files: JSON.parse(new TextDecoder().decode(await unpacked(embedded("engine-files") ?? ""))) as EngineParts["files"],
    scene: kFirstScene,
  });
  return overWorker(() => startWorker(script), parts);
}

export function overWorker(open: () => EngineWorker, parts: () => Promise<EngineParts>): Transport {
  let worker: EngineWorker | null = null;
  const start = (listener: TransportListener): void => {
    const end = (why: string): void => {
      if (worker) worker.onmessage = worker.onerror = null;
      worker = null;
      listener.closed(why, Infinity); // it cannot reconnect
    };
    const opened = open();
    opened.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) => {
      const why = typeof data === "string" ? endOf(data) : null;
      if (why !== null) return end(why);
      if (!worker) {
        worker = opened;
        listener.opened();
      }
      listener.received(data);
    };
    opened.onerror = (event) => {
      worker ??= opened;
      end(typeof event === "string" ? event : event.message);
    };
    parts().then(
      (ready) => opened.postMessage(ready),
      (reason: unknown) => end(`the engine in this page is damaged (${String(reason)})`),
    );
  };
  const send = (text: string): boolean => {
    worker?.postMessage(text);
    return worker !== null;
  };
  return { start, send };
}

// Reason if the message announces that the engine has ended.
function endOf(text: string): string | null {
  if (!text.startsWith('{"kind":"ended"')) return null;
  return (JSON.parse(text) as { why: string }).why;
}
