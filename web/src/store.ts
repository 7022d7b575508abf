// State of the page: the last message of each kind. Panels read it and subscribe to changes.
import { Emitter } from "./emitter";
import { nameOfA } from "./presets";
import type { Geometry, Hello, Obstacle, Picture, Scene, SideName, State, StepRow } from "./protocol";
import type { Incoming, Source } from "./source";

const kMostRows = 20_000; // same limit as in the program
const kRowsTooMany = 1000; // excess before the first rows are dropped, so that this does not happen at every step

export interface Side {
  scene: Scene;
  geometry: Geometry | null;
  picture: Picture | null;
  steps: StepRow[]; // consecutive steps, from 1 unless the first were dropped
  pins: number[];
  fibres: number[];
  obstacles: Obstacle[];
}

interface Events {
  hello: Hello;
  role: boolean; // whether the page may steer
  scene: SideName; // a side has been added, or its settings have changed
  gone: SideName;
  geometry: SideName;
  obstacles: SideName;
  picture: SideName;
  steps: { side: SideName; from: number };
  pins: SideName;
  fibres: SideName;
  extension: { kind: "bench" }; // message of an extension
  state: State;
  busy: string;
  refused: string;
  connected: boolean;
}

export class Store extends Emitter<Events> {
  hello: Hello | null = null;
  steers = false;
  failures: number | null = null; // failed connections in a row; null before the first connection
  state: State | null = null;
  busy = "";
  readonly sides: { a: Side | null; b: Side | null } = { a: null, b: null };

  constructor(readonly source: Source) {
    super();
  }

  start(): void {
    this.source.start((incoming) => this.receive(incoming));
  }

  get connected(): boolean {
    return this.failures === 0;
  }

  side(name: SideName): Side | null {
    return this.sides[name];
  }

  // Name of the scene.
  get name(): string {
    return this.sides.a?.scene.name ?? "";
  }

  label(name: SideName): string {
    const { a, b } = this.sides;
    const ofA = name === "a" && a && b ? nameOfA(a.scene, b.scene) : "";
    return this.sides[name]?.scene.label || ofA || name.toUpperCase();
  }

  // "A: its label", or "A" without one.
  title(name: SideName): string {
    const letter = name.toUpperCase();
    return this.label(name) === letter ? letter : `${letter}: ${this.label(name)}`;
  }

  private receive(incoming: Incoming): void {
    if ("geometry" in incoming) return this.receiveGeometry(incoming.geometry);
    if ("picture" in incoming) return this.receivePicture(incoming.picture);
    if ("failures" in incoming) {
      this.failures = incoming.failures;
      return this.emit("connected", this.connected);
    }
    const message = incoming.message;
    switch (message.kind) {
      case "hello":
        this.hello = message;
        this.endCompare(); // a side b that still exists follows
        this.emit("hello", message);
        this.steers = message.steers;
        return this.emit("role", message.steers);
      case "role":
        this.steers = message.steers;
        return this.emit("role", message.steers);
      case "scene":
        return this.receiveScene(message);
      case "end_compare":
        return this.endCompare();
      case "steps": {
        const side = this.sides[message.side];
        if (!side) return;
        while (side.steps.length > 0 && side.steps[side.steps.length - 1].step > message.from) side.steps.pop();
        side.steps.push(...message.steps);
        if (this.source.live && side.steps.length > kMostRows + kRowsTooMany)
          side.steps.splice(0, side.steps.length - kMostRows);
        return this.emit("steps", { side: message.side, from: message.from });
      }
      case "pins":
        if (this.sides[message.side]) this.sides[message.side]!.pins = message.vertices;
        return this.emit("pins", message.side);
      case "fibres": {
        const side = this.current(message);
        if (!side) return;
        side.fibres = message.lines;
        return this.emit("fibres", message.side);
      }
      case "obstacles": {
        const side = this.current(message);
        if (!side) return;
        side.obstacles = message.obstacles;
        return this.emit("obstacles", message.side);
      }
      case "bench":
        return this.emit("extension", message);
      case "state":
        this.state = message;
        return this.emit("state", message);
      case "busy":
        this.busy = message.what;
        return this.emit("busy", message.what);
      case "refused":
        return this.emit("refused", message.why);
      case "reply":
        return; // the source passes replies to their callers
    }
  }

  private endCompare(): void {
    if (!this.sides.b) return;
    this.sides.b = null;
    this.emit("gone", "b");
  }

  private receiveScene(scene: Scene): void {
    const known = this.sides[scene.side];
    if (known && known.scene.generation === scene.generation) known.scene = scene;
    else this.sides[scene.side] = { scene, geometry: null, picture: null, steps: known?.steps ?? [], pins: [], fibres: [], obstacles: [] };
    this.emit("scene", scene.side);
  }

  // The side with this generation of the geometry; null if the message is about an earlier one.
  private current({ side, generation }: { side: SideName; generation: number }): Side | null {
    return this.sides[side]?.scene.generation === generation ? this.sides[side] : null;
  }

  private receiveGeometry(geometry: Geometry): void {
    const side = this.current(geometry);
    if (!side) return;
    side.geometry = geometry;
    this.emit("geometry", geometry.side);
  }

  private receivePicture(picture: Picture): void {
    const side = this.current(picture);
    if (!side) return this.source.ready();
    side.picture = picture;
    this.emit("picture", picture.side);
  }
}
