import * as THREE from "three";

// Releases the geometries and materials of an object and of everything in it.
export function disposeOf(object: THREE.Object3D): void {
  object.traverse((part) => {
    if (!(part instanceof THREE.Mesh || part instanceof THREE.Line || part instanceof THREE.Points)) return;
    part.geometry.dispose();
    for (const material of [part.material].flat()) material.dispose();
    if (part instanceof THREE.InstancedMesh) part.dispose();
  });
}
