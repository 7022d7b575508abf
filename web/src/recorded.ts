// Source of messages from a recorded run inside the page: it plays, pauses and rewinds, but cannot be changed.
import { unpacked } from "./pack";
import type { Command, Obstacle, Picture, Query, State, TextReply, Vec3, VertexReply } from "./protocol";
import { carried, normalsOf, type RecordedSurface, Recording } from "./recording";
import type { Incoming, Source } from "./source";
import { boxOf } from "./view/body";
import { length, minus, vectorAt } from "./view/lens";
import { extremes } from "./view/ranges";

// Clock that calls back once per frame of the screen. Tests use their own.
export interface Pulse {
  now(): number; // [ms]
  next(callback: () => void): void;
}
const kScreen: Pulse = { now: () => performance.now(), next: (callback) => requestAnimationFrame(callback) };

const kPoints = 20000; // largest number of points of bodies that frame a picture
const kLargest = 4; // diagonal of bodies and obstacles in a picture, relative to that of the bodies
const kUnchangeable = "a recorded run cannot be changed; aspic view SCENE runs it live";
const kNotRecorded = "a recorded run does not contain this; aspic view SCENE computes it";

function everyNth(positions: ArrayLike<number>, stride: number): Vec3[] {
  return Array.from({ length: Math.ceil(positions.length / 3 / stride) }, (_, i) => vectorAt(positions, i * stride));
}

function diagonal(points: Vec3[]): number {
  const { lower, upper } = boxOf(Float32Array.from(points.flat()));
  return length(minus(upper, lower));
}

export class RecordedSource implements Source {
  readonly live = false;
  private receive: (incoming: Incoming) => void = () => {};
  private recording: Recording | null = null;
  private shown = 0; // index of the surface shown
  private field = "";
  private frame = 0;
  private time = 0; // time of the playback, between frames [s]
  private playing = false;
  private speed = 1;
  private lastPulse = 0; // [ms]
  private drawing = false; // the last picture sent is not drawn yet
  private waiting = false; // a newer picture is waiting

  constructor(
    private readonly text: string,
    private readonly pulse: Pulse = kScreen,
  ) {}

  start(receive: (incoming: Incoming) => void): void {
    this.receive = receive;
    const damaged = (error: unknown): void =>
      this.refuse(`the recording in this page is damaged (${String(error)}); make it again with aspic report`);
    unpacked(this.text)
      .then((bytes) => new Recording(bytes))
      .then((recording) => this.greet(recording), damaged);
  }

  send(command: Command): void {
    this.request(command).catch((error: Error) => this.refuse(error.message));
  }

  async request(command: Command): Promise<unknown> {
    const recording = this.opened();
    switch (command.do) {
      case "play":
        if (this.frame === recording.frameCount - 1) this.show(0);
        return this.play(true);
      case "pause":
        return this.play(false);
      case "step":
        this.play(false);
        return this.show(Math.min(this.frame + 1, recording.frameCount - 1));
      case "reset":
        this.play(false);
        return this.show(0);
      case "rewind":
        return this.show(recording.nearestFrame(command.step));
      case "speed":
        if (!(command.value > 0 && command.value < Infinity)) throw new Error("speed: expected a number above 0");
        this.speed = command.value;
        return this.sendState();
      case "color":
        return this.color(command.field);
      case "surface":
        return this.showSurface(command.which);
      case "iterate":
        throw new Error(kNotRecorded);
      case "take":
        return undefined; // every page has its own recording
      default:
        throw new Error(kUnchangeable);
    }
  }

  async ask<Reply>(query: Query): Promise<Reply> {
    const recording = this.opened();
    if (query.ask === "scene") {
      if (recording.isFigure) throw new Error("a figure of arrays has no scene");
      const reply: TextReply = { name: "scene.toml", text: recording.head.toml };
      return reply as Reply;
    }
    if (query.ask === "vertex") return this.vertex(query.vertex) as Reply;
    if (query.ask === "tet") throw new Error("a recorded run contains only the surface; aspic view SCENE shows tets");
    if (query.ask === "mesh") throw new Error("the meshes of a run are the files in its folder frames/");
    throw new Error(kNotRecorded);
  }

