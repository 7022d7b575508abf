// The settings of the simulation: built from what the program says it has, sent while a slider moves, and put back where
// the program refuses.
import { GUI } from "lil-gui";
import { element, messageOf } from "../dom";
import { Newest } from "../newest";
import type { Page } from "../page";
import type { Scene, Setting, SettingValue, SideName } from "../protocol";
import type { Store } from "../store";
import { addRow, NumberRow } from "./rows";
import type { Row } from "./rows";

type Target = SideName | "both";

// Whether the same rows can show both.
function sameShape(a: Setting[], b: Setting[]): boolean {
  const shape = (all: Setting[]): string =>
    JSON.stringify(all.map((s) => [s.key, s.label, s.group, s.unit, s.kind, s.min, s.max, s.choices]));
  return shape(a) === shape(b);
}

function valueText(value: SettingValue): string {
  return Array.isArray(value) ? value.join(", ") : String(value);
}

export class Settings {
  private readonly top: HTMLElement;
  private readonly gui: GUI;
  private folders: GUI[] = [];
  private shown: Setting[] = [];
  private target: Target = "both";
  private readonly rows = new Map<string, Row>();
  private readonly senders = new Map<string, Newest<SettingValue>>();
  private readonly mouse: NumberRow;
  private readonly surface: HTMLSelectElement;

  constructor(
    root: HTMLElement,
    private readonly store: Store,
    private readonly page: Page,
  ) {
    this.top = element("div", { class: "sides" });
    root.append(this.top);
    this.surface = this.makeSurface();
    root.append(element("label", { class: "surface-choice" }, element("span", {}, "Surface"), this.surface));
    this.gui = new GUI({ container: root, title: "Simulation" });
    if (!store.source.live) this.gui.close();
    const spring = this.gui.addFolder("Spring of the mouse").show(store.source.live);
    this.mouse = this.makeMouse(spring);
    store.on("scene", () => this.update());
    store.on("gone", () => this.update());
    store.on("role", () => this.enable());
    store.on("connected", () => this.enable());
  }

  private get scene(): Scene | null {
    return this.store.side(this.target === "b" ? "b" : "a")?.scene ?? null;
  }

  private update(): void {
    if (!this.store.side("b")) this.target = "both";
    this.showSides();
    const scene = this.scene;
    if (!scene) return;
    if (!sameShape(scene.settings, this.shown)) this.build(scene.settings);
    this.shown = scene.settings;
    this.showValues(scene);
    this.enable();
  }

  private showValues(scene: Scene): void {
    const other = this.store.side("b")?.scene.settings ?? [];
    for (const setting of scene.settings) {
      const row = this.rows.get(setting.key);
      if (!this.senders.get(setting.key)?.busy) row?.display(setting.value);
      const twin = other.find((s) => s.key === setting.key);
      const differs = this.target === "both" && twin && valueText(twin.value) !== valueText(setting.value);
      row?.mark(differs ? `A: ${valueText(setting.value)}, B: ${valueText(twin.value)}` : "");
    }
    this.mouse.display(scene.stiffness);
    this.surface.value = scene.surface;
    this.surface.closest("label")?.toggleAttribute("hidden", !scene.has_skin);
  }

  private build(settings: Setting[]): void {
    const closed = new Set(this.folders.filter((folder) => folder._closed).map((folder) => folder._title));
    for (const folder of this.folders) folder.destroy();
    this.folders = [];
    this.rows.clear();
    this.senders.clear();
    for (const group of new Set(settings.map((setting) => setting.group))) {
      const folder = this.gui.addFolder(group);
      this.folders.push(folder);
      if (closed.has(group)) folder.close();
      for (const setting of settings) if (setting.group === group) this.addSetting(folder, setting);
    }
  }

  private addSetting(folder: GUI, setting: Setting): void {
    const sender = new Newest<SettingValue>(
      (value) => this.store.source.request({ do: "set", key: setting.key, value, ...this.side() }),
      (reason) => this.page.notice(messageOf(reason), "error"),
      () => this.update(),
    );
    this.senders.set(setting.key, sender);
    this.rows.set(setting.key, addRow(folder, setting, (value) => sender.push(value)));
  }

  private side(): { side?: SideName } {
    return this.target === "both" || !this.store.side("b") ? {} : { side: this.target };
  }

  private makeMouse(folder: GUI): NumberRow {
    const range = { min: 1, max: 1e6, log: true, kind: "number" } as const;
    const row = new NumberRow(folder, "stiffness of the mouse's spring [N/m]", { value: 1000 }, range);
    row.name("stiffness [N/m]");
    row.$name.title = "Of the spring between the mouse and the point of the body that it drags";
    const sender = new Newest<number>(
      (value) => this.store.source.request({ do: "stiffness", value }),
      (reason) => this.page.notice(messageOf(reason), "error"),
      () => this.update(),
    );
    row.onChange((value: SettingValue) => sender.push(Number(value)));
    return row;
  }

  private makeSurface(): HTMLSelectElement {
    const select = element(
      "select",
      { "data-steers": true, title: "What is shown: the fine skin that the tets carry, or the boundary of the tets" },
      element("option", { value: "skin" }, "fine skin"),
      element("option", { value: "cage" }, "cage of tets"),
    );
    select.addEventListener("change", () => {
      this.store.source.send({ do: "surface", which: select.value === "cage" ? "cage" : "skin" });
    });
    return select;
  }

  private showSides(): void {
    const two = this.store.side("b") !== null;
    if (two === this.top.hasChildNodes()) return; // the choice that has the focus keeps it
    this.top.replaceChildren();
    if (!two) return;
    const names: Record<Target, string> = { a: "A", b: "B", both: "both" };
    for (const target of ["a", "b", "both"] as const) {
      const choice = element("input", { type: "radio", name: "side", value: target });
      choice.checked = target === this.target;
      choice.addEventListener("change", () => {
        this.target = target;
        this.update();
      });
      this.top.append(element("label", {}, choice, names[target]));
    }
  }

  private enable(): void {
    const may = this.store.source.live && this.store.steers && this.store.connected;
    for (const row of this.rows.values()) row.enable(may);
    this.mouse.enable(may);
  }
}
