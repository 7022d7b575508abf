// What the page and the program say to each other. Text frames are JSON: the page sends `Command`s and `Query`s, the
// program `ServerMessage`s. Binary frames, from the program only, are geometry and pictures; all numbers little-endian.
// docs/viewer_protocol.md describes their meaning. A number that is not finite travels as null.

import type { StepFields } from "./stepFields";

export type SideName = "a" | "b";
export type Vec3 = [number, number, number];
export type MaybeNumber = number | null;
export type SettingValue = number | string | boolean | (number | string)[];

// ---------------------------------------------------------------- page -> program

// Changes something; only the page that steers may send it. Answered by `reply` or `refused` when it carries an id.
export type Command = { id?: number } & (
  | { do: "play" }
  | { do: "pause" }
  | { do: "step" } // one time step
  | { do: "iterate" } // one iteration of the minimizer; after the last one the step is complete
  | { do: "reset" }
  | { do: "rewind"; step: number } // to the end of a step that `timeline` still holds; 0 is the start
  | { do: "speed"; value: number } // simulated seconds per second of wall time that play aims at
  | { do: "set"; key: string; value: SettingValue | null; side?: SideName } // null: as the scene's file has it; both sides without `side`
  // A scene or a mesh: a path on the program's machine, or the name of one of the files that come with the command.
  | { do: "load"; scene: string; overrides?: string[]; files?: UploadedFile[] }
  | { do: "lesson"; lesson: string }
  | { do: "grab"; side: SideName; triangle: number; weights: Vec3; target: Vec3 } // weights of the triangle's corners
  | { do: "move"; target: Vec3 }
  | { do: "release" }
  | { do: "stiffness"; value: number } // of the mouse's spring [N/m]
  | { do: "pin"; side: SideName; vertices: number[]; pinned: boolean } // vertices of the surface that is shown
  // A rigid tip touches the body at that point along the inward normal; what is left out is chosen by the program.
  | ({ do: "touch"; side: SideName; triangle: number; weights: Vec3; stiffness?: number } & Partial<TipChoice>)
  | { do: "press"; depth: number; shift?: Vec3 } // to so far along the tip's axis from where it touched [m]
  | { do: "lift" } // the tip is taken away
  | { do: "bench"; markers?: number; noise?: number; seed?: number; same_mesh?: boolean } // sets the virtual bench up
  | { do: "record"; depths?: number } // the tip's pose as load cases, in equal parts up to it
  | ({ do: "poke_all"; sites: number; depths: number; depth: number } & Partial<TipChoice>) // all over the body
  | { do: "forget"; case?: number } // a recorded case; all without it
  | { do: "save_capture"; folder: string } // as a data set, a path on the program's machine
  | { do: "fit" } // Young's modulus of every tet to the recorded cases, in the background
  | { do: "stop_fit" }
  | { do: "simulate_fit" } // side b has the fitted material
  | { do: "compare"; overrides: string[]; label: string } // opens side b: the scene of side a with these overrides
  | { do: "end_compare" }
  | { do: "color"; field: string } // name in Scene.fields; "" for none
  | { do: "surface"; which: "skin" | "cage" }
  | { do: "replay"; recording: Recording } // resets, then repeats what the mouse did, and the settings
  | { do: "take" } // this page wants to steer; any page may send it
);

export interface UploadedFile {
  name: string; // relative, with "/" between folders
  gzip: string; // in base64
}

export interface TipChoice {
  shape: "sphere" | "disc";
  contact: "bonded" | "sliding";
  radius: number; // [m]
}

// Asks; changes nothing; any page may send it. Always carries an id; answered by `reply` or `refused`.
export type Query =
  | { ask: "vertex"; side: SideName; vertex: number } // of the surface that is shown
  | { ask: "tet"; side: SideName; triangle: number } // the tet behind a triangle of the surface
  | { ask: "iteration"; side: SideName; step: number; iteration: number } // the landscape around it
  | { ask: "worst"; side: SideName }
  | ({ ask: "function" } & FunctionQuestion)
  | { ask: "mesh"; side: SideName; format: "obj" | "ply" | "vtu" | "msh" | "mesh" } // as deformed now
  | { ask: "scene"; side: SideName } // what `aspic run` runs: complete, with the drags so far
  | { ask: "scene_files"; side: SideName } // the same without drags, for the command "load"
  | { ask: "animation"; side: SideName; format: "usd" | "pc2" | "glb" } // of the steps that the timeline holds
  | { ask: "gallery" } // scenes to choose from
  | { ask: "recording" };

export interface FunctionQuestion {
  name: string; // "rosenbrock", "two_bump", "quadratic", or a formula of x and y
  start: [number, number];
  settings: Record<string, SettingValue>; // keys of [solver]: "method", "definiteness", "line_search.shrink", ...
  iteration: number; // whose curve along d is wanted
  samples: number; // of the surface, per axis; at most 101
}

// ---------------------------------------------------------------- program -> page