  ready(): void {
    this.drawing = false;
    if (this.waiting) this.sendPicture();
  }

  // Steps and times of all frames.
  get frames(): { step: number[]; time: number[] } {
    return this.opened().head.frames;
  }

  get largestPressure(): number | undefined {
    return this.recording?.largestPressure;
  }

  // Whether this is a figure of arrays, which has no simulation.
  get isFigure(): boolean {
    return this.opened().isFigure;
  }

  // Points that a picture of the run should show: those of bodies in all frames, thinned, and of the surfaces of obstacles,
  // unless these are so large that the bodies would be tiny. Planes have no end, and bodies fall onto them.
  get points(): Vec3[] {
    const { frames, obstacles = [] } = this.opened().head;
    const ofFrames = frames.step.map((_, frame) => carried(this.surface, this.opened().positions(frame)));
    const stride = Math.ceil((ofFrames.length * ofFrames[0]!.length) / 3 / kPoints);
    const bodies = ofFrames.flatMap((positions) => everyNth(positions, stride));
    const surfaces = [...obstacles, ...(frames.obstacles ?? []).flat()].filter(({ plane }) => !plane);
    const all = [...bodies, ...surfaces.flatMap(({ points }) => everyNth(points, 1))];
    return diagonal(all) <= kLargest * diagonal(bodies) ? all : bodies;
  }

  // Smallest and largest value of a field on the surface during the run.
  range(field: string): [number, number] {
    const recording = this.opened();
    const ofFrames = recording.head.frames.step.flatMap((_, frame) => {
      const positions = carried(this.surface, recording.positions(frame));
      return extremes(recording.values(field, frame, this.surface, positions)) ?? [];
    });
    return extremes(ofFrames) ?? [0, 0];
  }

  private opened(): Recording {
    if (!this.recording) throw new Error("the recording is still being read");
    return this.recording;
  }

  private get surface(): RecordedSurface {
    return this.opened().surfaces[this.shown];
  }

  private refuse(why: string): void {
    this.receive({ message: { kind: "refused", id: null, why } });
  }

  private greet(recording: Recording): void {
    this.recording = recording;
    this.field = recording.head.scenes[0].field;
    this.receive({ failures: 0 });
    this.receive({ message: recording.head.hello });
    this.sendSurface();
    this.receive({ message: { kind: "steps", side: "a", from: 0, steps: recording.head.steps } });
    this.show(0);
  }

  private sendSurface(): void {
    const { scene, geometry } = this.surface;
    this.receive({ message: { ...scene, field: this.field } });
    this.receive({ geometry });
    this.sendObstacles(this.opened().head.obstacles);
    const lines = this.opened().head.fibres?.[this.shown];
    if (lines) this.receive({ message: { kind: "fibres", side: "a", generation: scene.generation, lines } });
    const vertices = [...geometry.vertex.keys()].filter((vertex) => this.isPinned(vertex));
    this.receive({ message: { kind: "pins", side: "a", vertices } });
  }

  private sendObstacles(obstacles: Obstacle[] | undefined): void {
    const { generation } = this.surface.scene;
    if (obstacles?.length) this.receive({ message: { kind: "obstacles", side: "a", generation, obstacles } });
  }

  private isPinned(vertex: number): boolean {
    const { corners, weights } = this.surface;
    return !weights && this.opened().bytes("point.pinned")[corners[vertex]] === 1;
  }

  private play(playing: boolean): void {
    this.playing = playing;
    this.lastPulse = this.pulse.now();
    this.sendState();
    if (playing) this.pulse.next(() => this.onPulse());
  }

  private onPulse(): void {
    if (!this.playing) return;
    const recording = this.opened();
    const { time } = recording.head.frames;
    const now = this.pulse.now();
    const last = time.length - 1;
    this.time = Math.min(this.time + (this.speed * Math.max(0, now - this.lastPulse)) / 1000, time[last]);
    this.lastPulse = now;
    let frame = this.frame;
    while (frame < last && time[frame + 1] <= this.time) ++frame;
    this.playing = frame < last;
    if (frame !== this.frame) {
      this.frame = frame;
      this.sendPicture();
    }
    this.sendState();
    if (this.playing) this.pulse.next(() => this.onPulse());
  }

