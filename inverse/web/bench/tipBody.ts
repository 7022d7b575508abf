// The indenter in 3-D: its tip and the rod that holds it. In units of the stage.
import * as THREE from "three";
import type { Vec3 } from "../../../web/src/protocol";
import type { ToolShape } from "../../../web/src/view/viewTool";
import type { IndenterState } from "./protocol";

const kRod = 0.22; // radius of the rod relative to the tip
const kLength = 1.1; // length of the rod in units of the stage
const kUp = new THREE.Vector3(0, 1, 0);

export class TipBody extends THREE.Group implements ToolShape {
  private readonly metal = new THREE.MeshStandardMaterial({ metalness: 0.35, roughness: 0.35 });
  private readonly sphere = new THREE.Mesh(new THREE.SphereGeometry(1, 48, 24), this.metal);
  private readonly disc = new THREE.Mesh(new THREE.CylinderGeometry(1, 1, 0.35, 48), this.metal);
  private readonly rod = new THREE.Mesh(new THREE.CylinderGeometry(kRod, kRod, 1, 24), this.metal);

  constructor() {
    super();
    this.visible = false;
    this.disc.position.y = 0.175; // its flat end is at the center of the tip
    for (const part of [this.sphere, this.disc, this.rod]) part.castShadow = true;
    this.add(this.sphere, this.disc, this.rod);
  }

  // Returns true if something has changed.
  show(state: unknown, color: string, toUnits: (point: Vec3) => THREE.Vector3, radius: number): boolean {
    const tip = state as IndenterState | null;
    const was = this.visible;
    this.visible = tip !== null;
    if (!tip) return was;
    const size = tip.radius / radius;
    this.metal.color.set(color);
    this.sphere.visible = tip.shape === "sphere";
    this.disc.visible = tip.shape === "disc";
    this.position.copy(toUnits(tip.center));
    this.quaternion.setFromUnitVectors(kUp, new THREE.Vector3(...tip.axis).negate().normalize());
    this.scale.setScalar(size);
    this.rod.scale.y = kLength / size;
    this.rod.position.y = this.rod.scale.y / 2;
    return true;
  }
}
