// Exports the motion so far as a file for other programs.
import { element, fileName, labeled, openForm, saveFile, selectOf } from "./dom";
import { Gif } from "./gif";
import type { Page } from "./page";
import type { FileReply, Query, Recording, SideName, State } from "./protocol";
import type { Store } from "./store";
import { saveReply } from "./upload";
import type { Video } from "./video";
import type { CameraRig } from "./view/cameras";

type Format = Extract<Query, { ask: "animation" }>["format"];
const kFormats: Record<Format | "video" | "gif", string> = {
  usd: "USD (.usda): Blender, Houdini, Maya, Omniverse",
  glb: "glTF (.glb): Blender, browsers, game engines",
  pc2: "OBJ and PC2, in a ZIP archive: point caches",
  video: "Video of the view (.mp4 or .webm), while the session repeats itself",
  gif: "GIF of the view, while the session repeats itself",
};

export function openAnimation(store: Store, page: Page, video: Video, camera: (side: SideName) => CameraRig): void {
  const format = selectOf(Object.entries(kFormats));
  const side = selectOf([["a", "A"], ["b", "B"]]);
  const run = (): Promise<void> => {
    if (format.value === "video") return videoOfSession(store, video);
    if (format.value === "gif") return gifOfSession(store, page, video);
    return saveAnimation(store, page, { side: side.value as SideName, format: format.value as Format }, camera(side.value as SideName));
  };
  const fields = [
    element("p", {}, "The surface at the steps in the timeline, from the start to now, including drags. USD and glTF contain the camera of the view."),
    labeled("Format", format),
    store.side("b") && labeled("Side", side),
  ];
  openForm("Export the motion", fields, "Export", run, [
    element("p", { class: "faint" }, "Videos and GIFs of any size: save the scene (Shift+T), then on a command line"),
    element("pre", {}, "aspic run SCENE.toml --out out\naspic render out -o motion.gif   (or .mp4, .webm)"),
  ]);
}

async function saveAnimation(store: Store, page: Page, what: { side: SideName; format: Format }, rig: CameraRig): Promise<void> {
  const { eye, right, up, slope, extent } = rig.lens(16, 9);
  const camera = { eye, right, up, slope: slope || extent / rig.distance, nearest: rig.distance / 100 };
  const reply = await store.source.ask<FileReply>({ ask: "animation", ...what, camera });
  saveReply(reply);
  page.notice(`${reply.name}: ${reply.note ?? ""}`);
}

// Repeats the session in the program. The promise resolves when the replay begins; `atEnd` is called once, after the
// last picture.
async function repeatSession(store: Store, atEnd: () => void): Promise<void> {
  if (!store.steers) throw new Error("This page only watches; press Steer to repeat the session.");
  const recording = await store.source.ask<Recording>({ ask: "recording" });
  if (recording.steps === 0) throw new Error("nothing has moved yet; play first, then export");
  // A short session may end before the reply arrives, so the states are watched before the request is sent.
  let [began, accepted, ended] = [false, false, false];
  const follow = ({ replaying, a }: State): void => {
    began ||= replaying || a.step < recording.steps;
    if (ended || replaying || !accepted || !(began || a.step >= recording.steps)) return;
    ended = true;
    stop();
    requestAnimationFrame(() => requestAnimationFrame(atEnd));
  };
  const stop = store.on("state", follow);
  try {
    await store.source.request({ do: "replay", recording });
  } catch (reason) {
    stop();
    throw reason;
  }
  accepted = true;
  if (began && store.state) follow(store.state);
}

async function videoOfSession(store: Store, video: Video): Promise<void> {
  await repeatSession(store, () => video.isRecording && video.stop());
  if (!video.isRecording) video.start();
}

const kGifWidth = 640; // largest width [px]
const kGifEvery = 0.04; // simulated time between pictures [s]
const kMostGifFrames = 400;

async function gifOfSession(store: Store, page: Page, video: Video): Promise<void> {
  const [whole, small] = [element("canvas"), element("canvas")];
  video.picture(whole);
  const scale = Math.min(1, kGifWidth / whole.width);
  [small.width, small.height] = [Math.floor(whole.width * scale), Math.floor(whole.height * scale)];
  const gif = new Gif(small.width, small.height);
  const context = small.getContext("2d", { willReadFrequently: true })!;
  let [frames, shown] = [0, -Infinity];
  const take = (time: number): void => {
    if (time - shown < kGifEvery * 0.999 || frames >= kMostGifFrames) return;
    video.picture(whole);
    context.drawImage(whole, 0, 0, small.width, small.height);
    gif.add(context.getImageData(0, 0, small.width, small.height).data, 100 * kGifEvery);
    [frames, shown] = [frames + 1, time];
  };
  const stop = store.on("picture", (side) => side === "a" && take(store.side("a")?.picture?.time ?? 0));
  const end = (): void => {
    stop();
    take(Infinity);
    saveFile(fileName(store.name, "gif"), gif.blob());
    page.notice(`${frames} pictures${frames === kMostGifFrames ? ", the limit of a GIF here; aspic render makes longer ones" : ""}`);
  };
  await repeatSession(store, end).catch((reason: unknown) => {
    stop();
    throw reason;
  });
}
