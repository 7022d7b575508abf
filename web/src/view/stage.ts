// The three.js scene around a body: lights, obstacles, camera and renderer. The unit of length is the radius of the
// scene's box, so that bodies of micrometers and of kilometers suit the GPU's single precision.
import * as THREE from "three";
import type { Obstacle, Scene, Vec3 } from "../protocol";
import { Arrows } from "./arrows";
import type { Body, Box } from "./body";
import { sceneAxes } from "./cameras";
import { ContactDots } from "./contacts";
import type { DisplaySettings } from "./display";
import { disposeOf } from "./dispose";
import { dot, isInside, length, minus, pixelsPerMeter, type Lens } from "./lens";
import { ObstacleBodies } from "./obstacles";
import type { Clip } from "./picking";
import { roundStep } from "./ranges";
import { kGroundRadius } from "./shading";
import type { ToolShape } from "./viewTool";

const kFarthest = 1e4; // limit for a body that bursts; beyond it depths lose their digits
const kLampWidth = 0.02; // 1 - cosine of half the angle of the lamp of soft light
const kLowestSky = 0.35; // sine of the lowest direction of soft light
const kSoftBlur = 5; // of shadows on the ground in soft light, which joins those of different directions
const kSoftSky = 0.8; // intensity of light without shadows in soft light
const kFar = 30; // far plane in radii of the scene, and in heights of the view

export class Stage {
  readonly renderer: THREE.WebGLRenderer; // the constructor throws without WebGL
  gridStep = 0; // spacing of the grid [m]
  isFar = false; // the body is too far away to be drawn
  hasLeft = false; // the body fits the view, but its middle is outside
  radius = 1; // radius of the scene's box [m]
  readonly extras = new THREE.Group(); // objects beside the body [m]
  private center: Vec3 = [0, 0, 0];
  private up: Vec3 = [0, 0, 1];
  private body: Body | null = null;
  private readonly scene = new THREE.Scene();
  private readonly perspective = new THREE.PerspectiveCamera();
  private readonly orthographic = new THREE.OrthographicCamera();
  private readonly sky = new THREE.HemisphereLight("#ffffff", "#c4bfb8", 1.9);
  private readonly sun = new THREE.DirectionalLight("#fffaf0", 1.9);
  private readonly dome = new THREE.DirectionalLight("#ffffff", 2.4); // one direction of a bright sky, only in soft light
  private readonly lamp = new THREE.DirectionalLight("#ffffff", 0.55); // light at the camera
  readonly obstacles = new ObstacleBodies();
  readonly contacts = new ContactDots();
  readonly arrows = new Arrows();
  private shift = [0, 0]; // shift of the picture, less than a pixel; the mean of shifted pictures has smooth edges
  private tool: ToolShape | null = null;
  private readonly lit = new THREE.Sphere(new THREE.Vector3(), 0); // region that the shadow map covers

  constructor(canvas: HTMLCanvasElement) {
    this.renderer = new THREE.WebGLRenderer({ canvas, alpha: true, antialias: true, stencil: true, powerPreference: "high-performance" });
    this.renderer.localClippingEnabled = true;
    Object.assign(this.renderer.shadowMap, { enabled: true, autoUpdate: false });
    for (const light of [this.sun, this.dome]) {
      light.castShadow = true;
      light.shadow.mapSize.setScalar(light === this.sun ? 1024 : 256); // the sky's is blurred
      Object.assign(light.shadow, { radius: 6, bias: -0.0008 });
    }
    this.dome.visible = false;
    this.extras.matrixAutoUpdate = false;
    this.extras.add(this.contacts, this.arrows);
    this.scene.add(this.extras, this.sky, this.sun, this.sun.target, this.dome, this.dome.target, this.lamp, this.lamp.target, this.obstacles);
  }

  // Places lights around the bounding box of a scene.
  place(scene: Pick<Scene, "lower" | "upper" | "up">): void {
    this.center = [0, 1, 2].map((c) => (scene.lower[c] + scene.upper[c]) / 2) as Vec3;
    this.radius = Math.max(length(minus(scene.upper, scene.lower)) / 2, 1e-12);
    const { right, front, up } = sceneAxes(scene.up);
    this.up = up.toArray();
    this.gridStep = roundStep(this.radius / 4);
    this.sky.position.copy(up);
    this.lit.radius = 0;
    this.sun.userData.from = up.clone().multiplyScalar(1.6).add(front).addScaledVector(right, -0.7).normalize();
  }

