// The 2-D canvas over a view: axes, colour bar, numbers, highlights, the mouse's spring and brush.
import type { Highlight } from "../page";
import type { Field, Vec3 } from "../protocol";
import type { MapName } from "./colourMaps";
import type { Label } from "./labels";
import type { Lens } from "./lens";
import * as marks from "./marks";
import type { ColourRange } from "./ranges";

export interface Marks {
  axes: boolean;
  gridStep: number; // [m]; 0: no grid
  bar: { field: Field; range: ColourRange; map: MapName } | null;
  labels: Label[];
  highlights: Highlight[];
  spring: { point: Vec3; target: Vec3; force: Vec3 | null } | null;
  brush: { at: [number, number]; radius: number; words: string } | null;
  tip: { at: [number, number]; words: string } | null;
}

export interface Style {
  text: string; // colours
  background: string;
  accent: string;
  font: string; // family
  em: number; // height of text [px]
}

export class Overlay {
  readonly canvas = document.createElement("canvas");
  private readonly context = this.canvas.getContext("2d")!;

  draw(lens: Lens, style: Style, what: Marks): void {
    const { context } = this;
    const ratio = this.canvas.width / lens.width;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, lens.width, lens.height);
    context.font = `${style.em}px ${style.font}`;
    const ink: marks.Ink = { context, em: style.em, text: style.text, halo: style.background, accent: style.accent };
    for (const { x, y, text } of what.labels) marks.label(ink, text, x, y);
    for (const { positions, text } of what.highlights) marks.highlight(ink, lens, positions, text);
    if (what.axes) marks.axes(ink, lens);
    if (what.gridStep > 0) marks.gridNote(ink, lens, what.gridStep);
    if (what.bar) marks.colourBar(ink, lens, what.bar.field, what.bar.range, what.bar.map);
    if (what.spring) marks.spring(ink, lens, what.spring.point, what.spring.target, what.spring.force);
    if (what.brush) marks.ring(ink, what.brush.at, what.brush.radius, what.brush.words);
    if (what.tip) marks.text(ink, what.tip.words, what.tip.at[0] + style.em, what.tip.at[1] - style.em);
  }
}
