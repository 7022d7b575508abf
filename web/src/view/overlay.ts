// The 2-D canvas over a view: axes, color bar, numbers, highlights, the mouse's spring and the brush.
import type { Highlight } from "../page";
import type { Field, StepRow, Vec3 } from "../protocol";
import type { MapName } from "./colorMaps";
import type { DisplaySettings } from "./display";
import type { Label } from "./labels";
import type { Lens } from "./lens";
import * as marks from "./marks";
import type { ColorRange } from "./ranges";

export interface Marks {
  axes?: boolean;
  gridStep?: number; // [m]; 0: no grid
  scaleBar?: boolean;
  bar?: { field: Pick<Field, "label" | "unit">; range: ColorRange; map: MapName } | null;
  contact?: { largest: number; row: StepRow | null } | null; // pressure of the last color [Pa], and the step shown
  bodies?: { name: string; color: string }[]; // entries of the legend; empty: no legend
  labels?: Label[];
  highlights?: Highlight[];
  spring?: { point: Vec3; target: Vec3; force: Vec3 | null } | null;
  brush?: { at: [number, number]; radius: number; words: string } | null;
  tip?: { at: [number, number]; words: string } | null;
}

export interface Style {
  text: string; // color of texts
  background: string;
  accent: string;
  grid: string;
  font: string; // font family
  em: number; // height of text [px]
}

// Colors of the page's theme, unless the reader chose a background.
export function readStyle(host: HTMLElement, settings: DisplaySettings, size: [number, number] | null): Style {
  const style = getComputedStyle(host);
  const own = settings.ownBackground ? settings.background : null;
  return {
    text: own ? (isLight(own) ? "#1b1f27" : "#e8ebf0") : style.getPropertyValue("--text"),
    background: settings.transparent ? "transparent" : own ?? style.getPropertyValue("--background"),
    accent: style.getPropertyValue("--series-2"),
    grid: style.getPropertyValue("--faint"),
    font: style.fontFamily,
    em: size ? Math.max(10, (settings.textSize * size[1]) / 45) : parseFloat(style.fontSize),
  };
}

function isLight(color: string): boolean {
  const [r, g, b] = [1, 3, 5].map((at) => parseInt(color.slice(at, at + 2), 16));
  return 0.299 * r + 0.587 * g + 0.114 * b > 128;
}

export class Overlay {
  readonly canvas = document.createElement("canvas");
  private readonly context = this.canvas.getContext("2d")!;

  draw(lens: Lens, style: Style, what: Marks): void {
    const { context } = this;
    const ratio = this.canvas.height / lens.height; // the canvas is wider than the lens if there is a color bar
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, this.canvas.width / ratio, lens.height);
    context.font = `${style.em}px ${style.font}`;
    const ink: marks.Ink = { context, em: style.em, text: style.text, halo: style.background, accent: style.accent };
    for (const { x, y, text } of what.labels ?? []) marks.label(ink, text, x, y);
    marks.highlights(ink, lens, what.highlights ?? [], lens.width);
    if (what.axes) marks.axes(ink, lens);
    if (what.scaleBar) marks.scaleBar(ink, lens);
    if (what.gridStep) marks.gridNote(ink, lens, what.gridStep);
    const taken = marks.bodyLegend(ink, lens, what.bodies ?? []);
    if (what.contact) marks.contactLegend(ink, lens, what.contact, taken);
    if (what.spring) marks.spring(ink, lens, what.spring.point, what.spring.target, what.spring.force);
    if (what.brush) marks.ring(ink, what.brush.at, what.brush.radius, what.brush.words);
    if (what.bar) marks.colorBar(ink, lens, what.bar.field, what.bar.range, what.bar.map);
    if (what.tip) marks.paragraph(ink, lens, what.tip.words, what.tip.at[0] + style.em, what.tip.at[1] - style.em);
  }
}
