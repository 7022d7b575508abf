// Dialog that opens another scene: a scene of the program, a recent one, files of the reader's machine, or a path on
// the program's machine.
import "./gallery.css";
import { button, chooseFiles, element, labeled, messageOf, openDialog } from "./dom";
import { hasEngine } from "./engine";
import type { GalleryReply } from "./protocol";
import type { Store } from "./store";

export function openGallery(store: Store, openFiles: (files: File[]) => Promise<void>): void {
  const problem = element("p", { class: "problem", role: "alert" });
  const shelves = element("div", { class: "shelves" }, element("p", { class: "faint" }, "Looking for scenes ..."));
  const work = async (load: () => Promise<unknown>): Promise<void> => {
    problem.textContent = "";
    dialog.inert = true;
    try {
      await load();
      dialog.close();
    } catch (reason) {
      problem.textContent = messageOf(reason);
    } finally {
      dialog.inert = false;
    }
  };
  const load = (scene: string): Promise<void> => work(() => store.source.request({ do: "load", scene }));
  const paths = hasEngine() ? [] : [makePathForm(store, load)]; // a program in the page has no files but its scenes
  const dialog = openDialog(
    "Load a scene or a mesh",
    [...paths, problem, makeFileChooser((files) => work(() => openFiles(files))), shelves],
    "gallery",
  );
  void store.source
    .ask<GalleryReply>({ ask: "gallery" })
    .then((reply) => shelves.replaceChildren(...makeShelves(reply, load)))
    .catch((reason: unknown) => shelves.replaceChildren(element("p", { class: "problem" }, messageOf(reason))));
}

function makePathForm(store: Store, load: (scene: string) => Promise<void>): HTMLFormElement {
  const path = element("input", { type: "text", required: true, spellcheck: "false", size: "50" });
  path.value = store.side("a")?.scene.path ?? "";
  const submit = element("button", { type: "submit", class: "primary" }, "Load");
  const form = element("form", {}, labeled("Path on the computer that runs Aspic", path), submit);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    void load(path.value.trim());
  });
  requestAnimationFrame(() => path.select());
  return form;
}

// Opens the browser's dialog for several files: a scene and its meshes.
function makeFileChooser(open: (files: File[]) => Promise<void>): HTMLElement {
  const run = async (): Promise<void> => {
    const files = await chooseFiles({ multiple: true });
    if (files.length > 0) await open(files);
  };
  const choose = button({ text: "Files of this computer ..." }, () => void run());
  return element("p", {}, choose, " or drop them onto the page: a mesh, a scene with its meshes, or a saved ZIP archive");
}

function makeShelves({ scenes, recent }: GalleryReply, load: (scene: string) => Promise<void>): HTMLElement[] {
  const entry = (title: string, about: string, path: string, picture = ""): HTMLElement => {
    const made = button({ title: path }, () => void load(path));
    made.className = "scene";
    if (picture) made.append(element("img", { src: picture, alt: "" }));
    made.append(element("b", {}, title), ...(about ? [element("span", { class: "faint" }, about)] : []));
    return made;
  };
  const shelf = (title: string, entries: HTMLElement[]): HTMLElement[] =>
    entries.length === 0 ? [] : [element("section", {}, element("h3", {}, title), ...entries)];
  return [
    ...shelf("Opened before", recent.map((path) => entry(path.slice(path.lastIndexOf("/") + 1), path, path))),
    ...shelvesOf(scenes).flatMap(({ title, entries }) => shelf(title, entries.map(({ name, about, path, picture }) => entry(name, about, path, picture)))),
  ];
}

const kTitles: Record<string, string> = { "": "Scenes", gallery: "More scenes", lecture: "Lecture", capture: "Capture and fitting" };

// Scenes by folder, in the order of the program.
export function shelvesOf(scenes: GalleryReply["scenes"]): { title: string; entries: GalleryReply["scenes"] }[] {
  const folders = new Map<string, GalleryReply["scenes"]>();
  for (const scene of scenes) {
    const end = scene.name.lastIndexOf("/");
    const folder = scene.name.slice(0, Math.max(0, end));
    const entry = { ...scene, name: scene.name.slice(end + 1).replace(/\.toml$/, "") };
    folders.set(folder, [...(folders.get(folder) ?? []), entry]);
  }
  return [...folders].map(([folder, entries]) => ({ title: kTitles[folder] ?? folder, entries }));
}
