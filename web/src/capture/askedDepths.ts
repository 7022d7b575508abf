// The program recomputes each depth, so its last digits may differ from the request.
const isSame = (a: number, b: number): boolean => Math.abs(a - b) <= 1e-9 * Math.max(Math.abs(a), Math.abs(b));

// Depths that were requested and are not yet reported. The next notch continues from the latest request, not from an
// older one that is still under way.
export class AskedDepths {
  private before = 0; // depth reported when the first of them was requested
  private pending: number[] = [];

  ask(depth: number, reported: number): void {
    if (this.pending.length === 0) this.before = reported;
    this.pending.push(depth);
  }

  // Accepts a reported depth; null means that there is no tip. A depth that this page did not request comes from
  // another page and counts.
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
