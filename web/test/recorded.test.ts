// A recorded run as a source: an archive packed as in apps/viewer/recording.h plays, rewinds and answers.
import assert from "node:assert/strict";
import { test } from "node:test";
import { gzipSync } from "node:zlib";
import type { Obstacle, Picture, Scene, ServerMessage, State, StepRow, TextReply, VertexReply } from "../src/protocol";
import { RecordedSource } from "../src/recorded";
import { stepsToShow } from "../src/render";
import type { Incoming } from "../src/source";

// Three corners and one triangle that move along x: frame f has the codes 100 f^2.
const kFrames = 5;
const kSize = 6.5535; // so that a code is 0.0001

function positionBytes(): Uint8Array {
  const n = 9;
  const bytes = new Uint8Array(2 * n * kFrames);
  for (let frame = 0; frame < kFrames; ++frame) {
    for (let i = 0; i < n; ++i) {
      const code = (f: number): number => (f < 0 || i % 3 !== 0 ? 0 : 100 * f * f + i);
      const line = frame === 0 ? 0 : frame === 1 ? code(0) : 2 * code(frame - 1) - code(frame - 2);
      const difference = code(frame) - line;
      const folded = (difference << 1) ^ (difference >> 31);
      bytes[2 * n * frame + i] = folded & 255;
      bytes[2 * n * frame + n + i] = folded >> 8;
    }
  }
  return bytes;
}

const kField = { unit: "", diverging: false, center: 0, log: false };
const kScene = {
  kind: "scene",
  side: "a",
  generation: 1,
  surface: "cage",
  notes: [],
  fields: [
    { ...kField, name: "displacement", label: "displacement" },
    { ...kField, name: "stress", label: "stress" },
    { ...kField, name: "signed", label: "signed" },
    { ...kField, name: "young", label: "E" },
  ],
} as unknown as Scene;

const kFloor: Obstacle = { name: "floor", plane: { origin: [0, 0, 0], normal: [0, 1, 0] }, points: [], triangles: [] };

function recordingText(hasContact = false, isFigure = false): string {
  const pressure = { ...kField, name: "contact_pressure", label: "contact pressure", unit: "Pa" };
  const fields = hasContact ? [...kScene.fields, pressure] : kScene.fields;
  const scene = { ...kScene, fields, field: isFigure ? "young" : "" };
  const arrays: [string, "u8" | "u32" | "f32", Uint8Array | Uint32Array | Float32Array][] = [
    ["point.rest", "f32", Float32Array.of(0.00003, 0, 0, 0, 0, 0, 0, 0, 0)], // rounds to the first code
    ["point.mass", "f32", Float32Array.of(1, 2, 3)],
    ["point.pinned", "u8", Uint8Array.of(0, 1, 0)],
    ["cage.rest", "f32", new Float32Array(9)],
    ["cage.triangles", "u32", Uint32Array.of(0, 1, 2)],
    ["cage.tet", "u32", Uint32Array.of(7)],
    ["cage.vertex", "u32", Uint32Array.of(10, 11, 12)],
    ["cage.corners", "u32", Uint32Array.of(0, 1, 2)],
    ["cage.place", "u32", Uint32Array.of(0, 1, 1)],
    ["positions", "u8", positionBytes()],
    ["field.stress", "u8", Uint8Array.of(0, 254, 0, 0, 255 - 0, 1, 0, 0, 0, 0)],
    ["field.stress.range", "f32", Float32Array.of(0, 10, 0, 10, 0, 20, 0, 20, 0, 20)],
    ["field.young", "f32", Float32Array.of(5, 6)],
    ["field.signed", "u8", Uint8Array.of(...[4, 5, 0, 0, 0, 0, 0, 0, 0, 0])],
    ["field.signed.range", "f32", Float32Array.from(Array.from({ length: kFrames }, () => [-4 * 0.3, 250 * 0.3]).flat())],
    ["contact.at", "f32", Float32Array.of(1, 2, 3, 50, 4, 5, 6, 60, 7, 8, 9, 70)],
    ["contact.point", "u32", Uint32Array.of(1, 0xffffffff, 2)],
    ["arrows", "f32", Float32Array.of(0, 0, 0, 1, 2, 3, 1, 1, 1, 4, 5, 6)],
  ];
  let at = 0;
  const blocks: Uint8Array[] = [];
  const list = arrays.map(([name, type, numbers]) => {
    const entry = { name, type, at, count: numbers.length };
    const padded = new Uint8Array(Math.ceil(numbers.byteLength / 4) * 4);
    padded.set(new Uint8Array(numbers.buffer));
    blocks.push(padded);
    at += padded.length;
    return entry;
  });
  const steps = [10, 20, 30, 40].map((step) => ({ step, status: "converged" }) as StepRow);
  const all = Array.from({ length: 40 }, (_, i) => steps.find(({ step }) => step === i + 1) ?? ({ step: i + 1, status: "stuck" } as StepRow));
  const head = {
    format: 1,
    hello: { kind: "hello", live: false },
    scenes: [scene],
    obstacles: hasContact ? [kFloor] : [],
    toml: "name = 1\n",
    steps: all,
    frames: { step: [0, 10, 20, 30, 40], time: [0, 0.1, 0.2, 0.3, 0.4], contacts: [0, 2, 1, 0, 0], ...(isFigure ? { arrows: [1, 0, 1, 0, 0] } : {}) },
    lower: [0, 0, 0],
    size: [kSize, kSize, kSize],
    arrays: list,
  };
  const json = Buffer.from(JSON.stringify(head));
  const length = Buffer.alloc(4);
  length.writeUInt32LE(json.length);
  const padding = Buffer.alloc((4 - ((4 + json.length) % 4)) % 4);
  return gzipSync(Buffer.concat([length, json, padding, ...blocks])).toString("base64");
}

