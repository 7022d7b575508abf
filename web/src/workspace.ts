// Workspace file: the scene with its settings, the comparison, and the reader's choices in the page.
import { fileName, saveFile } from "./dom";
import type { Page } from "./page";
import type { Recording, SceneFilesReply, SettingValue, UploadedFile } from "./protocol";
import type { Store } from "./store";
import { isTooLarge } from "./upload";

export interface Workspace {
  aspic_workspace: 1;
  scene: string; // name of one of the files; without files a path on the program's machine
  files?: UploadedFile[]; // the complete scene and its meshes, so that it opens on any machine
  overrides: string[];
  settings: Record<string, SettingValue>; // settings of side a
  compare: Recording["compare"];
  page: Record<string, unknown>; // by the names in Page.keepers
}

const isStrings = (value: unknown): value is string[] =>
  Array.isArray(value) && value.every((entry) => typeof entry === "string");
const isTable = (value: unknown): value is Record<string, unknown> =>
  typeof value === "object" && value !== null && !Array.isArray(value);

function isSetting(value: unknown): value is SettingValue {
  if (Array.isArray(value)) return value.every((entry) => typeof entry === "number" || typeof entry === "string");
  return ["number", "string", "boolean"].includes(typeof value);
}

function parseJson(text: string, what: string): Record<string, unknown> {
  let read: unknown;
  try {
    read = JSON.parse(text);
  } catch {
    throw new Error(`The file is not JSON, so it is not a ${what}.`);
  }
  if (!isTable(read)) throw new Error(`The file is not a ${what}.`);
  return read;
}

function parseCompare(value: unknown): Recording["compare"] {
  if (!isTable(value) || !isStrings(value.overrides)) return null;
  return { overrides: value.overrides, label: typeof value.label === "string" ? value.label : "B" };
}

function parseFiles(value: unknown): UploadedFile[] | null {
  const isFile = (file: unknown): file is UploadedFile =>
    isTable(file) && typeof file.name === "string" && typeof file.gzip === "string";
  if (!Array.isArray(value) || !value.every(isFile)) return null;
  return value.map(({ name, gzip }) => ({ name, gzip }));
}

// Contents of a file. Throws an error with a message; ignores unknown parts.
export function parseWorkspace(text: string): Workspace {
  const read = parseJson(text, "workspace");
  if (!("aspic_workspace" in read)) throw new Error("The file is not a workspace of Aspic: it has no aspic_workspace.");
  if (read.aspic_workspace !== 1) {
    throw new Error(`The workspace has version ${String(read.aspic_workspace)}; this page reads version 1.`);
  }
  if (typeof read.scene !== "string") throw new Error("The workspace contains no scene.");
  const settings = isTable(read.settings) ? read.settings : {};
  const files = parseFiles(read.files);
  return {
    aspic_workspace: 1,
    scene: read.scene,
    ...(files ? { files } : {}),
    overrides: isStrings(read.overrides) ? read.overrides : [],
    settings: Object.fromEntries(Object.entries(settings).filter(([, value]) => isSetting(value))) as Workspace["settings"],
    compare: parseCompare(read.compare),
    page: isTable(read.page) ? read.page : {},
  };
}

// Recording of a session for replay. Only recognizes recordings; the program validates the events.
export function parseRecording(text: string): Recording {
  const read = parseJson(text, "recording");
  if (typeof read.scene !== "string" || !Array.isArray(read.events) || typeof read.steps !== "number") {
    throw new Error("The file is not a mouse recording: it has no scene, events and steps.");
  }
  return read as unknown as Recording;
}

export function isWorkspace(text: string): boolean {
  return text.includes('"aspic_workspace"');
}

// `isShipped`: whether the reader has a scene, so that the workspace needs no files.
export async function workspaceOf(store: Store, page: Page, isShipped: (scene: string) => boolean = () => false): Promise<Workspace> {
  const { scene, overrides, compare } = await store.source.ask<Recording>({ ask: "recording" });
  const shown = store.side("a")?.scene;
  const known = isShipped(scene);
  const whole = known ? null : await wholeScene(store);
  if (!whole && !known) page.notice(`The meshes are too large for a workspace, so it opens only where ${scene} exists.`);
  return {
    aspic_workspace: 1,
    ...(whole ?? { scene, overrides }),
    settings: Object.fromEntries((shown?.settings ?? []).map((setting) => [setting.key, setting.value])),
    compare,
    page: Object.fromEntries([...page.keepers].map(([name, keeper]) => [name, keeper.save()])),
  };
}

export async function saveWorkspace(store: Store, page: Page): Promise<void> {
  const text = JSON.stringify(await workspaceOf(store, page), null, 1);
  saveFile(fileName(`${store.name}.aspic`, "json"), new Blob([text], { type: "application/json" }));
}

async function wholeScene(store: Store): Promise<Pick<Workspace, "scene" | "files" | "overrides"> | null> {
  const reply = await store.source.ask<SceneFilesReply>({ ask: "scene_files", side: "a" }).catch(() => null);
  return reply && !isTooLarge(reply.files) ? { scene: reply.scene, files: reply.files, overrides: [] } : null;
}

export async function openWorkspace(workspace: Workspace, store: Store, page: Page): Promise<void> {
  const { source } = store;
  const { scene, files, overrides } = workspace;
  await source.request({ do: "load", scene, overrides, ...(files ? { files } : {}) });
  const refused: string[] = [];
  for (const { key, value } of store.side("a")?.scene.settings ?? []) {
    const kept = workspace.settings[key];
    if (kept === undefined || JSON.stringify(kept) === JSON.stringify(value)) continue;
    await source.request({ do: "set", key, value: kept }).catch(() => refused.push(key));
  }
  if (workspace.compare) await source.request({ do: "compare", ...workspace.compare });
  restorePage(workspace, page);
  if (refused.length > 0) page.notice(`The program refused these settings of the workspace: ${refused.join(", ")}`, "error");
}

// A part of the page that cannot use its saved state does not affect the others.
function restorePage(workspace: Workspace, page: Page): void {
  for (const [name, keeper] of page.keepers) {
    if (!(name in workspace.page)) continue;
    try {
      keeper.restore(workspace.page[name]);
    } catch {
      page.notice(`The workspace's "${name}" does not fit this page and was ignored.`);
    }
  }
}
