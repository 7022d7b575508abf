// The file menu: scenes, workspaces, mouse recordings, deformed meshes.
import { openAnimation } from "./animation";
import { chooseFiles, fileName, labeled, messageOf, openForm, saveFile, selectOf } from "./dom";
import { openGallery } from "./gallery";
import { makeMenu } from "./menu";
import type { Page } from "./page";
import type { Recording, SceneReply, SideName, TextReply } from "./protocol";
import type { Sharing } from "./share";
import { shortcutButton } from "./shortcuts";
import type { Store } from "./store";
import { isSceneOrMesh, prepareUpload, saveReply } from "./upload";
import type { Video } from "./video";
import type { CameraRig } from "./view/cameras";
import { isWorkspace, openWorkspace, parseRecording, parseWorkspace, saveWorkspace } from "./workspace";

const kLargestFile = 50e6; // largest workspace or recording [bytes]
const kFormats = ["obj", "ply", "vtu", "msh", "mesh"] as const;

export class Files {
  constructor(
    private readonly store: Store,
    private readonly page: Page,
    private readonly video: Video,
    private readonly sharing: Sharing | null,
    private readonly camera: (side: SideName) => CameraRig,
  ) {}

  // Includes the commands that make pictures. A recorded run has fewer commands.
  makeMenu(pictures: HTMLButtonElement[]): HTMLElement {
    const saveScene = (): void => this.try(this.saveScene());
    const scene = this.item("Shift+T", "Save the scene with all its values (TOML)", false, saveScene);
    if (!this.store.source.live) return makeMenu("File", "Save", [scene, ...pictures]);
    this.acceptDrops();
    return makeMenu("File", "Load and save", [
      this.item("Shift+O", "Load a scene or a mesh", true, () => openGallery(this.store, (files) => this.openFiles(files))),
      this.item("Shift+S", "Save the workspace", false, () => this.try(saveWorkspace(this.store, this.page))),
      this.item("Shift+L", "Load a workspace or a recording", true, () => this.try(this.choose())),
      this.item("Shift+R", "Save the recording of the mouse", false, () => this.try(this.saveRecording())),
      this.item("Shift+P", "Repeat the session from its start", true, () => this.try(this.replayNow())),
      this.item("Shift+M", "Save the deformed mesh", false, () => this.openMesh()),
      this.item("Shift+E", "Export the motion (USD, glTF, PC2, video, GIF)", false, () => openAnimation(this.store, this.page, this.video, this.camera)),
      scene,
      ...this.shareItems(),
      ...pictures,
    ]);
  }

  private shareItems(): HTMLButtonElement[] {
    const sharing = this.sharing;
    if (!sharing) return [];
    return [
      this.item("Shift+C", "Copy a link that opens this workspace", false, () => this.try(sharing.copyLink())),
      this.item("Shift+H", "Save this page, with the workspace, as one file", false, () => this.try(sharing.savePage())),
    ];
  }

  private item(key: string, does: string, steers: boolean, run: () => void): HTMLButtonElement {
    return shortcutButton(this.page, { key, does, group: "File", run }, { text: does, steers });
  }

  private try(work: Promise<unknown>): void {
    work.catch(this.page.report);
  }

  private openMesh(): void {
    const format = selectOf(kFormats.map((name) => [name, name]));
    const side = selectOf([["a", "A"], ["b", "B"]]);
    const fields = [
      labeled("obj and ply contain the surface; vtu, msh and mesh the tets", format),
      this.store.side("b") ? labeled("Side", side) : null,
    ];
    const save = async (): Promise<void> => {
      const query = { ask: "mesh", side: side.value as SideName, format: format.value as (typeof kFormats)[number] } as const;
      saveReply(await this.store.source.ask<TextReply>(query));
    };
    openForm("Save the deformed mesh", fields, "Save", save);
  }

  private async saveScene(): Promise<void> {
    const reply = await this.store.source.ask<SceneReply>({ ask: "scene", side: "a" });
    saveReply(reply);
    if (!("text" in reply)) {
      const folder = reply.name.replace(/\.zip$/, "");
      this.page.notice(`The archive contains the scene with its meshes. Unpack it, then run: aspic run ${folder}/${folder}.toml`);
    }
    for (const note of reply.notes ?? []) this.page.notice(`Not in the file: ${note}.`);
  }

  // Opens files of the reader's machine: a workspace, a recording, or a scene or mesh with its files.
  private async openFiles(files: File[]): Promise<void> {
    if (!files.some(({ name }) => isSceneOrMesh(name))) {
      if (!/\.json$/i.test(files[0].name))
        throw new Error(`${files[0].name}: expected a scene (.toml, .zip), a mesh, a workspace or a recording (.json)`);
      return this.open(files[0]);
    }
    const { scene, files: uploaded } = await prepareUpload(files);
    try {
      await this.store.source.request({ do: "load", scene, files: uploaded });
    } catch (reason) {
      const alone = files.length === 1 && /does not exist/.test(messageOf(reason));
      throw new Error(messageOf(reason) + (alone ? ". Open the scene together with the files that it names." : ""));
    }
  }

  private async saveRecording(): Promise<void> {
    const recording = await this.store.source.ask<Recording>({ ask: "recording" });
    const name = fileName(`${this.store.name}.recording`, "json");
    saveFile(name, new Blob([JSON.stringify(recording)], { type: "application/json" }));
  }

  private async replayNow(): Promise<void> {
    const recording = await this.store.source.ask<Recording>({ ask: "recording" });
    await this.store.source.request({ do: "replay", recording });
  }

  private async choose(): Promise<void> {
    const [file] = await chooseFiles({ accept: ".json,application/json" });
    if (file) await this.open(file);
  }

  private async open(file: File): Promise<void> {
    if (file.size > kLargestFile) throw new Error(`${file.name} is too large for a workspace or a recording.`);
    const text = await file.text();
    try {
      if (isWorkspace(text)) await openWorkspace(parseWorkspace(text), this.store, this.page);
      else await this.store.source.request({ do: "replay", recording: parseRecording(text) });
    } catch (reason) {
      throw new Error(`${file.name}: ${messageOf(reason)}`);
    }
  }

  private acceptDrops(): void {
    const showDrop = (over: boolean): void => void document.body.classList.toggle("dropping", over);
    addEventListener("dragover", (event) => {
      if (!event.dataTransfer?.types.includes("Files")) return;
      event.preventDefault();
      showDrop(true);
    });
    addEventListener("dragleave", (event) => event.relatedTarget === null && showDrop(false));
    addEventListener("drop", (event) => {
      showDrop(false);
      const files = [...(event.dataTransfer?.files ?? [])];
      if (files.length === 0) return;
      event.preventDefault();
      if (this.store.steers) this.try(this.openFiles(files));
      else this.page.notice("This page only watches; press Steer to load files.", "error");
    });
  }
}
