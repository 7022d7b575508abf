// Legend of the signs in a picture of a surface.
import { element } from "./dom";
import { cssOf, inkOf, type Color, type Palette } from "./palette";

export interface Sign {
  sign: string;
  color: Color;
  text: string;
}

export function legendOf(signs: readonly Sign[]): HTMLDListElement {
  const list = element("dl", { class: "surface-legend" });
  for (const { sign, color, text } of signs) {
    const term = element("dt", {}, sign);
    term.style.color = cssOf(color);
    list.append(term, element("dd", {}, text));
  }
  return list;
}

// The same legend on a canvas, in columns.
export function paintLegend(
  pen: CanvasRenderingContext2D,
  signs: readonly Sign[],
  colors: Palette,
  top: number,
  line: number,
): void {
  const columns = legendColumns(pen.canvas.width, line);
  signs.forEach(({ sign, color, text }, i) => {
    const [x, y] = [
      line * 0.5 + (i % columns) * ((pen.canvas.width - line) / columns),
      top + line * (Math.floor(i / columns) + 0.5),
    ];
    pen.fillStyle = inkOf(colors, color);
    pen.fillText(sign, x, y);
    pen.fillStyle = colors.text;
    pen.fillText(text, x + line * 1.5, y);
  });
}

export function legendColumns(width: number, line: number): number {
  return Math.max(1, Math.floor(width / (line * 16)));
}
