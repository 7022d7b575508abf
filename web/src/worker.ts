// The script of the engine's worker: passes messages between the page (engine.ts) and a session (apps/engine/engine.cpp).
import type { EngineParts } from "./engine";
import type { Flagged } from "./host";
import { bytesOf } from "./pack";
import { unpackXz } from "./xz";

interface Engine {
  FS: { mkdirTree(folder: string): void; writeFile(path: string, content: string | Uint8Array): void };
  lengthBytesUTF8(text: string): number;
  stringToUTF8(text: string, place: number, most: number): void;
  _malloc(bytes: number): number;
  _free(place: number): void;
  _engine_open(scene: number): number;
  _engine_judge(lesson: number): number;
  _engine_handle(message: number): void;
  _engine_run(wantsPictures: boolean): number;
  _engine_pause(wantsPictures: boolean): number;
}

type Post = (message: string | ArrayBuffer) => void;

interface EngineOptions {
  wasmBinary: Uint8Array;
  post: Post;
  isStopRequested: () => boolean;
  workers: number; // beside this one
  mainScriptUrlOrBlob: Blob; // for the scripts of the workers
  locateFile: () => string; // URL of these scripts
}

// Made by the compiler; its script defines it.
declare function createEngine(options: EngineOptions): Promise<Engine>;

interface Scope {
  onmessage: ((event: { data: Flagged<EngineParts | string> }) => void) | null;
  importScripts(url: string): void;
  postMessage(message: string | ArrayBuffer, transfer?: ArrayBuffer[]): void;
}
const scope = globalThis as unknown as Scope;

const post: Post = (message) => scope.postMessage(message, typeof message === "string" ? [] : [message]);
const ended = (reason: unknown): void => post(JSON.stringify({ kind: "ended", why: String(reason) }));

// Copies the text into the memory of the engine during the call. Uploads would not fit on its stack, where ccall() puts
// texts.
function withText<Result>(made: Engine, text: string, call: (place: number) => Result): Result {
  const bytes = made.lengthBytesUTF8(text) + 1;
  const place = made._malloc(bytes);
  if (place === 0) throw new Error("there is not enough memory for this message");
  try {
    made.stringToUTF8(text, place, bytes);
    return call(place);
  } finally {
    made._free(place);
  }
}

// Whether the page has revoked the flag (host.ts). Work shorter than kPatience never loads it, which takes a few ms.
const [kPatience, kPeriod] = [300, 150]; // [ms]
let flag = "";
let isStopped = false;
let nextCheck = 0; // [ms]
function isStopRequested(): boolean {
  if (isStopped || performance.now() < nextCheck) return isStopped;
  try {
    scope.importScripts(flag);
  } catch {
    isStopped = true;
  }
  nextCheck = performance.now() + kPeriod;
  return isStopped;
}

let engine: Engine | null = null;
let wantsPictures = true; // the first ones need no request
let timer: ReturnType<typeof setTimeout> | undefined;

// Lets waiting messages of the page pass before it continues; a timeout of zero would wait for 4 ms.
const atOnce = new MessageChannel();
let isQueued = false;
atOnce.port2.onmessage = () => {
  isQueued = false;
  guarded(run);
};

const blobOf = (text: string): Blob => new Blob([text], { type: "text/javascript" });

async function create({ script, module, threadScript, workers }: EngineParts): Promise<Engine> {
  const main = blobOf(script);
  scope.importScripts(URL.createObjectURL(main));
  const locateFile = (): string => URL.createObjectURL(blobOf(threadScript ?? ""));
  const used = threadScript === undefined ? 0 : workers;
  return createEngine({ wasmBinary: await unpackXz(module), post, isStopRequested, workers: used, mainScriptUrlOrBlob: main, locateFile });
}

async function open(parts: EngineParts): Promise<void> {
  const { files, task } = parts;
  const made = await create(parts);
  const texts = JSON.parse(new TextDecoder().decode(await unpackXz(files))) as Record<string, string>;
  for (const [path, text] of Object.entries(texts)) {
    made.FS.mkdirTree(path.slice(0, path.lastIndexOf("/")));
    made.FS.writeFile(path, path.endsWith(".webp") ? bytesOf(text) : text);
  }
  if ("judge" in task) return void withText(made, task.judge, made._engine_judge);
  if (!withText(made, task.scene, made._engine_open)) return;
  engine = made;
  run();
}

function run(): void {
  if (!engine) return;
  clearTimeout(timer);
  if (engine._engine_run(wantsPictures)) wantsPictures = false;
  const pause = engine._engine_pause(wantsPictures);
  if (pause >= 1) timer = setTimeout(() => guarded(run), pause);
  else if (pause >= 0 && !isQueued) {
    isQueued = true;
    atOnce.port1.postMessage(null);
  }
}

function carryOut(message: string): void {
  if (message === "ready") wantsPictures = true;
  else if (engine) withText(engine, message, engine._engine_handle);
  run();
}

// An exception here is a trap of the engine: an exhausted memory, or a bug. Its state is then undefined.
function guarded(work: () => void): void {
  nextCheck = performance.now() + kPatience;
  try {
    work();
  } catch (reason) {
    engine = null;
    ended(reason);
  }
}

scope.onmessage = ({ data }) => {
  if (flag !== data.flag) isStopped = false;
  flag = data.flag;
  const { message } = data;
  if (typeof message === "string") guarded(() => carryOut(message));
  else void open(message).catch(ended);
};
