// Contact points in 3-D, colored by pressure. Those behind a body shine through it faintly, but not through obstacles.
import * as THREE from "three";
import { short } from "../numbers";
import type { StepRow } from "../protocol";
import { colorAt } from "./colorMaps";
import { kAfterObstacles } from "./obstacles";
import { makePinMaterial } from "./shading";
import { valueText } from "./values";

export const kContactMap = "viridis";
const kSize = 10; // [px]
const kHidden = 0.3; // opacity of points behind a body

// Colors of the points, linear RGB. `largest`: pressure of the last color [Pa].
export function contactColors(contacts: Float32Array, largest: number): Float32Array {
  const colors = new Float32Array((3 * contacts.length) / 4);
  const color = new THREE.Color();
  for (let i = 0; 4 * i < contacts.length; ++i) {
    const [r, g, b] = colorAt(kContactMap, largest > 0 ? contacts[4 * i + 3] / largest : 0);
    color.setRGB(r / 255, g / 255, b / 255, THREE.SRGBColorSpace).toArray(colors, 3 * i);
  }
  return colors;
}

export function largestPressure(contacts: Float32Array): number {
  let largest = 0;
  for (let i = 3; i < contacts.length; i += 4) largest = Math.max(largest, contacts[i]);
  return largest;
}

// Summary of the contact at the end of a step.
export function contactText(row: Pick<StepRow, "contacts" | "min_gap" | "min_gap_pair" | "max_pressure">): string {
  if (row.contacts === 0) return "no contacts";
  const count = row.contacts === 1 ? "1 contact" : `${short(row.contacts)} contacts`;
  const pair = row.min_gap_pair ? ` (${row.min_gap_pair})` : "";
  return `${count}, smallest gap ${valueText(row.min_gap, "m", 3)}${pair}, largest pressure ${valueText(row.max_pressure, "Pa", 3)}`;
}

export class ContactDots extends THREE.Group {
  private readonly geometry = new THREE.BufferGeometry();
  private readonly lift = { value: 0 };
  readonly materials: THREE.PointsMaterial[];

  constructor() {
    super();
    // The stencil marks where no obstacle covers a point, before the bodies are drawn.
    const mark = { transparent: false, colorWrite: false, stencilWrite: true, stencilRef: 1, stencilZPass: THREE.ReplaceStencilOp };
    const hidden = { depthFunc: THREE.GreaterDepth, opacity: kHidden, stencilWrite: true, stencilRef: 1, stencilFunc: THREE.EqualStencilFunc };
    const points = [mark, hidden, {}].map((properties, i) => {
      const material = makePinMaterial(this.lift);
      Object.assign(material, { size: kSize, vertexColors: true, depthWrite: false }, properties);
      return Object.assign(new THREE.Points(this.geometry, material), { frustumCulled: false, renderOrder: i === 0 ? kAfterObstacles : 4 });
    });
    this.materials = points.map(({ material }) => material);
    this.add(...points);
    this.show(new Float32Array(0), 0);
  }

  // `contacts`: as in Picture. `largest`: pressure of the last color [Pa].
  show(contacts: Float32Array, largest: number): void {
    const places = new THREE.InterleavedBuffer(contacts, 4);
    this.geometry.setAttribute("position", new THREE.InterleavedBufferAttribute(places, 3, 0));
    this.geometry.setAttribute("color", new THREE.BufferAttribute(contactColors(contacts, largest), 3));
    this.geometry.setDrawRange(0, contacts.length / 4);
  }

  // Lifts the points in front of the surface that they lie on.
  adapt(liftPerPixel: number): void {
    this.lift.value = kSize * liftPerPixel;
  }
}
