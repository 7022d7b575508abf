// The program computes the depth anew, so that its last digits may differ from the request.
const isSame = (a: number, b: number): boolean => Math.abs(a - b) <= 1e-9 * Math.max(Math.abs(a), Math.abs(b));

// The depths that were asked for and that the program has not reported yet: the next notch continues from the last of them, not
// from the older one that is still on its way.
export class AskedDepths {
  private before = 0; // what was reported when the first of them was asked for
  private pending: number[] = [];

  ask(depth: number, reported: number): void {
    if (this.pending.length === 0) this.before = reported;
    this.pending.push(depth);
  }

  // A depth from the program; null: there is no tip. A depth that nobody asked for here is somebody else's, and counts.
  hear(reported: number | null): void {
    const at = reported === null ? -1 : this.pending.map((depth) => isSame(depth, reported)).lastIndexOf(true);
    if (at >= 0) this.pending = this.pending.slice(at + 1);
    else if (reported === null || !isSame(reported, this.before)) this.pending = [];
    if (reported !== null) this.before = reported;
  }

  last(reported: number): number {
    return this.pending.at(-1) ?? reported;
  }
}
