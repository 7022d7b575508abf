// State that the parts of the page share beside the messages: choices of the reader, keyboard shortcuts, and the
// contents of a workspace file.
import { messageOf } from "./dom";
import { Emitter } from "./emitter";
import type { PanelName, SideName, Vec3 } from "./protocol";

export interface Highlight {
  positions: Vec3[]; // one corner, or the four corners of a tet
  text: string;
}

export interface ChosenIteration {
  side: SideName;
  step: number;
  iteration: number;
}

interface Events {
  chosen: ChosenIteration; // iteration in the microscope
  highlight: Highlight[]; // highlights on the body of side a
  lesson: void; // a page of the lecture has opened
  panel: Panel["name"]; // the panel to open in the dock
  scale: "linear" | "log"; // of the energies
  notice: { text: string; kind: "info" | "error" };
  cleared: void; // clears notices about the previous scene
}

// Part of the page that a workspace file keeps.
export interface Keeper {
  save(): unknown;
  restore(saved: unknown): void; // accepts any value and ignores what does not fit
}

// Fields of a saved value; none if it is not an object.
export function fieldsOf(saved: unknown): Record<string, unknown> {
  return typeof saved === "object" && saved !== null ? (saved as Record<string, unknown>) : {};
}

export interface Shortcut {
  key: string; // KeyboardEvent.key, with "Shift+" before it if needed: " ", "s", "Shift+R", "1"
  does: string; // description in the list of shortcuts
  group: "Simulation" | "Camera" | "Display" | "Panels" | "File";
  run: () => void;
}

export class Page extends Emitter<Events> {
  readonly keepers = new Map<string, Keeper>();
  readonly shortcuts = new Map<string, Shortcut>();

  keep(name: string, keeper: Keeper): void {
    this.keepers.set(name, keeper);
  }

  shortcut(shortcut: Shortcut): void {
    if (this.shortcuts.has(shortcut.key)) throw new Error(`two shortcuts on ${shortcut.key}`);
    this.shortcuts.set(shortcut.key, shortcut);
  }

  notice(text: string, kind: "info" | "error" = "info"): void {
    this.emit("notice", { text, kind });
  }

  // Shows why something failed; for `catch`.
  readonly report = (reason: unknown): void => this.notice(messageOf(reason), "error");
}

// A tab of the dock.
export interface Panel {
  readonly name: PanelName | "certificate" | "bench";
  readonly title: string;
  readonly element: HTMLElement;
  readonly isTall?: boolean; // needs more than the usual height
  show(visible: boolean): void; // the dock has added or removed the element; draws only while it is in the page
}
