// Messages between the page and the program. Text frames are JSON: the page sends `Command`s and `Query`s, the program
// `ServerMessage`s. Binary frames, from the program only, are geometry and pictures; all numbers are little-endian.
// apps/viewer/protocol.md describes their meaning. A number that is not finite is null.

import type { MaybeNumber } from "./numbers";
import type { StepFields } from "./stepFields";

export type SideName = "a" | "b";
export type Vec3 = [number, number, number];
export type { MaybeNumber };
export type SettingValue = number | string | boolean | (number | string)[];

// ---------------------------------------------------------------- page -> program

// Changes the state; only the page that steers may send it. With an id, answered by `reply` or `refused`.
export type Command = { id?: number } & (
  | { do: "play" }
  | { do: "pause" }
  | { do: "step" } // one time step
  | { do: "iterate" } // one iteration of the minimizer; after the last one the step is complete
  | { do: "reset" }
  | { do: "rewind"; step: number } // to the end of a step in `timeline`; 0 is the initial state
  | { do: "speed"; value: number } // target of play: simulated seconds per second of wall time
  | { do: "set"; key: string; value: SettingValue | null; side?: SideName } // null: value of the file; no side: both
  // A scene or a mesh: a path on the program's machine, or the name of one of the files in this command.
  | { do: "load"; scene: string; overrides?: string[]; files?: UploadedFile[] }
  | { do: "lesson"; lesson: string }
  | { do: "grab"; side: SideName; triangle: number; weights: Vec3; target: Vec3 } // weights of the triangle's corners
  | { do: "move"; target: Vec3 }
  | { do: "release" }
  | { do: "stiffness"; value: number } // stiffness of the mouse's spring [N/m]
  | { do: "pin"; side: SideName; vertices: number[]; pinned: boolean } // vertices of the visible surface
  // Of an extension: inverse/web/bench/protocol.ts.
  | { do: "touch" | "press" | "lift" | "keep" | "forget" | "fit" | "stop_fit"; [member: string]: unknown }
  | { do: "compare"; overrides: string[]; label: string } // opens side b: the scene of side a with these overrides
  | { do: "end_compare" }
  | { do: "color"; field: string } // name in Scene.fields; "": no field
  | { do: "surface"; which: "skin" | "cage" }
  | { do: "replay"; recording: Recording } // resets, then repeats the mouse's actions and the changes of settings
  | { do: "take" } // requests to steer; any page may send it
);

export interface UploadedFile {
  name: string; // relative path with "/" between folders
  gzip: string; // base64 of gzip
}

// Query: changes nothing; any page may send it. Always has an id; answered by `reply` or `refused`.
export type Query =
  | { ask: "vertex"; side: SideName; vertex: number } // vertex of the visible surface
  | { ask: "tet"; side: SideName; triangle: number } // the tet behind a triangle of the surface
  | { ask: "iteration"; side: SideName; step: number; iteration: number } // landscape around the iteration
  | { ask: "worst"; side: SideName }
  | { ask: "mesh_error"; side: SideName } // adds the estimate after the last step to its row; the reply is its text
  | ({ ask: "function" } & FunctionQuestion)
  | { ask: "mesh"; side: SideName; format: "obj" | "ply" | "vtu" | "msh" | "mesh" } // mesh as deformed now
  | { ask: "scene"; side: SideName } // the complete scene for `aspic run`, including drags
  | { ask: "scene_files"; side: SideName } // the same without drags, for the command "load"
  | { ask: "animation"; side: SideName; format: "usd" | "pc2" | "glb"; camera: unknown } // motion over the steps in the timeline
  | { ask: "gallery" } // scenes to choose from
  | { ask: "recording" }
  | { ask: "fit_state" | "fit_report" }; // of an extension

export interface FunctionQuestion {
  name: string; // "rosenbrock", "two_bump", "quadratic", or a formula of x and y
  start: [number, number];
  settings: Record<string, SettingValue>; // keys of [solver]: "method", "definiteness", "line_search.shrink", ...
  iteration: number; // iteration whose curve along d is returned
  samples: number; // samples of the surface per axis; at most 101
}

// ---------------------------------------------------------------- program -> page

