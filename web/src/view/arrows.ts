// Vectors of a figure as arrows, each as thick as it is long.
import * as THREE from "three";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";

const kUp = new THREE.Vector3(0, 1, 0);

// An arrow of length 1 along y.
function makeArrow(): THREE.BufferGeometry {
  const shaft = new THREE.CylinderGeometry(0.015, 0.015, 0.75, 8).translate(0, 0.375, 0);
  return mergeGeometries([shaft, new THREE.ConeGeometry(0.05, 0.25, 12).translate(0, 0.875, 0)]);
}

// Matrices of the arrows; `arrows`: as in Picture.
export function arrowMatrices(arrows: Float32Array): THREE.Matrix4[] {
  const turn = new THREE.Quaternion();
  return Array.from({ length: arrows.length / 6 }, (_, i) => {
    const vector = new THREE.Vector3().fromArray(arrows, 6 * i + 3);
    const length = vector.length();
    turn.setFromUnitVectors(kUp, length > 0 ? vector.divideScalar(length) : kUp);
    return new THREE.Matrix4().compose(new THREE.Vector3().fromArray(arrows, 6 * i), turn, new THREE.Vector3().setScalar(length));
  });
}

export class Arrows extends THREE.Group {
  private readonly arrow = makeArrow();
  private readonly material = new THREE.MeshPhongMaterial({ color: "#2b2f38" });

  // `arrows`: as in Picture.
  show(arrows: Float32Array = new Float32Array(0)): void {
    for (const old of this.children) (old as THREE.InstancedMesh).dispose();
    this.clear();
    if (arrows.length === 0) return;
    const mesh = new THREE.InstancedMesh(this.arrow, this.material, arrows.length / 6);
    arrowMatrices(arrows).forEach((matrix, i) => mesh.setMatrixAt(i, matrix));
    mesh.frustumCulled = false;
    this.add(mesh);
  }
}
