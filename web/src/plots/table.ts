// Columns over a common x: merged, clipped to a window, and thinned for the screen. Every curve keeps its extremes.
import type { MaybeNumber } from "../protocol";

export interface Table {
  x: number[]; // ascending
  columns: MaybeNumber[][];
}

// First index whose x is at least `value`.
export function lowerBound(x: readonly number[], value: number): number {
  let [low, high] = [0, x.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (x[middle]! < value) low = middle + 1;
    else high = middle;
  }
  return low;
}

export function nearest(x: readonly number[], value: number): number {
  const above = lowerBound(x, value);
  if (above === 0) return 0;
  if (above === x.length) return x.length - 1;
  return value - x[above - 1]! <= x[above]! - value ? above - 1 : above;
}

// Rows in [from, to), at most two per bucket, which hold the smallest and the largest value of every column there, in
// their original order.
export function thinned(table: Table, from: number, to: number, buckets: number): Table {
  const { x, columns } = table;
  if (to - from <= 2 * buckets) return { x: x.slice(from, to), columns: columns.map((c) => c.slice(from, to)) };
  const out: Table = { x: [], columns: columns.map(() => []) };
  const [first, last] = [x[from]!, x[to - 1]!];
  const width = (last - first) / buckets || 1;
  for (let begin = from; begin < to;) {
    const bucket = Math.min(buckets - 1, Math.floor((x[begin]! - first) / width));
    let end = begin + 1;
    while (end < to && Math.min(buckets - 1, Math.floor((x[end]! - first) / width)) === bucket) ++end;
    addExtremes(table, begin, end, out);
    begin = end;
  }
  return out;
}

function addExtremes({ x, columns }: Table, begin: number, end: number, out: Table): void {
  const single = end === begin + 1;
  out.x.push(x[begin]!);
  if (!single) out.x.push(x[end - 1]!);
  columns.forEach((column, c) => {
    let [low, high] = [-1, -1];
    for (let i = begin; i < end; ++i) {
      const value = column[i]!;
      if (value === null) continue;
      if (low < 0 || value < column[low]!) low = i;
      if (high < 0 || value > column[high]!) high = i;
    }
    const at = (i: number): MaybeNumber => (i < 0 ? null : column[i]!);
    if (single) out.columns[c]!.push(at(low));
    else out.columns[c]!.push(at(Math.min(low, high)), at(Math.max(low, high)));
  });
}

// The tables over the union of their x, with null where a table has no row.
export function merged(...tables: Table[]): Table {
  if (tables.length === 1) return tables[0];
  const out: Table = { x: [], columns: tables.flatMap(({ columns }) => columns).map(() => []) };
  const next = tables.map(() => 0); // row of each table
  for (;;) {
    const x = Math.min(...tables.map((table, k) => table.x[next[k]] ?? Infinity));
    if (x === Infinity) return out;
    out.x.push(x);
    let c = 0;
    tables.forEach((table, k) => {
      const here = table.x[next[k]] === x;
      for (const column of table.columns) out.columns[c++].push(here ? column[next[k]] : null);
      if (here) ++next[k];
    });
  }
}

// Magnitude for a logarithmic axis; null for zero, which such an axis cannot show.
export function magnitude(value: MaybeNumber): MaybeNumber {
  return value === null || value === 0 ? null : Math.abs(value);
}
