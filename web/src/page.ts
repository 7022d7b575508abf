// What the parts of the page share beside the messages: choices of the reader, keyboard shortcuts, and what a workspace
// file keeps.
import { Emitter } from "./emitter";
import type { PanelName, SideName, Vec3 } from "./protocol";

export interface Highlight {
  positions: Vec3[]; // one corner, or the four of a tet
  text: string;
}

export interface ChosenIteration {
  side: SideName;
  step: number;
  iteration: number;
}

interface Events {
  chosen: ChosenIteration; // in the microscope
  highlight: Highlight[]; // on the body of side a
  theme: "light" | "dark"; // plots read their colors again
  panel: Panel["name"]; // to be opened in the dock
  layout: void; // sizes have changed
  notice: { text: string; kind: "info" | "error" };
  cleared: void; // notices about what was shown before go
}

// A part of the page that a workspace file keeps.
export interface Keeper {
  save(): unknown;
  restore(saved: unknown): void; // may be anything: what does not fit is ignored
}

export interface Shortcut {
  key: string; // KeyboardEvent.key, "Shift+" before it where it needs that: " ", "s", "Shift+R", "1"
  does: string; // for the list on the screen
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
}

// A tab of the dock.
export interface Panel {
  readonly name: PanelName | "certificate" | "capture";
  readonly title: string;
  readonly element: HTMLElement;
  readonly isTall?: boolean; // takes more than the usual height
  show(visible: boolean): void; // draws only while it is visible
}
