// Pictures of meshes for a program that sends them one by one: panels side by side with a common direction, scale and
// color bar. apps/aspic/mesh_picture.h defines the requests.
import { Vector3 } from "three";
import { png } from "./dom";
import { Pack } from "./pack";
import type { Send } from "./program";
import type { Geometry, Vec3 } from "./protocol";
import { edgesOf, normalsOf } from "./recording";
import { Body, type Box, boxOf } from "./view/body";
import { orientationFrom, sceneAxes } from "./view/cameras";
import { type DisplaySettings, kDefaults } from "./view/display";
import { along, dot, type Lens, minus } from "./view/lens";
import { colorBar, type Ink, kBarWidth, text } from "./view/marks";
import type { ColorRange } from "./view/ranges";
import { Stage } from "./view/stage";

interface MeshPicture {
  title: string;
  panels: { caption: string; values: "none" | "vertices" | "triangles" }[];
  eye: Vec3; // direction from the surfaces to the eye
  up: Vec3;
  wires: boolean;
  value_label: string;
  range: [number, number] | null;
  width: number; // [px]
  height: number; // largest height [px]
  letter: number; // height of text [px]
}

const kMargin = 0.94; // largest part of a panel's width and height that the surface fills
const kColors = { background: "#ffffff", grid: "#8a93a1", text: "#2b303a" };

// Direction of the camera, common to all panels.
class Outlook {
  private readonly right: Vec3;
  private readonly up: Vec3;
  private readonly forward: Vec3;

  constructor(eye: Vec3, up: Vec3) {
    const axes = sceneAxes(up);
    const orientation = orientationFrom(new Vector3(...eye).normalize(), axes.up, axes.right);
    const axis = (x: number, y: number, z: number): Vec3 => new Vector3(x, y, z).applyQuaternion(orientation).toArray();
    [this.right, this.up, this.forward] = [axis(1, 0, 0), axis(0, 1, 0), axis(0, 0, -1)];
  }

  // Coordinates across, upward and away from the eye.
  seen(point: Vec3): Vec3 {
    return [dot(point, this.right), dot(point, this.up), dot(point, this.forward)];
  }

  // Orthographic camera; `extent` is half the visible height [m].
  lens(middle: Vec3, extent: number, width: number, height: number): Lens {
    const { right, up, forward } = this;
    const eye = along(along(along([0, 0, 0], middle[0], right), middle[1], up), middle[2], forward);
    return { eye, right, up, forward, slope: 0, extent, width, height };
  }
}

// Surface of a panel. Where values belong to triangles, no two triangles share corners.
class Panel {
  readonly geometry: Geometry;
  readonly values: Float32Array | null = null;
  readonly normals: Int8Array;
  readonly box: Box;
  readonly middle: Vec3; // in coordinates of the camera
  readonly size: Vec3;

  constructor(pack: Pack<MeshPicture>, index: number, outlook: Outlook) {
    let positions = pack.floats(`${index}.positions`);
    let triangles = pack.indices(`${index}.triangles`);
    let edges = edgesOf(triangles);
    this.normals = normalsOf(positions, triangles);
    const { values } = pack.head.panels[index];
    if (values !== "none") this.values = pack.floats(`${index}.values`);
    if (values === "triangles") {
      const corner = new Uint32Array(positions.length / 3); // one of the triangle corners at each vertex
      triangles.forEach((vertex, c) => (corner[vertex] = c));
      edges = edges.map((vertex) => corner[vertex]);
      const shared = positions;
      positions = new Float32Array(3 * triangles.length);
      triangles.forEach((vertex, c) => positions.set(shared.subarray(3 * vertex, 3 * vertex + 3), 3 * c));
      this.values = Float32Array.from(triangles, (_, c) => this.values![Math.floor(c / 3)]);
      triangles = triangles.map((_, c) => c);
      this.normals = normalsOf(positions, triangles);
    }
    const none = new Uint32Array(0);
    this.geometry = { side: "a", generation: 0, rest: positions, triangles, edges, tet: none, vertex: none };
    this.box = boxOf(positions);
    const { lower, upper } = boxOf(positions, (x) => outlook.seen(x));
    this.middle = [0, 1, 2].map((c) => (lower[c] + upper[c]) / 2) as Vec3;
    this.size = minus(upper, lower);
  }
}

