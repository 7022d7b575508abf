// What other folders add to the page: build.mjs imports their index.ts, if there is one, before main.ts.
import type { Dock } from "./dock";
import type { Page } from "./page";
import type { Store } from "./store";
import type { Display } from "./view/display";

export interface Extension {
  document: { id: string; open(packed: string): Promise<void> }; // shows the packed element of this id
  addTo(store: Store, page: Page, display: Display, dock: () => Dock): void; // extends a live session
}

export const extensions: Extension[] = [];
