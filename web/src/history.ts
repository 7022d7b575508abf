// Undo of settings. What is undone is an override of a side: back to the value before, or to what the scene's file has
// when there was none.
import type { Scene, SettingValue, SideName } from "./protocol";

export interface SettingChange {
  key: string;
  value: SettingValue | null; // null: drops the override
  side?: SideName;
}

function keyOf(override: string): string {
  return override.slice(0, override.indexOf("=")).replaceAll(" ", "");
}

// What brings a setting of a side back to what it is now.
export function backTo(scene: Scene, key: string, side?: SideName): SettingChange {
  const overridden = scene.overrides.some((override) => keyOf(override) === key);
  const setting = scene.settings.find((candidate) => candidate.key === key);
  const value = overridden && setting ? setting.value : null;
  return side ? { key, value, side } : { key, value };
}

// The value of an override's text, which is TOML; null for one that is no number, text, switch or list of these.
function valueOf(override: string): SettingValue | null {
  const text = override.slice(override.indexOf("=") + 1).trim();
  try {
    return JSON.parse(text.replace(/(\d)\.(?=$|[^\d])/g, "$1.0").replace(/e\+/g, "e")) as SettingValue;
  } catch {
    return null;
  }
}

// What brings every setting of a side back to how it was loaded, the latest change first.
export function toLoaded(scene: Scene, side?: SideName): SettingChange[] {
  const before = new Map(scene.loaded_overrides.map((override) => [keyOf(override), override]));
  const known = new Set(scene.settings.map((setting) => setting.key));
  return scene.overrides
    .filter((override) => known.has(keyOf(override)) && before.get(keyOf(override)) !== override)
    .reverse()
    .map((override) => {
      const loaded = before.get(keyOf(override));
      const value = loaded === undefined ? null : valueOf(loaded);
      return side ? { key: keyOf(override), value, side } : { key: keyOf(override), value };
    });
}

const kMostUndone = 100;

// Changes in the order in which they were made; what belongs together is undone together.
export class History {
  private readonly done: { what: string; back: SettingChange[] }[] = [];

  get last(): string | null {
    return this.done[this.done.length - 1]?.what ?? null;
  }

  add(what: string, back: SettingChange[]): void {
    if (back.length === 0) return;
    this.done.push({ what, back });
    if (this.done.length > kMostUndone) this.done.shift();
  }

  pop(): SettingChange[] {
    return this.done.pop()?.back ?? [];
  }

  clear(): void {
    this.done.length = 0;
  }
}