export type ServerMessage =
  | Hello
  | { kind: "role"; steers: boolean }
  | Scene
  | { kind: "end_compare" } // side b is gone
  | { kind: "steps"; side: SideName; from: number; steps: StepRow[] } // rows of steps from+1, ...; later ones are void
  | Capture
  | { kind: "pins"; side: SideName; vertices: number[] } // of the surface
  | State
  | { kind: "busy"; what: string } // "" when done
  | { kind: "reply"; id: number; reply: unknown }
  | { kind: "refused"; id: number | null; why: string };

export interface Hello {
  kind: "hello";
  protocol: 1;
  version: string; // of Aspic
  steers: boolean;
  live: boolean; // false: a recorded run
  lessons: Lesson[];
}

export interface Lesson {
  id: string;
  pages: string; // "33-34"
  title: string;
  claim: string; // what the lecture says there
  look: string; // what to look at, two sentences
  panel: PanelName; // to be opened
  function?: FunctionQuestion; // for the functions panel
  missing?: string; // why it cannot be shown
}
export type PanelName = "energy" | "microscope" | "landscape" | "functions";

export interface Scene {
  kind: "scene";
  side: SideName;
  generation: number; // of the geometry: pictures carry the same
  name: string;
  label: string; // of the side in a comparison, else ""
  path: string;
  overrides: string[];
  loaded_overrides: string[]; // before any setting was changed
  notes: string[];
  surface: "skin" | "cage";
  has_skin: boolean; // a fine skin apart from the cage
  vertices: number;
  tets: number;
  bodies: string[];
  body_tets: number[]; // the first tet of each body, by the user's numbers
  lower: Vec3; // box around the start
  upper: Vec3;
  up: Vec3; // against gravity
  h: number; // [s]
  implicit: boolean; // minimizes
  solver: string; // methods in words
  potentials: string[]; // names of the terms of V, as in StepRow.potential
  fields: Field[];
  field: string; // shown now; "" for none
  settings: Setting[];
  stiffness: number; // of the mouse's spring [N/m]
}

export interface Field {
  name: string; // "von_mises"
  label: string; // "von Mises stress"
  unit: string; // "Pa"
  diverging: boolean; // about `center`
  center: number;
  log: boolean; // looked at on a logarithmic scale, unless another is chosen
}

export interface Setting {
  key: string; // "material.young", as in a scene
  label: string; // "E"
  group: string; // "Material", "Time", "World", "Solver", "Line search"
  unit: string;
  meaning: string;
  kind: "number" | "integer" | "choice" | "switch" | "vector" | "text";
  value: SettingValue;
  min: number; // of the slider, not of what is allowed
  max: number;
  log: boolean;
  choices: string[];
}

export interface StepRow extends StepFields {
  iterations: IterationRow[];
  mouse_work: MaybeNumber; // in this step [J]; pin_work is without it and without probe_work
  probe_work: MaybeNumber;
  reactions?: Record<string, MaybeNumber[]>; // of each pin: its force [N] and moment about the origin [N m], x y z
  explanation: { cause: string; place: string; remedy: string } | null; // why it did not converge
}

export interface IterationRow {
  value: MaybeNumber; // E before it
  gradient_norm: MaybeNumber;
  decrement: MaybeNumber;
  alpha: MaybeNumber; // 0: no step found
  projected_elements: number;
  linear_iterations: number;
  seconds: Record<"hessian" | "factorize" | "solve" | "line_search" | "gradient", number>;
  trials: TrialRow[]; // empty in a recorded run without trace
}

export interface TrialRow {
  alpha: number;
  value: MaybeNumber;
  bound: MaybeNumber; // the largest value that the test accepts; null: any
  accepted: boolean;
}

export interface State {
  kind: "state";
  playing: boolean;
  speed: number;
  rate: number; // simulated seconds per second of wall time, measured; 0 when paused
  replaying: boolean;
  a: SideState;
  b: SideState | null;
}

export interface SideState {
  step: number;
  time: number;
  iteration: number; // of the step under way, shown by the picture; -1 between steps
  iterations?: IterationRow[]; // of that step, so far
  timeline: { first: number; last: number }; // steps that rewind can reach; steps in between may be thinned out
  status: string; // of the last step; "" at the start
  words: { cause: string; place: string; remedy: string } | null;
  grab: { point: Vec3; target: Vec3; force: Vec3 } | null; // force on the body [N]
  probe: ProbeState | null;
}

// The virtual bench.
export interface Capture {
  kind: "capture";
  radius: number; // that the program would choose for a tip [m]
  noise: number; // standard deviation, relative to the largest motion and to the force of each case
  seed: number;
  words: string; // what has just happened
  notes: string[]; // of the mesh of the fit
  markers: { triangles: number[]; weights: number[] }; // on the surface of side a; 3 weights each
  cases: CaptureCase[];
  tets: number; // of the mesh of the fit; 0: there is none yet
  same_mesh: boolean; // it is that of the body: an inverse crime
  fit: CaptureFit | null;
}

