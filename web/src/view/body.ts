// One body on the GPU. The arrays of a picture are uploaded unchanged; only a coarse box is computed from them.
import * as THREE from "three";
import type { ColorRange } from "./ranges";
import type { Geometry, Picture, Vec3 } from "../protocol";
import { bodiesOf, bodyColors, bodyTexels } from "./bodies";
import { mapTexels, type MapName } from "./colorMaps";
import type { DisplaySettings } from "./display";
import { disposeOf } from "./dispose";
import { FibreLines } from "./fibres";
import { kSkinPoint } from "./labels";
import { vectorAt } from "./lens";
import { makeFieldUniforms, makePinMaterial, makeSurfaceMaterial } from "./shading";
import type { ThickSheets } from "./thickSheets";

export interface Box {
  lower: Vec3;
  upper: Vec3;
}

const kBoxSamples = 2000;

// Bounding box of the finite ones of every `stride`th point, as `seen` shows them. Points have three coordinates each.
export function boxOf(points: Float32Array, seen: (x: Vec3) => Vec3 = (x) => x, stride = 1): Box {
  const box: Box = { lower: [Infinity, Infinity, Infinity], upper: [-Infinity, -Infinity, -Infinity] };
  for (let i = 0; i < points.length / 3; i += stride)
    seen(vectorAt(points, i)).forEach((x, c) => {
      if (!Number.isFinite(x)) return;
      box.lower[c] = Math.min(box.lower[c], x);
      box.upper[c] = Math.max(box.upper[c], x);
    });
  return box;
}

// Bounding box of a regular subset of the vertices; null if none is finite.
export function coarseBox(positions: Float32Array): Box | null {
  const box = boxOf(positions, undefined, Math.max(1, Math.floor(positions.length / 3 / kBoxSamples)));
  return box.lower.every((x, c) => x <= box.upper[c]) ? box : null;
}

function meanEdge(geometry: Geometry): number {
  const { rest, edges } = geometry;
  const stride = 2 * Math.max(1, Math.floor(edges.length / 2 / kBoxSamples));
  let [sum, count] = [0, 0];
  for (let e = 0; e < edges.length; e += stride, ++count) {
    const [a, b] = [3 * edges[e], 3 * edges[e + 1]];
    sum += Math.hypot(rest[a] - rest[b], rest[a + 1] - rest[b + 1], rest[a + 2] - rest[b + 2]);
  }
  return count > 0 ? sum / count : 0;
}

function upload(attribute: THREE.BufferAttribute, array: THREE.TypedArray): void {
  attribute.array = array;
  attribute.needsUpdate = true;
}

// One per vertex: 1 in a sheet.
function sheetFlags(geometry: Geometry, tets: number): Float32Array {
  const flags = new Float32Array(geometry.rest.length / 3);
  geometry.tet.forEach((element, t) => {
    if (element < tets) return;
    for (let c = 0; c < 3; ++c) flags[geometry.triangles[3 * t + c]] = 1;
  });
  return flags;
}

// Edges to draw: of the tube of a rod only its cross sections, which mark the segments. `rods`: its first element.
export function wiresOf(geometry: Geometry, rods: number): Uint32Array {
  const tube = new Set<number>();
  geometry.tet.forEach((element, t) => {
    if (element >= rods) for (let c = 0; c < 3; ++c) tube.add(geometry.triangles[3 * t + c]);
  });
  const { edges, vertex } = geometry;
  const isShown = (a: number, b: number): boolean => !tube.has(a) || vertex[a] === vertex[b];
  return tube.size === 0 ? edges : edges.filter((_, i) => isShown(edges[i - (i % 2)], edges[i - (i % 2) + 1]));
}

export class Body {
  readonly root = new THREE.Group(); // meters inside, units of the stage outside
  readonly edge: number; // mean edge length at rest [m]
  readonly numbered: boolean; // whether some vertex has a user's number
  box: Box | null;
  hasPicture = false; // the first picture brings the normals
  current: Float32Array; // positions of the vertices [m]
  private readonly positions: THREE.BufferAttribute;
  private readonly normals: THREE.BufferAttribute;
  private readonly values: THREE.BufferAttribute;
  private readonly uniforms = makeFieldUniforms();
  private readonly surface = makeSurfaceMaterial(this.uniforms);
  private readonly lines = new THREE.LineBasicMaterial({ transparent: true, depthWrite: false });
  private readonly lift = { value: 0 };
  private readonly pinMaterial = makePinMaterial(this.lift);
  private readonly mesh: THREE.Mesh;
  private readonly bodyCount: number;
  private readonly bodies: Float32Array | null; // body index of each vertex if there are several bodies
  private readonly wires: THREE.LineSegments;
  private readonly pins: THREE.Points;
  private readonly fibres = new FibreLines();
  private gloss = 0;
  private mapShown: string | null = null; // name of the current map, or the colors of the bodies

