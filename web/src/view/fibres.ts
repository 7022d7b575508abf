// Fibres at the surface as short lines, which move with their triangles.
import * as THREE from "three";

const kLift = 0.03; // above the surface, relative to the edges

// Ends of the lines, 6 numbers each. `lines`: as in the message "fibres".
export function fibreEnds(lines: number[], triangles: Uint32Array, positions: Float32Array): Float32Array {
  const ends = new Float32Array(2 * lines.length);
  for (let i = 0; i < lines.length; i += 3) {
    const [p, q, r] = [0, 1, 2].map((corner) => 3 * triangles[3 * lines[i] + corner]);
    const e = [0, 1, 2].map((c) => positions[q + c] - positions[p + c]);
    const f = [0, 1, 2].map((c) => positions[r + c] - positions[p + c]);
    const normal = [e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]];
    const lift = kLift / Math.sqrt(Math.hypot(...normal) || 1);
    for (let c = 0; c < 3; ++c) {
      const half = 0.5 * (lines[i + 1] * e[c] + lines[i + 2] * f[c]);
      const middle = positions[p + c] + (e[c] + f[c]) / 3 + lift * normal[c];
      ends[2 * i + c] = middle - half;
      ends[2 * i + 3 + c] = middle + half;
    }
  }
  return ends;
}

export class FibreLines extends THREE.LineSegments<THREE.BufferGeometry, THREE.LineBasicMaterial> {
  private lines: number[] = [];

  constructor() {
    super(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: "#a01830" }));
    this.frustumCulled = false;
    this.renderOrder = 1;
  }

  // Lines of triangles that the surface lacks belong to another surface, which is about to arrive.
  set(lines: number[], triangles: Uint32Array): void {
    this.lines = lines.every((at, i) => i % 3 !== 0 || 3 * at + 2 < triangles.length) ? lines : [];
  }

  show(triangles: Uint32Array, positions: Float32Array): void {
    if (this.lines.length === 0 && !this.geometry.getAttribute("position")) return;
    const ends = new THREE.BufferAttribute(fibreEnds(this.lines, triangles, positions), 3);
    this.geometry.setAttribute("position", ends.setUsage(THREE.DynamicDrawUsage));
    this.geometry.setDrawRange(0, (2 * this.lines.length) / 3);
  }
}
