// Axes of a chart: units with SI prefixes, powers of ten, and shortened numbers.
import type uPlot from "uplot";
import { prefixOf, tickTexts } from "../numbers";
import type { Palette } from "./palette";

export interface Axis {
  label: string;
  unit?: string; // shown with a suitable SI prefix
  integer?: boolean;
}

const kWholeSteps = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000, 50000, 100000, 1e6, 1e7];

export function axis(options: Axis & { log?: boolean }, colors: Palette, vertical: boolean): uPlot.Axis {
  const measure = document.createElement("canvas").getContext("2d")!;
  measure.font = colors.font;
  const factorOf = (u: uPlot): { factor: number; letter: string } => {
    const scale = u.scales[vertical ? "y" : "x"]!;
    const size = Math.max(Math.abs(scale.min ?? 0), Math.abs(scale.max ?? 0));
    return options.unit === undefined || options.log === true ? { factor: 1, letter: "" } : prefixOf(size);
  };
  return {
    stroke: colors.faint,
    font: colors.font,
    labelFont: colors.font,
    grid: { stroke: colors.line, width: 1 },
    splits: options.log === true ? ({ scales, over }) => powersOfTen(scales.y!.min!, scales.y!.max!, over.clientHeight / (2 * colors.fontSize)) : undefined,
    filter: (_u, splits) => splits,
    ticks: { stroke: colors.line, width: 1, size: 4 },
    gap: 3,
    label: (u) =>
      options.unit === undefined ? options.label : `${options.label} [${factorOf(u).letter}${options.unit}]`,
    labelSize: colors.fontSize * 1.35,
    labelGap: 0,
    space: vertical ? colors.fontSize * 2.2 : colors.fontSize * 5,
    // uPlot omits all ticks where it finds no step among these, though `splits` needs none.
    incrs: options.log === true ? [Number.MAX_VALUE] : options.integer === true ? kWholeSteps : undefined,
    size: (_u, values) =>
      vertical
        ? Math.max(...(values ?? []).map((v) => measure.measureText(v ?? "").width), colors.fontSize) + 10
        : colors.fontSize * 1.7,
    values: (u, splits) => (options.log === true ? splits.map(superscript) : tickTexts(splits, factorOf(u).factor)),
  };
}

// Powers of ten, at most about `room` of them.
export function powersOfTen(min: number, max: number, room: number): number[] {
  if (!(min > 0) || !(max > 0)) return [];
  const [first, last] = [Math.ceil(Math.log10(min) - 1e-9), Math.floor(Math.log10(max) + 1e-9)];
  const stride = Math.max(1, Math.ceil((last - first) / Math.max(1, room)));
  const out: number[] = [];
  for (let exponent = last; exponent >= first; exponent -= stride) out.unshift(10 ** exponent);
  return out;
}

const kSuperscripts = "⁰¹²³⁴⁵⁶⁷⁸⁹";
function superscript(value: number): string {
  const exponent = Math.log10(value);
  const digits = [...String(Math.abs(Math.round(exponent)))].map((d) => kSuperscripts[Number(d)]).join("");
  return `10${exponent < -0.5 ? "⁻" : ""}${digits}`;
}

const kLargestExponent = 308; // of a double

export function padded(low: number | null, high: number | null, integer: boolean): [number, number] {
  if (low === null || high === null) return [0, 1];
  if (integer) return [low - 0.5, high + 0.5];
  return low === high ? [low - Math.abs(low) * 0.1 - 1e-12, high + Math.abs(high) * 0.1 + 1e-12] : [low, high];
}

export function ranged(low: number | null, high: number | null, log: boolean): [number, number] {
  if (low === null || high === null) return log ? [1e-1, 1e1] : [0, 1];
  if (log) return [10 ** Math.floor(Math.log10(low) - 1e-9), 10 ** Math.min(kLargestExponent, Math.ceil(Math.log10(high) + 1e-9))];
  const margin = (high - low) * 0.06 || Math.abs(high) * 0.1 || 1;
  return [low - margin, high + margin];
}