  constructor(
    readonly geometry: Geometry,
    bodyTets: readonly number[] = [],
    tets = Infinity, // number of tets; elements from there on are triangles of sheets, which have no inside
    sheet = Infinity, // number of triangles of sheets; elements after them are segments of rods
    readonly solid: ThickSheets | null = null, // sheets as solids; null: without their thickness
  ) {
    this.bodyCount = bodyTets.length;
    this.bodies = this.bodyCount > 1 ? bodiesOf(geometry, bodyTets) : null;
    const shown = solid?.positions ?? geometry.rest;
    const n = shown.length / 3;
    this.current = geometry.rest;
    this.edge = meanEdge(geometry);
    this.numbered = geometry.vertex.some((vertex) => vertex !== kSkinPoint);
    this.box = coarseBox(geometry.rest);
    this.positions = new THREE.BufferAttribute(shown, 3);
    this.normals = new THREE.BufferAttribute(new Int8Array(4 * n), 4, true);
    this.values = new THREE.BufferAttribute(new Float32Array(n), 1);
    for (const attribute of [this.positions, this.normals, this.values]) attribute.setUsage(THREE.DynamicDrawUsage);
    this.mesh = new THREE.Mesh(this.shape(solid?.triangles ?? geometry.triangles, true), this.surface);
    const edges = wiresOf(geometry, tets + sheet);
    this.wires = new THREE.LineSegments(this.shape(solid?.bothSides(edges) ?? edges, false), this.lines);
    this.pins = new THREE.Points(this.shape(new Uint32Array(0), false), this.pinMaterial);
    this.mesh.castShadow = this.mesh.receiveShadow = true;
    this.wires.renderOrder = 1;
    this.pins.renderOrder = 2;
    for (const object of [this.mesh, this.wires, this.pins]) object.frustumCulled = false;
    if (geometry.tet.some((element) => element >= tets))
      this.mesh.geometry.setAttribute("isSheet", new THREE.BufferAttribute(this.perPoint(sheetFlags(geometry, tets)), 1));
    this.root.add(this.mesh, this.wires, this.pins, this.fibres);
    this.root.visible = false;
    this.root.matrixAutoUpdate = false;
  }

  get shading(): Int8Array {
    return this.normals.array as Int8Array;
  }

  show(picture: Pick<Picture, "positions" | "normals" | "values">): void {
    this.solid?.show(picture);
    this.current = picture.positions;
    upload(this.positions, this.solid?.positions ?? picture.positions);
    upload(this.normals, this.solid?.normals ?? picture.normals);
    if (picture.values) this.showValues(picture.values);
    this.fibres.show(this.geometry.triangles, picture.positions);
    this.box = coarseBox(picture.positions) ?? this.box;
    this.hasPicture = this.root.visible = true;
  }

  showValues(values: Float32Array): void {
    upload(this.values, this.perPoint(values));
  }

  apply(settings: DisplaySettings): void {
    this.mesh.visible = settings.fill;
    this.surface.polygonOffset = this.wires.visible = settings.wires || !settings.fill;
    this.pins.visible = settings.pins;
    this.fibres.visible = settings.fibres;
    this.surface.color.set(settings.bodyColor);
    this.surface.shininess = Math.max(1, settings.shininess);
    this.gloss = settings.shininess > 0 ? 0.09 : 0;
    this.uniforms.insideColor.value.set(settings.insideColor);
    this.uniforms.insideOwn.value = settings.inside === "own";
    this.uniforms.inverted.value = settings.invert;
    this.uniforms.skin.value = settings.skin;
    const hidden = settings.invert ? THREE.BackSide : THREE.FrontSide;
    const side = settings.inside === "hidden" ? hidden : THREE.DoubleSide;
    if (this.surface.flatShading === settings.smooth || this.surface.side !== side) this.surface.needsUpdate = true;
    this.surface.flatShading = !settings.smooth;
    this.surface.side = side;
    this.lines.color.set(settings.lineColor);
    this.lines.depthTest = !settings.wiresOnTop;
  }