  // Lights the stage with sample `i` of soft light: a direction of a wide lamp and one of a bright sky. The mean of
  // the pictures of all samples has soft shadows, and is darker where less of the sky is visible.
  lightSoftly(i: number, count: number): void {
    this.shift = [(i + 0.5) / count - 0.5, ((i * 0.618034) % 1) - 0.5];
    const upward = new THREE.Vector3(...this.up);
    const part = (i + 0.5) / count;
    this.aim(this.sun, around(this.sun.userData.from as THREE.Vector3, i, 1 - kLampWidth * part));
    this.aim(this.dome, around(upward, i, 1 - (1 - kLowestSky) * part));
    this.obstacles.blurShadows(kSoftBlur);
    this.dome.visible = true;
    this.sky.intensity = kSoftSky;
    this.renderer.shadowMap.needsUpdate = true;
  }

  show(body: Body): void {
    this.remove();
    this.body = body;
    body.root.matrix.copy(this.toStage());
    this.extras.matrix.copy(body.root.matrix);
    this.scene.add(body.root);
  }

  showObstacles(obstacles: readonly Obstacle[]): void {
    this.obstacles.show(obstacles, this.up, this.toStage());
    this.obstacles.follow(this.center, this);
    this.renderer.shadowMap.needsUpdate = true;
  }

  addTool(shape: ToolShape): void {
    this.scene.add((this.tool = shape));
  }

  showTool(state: unknown, color: string): void {
    if (this.tool?.show(state, color, (point) => this.toUnits(point), this.radius)) this.renderer.shadowMap.needsUpdate = true;
  }

  remove(): void {
    if (!this.body) return;
    this.scene.remove(this.body.root);
    this.body.dispose();
    this.body = null;
  }

  // Updates the shadow of a moved body, and keeps the shown parts of planes below it.
  moved(): void {
    const box = this.body?.box;
    if (!box) return;
    this.obstacles.follow(middleOf(box), this);
    this.lightUp(box);
    this.renderer.shadowMap.needsUpdate = true;
  }

  apply(settings: DisplaySettings, colors: { background: string; grid: string }): void {
    this.scene.background = settings.transparent ? null : new THREE.Color(colors.background);
    this.obstacles.visible = settings.obstacles;
    this.obstacles.material.color.set(settings.obstacleColor);
    this.obstacles.material.polygonOffset = settings.wires || !settings.fill;
    this.obstacles.showGround(!settings.transparent, colors.grid, settings.grid);
    this.contacts.visible = settings.contacts;
    this.sun.castShadow = this.dome.castShadow = settings.shadows;
    this.renderer.shadowMap.needsUpdate = true;
  }

  clip(clip: Clip | null): void {
    const inside = clip ? (dot(clip.normal, this.center) - clip.offset) / this.radius : 0; // depth of the scene's middle [radii]
    const planes = clip ? [new THREE.Plane(new THREE.Vector3(...clip.normal), inside)] : [];
    for (const material of [this.obstacles.material, ...this.contacts.materials]) material.clippingPlanes = planes;
    this.body?.clip(planes);
    this.renderer.shadowMap.needsUpdate = true;
  }

  render(lens: Lens, pinColor: string): void {
    const camera = this.camera(lens);
    camera.position.copy(this.toUnits(lens.eye));
    const [right, up, forward] = [lens.right, lens.up, lens.forward].map((axis) => new THREE.Vector3(...axis));
    camera.setRotationFromMatrix(new THREE.Matrix4().makeBasis(right, up, forward.clone().negate()));
    camera.setViewOffset(lens.width, lens.height, this.shift[0]!, this.shift[1]!, lens.width, lens.height);
    this.lamp.position.copy(camera.position);
    this.lamp.target.position.copy(camera.position).add(forward);
    this.contacts.adapt(liftPerPixel(lens, this.radius));
    if (this.body) this.adapt(this.body, lens, pinColor);
    this.renderer.render(this.scene, camera);
  }

  dispose(): void {
    this.remove();
    disposeOf(this.scene);
    this.sun.dispose();
    this.dome.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss(); // browsers allow about sixteen contexts
  }

  toUnits(point: Vec3): THREE.Vector3 {
    return new THREE.Vector3(...minus(point, this.center)).divideScalar(this.radius);
  }