export type ServerMessage =
  | Hello
  | { kind: "role"; steers: boolean }
  | Scene
  | { kind: "end_compare" } // side b is removed
  | Obstacles
  | { kind: "steps"; side: SideName; from: number; steps: StepRow[] } // rows of steps from+1, ...; all later rows are invalid
  | { kind: "bench" } // of an extension, with further members
  | { kind: "pins"; side: SideName; vertices: number[] } // vertices of the surface
  | { kind: "fibres"; side: SideName; generation: number; lines: number[] } // triangle, shares of its edges from corner 0; ...
  | State
  | { kind: "busy"; what: string } // "" when finished
  | { kind: "reply"; id: number; reply: unknown }
  | { kind: "refused"; id: number | null; why: string; interrupted?: true }; // interrupted: the question may be repeated

export interface Hello {
  kind: "hello";
  protocol: 1;
  version: string; // version of Aspic
  steers: boolean;
  live: boolean; // false: a recorded run
  lessons: Lesson[];
}

export interface Lesson {
  id: string;
  pages: string; // "33-34"
  title: string;
  claim: string; // statement of the lecture
  exercise: string; // what to look at and to try
  question?: string; // for the reader
  answer?: string;
  panel: PanelName; // panel to open
  log?: boolean; // logarithmic energies
  function?: FunctionQuestion; // question for the functions panel
  missing?: string; // reason why it cannot be shown
}
// Numbers of a lesson's demonstration, judged as by `aspic lecture`.
export interface Measure {
  what: string;
  value: number | string; // "inf": overflow
  unit: string;
  relation?: string; // "<="; none: not judged
  bound?: number | string;
  holds?: boolean;
  reason?: string; // source of the bound
}
export interface Judgment {
  pages: number[];
  passes: boolean;
  seconds: number;
  measures: Measure[];
  remarks: string[];
}
export type PanelName = "energy" | "microscope" | "landscape" | "functions";

export interface Scene {
  kind: "scene";
  side: SideName;
  generation: number; // generation of the geometry; pictures carry the same number
  name: string;
  label: string; // label of the side in a comparison, otherwise ""
  path: string;
  overrides: string[];
  loaded_overrides: string[]; // overrides before any change of a setting
  notes: string[];
  surface: "skin" | "cage";
  has_skin: boolean; // whether a fine skin exists apart from the cage
  vertices: number;
  tets: number;
  triangles?: number; // of sheets; missing in recordings of earlier versions
  bodies: string[];
  body_tets: number[]; // first tet of each body, in the user's numbering
  thickness?: number[]; // of each body [m]; 0: not a sheet; missing in recordings of earlier versions
  lower: Vec3; // bounding box of the initial state, with obstacles that are not much larger
  upper: Vec3;
  up: Vec3; // direction against gravity
  h: number; // time step [s]
  implicit: boolean; // whether the integrator minimizes
  solver: string; // summary of the methods
  potentials: string[]; // names of the terms of V, as in StepRow.potential
  fields: Field[];
  field: string; // field shown; "": none
  settings: Setting[];
  stiffness: number; // stiffness of the mouse's spring [N/m]
}

// The obstacles of a scene with contact, in their present positions.
export interface Obstacles {
  kind: "obstacles";
  side: SideName;
  generation: number; // generation of the geometry
  obstacles: Obstacle[];
}

export interface Obstacle {
  name: string;
  plane: { origin: Vec3; normal: Vec3 } | null; // infinite; the normal points to the bodies
  points: number[]; // 3 per point [m]; of a plane: a square below the bodies
  triangles: number[];
}

export interface Field {
  name: string; // "von_mises"
  label: string; // "von Mises stress"
  unit: string; // "Pa"
  diverging: boolean; // colors diverge from `center`
  center: number;
  log: boolean; // default scale is logarithmic
}

export interface Setting {
  key: string; // key in a scene: "material.young"
  label: string; // "E"
  group: string; // "Material", "Time", "World", "Solver", "Line search"
  unit: string;
  meaning: string;
  kind: "number" | "integer" | "choice" | "switch" | "vector" | "text";
  value: SettingValue;
  min: number; // lower end of the slider; typed values may be smaller
  max: number;
  log: boolean;
  choices: string[];
}

