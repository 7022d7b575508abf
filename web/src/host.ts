// Starts the engine's worker in this page or, for a page from a file, in a sandboxed frame.
//
// A busy worker reads no messages, and only isolated pages share memory with it. So the worker loads an empty script from
// a URL, the flag, from time to time: once its owner has revoked the flag, this fails, and the work stops. Browsers let a
// worker load such a URL if the page comes from a server or is sandboxed, but not if it comes from a file.

export interface Flagged<Message> {
  message: Message;
  flag: string; // URL; revoked: stop
}

export interface EngineWorker<Message> {
  onmessage: ((message: string | ArrayBuffer) => void) | null;
  send(message: Message, stops: boolean): void; // `stops`: the worker drops its current work
  end(): void;
}

interface Request {
  message: unknown;
  stops: boolean;
}

// Runs the script in a worker that serves the port. Returns a function that ends it. The frame contains the text of this
// function, so it uses nothing outside.
function startHere(script: string, port: MessagePort): () => void {
  const urlOf = (text: string): string => URL.createObjectURL(new Blob([text], { type: "text/javascript" }));
  const worker = new Worker(urlOf(script));
  let flag = urlOf("");
  worker.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) => port.postMessage(data, typeof data === "string" ? [] : [data]);
  worker.onerror = (event) => {
    event.preventDefault(); // reported by the page
    port.postMessage(JSON.stringify({ kind: "ended", why: event.message, line: event.lineno }));
  };
  port.onmessage = ({ data: { message, stops } }: MessageEvent<Request>) => {
    if (stops) {
      URL.revokeObjectURL(flag);
      flag = urlOf("");
    }
    worker.postMessage({ message, flag });
  };
  return () => worker.terminate();
}

const kFrameScript = `onmessage = ({ data, ports }) => (${startHere.toString()})(data, ports[0]);`;

function startInFrame(script: string, port: MessagePort): () => void {
  const frame = document.createElement("iframe");
  frame.setAttribute("sandbox", "allow-scripts");
  frame.hidden = true;
  frame.srcdoc = `<script>${kFrameScript.replaceAll("</", "<\\/")}</script>`;
  frame.onload = () => frame.contentWindow?.postMessage(script, "*", [port]);
  document.body.append(frame);
  return () => frame.remove();
}

export function startWorker<Message>(script: string): EngineWorker<Message> {
  const { port1, port2 } = new MessageChannel();
  const start = location.protocol === "file:" ? startInFrame : startHere;
  const end = start(script, port2);
  const worker: EngineWorker<Message> = {
    onmessage: null,
    send: (message, stops) => port1.postMessage({ message, stops }),
    end: () => {
      worker.onmessage = null;
      end();
    },
  };
  port1.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) => worker.onmessage?.(data);
  return worker;
}
