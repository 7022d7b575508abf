// The force over the depth at which it was felt, of one touch: the latest force of every depth, the shallowest first.
import type { ProbeState } from "../protocol";

const kMost = 400; // depths that are distinguished, over the radius of the tip

export class ForceCurve {
  private touch = "";
  private readonly points = new Map<number, [depth: number, force: number]>();

  // True when the curve is another one.
  add(probe: ProbeState | null): boolean {
    if (!probe) return false; // the last touch stays to be looked at
    const touch = [...probe.begun, ...probe.axis, probe.radius, probe.shape, probe.contact].join();
    if (touch !== this.touch) this.points.clear();
    this.touch = touch;
    const force = pushOf(probe);
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

// With what force the tip is pushed in; negative where a bonded tip pulls.
export function pushOf({ force, axis }: { force: readonly number[]; axis: readonly number[] }): number {
  return force[0]! * axis[0]! + force[1]! * axis[1]! + force[2]! * axis[2]!;
}
