// Settings of the simulation: built from the program's list, sent while a slider moves, and restored if the program
// refuses them.
import { GUI, type Controller } from "lil-gui";
import { button, element, messageOf, selectOf } from "../dom";
import { choiceFormulas, kWithFormulas } from "../formulas";
import { backTo, History, toLoaded, type SettingChange } from "../history";
import { kMaterials } from "../materials";
import { refusalText } from "../names";
import { Newest } from "../newest";
import type { Page } from "../page";
import type { Command, Scene, Setting, SettingValue, SideName } from "../protocol";
import type { Store } from "../store";
import { shortcutButton } from "../shortcuts";
import { addRow, NumberRow, type Row } from "./rows";

type Target = SideName | "both";

const kClosed = ["Solver", "Line search"]; // closed at first
const kConstants = ["young", "poisson", "density"] as const; // of a material
const kOneChange = 1000; // [ms]: changes that follow each other faster are one change

// Whether the same rows can show both lists.
function sameShape(a: Setting[], b: Setting[]): boolean {
  const shape = (all: Setting[]): string =>
    JSON.stringify(all.map((s) => [s.key, s.label, s.group, s.unit, s.kind, s.min, s.max, s.choices]));
  return shape(a) === shape(b);
}

function valueText(value: SettingValue): string {
  return Array.isArray(value) ? value.join(", ") : String(value);
}

export class Settings {
  private readonly top = element("div", { class: "sides" });
  private readonly gui: GUI;
  private folders: GUI[] = [];
  private shown: Setting[] = [];
  private target: Target = "both";
  private readonly rows = new Map<string, Row>();
  private readonly senders = new Map<string, Newest<SettingValue>>();
  private readonly mouse: NumberRow;
  private readonly surface = this.makeSurface();
  private readonly spring: GUI;
  private readonly history = new History();
  private readonly undoer: HTMLButtonElement;
  private readonly resetter: HTMLButtonElement;
  private newest = { key: "", at: 0 }; // the latest change
  private loaded = ""; // scene that the history belongs to
  private material: Controller | null = null;
  private readonly formulas = new Map(
    Object.entries(kWithFormulas).map(([key, { title }]) => [key, element("div", { class: "choice-formulas", "aria-label": title })]),
  );

  constructor(
    root: HTMLElement,
    private readonly store: Store,
    private readonly page: Page,
  ) {
    root.append(this.top, element("label", { class: "surface-choice" }, element("span", {}, "Surface"), this.surface));
    const undo = { key: "z", does: "Undo the last change of a setting", group: "Simulation", run: () => void this.undo() } as const;
    this.undoer = shortcutButton(page, undo, { text: "Undo", steers: true });
    const title = "Restore the loaded value of every setting; the motion continues";
    this.resetter = button({ text: "Reset settings", title, steers: true }, () => void this.reset());
    const actions = element("div", { class: "setting-actions" }, this.undoer, this.resetter);
    actions.hidden = !store.source.live;
    root.append(actions);
    this.gui = new GUI({ container: root, title: "Simulation" });
    if (!store.source.live) this.gui.close();
    this.spring = this.gui.addFolder("Mouse spring").show(store.source.live).close();
    this.mouse = this.makeMouse(this.spring);
    for (const event of ["scene", "gone"] as const) store.on(event, () => this.update());
    for (const event of ["role", "connected"] as const) store.on(event, () => this.enable());
  }

  private get scene(): Scene | null {
    return this.store.side(this.target === "b" ? "b" : "a")?.scene ?? null;
  }

  private update(): void {
    if (!this.store.side("b")) this.target = "both";
    this.showSides();
    const scene = this.scene;
    if (!scene) return;
    const loaded = JSON.stringify([scene.path, scene.loaded_overrides, this.store.side("b") !== null]);
    if (loaded !== this.loaded) this.history.clear();
    this.loaded = loaded;
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
    this.showMaterial(scene);
    for (const [key, shown] of this.formulas) shown.replaceChildren(...choiceFormulas(scene.settings, key));
    this.mouse.display(scene.stiffness);
    this.surface.value = scene.surface;
    this.surface.closest("label")?.toggleAttribute("hidden", !scene.has_skin);
  }

  private build(settings: Setting[]): void {
    const closed = this.folders.length === 0 ? kClosed : this.folders.filter((folder) => folder._closed).map((folder) => folder._title);
    for (const folder of this.folders) folder.destroy();
    this.folders = [];
    this.rows.clear();
    this.senders.clear();
    for (const group of new Set(settings.map((setting) => setting.group))) {
      const folder = this.gui.addFolder(group);
      this.folders.push(folder);
      if (closed.includes(group)) folder.close();
      if (group === "Material") this.addMaterials(folder, settings);
      for (const setting of settings.filter((each) => each.group === group)) {
        this.addSetting(folder, setting);
        const formulas = this.formulas.get(setting.key);
        if (formulas) folder.$children.append(formulas);
      }
    }
    this.spring.domElement.parentElement?.append(this.spring.domElement); // keeps it last
  }

  private addMaterials(folder: GUI, settings: Setting[]): void {
    this.material = null;
    if (!this.store.source.live || !settings.some(({ key }) => key === "material.young")) return;
    const names = Object.fromEntries(kMaterials.map(({ name }) => [name, name]));
    this.material = folder.add({ value: "" }, "value", { "choose ...": "", ...names }).name("Typical values");
    this.material.onChange((name: string) => void this.takeMaterial(name));
    this.material.$name.title = "Published moduli with their source, and typical values.\nmaterial.young, material.poisson, material.density";
    const options = [...this.material.domElement.querySelectorAll("option")];
    kMaterials.forEach(({ source }, i) => (options[i + 1].title = source));
  }

