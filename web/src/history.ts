// Undo of settings. Undo restores an override of a side to its previous value, or removes it if there was none.
import type { Scene, SettingValue, SideName } from "./protocol";

export interface SettingChange {
  key: string;
  value: SettingValue | null; // null: removes the override
  side?: SideName;
}

function keyOf(override: string): string {
  return override.slice(0, override.indexOf("=")).replaceAll(" ", "");
}

// Change that restores the present value of a setting of a side.
export function backTo(scene: Scene, key: string, side?: SideName): SettingChange {
  const overridden = scene.overrides.some((override) => keyOf(override) === key);
  const setting = scene.settings.find((candidate) => candidate.key === key);
  return { key, value: overridden && setting ? setting.value : null, ...(side && { side }) };
}

// Value of an override's TOML text; null unless it is a number, text, boolean or list of these.
function valueOf(override: string): SettingValue | null {
  const text = override.slice(override.indexOf("=") + 1).trim();
  try {
    return JSON.parse(text.replace(/(\d)\.(?=$|[^\d])/g, "$1.0").replace(/e\+/g, "e")) as SettingValue;
  } catch {
    return null;
  }
}

// Changes that restore every setting of a side to its loaded value, the latest change first.
export function toLoaded(scene: Scene, side?: SideName): SettingChange[] {
  const before = new Map(scene.loaded_overrides.map((override) => [keyOf(override), override]));
  const known = new Set(scene.settings.map((setting) => setting.key));
  return scene.overrides
    .filter((override) => known.has(keyOf(override)) && before.get(keyOf(override)) !== override)
    .reverse()
    .map((override) => {
      const loaded = before.get(keyOf(override));
      return { key: keyOf(override), value: loaded === undefined ? null : valueOf(loaded), ...(side && { side }) };
    });
}

const kMostUndone = 100;

// Changes in the order in which they were made. A group of changes is undone together.
export class History {
  private readonly done: SettingChange[][] = [];

  add(back: SettingChange[]): void {
    if (back.length === 0) return;
    this.done.push(back);
    if (this.done.length > kMostUndone) this.done.shift();
  }

  pop(): SettingChange[] | undefined {
    return this.done.pop();
  }

  clear(): void {
    this.done.length = 0;
  }
}