export interface CaptureCase {
  name: string; // "poke 3, depth 2"
  group: string; // "poke 3"
  shape: TipChoice["shape"];
  radius: number;
  center: Vec3; // of the tip in this case [m]
  axis: Vec3;
  depth: number; // [m]
  force: Vec3; // as read, with its noise [N]
  push: number; // its part along the axis
  deviation: number; // of each part of the force [N]
}

export interface CaptureFit {
  running: boolean;
  stage: string; // what is being done; "" when nothing is
  words: string; // how it ended
  failure: string; // "" when it has not failed
  // chi: root mean square of the residuals, each by its standard deviation; 1 is as good as the noise allows
  iterations: { index: number; misfit: MaybeNumber; roughness: MaybeNumber; weight: MaybeNumber; chi: MaybeNumber }[];
  residuals: number;
  error: MaybeNumber; // root mean square of log(fitted / true modulus) over the volume
  softest: MaybeNumber; // [Pa]
  stiffest: MaybeNumber;
  has_material: boolean; // it can be simulated
  warnings: string[];
  next: { site: Vec3; words: string } | null; // where the next poke would tell most
}

// The tip that touches the body.
export interface ProbeState extends TipChoice {
  stiffness: number; // of the layer between tip and body [Pa/m]
  begun: Vec3; // its center when it touched [m]: of the sphere, or of the flat end
  center: Vec3; // now
  axis: Vec3; // out of the tip, into the body
  depth: number; // now [m]
  wanted: number; // by the end of the next step [m]
  force: Vec3; // of the tip on the body [N]
  torque: Vec3; // about its center [N m]
  points: number; // of the surface that it touches
}

// What was done, by step: enough to repeat a session to the same bits.
export interface Recording {
  scene: string;
  overrides: string[];
  compare: { overrides: string[]; label: string } | null;
  // Carried out before that step of side a and, in a comparison, when side b had taken `b` steps.
  events: { step: number; b?: number; command: Command }[];
  steps: number;
}

// ---------------------------------------------------------------- replies

export interface VertexReply {
  vertex: number; // by the user's numbers; -1 for a point of a fine skin
  first_entry: number; // q[first_entry .. first_entry + 2]
  rest: Vec3;
  position: Vec3; // [m]
  velocity: Vec3; // [m/s]
  mass: number; // [kg]
  pinned: boolean;
  values: Record<string, MaybeNumber>; // of every field there
}

export interface TetReply {
  tet: number; // by the user's numbers
  corners: [number, number, number, number]; // the user's vertices
  positions: [Vec3, Vec3, Vec3, Vec3];
  F: [Vec3, Vec3, Vec3]; // rows
  J: MaybeNumber;
  stretches: Vec3; // largest first
  cauchy: [Vec3, Vec3, Vec3]; // [Pa]
  von_mises: MaybeNumber;
  energy_density: MaybeNumber; // [J/m^3]
  energy: MaybeNumber; // [J]
  volume: number; // at rest [m^3]
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
  curve: { alpha: number[]; value: MaybeNumber[]; model: MaybeNumber[]; textbook: MaybeNumber[]; slide: MaybeNumber[] };
  slice: { columns: number; rows: number; s: number[]; t: number[]; value: MaybeNumber[]; model: MaybeNumber[] };
  path: { s: number; t: number; value: MaybeNumber }[]; // the step's iterates, projected onto the plane; at most 1000
  text: string; // how the step ended, in words
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
  value: MaybeNumber[]; // samples x samples, x fastest
  status: string;
  text: string; // the status in words
  path: { x: number; y: number; value: MaybeNumber }[]; // iterates
  iterations: IterationRow[];
  // The quadratic model that iteration `iteration` minimized, about its iterate.
  model: { center: [number, number]; value: number; gradient: [number, number]; xx: number; xy: number; yy: number };
  curve: IterationReply["curve"];
  trials: TrialRow[];
}

export interface TextReply {
  name: string; // a file name
  text: string;
}

export interface FileReply {
  name: string;
  base64: string;
  note?: string;
}

// A scene that needs other files is a ZIP archive.
export type SceneReply = (TextReply | FileReply) & { notes?: string[] };

export interface SceneFilesReply {
  scene: string;
  files: UploadedFile[];
  notes: string[];
}

export interface GalleryReply {
  scenes: { name: string; about: string; path: string }[];
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
  tet: Uint32Array; // m: the tet behind each triangle, by the user's numbers
  vertex: Uint32Array; // n: the user's number of each vertex; 0xffffffff for a point of a fine skin
}

// Header of 48 bytes: u32 kind = 2, u32 side, u32 generation, u32 vertices n, u32 step, i32 iteration (-1: of a whole
// step), f64 time, u32 has values, f32 smallest and f32 largest value, 4 reserved.
export interface Picture {
  side: SideName;
  generation: number;
  step: number;
  iteration: number;
  time: number;
  positions: Float32Array; // 3 n
  normals: Int8Array; // 4 n: unit vectors times 127, the fourth is 0
  values: Float32Array | null; // n, of Scene.field
  min: number; // over the surface; equal for a constant
  max: number;
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
    },
  };
}