  // Selects the preset whose values the scene has, if any.
  private showMaterial(scene: Scene): void {
    if (!this.material) return;
    const value = (name: string): unknown => scene.settings.find(({ key }) => key === `material.${name}`)?.value;
    const shown = kMaterials.find((material) => kConstants.every((name) => value(name) === material[name]));
    (this.material.object as { value: string }).value = shown?.name ?? "";
    this.material.updateDisplay();
    this.material.$widget.title = shown?.source ?? "";
  }

  private async takeMaterial(name: string): Promise<void> {
    const chosen = kMaterials.find((material) => material.name === name);
    if (!chosen) return this.update();
    const values = kConstants.map((name) => ({ key: `material.${name}`, value: chosen[name], ...this.side() }));
    const changes = values.filter(({ key }) => this.rows.has(key));
    this.history.add(changes.flatMap(({ key }) => this.back(key)).reverse());
    this.newest = { key: "", at: 0 };
    await this.carryOut(changes);
  }

  private sceneOf(side: SideName | undefined): Scene | null {
    return this.store.side(side ?? "a")?.scene ?? null;
  }

  // Changes of each side that a change affects; the side is undefined if there is only one.
  private onSides(target: Target, changes: (scene: Scene, side?: SideName) => SettingChange[]): SettingChange[] {
    const both = target === "both" ? (["a", "b"] as const) : [target];
    const sides = this.store.side("b") ? both : [undefined];
    return sides.flatMap((side) => {
      const scene = this.sceneOf(side);
      return scene ? changes(scene, side) : [];
    });
  }

  // Changes that restore the present value of a setting.
  private back(key: string): SettingChange[] {
    return this.onSides(this.target, (scene, side) => [backTo(scene, key, side)]);
  }

  private note(setting: Setting): void {
    const now = performance.now();
    const continues = this.newest.key === setting.key && now - this.newest.at < kOneChange;
    this.newest = { key: setting.key, at: now };
    if (!continues) this.history.add(this.back(setting.key));
  }

  private async undo(): Promise<void> {
    this.newest = { key: "", at: 0 };
    for (let back = this.history.pop(); back; back = this.history.pop()) {
      const changes = back.filter((change) => this.changes(change));
      if (changes.length > 0) return this.carryOut(changes);
    }
    this.page.notice("There is no change of a setting to undo.");
  }

  private async reset(): Promise<void> {
    const changes = this.onSides("both", toLoaded);
    if (changes.length === 0) return this.page.notice("All settings have their loaded values.");
    this.newest = { key: "", at: 0 };
    this.history.add(changes.flatMap(({ key, side }) => backTo(this.sceneOf(side)!, key, side)).reverse());
    await this.carryOut(changes);
  }

  // Whether a change would have an effect.
  private changes({ key, value, side }: SettingChange): boolean {
    const scene = this.sceneOf(side);
    return scene !== null && JSON.stringify(backTo(scene, key).value) !== JSON.stringify(value);
  }

  private async carryOut(changes: SettingChange[]): Promise<void> {
    try {
      for (const change of changes) await this.store.source.request({ do: "set", ...change });
    } catch (reason) {
      this.page.report(reason);
    }
    this.update();
  }

  private addSetting(folder: GUI, setting: Setting): void {
    const refused = (reason: unknown): void => this.page.notice(refusalText(messageOf(reason), setting), "error");
    const sender = this.makeSender((value) => ({ do: "set", key: setting.key, value, ...this.side() }), refused);
    this.senders.set(setting.key, sender);
    const changed = (value: SettingValue): void => {
      this.note(setting);
      sender.push(value);
    };
    this.rows.set(setting.key, addRow(folder, setting, changed));
  }

  private makeSender(command: (value: SettingValue) => Command, refused = this.page.report): Newest<SettingValue> {
    return new Newest((value) => this.store.source.request(command(value)), refused, () => this.update());
  }

  private side(): { side?: SideName } {
    return this.target === "both" || !this.store.side("b") ? {} : { side: this.target };
  }

  private makeMouse(folder: GUI): NumberRow {
    const range = { min: 1, max: 1e6, log: true, kind: "number" } as const;
    const row = new NumberRow(folder, "stiffness of the mouse's spring [N/m]", { value: 1000 }, range);
    row.name("stiffness [N/m]");
    row.$name.title = "Stiffness of the spring between the mouse and the dragged point";
    const sender = this.makeSender((value) => ({ do: "stiffness", value: Number(value) }));
    row.onChange((value: SettingValue) => sender.push(value));
    return row;
  }

  private makeSurface(): HTMLSelectElement {
    const select = selectOf([["skin", "fine skin"], ["cage", "cage of tets"]]);
    select.dataset.steers = "";
    select.title = "Visible surface: the fine skin embedded in the tets, or the boundary of the tets";
    select.addEventListener("change", () => {
      this.store.source.send({ do: "surface", which: select.value === "cage" ? "cage" : "skin" });
    });
    return select;
  }

  private showSides(): void {
    const two = this.store.side("b") !== null;
    if (two === this.top.hasChildNodes()) return; // keeps the focus in the list
    this.top.replaceChildren();
    if (!two) return;
    for (const [target, name] of [["a", "A"], ["b", "B"], ["both", "both"]] as const) {
      const choice = element("input", { type: "radio", name: "side", value: target });
      choice.checked = target === this.target;
      choice.addEventListener("change", () => {
        this.target = target;
        this.update();
      });
      this.top.append(element("label", {}, choice, name));
    }
  }

  private enable(): void {
    const may = this.store.source.live && this.store.steers && this.store.connected;
    for (const row of this.rows.values()) row.enable(may);
    this.mouse.enable(may);
    this.material?.enable(may);
    this.undoer.disabled = this.resetter.disabled = !may;
  }
}
