// Messages of the bench (inverse/bench) and the members of its commands.
import type { Vec3 } from "../../../web/src/protocol";

export interface IndenterChoice {
  shape: "sphere" | "disc";
  contact: "bonded" | "sliding";
  radius: number; // [m]
}

export type BenchCommand =
  // Touches the body at that point along the inward normal. The program chooses omitted values.
  | ({ do: "touch"; side: "a" | "b"; triangle: number; weights: Vec3; stiffness?: number } & Partial<IndenterChoice>)
  | { do: "press"; depth: number } // since the first contact [m]
  | { do: "lift" }
  | { do: "keep" } // the reading of the gauge
  | { do: "forget"; reading?: number } // without it all readings
  | { do: "fit" } // writes a data set and runs aspic fit
  | { do: "stop_fit" };

// SideState.tool: the indenter on the body.
export interface IndenterState extends IndenterChoice {
  stiffness: number; // of its layer [Pa/m]
  begun: Vec3; // center at the first contact [m]: of the sphere, or of the flat end
  center: Vec3; // [m]
  axis: Vec3; // into the body
  depth: number; // [m]
  wanted: number; // depth at the end of the next step [m]
  force: number; // on the body, along the axis [N]
}

export interface Bench {
  kind: "bench";
  radius: number; // default radius of an indenter [m]
  readings: { name: string; radius: number; depth: number; force: number }[]; // [m, N]
}

// Reply to fit_state; null: no fit yet.
export interface FitState {
  running: boolean;
  folder: string; // of the data set, on the program's machine
  line: string; // last line of the output
  has_report: boolean;
}
