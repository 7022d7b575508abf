// Formats numbers: few digits, SI prefixes, a dash for missing values.
export type MaybeNumber = number | null; // null: not finite

const kPrefixes = [..."TGMk mµnpf"].map((letter, i) => ({ factor: Number(`1e${12 - 3 * i}`), letter: letter.trim() }));
const kTooLarge = 1e15; // largest value with a prefix; beyond it powers of ten are clearer

// SI prefix that leaves one to three digits before the point.
export function prefixOf(size: number): { factor: number; letter: string } {
  const magnitude = Math.abs(size);
  if (!(magnitude > 0) || !(magnitude < kTooLarge)) return { factor: 1, letter: "" };
  return kPrefixes.find(({ factor }) => magnitude >= factor * (1 - 1e-12)) ?? kPrefixes[kPrefixes.length - 1];
}

// "0.0012", "1.2e-7", "34 500": at most `digits` significant digits, without trailing zeros.
export function short(value: MaybeNumber | undefined, digits = 4): string {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (value === 0) return "0";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  const size = Math.abs(value);
  const text =
    size >= 1e-3 && size < 1e6
      ? String(Number(value.toPrecision(size >= 1e4 ? Math.max(digits, 6) : digits)))
      : value
          .toExponential(digits - 1)
          .replace(/\.?0+e/, "e")
          .replace("e+", "e");
  return text.replace(/-/g, "−");
}

// "12.3 mJ"
export function withUnit(value: MaybeNumber | undefined, unit: string, digits = 4): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return `0 ${unit}`;
  const size = Math.abs(value);
  if (size < 1e-15 || size >= kTooLarge) return `${short(value, digits)} ${unit}`;
  const { factor, letter } = prefixOf(value);
  return `${short(value / factor, digits)} ${letter}${unit}`;
}

// Decimals that show a gap exactly: 0 for 5, 1 for 2.5, 3 for 0.025. A gap of many digits gets three.
function decimalsOf(gap: number): number {
  const first = Math.max(0, -Math.floor(Math.log10(gap) + 1e-9));
  const isWhole = (decimals: number): boolean => Math.abs(gap * 10 ** decimals - Math.round(gap * 10 ** decimals)) < 1e-6 * gap * 10 ** decimals;
  return Math.min(12, [first, first + 1].find(isWhole) ?? first + 2);
}

// Texts of an axis' ticks, with enough decimals to distinguish neighbors.
export function tickTexts(values: readonly (number | null)[], factor = 1): string[] {
  const known = values.filter((v): v is number => v !== null).map((v) => v / factor);
  const gap = known.length > 1 ? Math.abs(known[1]! - known[0]!) : 1;
  const largest = Math.max(...known.map(Math.abs), 0);
  const decimals = decimalsOf(gap);
  const plain = largest < 1e6 && (largest === 0 || decimals <= 4);
  return values.map((value) => {
    if (value === null) return "";
    const v = Math.abs(value / factor) < gap * 1e-6 ? 0 : value / factor;
    if (v === 0) return "0";
    const digits = Math.min(12, Math.max(1, Math.ceil(Math.log10(Math.abs(v) / gap) + 1)));
    return plain ? v.toFixed(decimals).replace("-", "−") : short(v, digits);
  });
}

export function finite(values: readonly MaybeNumber[]): number[] {
  return values.filter((value): value is number => value !== null && Number.isFinite(value));
}

export function plural(count: number, noun: string): string {
  return `${count} ${noun}${count === 1 ? "" : "s"}`;
}

// CSV text: shortest decimals that read back to the same bits; empty for values that are not finite.
export function csv(header: readonly string[], columns: readonly (readonly MaybeNumber[])[], rows: number): string {
  const lines = [header.map(csvCell).join(",")];
  for (let row = 0; row < rows; ++row)
    lines.push(columns.map((c) => (c[row] === null ? "" : String(c[row]))).join(","));
  return lines.join("\n") + "\n";
}

function csvCell(text: string): string {
  return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}