class Reader {
  readonly messages: ServerMessage[] = [];
  readonly pictures: Picture[] = [];
  readonly source: RecordedSource;
  now = 0; // [ms]
  private pulse: (() => void) | null = null;
  private greeted: () => void = () => {};

  constructor(text: string) {
    this.source = new RecordedSource(text, { now: () => this.now, next: (callback) => (this.pulse = callback) });
  }

  start(): Promise<void> {
    return new Promise((resolve) => {
      this.greeted = resolve;
      this.source.start((incoming) => this.take(incoming));
    });
  }

  // Advances the clock by the duration of some frames.
  pass(milliseconds: number): void {
    for (let elapsed = 0; elapsed < milliseconds; elapsed += 10) {
      this.now += 10;
      const pulse = this.pulse;
      this.pulse = null;
      pulse?.();
      this.source.ready();
    }
  }

  get state(): State {
    return this.messages.filter((message): message is State => message.kind === "state").at(-1)!;
  }

  get picture(): Picture {
    return this.pictures.at(-1)!;
  }

  private take(incoming: Incoming): void {
    if ("message" in incoming) this.messages.push(incoming.message);
    if ("picture" in incoming) this.pictures.push(incoming.picture);
    if ("message" in incoming && ["state", "refused"].includes(incoming.message.kind)) this.greeted();
  }
}

async function opened(hasContact = false, isFigure = false): Promise<Reader> {
  const reader = new Reader(recordingText(hasContact, isFigure));
  await reader.start();
  reader.source.ready();
  return reader;
}

test("a recording sends a greeting and its start", async () => {
  const reader = await opened();
  assert.deepEqual(reader.messages.map(({ kind }) => kind), ["hello", "scene", "pins", "steps", "state"]);
  assert.deepEqual(reader.messages[2], { kind: "pins", side: "a", vertices: [1] });
  assert.deepEqual(reader.state.a.timeline, { first: 0, last: 40 });
  assert.equal(reader.picture.step, 0);
  assert.equal(reader.picture.values, null);
});

test("positions equal the packed ones", async () => {
  const reader = await opened();
  for (const frame of [4, 2, 0, 3]) {
    await reader.source.request({ do: "rewind", step: 10 * frame });
    reader.source.ready();
    const x = [0, 3, 6].map((i) => (100 * frame * frame + i) * 1e-4);
    reader.picture.positions.forEach((value, i) => assert.ok(Math.abs(value - (i % 3 === 0 ? x[i / 3] : 0)) < 1e-6));
  }
});

test("a figure of arrays opens with its first field, and has arrows but no scene", async () => {
  const reader = await opened(false, true);
  assert.deepEqual([...reader.picture.values!], [5, 6, 6]);
  assert.deepEqual([...reader.picture.arrows!], [0, 0, 0, 1, 2, 3]);
  await reader.source.request({ do: "rewind", step: 20 });
  reader.source.ready();
  assert.deepEqual([...reader.picture.arrows!], [1, 1, 1, 4, 5, 6]);
  assert.equal((await reader.source.ask<VertexReply>({ ask: "vertex", side: "a", vertex: 0 })).mass, undefined);
  await assert.rejects(reader.source.ask({ ask: "scene", side: "a" }), /no scene/);
});

test("plays at its speed, ends, and restarts", async () => {
  const reader = await opened();
  await reader.source.request({ do: "speed", value: 0.5 });
  await reader.source.request({ do: "play" });
  reader.pass(500);
  assert.equal(reader.state.a.step, 20);
  assert.equal(reader.state.rate, 0.5);
  reader.pass(500);
  assert.equal(reader.state.a.step, 40);
  assert.equal(reader.state.playing, false);
  await reader.source.request({ do: "play" });
  assert.equal(reader.state.a.step, 0);
  await reader.source.request({ do: "pause" });
  reader.pass(500);
  assert.equal(reader.state.a.step, 0);
});

