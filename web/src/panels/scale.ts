// Converts between a setting's value and the position of its slider, 0 to 1.
import type { Setting } from "../protocol";

export type Range = Pick<Setting, "min" | "max" | "log" | "kind">;

function isLog(range: Range): boolean {
  return range.log && range.min > 0 && range.max > range.min;
}

// A typed value outside of the slider's range is at the slider's end.
export function toPosition(value: number, range: Range): number {
  if (!(range.max > range.min)) return 0;
  const { min, max } = range;
  const position = isLog(range) ? Math.log(value / min) / Math.log(max / min) : (value - min) / (max - min);
  return Number.isFinite(position) ? Math.max(0, Math.min(1, position)) : 0;
}

// Rounded to three digits, the precision of a slider.
export function toValue(position: number, range: Range): number {
  const { min, max } = range;
  const value = isLog(range) ? min * (max / min) ** position : min + position * (max - min);
  return range.kind === "integer" ? Math.round(value) : Number(value.toPrecision(3));
}

// At most six digits, the width of a field.
export function numberText(exact: number): string {
  const value = Number(exact.toPrecision(6));
  const size = Math.abs(value);
  const text = size >= 1e5 || (size < 1e-3 && size > 0) ? value.toExponential() : String(value);
  return text.replace("e+", "e");
}

// The typed number, or null.
export function parseNumber(text: string): number | null {
  const value = Number(text.trim().replace(",", "."));
  return text.trim() !== "" && Number.isFinite(value) ? value : null;
}
