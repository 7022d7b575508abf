// Force over depth during one touch: the latest force at every depth, in order of increasing depth.
import type { ProbeState } from "../protocol";
import { dot } from "../view/lens";

const kMost = 400; // distinct depths per tip radius

export class ForceCurve {
  private touch = "";
  private readonly points = new Map<number, [depth: number, force: number]>();

  // Returns true if the curve has changed.
  add(probe: ProbeState | null): boolean {
    if (!probe) return false; // the curve of the last touch remains visible
    const touch = [...probe.begun, ...probe.axis, probe.radius, probe.shape, probe.contact].join();
    if (touch !== this.touch) this.points.clear();
    this.touch = touch;
    const force = dot(probe.force, probe.axis); // negative where a bonded tip pulls
    const place = Math.round((kMost * probe.depth) / probe.radius);
    const known = this.points.get(place);
    if (known && known[0] === probe.depth && known[1] === force) return false;
    this.points.set(place, [probe.depth, force]);
    return true;
  }

  sorted(): [depth: number, force: number][] {
    return [...this.points.values()].sort((a, b) => a[0] - b[0]);
  }
}