export interface StepRow extends StepFields {
  iterations: IterationRow[];
  mouse_work: MaybeNumber; // work of the mouse in this step [J]; pin_work excludes it and tool_work
  tool_work: MaybeNumber; // work of the tool of an extension [J]
  reactions?: Record<string, MaybeNumber[]>; // per pin: force [N] and moment about the origin [N m], x y z
  explanation: { cause: string; place: string; remedy: string } | null; // explanation of a failed convergence
}

export interface IterationRow {
  value: MaybeNumber; // E before the iteration
  gradient_norm: MaybeNumber;
  decrement: MaybeNumber;
  alpha: MaybeNumber; // 0: no step found
  projected_elements: number;
  linear_iterations: number;
  seconds: Record<"hessian" | "factorize" | "solve" | "line_search" | "gradient", number>;
  trials: TrialRow[]; // empty in a recorded run without a trace
}

export interface TrialRow {
  alpha: number;
  value: MaybeNumber;
  bound: MaybeNumber; // largest value that the test accepts; null: any
  accepted: boolean;
}

export interface State {
  kind: "state";
  playing: boolean;
  speed: number;
  rate: number; // measured speed: simulated seconds per second of wall time; 0 when paused
  replaying: boolean;
  a: SideState;
  b: SideState | null;
}

export interface SideState {
  step: number;
  time: number;
  iteration: number; // iteration of the step under way that the picture shows; -1 between steps
  iterations?: IterationRow[]; // iterations of that step so far
  timeline: { first: number; last: number }; // range of steps for rewind; steps inside may be thinned out
  status: string; // status of the last step; "" in the initial state
  words: { cause: string; place: string; remedy: string } | null;
  grab: { point: Vec3; target: Vec3; force: Vec3 } | null; // force on the body [N]
  tool: unknown; // tool of an extension on the body; null: none
}

// Actions by step; enough to repeat a session bit by bit.
export interface Recording {
  scene: string;
  overrides: string[];
  compare: { overrides: string[]; label: string } | null;
  // Executed before that step of side a and, in a comparison, when side b had completed `b` steps.
  events: { step: number; b?: number; command: Command }[];
  steps: number;
}

// ---------------------------------------------------------------- replies

export interface VertexReply {
  vertex: number; // in the user's numbering; -1 for a point of a fine skin
  first_entry: number; // q[first_entry .. first_entry + 2]
  rest: Vec3;
  position: Vec3; // [m]
  velocity: Vec3; // [m/s]
  mass?: number; // [kg]; missing in a figure of arrays
  pinned: boolean;
  values: Record<string, MaybeNumber>; // value of every field at the vertex
}

export interface TetReply {
  tet: number; // in the user's numbering
  corners: [number, number, number, number]; // vertices in the user's numbering
  positions: [Vec3, Vec3, Vec3, Vec3];
  F: [Vec3, Vec3, Vec3]; // rows
  J: MaybeNumber;
  stretches: Vec3; // largest first
  cauchy: [Vec3, Vec3, Vec3]; // [Pa]
  von_mises: MaybeNumber;
  energy_density: MaybeNumber; // [J/m^3]
  energy: MaybeNumber; // [J]
  volume: number; // rest volume [m^3]
  quality: number; // 1 for a regular tet
  young: MaybeNumber;
  poisson: MaybeNumber;
  density: number;
}

export interface IterationReply {
  step: number;
  iteration: number;
  value: number; // E
  alpha: number;
  trials: TrialRow[];
  max_step: MaybeNumber; // largest alpha that contact allows; null: all of the curve
  curve: { alpha: number[]; value: MaybeNumber[]; model: MaybeNumber[]; textbook: MaybeNumber[]; slide: MaybeNumber[] };
  slice: { columns: number; rows: number; s: number[]; t: number[]; value: MaybeNumber[]; model: MaybeNumber[]; blocked: number[] }; // blocked: samples that contact keeps x from reaching
  path: { s: number; t: number; value: MaybeNumber }[]; // iterates of the step, projected onto the plane; at most 1000
  text: string; // summary of the step's result
}

export interface WorstReply {
  items: { what: string; value: MaybeNumber; unit: string; tet: number; vertex: number; positions: Vec3[] }[];
}

