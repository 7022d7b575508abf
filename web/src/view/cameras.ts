// Camera of one or both views: position, rotation, panning and zoom. Independent of any canvas.
import { Matrix4, Quaternion, Vector3 } from "three";
import { Emitter } from "../emitter";
import type { Vec3 } from "../protocol";
import { fieldsOf, type Keeper } from "../page";
import type { Lens } from "./lens";

// orbit: turns about any axis; turntable: turns about `up` and the horizontal, so that the horizon stays level; flat:
// never turns.
export const kCameraModes = ["turntable", "orbit", "flat"] as const;
export type CameraMode = (typeof kCameraModes)[number];
export const kViewNames = ["front", "back", "left", "right", "top", "bottom", "isometric"] as const;
export type ViewName = (typeof kViewNames)[number];

const kSlope = Math.tan((15 * Math.PI) / 180); // tangent of half the field of view
const kTurn = 0.008; // [rad / px]

// Right-handed axes of a scene with any `up`: right, toward the reader in the front view, up.
export function sceneAxes(up: Vec3): { right: Vector3; front: Vector3; up: Vector3 } {
  const upward = new Vector3(...up);
  if (!(upward.length() > 0)) upward.set(0, 0, 1);
  upward.normalize();
  const across = Math.abs(upward.x) > 0.9 ? new Vector3(0, 1, 0) : new Vector3(1, 0, 0);
  const right = across.addScaledVector(upward, -across.dot(upward)).normalize();
  return { right, front: new Vector3().crossVectors(right, upward), up: upward };
}

// Orientation of a camera that looks from a direction, with `up` as far upward on the screen as possible.
export function orientationFrom(from: Vector3, up: Vector3, right: Vector3): Quaternion {
  const across = new Vector3().crossVectors(up, from);
  if (across.length() < 1e-6) across.copy(right);
  across.normalize();
  const upward = new Vector3().crossVectors(from, across).normalize();
  return new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(across, upward, from.clone().normalize()));
}

export class CameraRig extends Emitter<{ changed: void }> implements Keeper {
  mode: CameraMode = "turntable";
  orthographic = false;
  readonly target = new Vector3(); // [m]
  readonly orientation = new Quaternion(); // rotation from the camera to the scene
  distance = 3; // distance from the target [m]
  private up: Vec3 = [0, 0, 1];
  private size = 1; // radius of the scene [m]
  private shown = ""; // scene for which the camera was placed

  // Places the camera for a scene unless it was placed for that scene before.
  show(name: string, lower: Vec3, upper: Vec3, up: Vec3): void {
    const key = JSON.stringify([name, lower, upper, up]);
    this.up = up;
    this.size = Math.max(new Vector3(...upper).sub(new Vector3(...lower)).length() / 2, 1e-12);
    if (key === this.shown) return;
    this.shown = key;
    this.orientation.copy(this.viewOrientation(this.mode === "flat" ? "front" : "isometric"));
    this.center(lower, upper);
  }

  // Fits the box to the view.
  center(lower: Vec3, upper: Vec3): void {
    const radius = new Vector3(...upper).sub(new Vector3(...lower)).length() / 2;
    if (!Number.isFinite(radius)) return;
    this.target.set(...lower).add(new Vector3(...upper)).multiplyScalar(0.5);
    this.distance = (1.05 * Math.max(radius, 1e-3 * this.size)) / Math.sin(Math.atan(kSlope));
    this.emit("changed", undefined);
  }

  setView(name: ViewName): void {
    this.orientation.copy(this.viewOrientation(name));
    this.emit("changed", undefined);
  }

  setMode(mode: CameraMode): void {
    this.mode = mode;
    if (mode === "turntable") this.orientation.copy(orientationFrom(this.axis(2), sceneAxes(this.up).up, this.axis(0))); // levels the horizon
    if (mode === "flat") {
      this.faceAxis();
      this.orthographic = true;
    }
    this.emit("changed", undefined);
  }

  setOrthographic(orthographic: boolean): void {
    this.orthographic = orthographic;
    this.emit("changed", undefined);
  }

