// Texts for values of the body.
import { short, withUnit } from "../numbers";
import type { MaybeNumber, Vec3 } from "../protocol";

export function unitText(unit: string): string {
  return unit.replaceAll("^2", "²").replaceAll("^3", "³");
}

// With an SI prefix where the unit allows one: 12.3 kPa, 4 mm, but 1000 kg/m³.
export function valueText(value: MaybeNumber, unit: string, digits = 4): string {
  if (value === null || !Number.isFinite(value)) return "not finite";
  if (/^(Pa|N|J|W|m|s|Hz)(\/|$)/.test(unit)) return withUnit(value, unitText(unit), digits);
  return unit === "" ? short(value, digits) : `${short(value, digits)} ${unitText(unit)}`;
}

// Entries of a vector or matrix. Round-off relative to the largest entry is shown as 0.
export function entryTexts(values: readonly number[]): string[] {
  const largest = Math.max(...values.map(Math.abs));
  return values.map((x) => short(Math.abs(x) < 1e-9 * largest ? 0 : x, 4));
}

export function vectorText(values: Vec3, unit: string): string {
  return `${entryTexts(values).join("  ")} ${unit}`.trimEnd();
}

// Rows of a matrix, aligned in columns with a font of equal digit widths.
export function matrixText(rows: [Vec3, Vec3, Vec3], unit: string): string {
  const texts = entryTexts(rows.flat());
  const width = Math.max(...texts.map((text) => text.length));
  const padded = texts.map((text) => text.padStart(width, "\u2007"));
  return [0, 3, 6].map((k) => padded.slice(k, k + 3).join("  ")).join("\n") + (unit && ` ${unit}`);
}