  private toStage(): THREE.Matrix4 {
    const scale = 1 / this.radius;
    const [x, y, z] = this.center;
    return new THREE.Matrix4().makeScale(scale, scale, scale).multiply(new THREE.Matrix4().makeTranslation(-x, -y, -z));
  }

  private camera(lens: Lens): THREE.PerspectiveCamera | THREE.OrthographicCamera {
    const away = this.toUnits(lens.eye).length();
    const aspect = lens.width / Math.max(1, lens.height);
    const far = away + 2 * kGroundRadius + this.reach();
    if (lens.extent > 0) {
      const half = lens.extent / this.radius;
      Object.assign(this.orthographic, { top: half, bottom: -half, left: -half * aspect, right: half * aspect, near: -far, far });
      this.orthographic.updateProjectionMatrix();
      return this.orthographic;
    }
    this.perspective.fov = (2 * Math.atan(lens.slope) * 180) / Math.PI;
    this.perspective.aspect = aspect;
    this.perspective.near = Math.max(1e-5 * far, 0.2 * (away - this.reach()), 1e-3 * Math.min(1, away));
    this.perspective.far = far;
    this.perspective.updateProjectionMatrix();
    return this.perspective;
  }

  // Largest distance of the body from the middle of the scene.
  private reach(): number {
    const box = this.body?.box;
    return box ? Math.min(kFarthest, Math.max(1, this.toUnits(box.lower).length(), this.toUnits(box.upper).length())) : 1;
  }

  private adapt(body: Body, lens: Lens, pinColor: string): void {
    const middle = body.box ? middleOf(body.box) : this.center;
    const depth = Math.max(dot(minus(middle, lens.eye), lens.forward), 1e-3 * this.radius);
    const pixels = pixelsPerMeter(lens, depth);
    // Beyond this each triangle would fill the view, which takes minutes without a GPU and shows nothing.
    const height = lens.extent > 0 ? lens.extent : lens.slope * length(minus(this.center, lens.eye));
    this.isFar = this.reach() > kFar && this.reach() * this.radius > kFar * height;
    body.root.visible = body.hasPicture && !this.isFar;
    this.hasLeft = body.box !== null && this.reach() * this.radius * pixels < lens.height && !isInside(lens, middle);
    body.adapt(body.edge * pixels, this.renderer.getPixelRatio(), liftPerPixel(lens, this.radius), pinColor);
  }

  // The shadow map covers the body and changes only when necessary, because changes make shadows crawl.
  private lightUp(box: Box): void {
    const ball = new THREE.Box3(this.toUnits(box.lower), this.toUnits(box.upper)).getBoundingSphere(new THREE.Sphere());
    const covered = ball.center.distanceTo(this.lit.center) + ball.radius <= this.lit.radius;
    if (!covered || ball.radius < this.lit.radius / 3) {
      this.lit.center.copy(ball.center);
      this.lit.radius = 1.3 * ball.radius;
    }
    this.aim(this.sun, this.sun.userData.from as THREE.Vector3);
  }

  // Lets a light shine from a direction onto what the shadow map covers.
  private aim({ position, target, shadow }: THREE.DirectionalLight, from: THREE.Vector3): void {
    const { center, radius } = this.lit;
    target.position.copy(center);
    position.copy(center).addScaledVector(from, 4 * radius);
    Object.assign(shadow.camera, { left: -radius, right: radius, top: radius, bottom: -radius, near: radius, far: 12 * radius });
    shadow.normalBias = 0.012 * radius;
    shadow.camera.updateProjectionMatrix();
  }
}

// Direction `i` of a sequence that winds about a unit axis by the golden angle; its angle from the axis has this cosine.
function around(axis: THREE.Vector3, i: number, cosine: number): THREE.Vector3 {
  const { right, front } = sceneAxes(axis.toArray());
  const [angle, sine] = [2.39996 * i, Math.sqrt(1 - cosine * cosine)];
  return axis.clone().multiplyScalar(cosine).addScaledVector(right, sine * Math.cos(angle)).addScaledVector(front, sine * Math.sin(angle));
}

// Lift of a marker per pixel of its width, see makePinMaterial.
function liftPerPixel(lens: Lens, radius: number): number {
  return (lens.extent > 0 ? lens.extent / radius : lens.slope) / (lens.height / 2);
}

function middleOf(box: Box): Vec3 {
  return [0, 1, 2].map((c) => (box.lower[c] + box.upper[c]) / 2) as Vec3;
}
