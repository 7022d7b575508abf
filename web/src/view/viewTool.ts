// A tool of the mouse that an extension adds to the views, and its shape.
import type * as THREE from "three";
import type { SideName, Vec3 } from "../protocol";
import type { Store } from "../store";
import type { Lens } from "./lens";
import type { Hit, Surface } from "./picking";

// What tools use of a view.
export interface TouchedView {
  readonly store: Store;
  readonly side: SideName;
  lens(): Lens;
  surface(): Surface | null;
}

export interface ToolGesture {
  move(dx: number, dy: number): void; // of the pointer [px]
  flush(): void; // notifies the program; at most once per frame
}

export interface ToolShape extends THREE.Object3D {
  // `state`: SideState.tool; `radius`: unit of the stage [m]. Returns true if something has changed.
  show(state: unknown, color: string, toUnits: (point: Vec3) => THREE.Vector3, radius: number): boolean;
}

export interface ViewTool {
  begin(view: TouchedView, at: [number, number], hit: Hit | null): ToolGesture | null; // null: the camera turns
  makeShape(): ToolShape;
}