test("steps by frames, rewinds to the nearest", async () => {
  const reader = await opened();
  await reader.source.request({ do: "step" });
  assert.equal(reader.state.a.step, 10);
  assert.equal(reader.state.a.status, "converged");
  await reader.source.request({ do: "rewind", step: 27 });
  assert.equal(reader.state.a.step, 30);
  await reader.source.request({ do: "reset" });
  assert.equal(reader.state.a.step, 0);
});

test("the newest picture follows a drawn one", async () => {
  const reader = await opened();
  for (const step of [10, 20, 30]) await reader.source.request({ do: "rewind", step });
  assert.deepEqual(reader.pictures.map(({ step }) => step), [0, 10]);
  reader.source.ready();
  assert.deepEqual(reader.pictures.map(({ step }) => step), [0, 10, 30]);
});

test("shared points share values, NaN stays NaN", async () => {
  const reader = await opened();
  await reader.source.request({ do: "color", field: "stress" });
  assert.deepEqual([...reader.picture.values!], [0, 10, 10]);
  assert.equal(reader.picture.max, 10);
  await reader.source.request({ do: "rewind", step: 20 });
  reader.source.ready();
  assert.deepEqual([...reader.picture.values!].map(Number.isNaN), [true, true, true]);
  await assert.rejects(reader.source.request({ do: "color", field: "color" }), /no field 'color'/);
});

test("refuses unknown queries with a message", async () => {
  const reader = await opened();
  await reader.source.request({ do: "rewind", step: 20 });
  const text = await reader.source.ask<TextReply>({ ask: "scene", side: "a" });
  assert.equal(text.text, "name = 1\n");
  const vertex = await reader.source.ask<VertexReply>({ ask: "vertex", side: "a", vertex: 1 });
  assert.equal(vertex.vertex, 11);
  assert.equal(vertex.pinned, true);
  assert.ok(Math.abs(vertex.position[0] - 0.0403) < 1e-6);
  assert.ok(Math.abs(vertex.velocity[0] - 0.3) < 1e-4);
  assert.equal(vertex.values.young, 6);
  assert.equal(vertex.values.stress, null);
  await assert.rejects(reader.source.ask({ ask: "vertex", side: "a", vertex: 3 }), /no vertex 3/);
  await assert.rejects(reader.source.ask({ ask: "worst", side: "a" }), /does not contain/);
  await assert.rejects(reader.source.request({ do: "set", key: "time.step", value: 1 }), /cannot be changed/);
  await assert.rejects(reader.source.request({ do: "surface", which: "skin" }), /no skin/);
});

test("a damaged recording is reported", async () => {
  for (const text of [recordingText().slice(0, 400), "", "no base64 at all!"]) {
    const reader = new Reader(text);
    await reader.start();
    assert.match(JSON.stringify(reader.messages), /recording in this page is damaged/);
  }
});

test("video pictures use the latest earlier frame", () => {
  const frames = { step: [0, 10, 20, 30, 40], time: [0, 0.1, 0.2, 0.3, 0.4] };
  assert.deepEqual(stepsToShow(frames, { step: null, every: 0 }), frames.step);
  assert.deepEqual(stepsToShow(frames, { step: null, every: 0.05 }), [0, 0, 10, 10, 20, 20, 30, 30, 40]);
  assert.deepEqual(stepsToShow(frames, { step: null, every: 0.2 }), [0, 20, 40]);
  assert.deepEqual(stepsToShow(frames, { step: 17, every: 0 }), [17]);
});

test("recordings with contact have obstacles and points", async () => {
  const reader = await opened(true);
  const sent = reader.messages.find((message) => message.kind === "obstacles");
  assert.ok(sent?.kind === "obstacles");
  assert.deepEqual(sent.obstacles, [kFloor]);
  assert.equal(reader.picture.contacts.length, 0, "nothing touches at the start");
  assert.equal(reader.source.largestPressure, 70, "one scale for all frames");
  await reader.source.request({ do: "color", field: "contact_pressure" });
  reader.source.ready();
  await reader.source.request({ do: "step" });
  reader.source.ready();
  assert.deepEqual([...reader.picture.contacts], [1, 2, 3, 50, 4, 5, 6, 60]);
  assert.deepEqual([...reader.picture.values!], [0, 50, 0]);
  await reader.source.request({ do: "step" });
  reader.source.ready();
  assert.deepEqual([...reader.picture.contacts], [7, 8, 9, 70]);
});

test("zeros of recorded fields are exact", async () => {
  const reader = await opened();
  await reader.source.request({ do: "color", field: "signed" });
  reader.source.ready();
  assert.equal(reader.picture.values![0], 0);
  assert.ok(Math.abs(reader.picture.values![1] - 0.3) < 1e-6);
  await reader.source.request({ do: "color", field: "displacement" });
  reader.source.ready();
  assert.equal(reader.picture.values![0], 0, "no displacement at the start");
  assert.ok(reader.picture.values![1] > 0);
});