export interface FunctionReply {
  lower: [number, number];
  upper: [number, number];
  formula: string;
  remarks: string;
  minimizer: [number, number] | null;
  samples: number;
  value: MaybeNumber[]; // samples x samples values, x fastest
  status: string;
  text: string; // message about the status
  path: { x: number; y: number; value: MaybeNumber }[]; // iterates
  iterations: IterationRow[];
  // Quadratic model that iteration `iteration` minimized, about its iterate.
  model: { center: [number, number]; value: number; gradient: [number, number]; xx: number; xy: number; yy: number };
  curve: IterationReply["curve"];
  trials: TrialRow[];
}

export interface TextReply {
  name: string; // file name
  text: string;
}

export interface FileReply {
  name: string;
  base64: string;
  note?: string;
}

// A scene with additional files is a ZIP archive.
export type SceneReply = (TextReply | FileReply) & { notes?: string[] };

export interface SceneFilesReply {
  scene: string;
  files: UploadedFile[];
  notes: string[];
}

export interface GalleryReply {
  scenes: { name: string; about: string; path: string; picture: string }[]; // URL of an image; "": none
  recent: string[]; // paths
}

// ---------------------------------------------------------------- binary

export const kGeometry = 1;
export const kPicture = 2;

// Header of 32 bytes: u32 kind = 1, u32 side, u32 generation, u32 vertices n, u32 triangles m, u32 edges e, 8 reserved.
export interface Geometry {
  side: SideName;
  generation: number;
  rest: Float32Array; // 3 n
  triangles: Uint32Array; // 3 m
  edges: Uint32Array; // 2 e
  tet: Uint32Array; // m: tet of each triangle, in the user's numbering
  vertex: Uint32Array; // n: user's number of each vertex; 0xffffffff for a point of a fine skin
}

// Header of 48 bytes: u32 kind = 2, u32 side, u32 generation, u32 vertices n, u32 step, i32 iteration (-1: complete
// step), f64 time, u32 has values, f32 smallest and f32 largest value, u32 contact points k.
export interface Picture {
  side: SideName;
  generation: number;
  step: number;
  iteration: number;
  time: number;
  positions: Float32Array; // 3 n
  normals: Int8Array; // 4 n: unit vectors times 127; the fourth number is 0
  values: Float32Array | null; // n values of Scene.field
  min: number; // smallest value on the surface; equal to max for a constant field
  max: number;
  arrows?: Float32Array; // start and vector of each arrow of a figure of arrays [m]
  contacts: Float32Array; // 4 k: points closer to another surface than the reach [m], and the pressure there [Pa]
}

function sideOf(view: DataView): SideName {
  return view.getUint32(4, true) === 0 ? "a" : "b";
}

export function decode(bytes: ArrayBuffer): { geometry: Geometry } | { picture: Picture } {
  const view = new DataView(bytes);
  const kind = view.getUint32(0, true);
  const generation = view.getUint32(8, true);
  const n = view.getUint32(12, true);
  if (kind === kGeometry) {
    const m = view.getUint32(16, true);
    const e = view.getUint32(20, true);
    let at = 32;
    const words = (count: number): Uint32Array => {
      const array = new Uint32Array(bytes, at, count);
      at += 4 * count;
      return array;
    };
    const rest = new Float32Array(bytes, at, 3 * n);
    at += 12 * n;
    const [triangles, edges, tet, vertex] = [words(3 * m), words(2 * e), words(m), words(n)];
    return { geometry: { side: sideOf(view), generation, rest, triangles, edges, tet, vertex } };
  }
  if (kind !== kPicture) throw new Error(`unknown binary message ${kind}`);
  const hasValues = view.getUint32(32, true) === 1;
  const end = 48 + (hasValues ? 20 : 16) * n;
  return {
    picture: {
      side: sideOf(view),
      generation,
      step: view.getUint32(16, true),
      iteration: view.getInt32(20, true),
      time: view.getFloat64(24, true),
      min: view.getFloat32(36, true),
      max: view.getFloat32(40, true),
      positions: new Float32Array(bytes, 48, 3 * n),
      normals: new Int8Array(bytes, 48 + 12 * n, 4 * n),
      values: hasValues ? new Float32Array(bytes, 48 + 16 * n, n) : null,
      contacts: new Float32Array(bytes, end, 4 * view.getUint32(44, true)),
    },
  };
}
