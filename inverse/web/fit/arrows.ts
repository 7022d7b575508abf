// Arrows and balls in a view, lit like the body and hidden behind it. Positions in meters.
import * as THREE from "three";
import type { Vec3 } from "../../../web/src/protocol";

export interface Arrow {
  from: Vec3;
  to: Vec3;
}

const kUp = new THREE.Vector3(0, 1, 0);
const kHead = 0.35; // largest length of the head relative to the arrow
const kSegments = 14;

function instanced(geometry: THREE.BufferGeometry, material: THREE.Material, matrices: THREE.Matrix4[]): THREE.InstancedMesh {
  const mesh = new THREE.InstancedMesh(geometry, material, matrices.length);
  matrices.forEach((matrix, i) => mesh.setMatrixAt(i, matrix));
  mesh.frustumCulled = false;
  return mesh;
}

// Round shafts of the given `radius` [m], with heads.
export function makeArrows(arrows: readonly Arrow[], radius: number, color: string): THREE.Group {
  const material = new THREE.MeshLambertMaterial({ color: color });
  const [shafts, heads]: [THREE.Matrix4[], THREE.Matrix4[]] = [[], []];
  for (const { from, to } of arrows) {
    const start = new THREE.Vector3(...from);
    const way = new THREE.Vector3(...to).sub(start);
    const size = way.length();
    if (!(size > 0)) continue;
    const turn = new THREE.Quaternion().setFromUnitVectors(kUp, way.clone().divideScalar(size));
    const head = Math.min(kHead * size, 6 * radius);
    const middle = start.clone().addScaledVector(way, (size - head) / 2 / size);
    shafts.push(new THREE.Matrix4().compose(middle, turn, new THREE.Vector3(radius, size - head, radius)));
    const tip = start.clone().addScaledVector(way, (size - head / 2) / size);
    heads.push(new THREE.Matrix4().compose(tip, turn, new THREE.Vector3(2.6 * radius, head, 2.6 * radius)));
  }
  const group = new THREE.Group();
  group.add(instanced(new THREE.CylinderGeometry(1, 1, 1, kSegments), material, shafts));
  group.add(instanced(new THREE.ConeGeometry(1, 1, kSegments), material, heads));
  return group;
}

export function makeBalls(centers: readonly Vec3[], radius: number, color: string, opacity = 1): THREE.Group {
  const material = new THREE.MeshLambertMaterial({ color: color, transparent: opacity < 1, opacity });
  const matrices = centers.map((c) => new THREE.Matrix4().makeScale(radius, radius, radius).setPosition(...c));
  const group = new THREE.Group();
  group.add(instanced(new THREE.SphereGeometry(1, 20, 14), material, matrices));
  return group;
}
