// The program computes the depth anew, so that it tells what was asked for but for the last digits.
const isSame = (a: number, b: number): boolean => Math.abs(a - b) <= 1e-9 * Math.max(Math.abs(a), Math.abs(b));

// The depths that were asked for and that the program has not told yet: the next notch goes on from the last of them, not
// from the older one that is still on its way.
export class AskedDepths {
  private before = 0; // what was told when the first of them was asked for
  private pending: number[] = [];

  ask(depth: number, told: number): void {
    if (this.pending.length === 0) this.before = told;
    this.pending.push(depth);
  }

  // What the program tells; null: there is no tip. A depth that nobody asked for here is somebody else's, and counts.
  hear(told: number | null): void {
    const at = told === null ? -1 : this.pending.map((depth) => isSame(depth, told)).lastIndexOf(true);
    if (at >= 0) this.pending = this.pending.slice(at + 1);
    else if (told === null || !isSame(told, this.before)) this.pending = [];
    if (told !== null) this.before = told;
  }

  last(told: number): number {
    return this.pending.at(-1) ?? told;
  }
}