  // Colors the values by a range; null: the body's own color.
  color(range: ColorRange | null, map: MapName): void {
    this.uniforms.fieldShown.value = range !== null;
    this.surface.specular.setScalar(range ? 0.3 * this.gloss : this.gloss); // glare hides colors
    if (!range) return;
    this.showMap(map, () => mapTexels(map, 256));
    const [low, high] = range.log ? [Math.log(range.low), Math.log(range.high)] : [range.low, range.high];
    // A constant field has the middle color.
    this.uniforms.fieldLow.value = high > low ? low : low - 0.5;
    this.uniforms.fieldScale.value = high > low ? 1 / (high - low) : 1;
    this.uniforms.fieldLog.value = range.log;
  }

  // Gives each of several bodies a color, the first the reader's choice.
  colorBodies(own: string, isTissue: boolean): void {
    this.uniforms.fieldShown.value = this.bodies !== null;
    this.surface.specular.setScalar(this.gloss);
    if (!this.bodies) return;
    this.showValues(this.bodies);
    const colors = bodyColors(own, this.bodyCount, isTissue);
    this.showMap(colors.join(), () => bodyTexels(colors));
    this.uniforms.fieldLow.value = 0;
    this.uniforms.fieldScale.value = 1 / (this.bodyCount - 1);
    this.uniforms.fieldLog.value = false;
  }

  private showMap(name: string, make: () => Uint8Array): void {
    if (name === this.mapShown) return;
    this.mapShown = name;
    this.uniforms.fieldMap.value?.dispose();
    const texels = make();
    const texture = new THREE.DataTexture(texels, texels.length / 4, 1);
    texture.colorSpace = THREE.SRGBColorSpace;
    texture.magFilter = texture.minFilter = THREE.LinearFilter;
    texture.needsUpdate = true;
    this.uniforms.fieldMap.value = texture;
  }

  clip(planes: THREE.Plane[]): void {
    for (const material of [this.surface, this.lines, this.pinMaterial, this.fibres.material]) material.clippingPlanes = planes;
  }

  setPins(vertices: number[]): void {
    const n = this.current.length / 3;
    this.pins.geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(vertices.filter((v) => v < n)), 1));
  }

  // `lines`: as in the message "fibres".
  setFibres(lines: number[]): void {
    this.fibres.set(lines, this.geometry.triangles);
    this.fibres.show(this.geometry.triangles, this.current);
  }

  // Adapts to the view: `edgePixels` is an edge's length [px], `ratio` the device pixels per pixel. Wires of a dense
  // mesh fade before they hide the surface, and pins shrink.
  adapt(edgePixels: number, ratio: number, liftPerPixel: number, pinColor: string): void {
    const density = Math.min(1, Math.max(0, (edgePixels * ratio - 2) / 10));
    this.lines.opacity = this.mesh.visible ? 0.12 + 0.5 * density : 0.35 + 0.6 * density;
    const size = Math.min(9, Math.max(4, 0.8 * edgePixels));
    this.pinMaterial.size = size;
    this.pinMaterial.color.set(pinColor);
    const thickness = this.solid ? (this.solid.thickness / this.edge) * edgePixels : 0;
    this.lift.value = (size + thickness) * liftPerPixel;
  }

  dispose(): void {
    disposeOf(this.root);
    this.uniforms.fieldMap.value?.dispose();
  }

  private perPoint(values: Float32Array): Float32Array {
    return this.solid?.values(values) ?? values;
  }

  private shape(index: Uint32Array, shaded: boolean): THREE.BufferGeometry {
    const shape = new THREE.BufferGeometry();
    shape.setAttribute("position", this.positions);
    if (shaded) shape.setAttribute("normal", this.normals).setAttribute("fieldValue", this.values);
    shape.setIndex(new THREE.BufferAttribute(index, 1));
    shape.boundingSphere = new THREE.Sphere(new THREE.Vector3(), 1); // placeholder, so that three.js computes none
    return shape;
  }
}
