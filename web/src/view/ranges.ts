// Range of a color map's values, and the ticks of its bar.

export interface ColorRange {
  low: number;
  high: number;
  log: boolean;
}

const kShrink = 0.03; // fraction of the gap per picture

// Grows immediately and shrinks slowly, so that the colors of a moving body do not flicker.
export class RunningRange {
  private readonly latest = new Map<string, { min: number; max: number }>(); // key: side
  private low = Infinity;
  private high = -Infinity;

  reset(): void {
    this.latest.clear();
    [this.low, this.high] = [Infinity, -Infinity];
  }

  // Removes a side, or its values that are no longer meaningful. The range becomes that of the other side, if any.
  forget(side: string): void {
    const others = [...this.latest].filter(([name]) => name !== side);
    if (!this.latest.has(side) || others.length === 0) return;
    this.reset();
    for (const [name, { min, max }] of others) this.feed(name, min, max);
  }

  feed(side: string, min: number, max: number): void {
    if (!Number.isFinite(min) || !Number.isFinite(max) || min > max) return;
    this.latest.set(side, { min, max });
    const all = [...this.latest.values()];
    const [least, most] = [Math.min(...all.map((r) => r.min)), Math.max(...all.map((r) => r.max))];
    this.low = least <= this.low ? least : this.low + kShrink * (least - this.low);
    this.high = most >= this.high ? most : this.high + kShrink * (most - this.high);
  }

  get(): { low: number; high: number } | null {
    return this.low <= this.high ? { low: this.low, high: this.high } : null;
  }
}

// Smallest and largest finite value; null if there is none.
export function extremes(values: Iterable<number>): [number, number] | null {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    if (!Number.isFinite(value)) continue;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return low <= high ? [low, high] : null;
}

// Symmetric range around the center.
export function about(center: number, low: number, high: number): { low: number; high: number } {
  const half = Math.max(Math.abs(high - center), Math.abs(center - low));
  return { low: center - half, high: center + half };
}

// Range for a logarithmic scale: positive values, at most nine decades below the largest. Null if there are none.
export function logRange(low: number, high: number): { low: number; high: number } | null {
  if (!(high > 0)) return null;
  return { low: low > high * 1e-9 ? low : high * 1e-9, high };
}

// Position of a value in the range, as the shader computes it.
export function fraction(range: ColorRange, value: number): number {
  const f = range.log ? Math.log : (x: number): number => x;
  const width = f(range.high) - f(range.low);
  return width > 0 ? (f(value) - f(range.low)) / width : 0.5;
}

// Round values inside [low, high], about `count` of them; steps are 1, 2 or 5 times a power of ten.
export function ticks(low: number, high: number, count: number): number[] {
  if (!(high > low) || !Number.isFinite(high - low)) return Number.isFinite(low) ? [low] : [];
  const step = roundStep((high - low) / Math.max(1, count));
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: Math.max(0, Math.min(50, last - first + 1)) }, (_, i) => (first + i) * step);
}

// Powers of ten inside [low, high]; with 2 and 5 between them when there are few; evenly spaced values where there is
// none.
export function logTicks(low: number, high: number): number[] {
  if (!(low > 0) || !(high > low)) return [];
  const decades = Math.log10(high / low);
  const factors = decades < 2 ? [1, 2, 5] : [1];
  const every = Math.max(1, Math.ceil(decades / 6));
  const found: number[] = [];
  for (let k = Math.floor(Math.log10(low)); k <= Math.ceil(Math.log10(high)); ++k)
    for (const factor of factors) {
      const tick = factor * 10 ** k;
      if (k % every === 0 && tick >= low * (1 - 1e-9) && tick <= high * (1 + 1e-9)) found.push(tick);
    }
  return found.length < 2 ? ticks(low, high, 4) : found;
}

// Smallest of 1, 2, 5 times a power of ten that is at least x.
export function roundStep(x: number): number {
  const power = 10 ** Math.floor(Math.log10(x));
  const factor = [1, 2, 5, 10].find((f) => f * power >= x * (1 - 1e-9)) ?? 10;
  return factor * power;
}
