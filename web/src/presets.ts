// Preset comparisons: overrides of side b relative to the scene of side a.
import { choiceName } from "./names";
import type { Scene, Setting, SettingValue } from "./protocol";
import { valueText } from "./view/values";

export interface Preset {
  title: string;
  label: string; // label of side b
  overrides: string[]; // in the syntax of --set
}

export function toml(value: SettingValue): string {
  if (typeof value === "string") return JSON.stringify(value);
  if (Array.isArray(value)) return `[${value.map(toml).join(", ")}]`;
  return String(value);
}

function find(scene: Scene, key: string): Setting | undefined {
  return scene.settings.find((setting) => setting.key === key || setting.key.endsWith(`.${key}`));
}

// The value, of two, that side a does not have.
function other(scene: Scene, key: string, first: string, second: string): string {
  return find(scene, key)?.value === first ? second : first;
}

const kWords: Record<string, string> = {
  symplectic_euler: "explicit: symplectic Euler",
  backward_euler: "implicit: backward Euler",
  gradient_descent: "gradient descent",
  newton: "Newton's method",
  none: "without line search",
  textbook: "with line search",
  corotated: "corotated",
  neo_hookean: "neo-Hookean",
  exact: "exact Hessian",
  clamped: "clamped Hessian",
};

function choice(scene: Scene, title: string, key: string, first: string, second: string): Preset {
  const value = other(scene, key, first, second);
  return { title, label: kWords[value] ?? value, overrides: [`${key}=${toml(value)}`] };
}

export function presets(scene: Scene): Preset[] {
  const explicit = scene.implicit ? "symplectic_euler" : "backward_euler";
  const all: Preset[] = [
    { title: "Explicit or implicit", label: kWords[explicit], overrides: [`time.integrator=${toml(explicit)}`] },
  ];
  if (scene.implicit) {
    all.push(
      choice(scene, "Gradient descent or Newton", "solver.method", "gradient_descent", "newton"),
      choice(scene, "With or without line search", "solver.line_search.test", "none", "textbook"),
      choice(scene, "Exact or clamped Hessian", "solver.definiteness", "exact", "clamped"),
    );
  }
  all.push({ title: "Half the time step", label: "h / 2", overrides: [`time.step=${toml(scene.h / 2)}`] });
  const young = find(scene, "material.young")?.value;
  if (young !== undefined) {
    const stiffer = typeof young === "number" ? 10 * young : `10 * (${String(young)})`;
    all.push({ title: "Ten times as stiff", label: "10 E", overrides: [`material.young=${toml(stiffer)}`] });
  }
  all.push(choice(scene, "Another material", "material.model", "corotated", "neo_hookean"));
  return all;
}

// Name of side a: the values of the settings that side b changes.
export function nameOfA(a: Scene, b: Scene): string {
  const changed = a.settings.filter(({ key, value }) => {
    const twin = b.settings.find((setting) => setting.key === key);
    return twin && JSON.stringify(twin.value) !== JSON.stringify(value);
  });
  return changed.slice(0, 2).map(nameOfValue).join(", ");
}

function nameOfValue({ key, label, value, unit }: Setting): string {
  if (typeof value === "string") return kWords[value] ?? choiceName(key, value);
  const symbol = / (\S|\S+_\S+)$/.exec(label)?.[1] ?? label;
  return `${symbol} = ${typeof value === "number" && unit !== "" ? valueText(value, unit) : toml(value)}`;
}

// One override per line; empty lines are ignored.
export function parseOverrides(text: string): string[] {
  return text
    .split("\n")
    .map((line) => line.trim())
    .filter((line) => line !== "");
}

// Message about the first line that is not KEY=VALUE; "" if there is none.
export function faultOfOverrides(overrides: string[]): string {
  const wrong = overrides.find((line) => !/^[\w.-]+\s*=\s*\S/.test(line));
  if (wrong !== undefined) return `'${wrong}' is not KEY=VALUE, such as material.young=1e6`;
  return overrides.length === 0 ? "The sides are equal: choose a comparison, or enter KEY=VALUE, one per line." : "";
}
