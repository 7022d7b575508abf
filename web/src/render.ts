// Pictures of a recorded run for a program: draws frame after frame and sends each to the server of this page, which
// writes the files (apps/viewer/render.h). The page's address contains the request.
import { Vector3 } from "three";
import { element } from "./dom";
import { Page } from "./page";
import type { Send } from "./program";
import type { Field, Vec3 } from "./protocol";
import type { RecordedSource } from "./recorded";
import { Store } from "./store";
import { type CameraRig, kViewNames, orientationFrom, sceneAxes, type ViewName } from "./view/cameras";
import { boxOf } from "./view/body";
import { Display, type DisplaySettings } from "./view/display";
import { project } from "./view/lens";
import { View } from "./view/view";

export interface RenderRequest {
  width: number;
  height: number;
  view: ViewName | [number, number, number]; // canonical view, or direction of the camera
  color: string; // field; "": none
  wires: boolean;
  thickness: boolean; // of sheets
  dark: boolean;
  preset: string; // "": none
  transparent: boolean; // no background
  samples: number; // directions of light; 1: a sun
  step: number | null; // draws one picture, of the nearest frame
  every: number; // simulated time between pictures [s]; 0: a picture of every frame
}

// Throws if the view is unknown.
export function renderRequest(query: URLSearchParams): RenderRequest {
  const number = (name: string, fallback: number): number => Number(query.get(name) ?? fallback);
  const view = query.get("view") ?? "isometric";
  const direction = view.split(",").map(Number);
  return {
    width: number("width", 1280),
    height: number("height", 720),
    view: direction.length === 3 && direction.every(Number.isFinite) && Math.hypot(...direction) > 0 ? [direction[0], direction[1], direction[2]] : named(view),
    color: query.get("color") ?? "",
    wires: query.get("wires") !== "0",
    thickness: query.get("thickness") === "1",
    dark: query.get("dark") === "1",
    preset: query.get("preset") ?? "",
    transparent: query.get("transparent") === "1",
    samples: number("samples", 1),
    step: query.has("step") ? number("step", 0) : null,
    every: number("every", 0),
  };
}

function named(view: string): ViewName {
  const found = kViewNames.find((name) => name === view);
  if (!found) throw new Error(`--view: there is no view '${view}'; choose one of ${kViewNames.join(", ")}, or a direction x,y,z`);
  return found;
}

// Steps to show, one per picture: the last frame at or before each multiple of `every`.
export function stepsToShow(frames: { step: number[]; time: number[] }, request: Pick<RenderRequest, "step" | "every">): number[] {
  const { step, time } = frames;
  if (request.step !== null) return [request.step];
  if (request.every <= 0) return step;
  const last = time.length - 1;
  const count = Math.floor((time[last] - time[0]) / request.every + 1e-6) + 1;
  let frame = 0;
  return Array.from({ length: count }, (_, i) => {
    const now = time[0] + i * request.every * (1 + 1e-9);
    while (frame < last && time[frame + 1] <= now) ++frame;
    return step[frame];
  });
}

// Settings for pictures in articles and in talks.
const kPresets: Record<string, Partial<DisplaySettings>> = {
  "": { shininess: 20 },
  paper: { inside: "same", obstacleColor: "#d9d9d9", contacts: false, grid: false, scaleBar: true, shininess: 15, ownBackground: true, background: "#ffffff" },
  plain: { inside: "same", shininess: 20, pins: false, contacts: false, textSize: 0 },
  tissue: { inside: "same", shininess: 50, pins: false, contacts: false, fibres: false, textSize: 0, bodyColor: "#c98474", tissue: true, skin: true },
  talk: { inside: "same", shininess: 20, pins: false, contacts: false, textSize: 1.7 },
};
const kFilled = 0.86; // part of the picture that the run fills

// Moves the camera so that the points just fit the picture.
function fit(rig: CameraRig, points: Vec3[], width: number, height: number): void {
  for (let tries = 0; tries < 6; ++tries) {
    const lens = rig.lens(width, height);
    const { lower, upper } = boxOf(Float32Array.from(points.flat()), (point) => project(lens, point));
    rig.pan((width - lower[0] - upper[0]) / 2, (height - lower[1] - upper[1]) / 2, height);
    rig.distance *= Math.max((upper[0] - lower[0]) / width, (upper[1] - lower[1]) / height) / kFilled;
  }
}

function aim(rig: CameraRig, request: RenderRequest, source: RecordedSource, up: [number, number, number]): void {
  if (typeof request.view === "string") {
    rig.setView(request.view);
  } else {
    const axes = sceneAxes(up);
    rig.orientation.copy(orientationFrom(new Vector3(...request.view).normalize(), axes.up, axes.right));
  }
  rig.setOrthographic(request.preset === "paper");
  const { lower, upper } = boxOf(Float32Array.from(source.points.flat()));
  rig.center(lower, upper);
}

// Resolves when the store has the initial messages of the source.
function started(store: Store): Promise<void> {
  return new Promise((resolve, reject) => {
    store.on("picture", () => resolve());
    store.on("refused", (why) => reject(new Error(why)));
    store.start();
  });
}

// In a video a color has the same value throughout.
async function color(request: RenderRequest, source: RecordedSource, display: Display, fields: Field[]): Promise<void> {
  const field = fields.find(({ name }) => name === request.color);
  if (!field) throw new Error(`--color: the run has no field '${request.color}'; choose one of ${fields.map(({ name }) => name).join(", ")}`);
  await source.request({ do: "color", field: field.name });
  if (request.step !== null) return;
  const [least, most] = source.range(field.name);
  const reach = Math.max(most - field.center, field.center - least);
  const [low, high] = field.diverging ? [field.center - reach, field.center + reach] : [least, most];
  display.change({ fixedRange: true, low, high });
}

async function draw(request: RenderRequest, source: RecordedSource, send: Send): Promise<void> {
  document.documentElement.dataset.theme = request.dark ? "dark" : "light";
  const store = new Store(source);
  const display = new Display();
  const host = element("div");
  document.body.replaceChildren(host);
  const view = new View(host, store, new Page(), "a", display);
  await started(store);
  const { wires, thickness, transparent } = request;
  display.change({ ...kPresets[request.preset], wires, thickness, transparent });
  view.renderSize(request.width, request.height);
  const scene = store.side("a")?.scene;
  if (!scene) throw new Error("the recording has no scene");
  if (request.step !== null) await source.request({ do: "rewind", step: request.step }); // the range of that frame colors it
  view.drawNow();
  if (request.color !== "") await color(request, source, display, scene.fields);
  aim(display.camera("a"), request, source, scene.up);
  const { width, height } = view.lens();
  fit(display.camera("a"), source.points, width, height);
  const steps = stepsToShow(source.frames, request);
  await send("/count", String(steps.length));
  for (const step of steps) {
    view.drawNow(); // the source waits until the previous picture is drawn
    await source.request({ do: "rewind", step });
    await send("/frame", request.samples > 1 ? await view.softScreenshot(request.samples) : await view.screenshot());
  }
}

export function renderPictures(source: RecordedSource): (query: URLSearchParams, send: Send) => Promise<void> {
  return (query, send) => draw(renderRequest(query), source, send);
}
