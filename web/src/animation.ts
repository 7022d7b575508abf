// Hands the motion so far to other programs, as a file.
import { element, labelled, messageOf, openDialog, saveFile } from "./dom";
import type { Page } from "./page";
import type { FileReply, Query, Recording, SideName } from "./protocol";
import type { Store } from "./store";
import { bytesOf } from "./upload";
import type { Video } from "./video";

type Format = Extract<Query, { ask: "animation" }>["format"];
const kFormats: Record<Format | "video", string> = {
  usd: "USD (.usda): Blender, Houdini, Maya, Omniverse",
  glb: "glTF (.glb): Blender, browsers, game engines",
  pc2: "OBJ and PC2, in a ZIP archive: point caches",
  video: "Video of the view (.mp4 or .webm), while the session repeats itself",
};

export function openAnimation(store: Store, page: Page, video: Video): void {
  const format = element("select", {}, ...Object.entries(kFormats).map(([value, text]) => element("option", { value }, text)));
  const side = element("select", {}, element("option", { value: "a" }, "A"), element("option", { value: "b" }, "B"));
  const submit = element("button", { type: "submit", class: "primary" }, "Export");
  const problem = element("p", { class: "problem", role: "alert" });
  const form = element(
    "form",
    {},
    labelled("Format", format),
    store.side("b") ? labelled("Side", side) : null,
    problem,
    element("div", { class: "actions" }, submit),
  );
  const dialog = openDialog("Export the motion", [
    element("p", {}, "The surface at the steps that the timeline holds, from the start to now. Drags are part of it."),
    form,
    element("p", { class: "faint" }, "A GIF, or a video of any size: save the scene (Shift+T), then on a command line"),
    element("pre", {}, "aspic run SCENE.toml --out out\naspic render out -o motion.gif   (or .mp4, .webm)"),
  ]);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    submit.disabled = true;
    problem.textContent = "";
    const made =
      format.value === "video"
        ? videoOfSession(store, video)
        : saveAnimation(store, page, side.value as SideName, format.value as Format);
    made
      .then(() => dialog.close())
      .catch((reason: unknown) => (problem.textContent = messageOf(reason)))
      .finally(() => (submit.disabled = false));
  });
}

async function saveAnimation(store: Store, page: Page, side: SideName, format: Format): Promise<void> {
  const reply = await store.source.ask<FileReply>({ ask: "animation", side, format });
  saveFile(reply.name, new Blob([bytesOf(reply.base64)]));
  page.notice(`${reply.name}: ${reply.note ?? ""}`);
}

// The program repeats what was done, and the page films it until the end.
async function videoOfSession(store: Store, video: Video): Promise<void> {
  if (!store.steers) throw new Error("This page watches; take the steering to repeat the session.");
  const recording = await store.source.ask<Recording>({ ask: "recording" });
  if (recording.steps === 0) throw new Error("nothing has moved yet; play first, then export");
  await store.source.request({ do: "replay", recording });
  if (!video.isRecording) video.start();
  let began = store.state?.replaying ?? false;
  const stop = store.on("state", ({ replaying, a }) => {
    began ||= replaying;
    if (replaying || !(began || a.step >= recording.steps)) return;
    stop();
    requestAnimationFrame(() => requestAnimationFrame(() => video.isRecording && video.stop()));
  });
}
