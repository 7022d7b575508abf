// Force over depth during one touch: the latest force at every depth, in order of increasing depth.
import type { IndenterState } from "./protocol";

const kMost = 400; // distinct depths per radius of the indenter

export class ForceCurve {
  private touch = "";
  private readonly points = new Map<number, [depth: number, force: number]>();

  // Returns true if the curve has changed. The curve of the last touch remains.
  add(tip: IndenterState | null): boolean {
    if (!tip) return false;
    const touch = [...tip.begun, ...tip.axis, tip.radius, tip.shape, tip.contact].join();
    if (touch !== this.touch) this.points.clear();
    this.touch = touch;
    const place = Math.round((kMost * tip.depth) / tip.radius);
    const known = this.points.get(place);
    if (known && known[0] === tip.depth && known[1] === tip.force) return false;
    this.points.set(place, [tip.depth, tip.force]);
    return true;
  }

  sorted(): [depth: number, force: number][] {
    return [...this.points.values()].sort((a, b) => a[0] - b[0]);
  }
}
