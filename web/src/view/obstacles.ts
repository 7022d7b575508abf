// Obstacles in 3-D, in units of the stage: planes as ground with a grid, surfaces in a neutral color.
import * as THREE from "three";
import type { Obstacle, Vec3 } from "../protocol";
import { sceneAxes } from "./cameras";
import { disposeOf } from "./dispose";
import { dot, minus } from "./lens";
import { kGroundRadius, kSurface, makeGroundMaterial } from "./shading";

export const kAfterObstacles = -2; // order of what obstacles cover although bodies do not, which are drawn later

// Two unit vectors along a plane, the first as horizontal as possible.
export function planeAxes(normal: Vec3, up: Vec3): [Vec3, Vec3] {
  const n = new THREE.Vector3(...normal);
  const { right, front } = sceneAxes(up);
  const lead = Math.abs(n.dot(right)) < 0.9 ? right : front;
  const u = lead.clone().addScaledVector(n, -n.dot(lead)).normalize();
  return [u.toArray(), n.clone().cross(u).toArray()];
}

// The disk of a plane below the bodies.
class Ground extends THREE.Mesh {
  private readonly axes: [Vec3, Vec3];
  private readonly uniforms = {
    gridStep: { value: 1 },
    gridOrigin: { value: new THREE.Vector2() },
    gridColor: { value: new THREE.Color() },
    gridLines: { value: true },
    shadowBlur: { value: 1 },
  };

  constructor(
    private readonly plane: { origin: Vec3; normal: Vec3 },
    up: Vec3,
  ) {
    super(new THREE.CircleGeometry(kGroundRadius, 96));
    this.material = makeGroundMaterial(this.uniforms);
    this.axes = planeAxes(plane.normal, up);
    this.receiveShadow = true;
    this.renderOrder = -1;
    const [u, v] = this.axes.map((axis) => new THREE.Vector3(...axis));
    this.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(u, v, new THREE.Vector3(...plane.normal)));
  }

  // Moves the disk below a point. Its grid lines stay where they are.
  follow(point: Vec3, unit: Units): void {
    const { origin, normal } = this.plane;
    const depth = dot(normal, minus(point, origin));
    const foot = point.map((x, c) => x - depth * normal[c]) as Vec3;
    this.position.copy(unit.toUnits(foot));
    this.uniforms.gridStep.value = unit.gridStep / unit.radius;
    this.uniforms.gridOrigin.value.set(-dot(this.axes[0], foot) / unit.radius, -dot(this.axes[1], foot) / unit.radius);
  }

  // Multiplies the blur of shadows on the ground.
  blur(factor: number): void {
    this.uniforms.shadowBlur.value = factor;
  }

  // Without lines: a faint disk.
  color(color: string, lines: boolean): void {
    this.uniforms.gridLines.value = lines;
    this.uniforms.gridColor.value.set(color);
  }
}

export interface Units {
  radius: number; // length of a unit [m]
  gridStep: number; // spacing of the grid [m]
  toUnits(point: Vec3): THREE.Vector3;
}

export class ObstacleBodies extends THREE.Group {
  private readonly surfaces = new THREE.Group(); // [m]
  readonly material = new THREE.MeshPhongMaterial(kSurface);
  private grounds: Ground[] = [];

  constructor() {
    super();
    this.surfaces.matrixAutoUpdate = false;
  }

  get hasGround(): boolean {
    return this.visible && this.grounds.length > 0;
  }

  // `toStage`: from meters to units of the stage.
  show(obstacles: readonly Obstacle[], up: Vec3, toStage: THREE.Matrix4): void {
    disposeOf(this);
    this.surfaces.clear();
    this.surfaces.matrix.copy(toStage);
    this.grounds = obstacles.flatMap(({ plane }) => (plane ? [new Ground(plane, up)] : []));
    this.clear().add(this.surfaces, ...this.grounds);
    for (const { plane, points, triangles } of obstacles) {
      if (plane) continue;
      const corners = Float32Array.from(triangles.flatMap((p) => points.slice(3 * p, 3 * p + 3)));
      const shape = new THREE.BufferGeometry().setAttribute("position", new THREE.BufferAttribute(corners, 3));
      shape.computeVertexNormals(); // those of the triangles, which share no corners
      const mesh = new THREE.Mesh(shape, this.material);
      mesh.castShadow = mesh.receiveShadow = true;
      mesh.renderOrder = kAfterObstacles - 1;
      this.surfaces.add(mesh);
    }
  }

  follow(point: Vec3, unit: Units): void {
    for (const ground of this.grounds) ground.follow(point, unit);
  }

  blurShadows(factor: number): void {
    for (const ground of this.grounds) ground.blur(factor);
  }

  showGround(visible: boolean, color: string, lines: boolean): void {
    for (const ground of this.grounds) {
      ground.visible = visible;
      ground.color(color, lines);
    }
  }
}