  private show(frame: number): void {
    this.frame = frame;
    this.time = this.opened().head.frames.time[frame];
    this.sendPicture();
    this.sendState();
  }

  private color(field: string): void {
    if (field !== "" && !this.surface.scene.fields.some(({ name }) => name === field))
      throw new Error(`the recording has no field '${field}'`);
    this.field = field;
    this.receive({ message: { ...this.surface.scene, field } });
    this.sendPicture();
  }

  private showSurface(which: "skin" | "cage"): void {
    const index = this.opened().surfaces.findIndex(({ scene }) => scene.surface === which);
    if (index < 0) throw new Error(`the recording has no ${which}`);
    if (index === this.shown) return;
    this.shown = index;
    this.sendSurface();
    this.sendPicture();
  }

  private sendPicture(): void {
    this.waiting = this.drawing;
    if (this.drawing) return;
    this.drawing = true;
    this.sendObstacles(this.opened().head.frames.obstacles?.[this.frame]);
    this.receive({ picture: this.picture() });
  }

  private picture(): Picture {
    const recording = this.opened();
    const { geometry, scene } = this.surface;
    const { step, time } = recording.head.frames;
    const positions = carried(this.surface, recording.positions(this.frame));
    const values = this.field === "" ? null : recording.values(this.field, this.frame, this.surface, positions);
    const [min, max] = extremes(values ?? []) ?? [0, 0];
    return {
      side: "a",
      generation: scene.generation,
      step: step[this.frame],
      iteration: -1,
      time: time[this.frame],
      positions,
      normals: normalsOf(positions, geometry.triangles),
      values,
      min,
      max,
      contacts: recording.contacts(this.frame).at,
      arrows: recording.arrows(this.frame),
    };
  }

  private sendState(): void {
    const { frames, steps } = this.opened().head;
    const step = frames.step[this.frame];
    const row = step > 0 ? steps[step - 1] : undefined;
    const state: State = {
      kind: "state",
      playing: this.playing,
      speed: this.speed,
      rate: this.playing ? this.speed : 0,
      replaying: false,
      a: {
        step,
        time: frames.time[this.frame],
        iteration: -1,
        timeline: { first: frames.step[0], last: frames.step[frames.step.length - 1] },
        status: row?.status ?? "",
        words: row?.explanation ?? null,
        grab: null,
        tool: null,
      },
      b: null,
    };
    this.receive({ message: state });
  }

  private vertex(vertex: number): VertexReply {
    const recording = this.opened();
    const { geometry, corners, weights, scene } = this.surface;
    if (!(vertex in geometry.vertex)) throw new Error(`there is no vertex ${vertex}`);
    const positions = carried(this.surface, recording.positions(this.frame));
    const at = (x: Float32Array): Vec3 => vectorAt(x, vertex);
    const user = geometry.vertex[vertex];
    const isFine = user === 0xffffffff;
    const values: VertexReply["values"] = {};
    for (const { name } of scene.fields) {
      const value = recording.values(name, this.frame, this.surface, positions)[vertex];
      values[name] = Number.isFinite(value) ? value : null;
    }
    return {
      vertex: isFine ? -1 : user,
      first_entry: isFine ? -1 : 3 * user,
      rest: at(geometry.rest),
      position: at(positions),
      velocity: this.velocity(at),
      mass: recording.isFigure ? undefined : weights ? 0 : recording.floats("point.mass")[corners[vertex]],
      pinned: this.isPinned(vertex),
      values,
    };
  }

  // Mean velocity since the previous frame; equals that of backward Euler if every step has a frame.
  private velocity(at: (x: Float32Array) => Vec3): Vec3 {
    if (this.frame === 0) return [0, 0, 0];
    const recording = this.opened();
    const { time } = recording.head.frames;
    const [before, now] = [this.frame - 1, this.frame].map((frame) => at(carried(this.surface, recording.positions(frame))));
    return now.map((x, axis) => (x - before[axis]) / (time[this.frame] - time[this.frame - 1])) as Vec3;
  }
}