  // Turns by pixels; the scene follows the cursor.
  turn(dx: number, dy: number): void {
    if (this.mode === "flat") return;
    const sideways = new Vector3(1, 0, 0);
    if (this.mode === "orbit") {
      this.orientation.multiply(new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), -kTurn * dx));
      this.orientation.multiply(new Quaternion().setFromAxisAngle(sideways, -kTurn * dy));
    } else {
      const upward = sceneAxes(this.up).up;
      this.orientation.premultiply(new Quaternion().setFromAxisAngle(upward, -kTurn * dx));
      const tilt = Math.atan2(this.axis(2).dot(upward), this.axis(1).dot(upward)); // angle above the horizon
      const turned = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, tilt + kTurn * dy));
      this.orientation.multiply(new Quaternion().setFromAxisAngle(sideways, tilt - turned));
    }
    this.orientation.normalize();
    this.emit("changed", undefined);
  }

  pan(dx: number, dy: number, height: number): void {
    const scale = (2 * kSlope * this.distance) / Math.max(1, height); // [m / px]
    this.target.addScaledVector(this.axis(0), -scale * dx).addScaledVector(this.axis(1), scale * dy);
    this.emit("changed", undefined);
  }

  // Zooms about the point under the cursor at the target's depth. x and y in pixels from the middle, y upward.
  zoom(factor: number, x: number, y: number, height: number): void {
    const distance = Math.min(1e4 * this.size, Math.max(1e-4 * this.size, this.distance * factor));
    const scale = (2 * kSlope * (this.distance - distance)) / Math.max(1, height);
    this.target.addScaledVector(this.axis(0), scale * x).addScaledVector(this.axis(1), scale * y);
    this.distance = distance;
    this.emit("changed", undefined);
  }

  lens(width: number, height: number): Lens {
    const back = this.axis(2);
    const slope = kSlope * Math.max(1, height / Math.max(1, width)); // a tall view shows an equal extent across
    return {
      eye: this.target.clone().addScaledVector(back, this.distance).toArray(),
      right: this.axis(0).toArray(),
      up: this.axis(1).toArray(),
      forward: back.negate().toArray(),
      slope: this.orthographic ? 0 : slope,
      extent: this.orthographic ? slope * this.distance : 0,
      width,
      height,
    };
  }

  join(other: CameraRig): void {
    [this.mode, this.orthographic, this.distance] = [other.mode, other.orthographic, other.distance];
    this.target.copy(other.target);
    this.orientation.copy(other.orientation);
    this.emit("changed", undefined);
  }

  save(): unknown {
    const { mode, orthographic, distance, shown } = this;
    return { mode, orthographic, distance, shown, target: this.target.toArray(), orientation: this.orientation.toArray() };
  }

  restore(saved: unknown): void {
    const camera = fieldsOf(saved);
    const mode = kCameraModes.find((name) => name === camera.mode);
    const target = numbers(camera.target, 3);
    const orientation = numbers(camera.orientation, 4);
    const distance = numbers([camera.distance], 1);
    if (!mode || !target || !orientation || !distance || !(distance[0] > 0) || !(Math.hypot(...orientation) > 0)) return;
    this.mode = mode;
    this.orthographic = camera.orthographic === true;
    this.target.fromArray(target);
    this.orientation.fromArray(orientation).normalize();
    this.distance = distance[0];
    this.shown = typeof camera.shown === "string" ? camera.shown : "";
    this.emit("changed", undefined);
  }

  private axis(k: 0 | 1 | 2): Vector3 {
    return new Vector3().setComponent(k, 1).applyQuaternion(this.orientation);
  }

  private viewOrientation(name: ViewName): Quaternion {
    const { right, front, up } = sceneAxes(this.up);
    const from: Record<ViewName, Vector3> = {
      front: front.clone(),
      back: front.clone().negate(),
      left: right.clone().negate(),
      right: right.clone(),
      top: up.clone(),
      bottom: up.clone().negate(),
      isometric: front.clone().multiplyScalar(1.5).add(right).addScaledVector(up, 0.8),
    };
    return orientationFrom(from[name].normalize(), up, right);
  }

  // Turns to the canonical view nearest to the present direction.
  private faceAxis(): void {
    const views = kViewNames.filter((name) => name !== "isometric").map((name) => this.viewOrientation(name));
    const angles = views.map((view) => new Vector3(0, 0, 1).applyQuaternion(view).angleTo(this.axis(2)));
    this.orientation.copy(views[angles.indexOf(Math.min(...angles))]);
  }
}

function numbers(value: unknown, count: number): number[] | null {
  if (!Array.isArray(value) || value.length !== count) return null;
  return value.every((entry) => typeof entry === "number" && Number.isFinite(entry)) ? (value as number[]) : null;
}