class Painter {
  private readonly glCanvas = document.createElement("canvas");
  private readonly stage = new Stage(this.glCanvas);
  private readonly font = getComputedStyle(document.body).fontFamily;

  async paint(pack: Pack<MeshPicture>): Promise<Blob> {
    const { head } = pack;
    const em = head.letter;
    const outlook = new Outlook(head.eye, head.up);
    const panels = head.panels.map((_, index) => new Panel(pack, index, outlook));
    const canvas = document.createElement("canvas");
    const context = canvas.getContext("2d")!;
    context.font = `${em}px ${this.font}`;
    const bar = head.range ? kBarWidth * em : 0;
    const top = head.title === "" ? 0 : 2.4 * em;
    const bottom = head.panels.some(({ caption }) => caption !== "") ? 2.4 * em : 0;
    const width = Math.floor((head.width - bar) / panels.length);

    // Largest scale at which all panels fit; no higher than needed.
    const room = head.height - top - bottom;
    const largest = (axis: 0 | 1): number => Math.max(...panels.map(({ size }) => size[axis]));
    const scale = kMargin * Math.min(width / largest(0), room / largest(1)); // [px / m]
    if (!(scale < Infinity)) throw new Error("the surfaces have no size");
    const height = Math.ceil(Math.min(room, Math.max((scale * largest(1)) / kMargin, (bar > 0 ? 16 : 6) * em)));

    [canvas.width, canvas.height] = [head.width, height + top + bottom];
    context.font = `${em}px ${this.font}`;
    context.fillStyle = kColors.background;
    context.fillRect(0, 0, canvas.width, canvas.height);
    panels.forEach((panel, index) => {
      const lens = outlook.lens(panel.middle, height / 2 / scale, width, height);
      this.draw(panel, lens, head);
      context.drawImage(this.glCanvas, index * width, top);
    });
    const ink: Ink = { context, em, text: kColors.text, halo: kColors.background, accent: kColors.text };
    text(ink, head.title, head.width / 2, 1.3 * em, "center");
    head.panels.forEach(({ caption }, i) => text(ink, caption, (i + 0.5) * width, top + height + 1.1 * em, "center"));
    if (head.range) this.addBar(ink, head, head.range, top, height);
    return png(canvas);
  }

  private draw(panel: Panel, lens: Lens, head: MeshPicture): void {
    // Glare and the color of inner sides would hide colors that represent values.
    const meaning: Partial<DisplaySettings> = panel.values ? { shininess: 0, inside: "same" } : {};
    const settings: DisplaySettings = { ...kDefaults, wires: head.wires, ...meaning };
    const { stage } = this;
    stage.renderer.setSize(lens.width, lens.height, false);
    stage.place({ ...panel.box, up: head.up });
    const body = new Body(panel.geometry);
    body.show({ positions: panel.geometry.rest, normals: panel.normals, values: panel.values });
    stage.show(body);
    body.apply(settings);
    body.color(panel.values && head.range ? colors(head.range) : null, "viridis");
    stage.apply(settings, kColors);
    stage.moved();
    stage.render(lens, kColors.text);
  }

  // Half as high as the panels, centered vertically.
  private addBar(ink: Ink, head: MeshPicture, range: [number, number], top: number, height: number): void {
    const field = { label: head.value_label, unit: "" };
    const lens = { width: head.width - kBarWidth * ink.em, height };
    ink.context.translate(0, top + Math.max(0, (height - 23 * ink.em) / 2));
    colorBar(ink, lens, field, colors(range), "viridis");
    ink.context.resetTransform();
  }
}

function colors([low, high]: [number, number]): ColorRange {
  return { low, high, log: false };
}

export async function drawMeshPictures(query: URLSearchParams, send: Send): Promise<void> {
  const count = Number(query.get("meshes"));
  const painter = new Painter();
  await send("/count", String(count));
  for (let index = 0; index < count; ++index) {
    const bytes = await (await send("/part", String(index))).arrayBuffer();
    await send("/frame", await painter.paint(new Pack<MeshPicture>(bytes)));
  }
}
