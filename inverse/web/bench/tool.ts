// The indenter as a tool of the mouse: a click places it, dragging presses it in.
import { isBehind, pixelsPerMeter, project } from "../../../web/src/view/lens";
import type { Hit } from "../../../web/src/view/picking";
import type { ToolGesture, TouchedView, ViewTool } from "../../../web/src/view/viewTool";
import { depthOf, inwardNormal, wayIn, type Way } from "./pressing";
import type { IndenterChoice, IndenterState } from "./protocol";
import { TipBody } from "./tipBody";

const kReach = 4; // smallest distance at which the pointer holds the indenter [px]

export class IndenterTool implements ViewTool {
  readonly choice: Partial<IndenterChoice> = { shape: "sphere", contact: "bonded" }; // of the next indenter

  makeShape(): TipBody {
    return new TipBody();
  }

  begin(view: TouchedView, at: [number, number], hit: Hit | null): ToolGesture | null {
    const lens = view.lens();
    const tip = view.store.state?.[view.side]?.tool as IndenterState | null | undefined;
    if (tip) {
      const [x, y, depth] = project(lens, tip.center);
      const reach = Math.max(kReach, tip.radius * pixelsPerMeter(lens, depth));
      if (!isBehind(lens, depth) && Math.hypot(at[0] - x, at[1] - y) <= reach) return press(view, wayIn(lens, tip.center, tip.axis), tip.wanted);
    }
    const surface = view.surface();
    if (!hit || !surface) return null;
    const { source, state } = view.store;
    source.send({ do: "touch", side: view.side, triangle: hit.triangle, weights: hit.weights, ...this.choice });
    if (!state?.playing) source.send({ do: "play" });
    return press(view, wayIn(lens, hit.point, inwardNormal(surface.positions, surface.triangles, hit.triangle)), 0);
  }
}

function press({ store }: TouchedView, way: Way, from: number): ToolGesture {
  let [dx, dy] = [0, 0];
  let sent = from;
  return {
    move(byX, byY) {
      [dx, dy] = [dx + byX, dy + byY];
    },
    flush() {
      const depth = from + depthOf(way, [dx, dy]);
      if (depth !== sent) store.source.send({ do: "press", depth: (sent = depth) });
    },
  };
}
