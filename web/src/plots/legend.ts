// Legend of the signs in a picture of a surface.
import { element } from "../dom";
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

// A picture with its title above and room for `rows` lines of a legend below, where the pen writes next. `scale`:
// pixels per CSS pixel. Lines are `line` pixels high.
export function titled(source: HTMLCanvasElement, title: string, colors: Palette, scale: number, rows: number): {
  canvas: HTMLCanvasElement;
  pen: CanvasRenderingContext2D;
} {
  const line = lineHeight(colors, scale);
  const canvas = document.createElement("canvas");
  canvas.width = source.width;
  canvas.height = source.height + line * (2 + rows);
  const pen = canvas.getContext("2d")!;
  pen.fillStyle = colors.panel;
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.drawImage(source, 0, line * 1.5);
  pen.textBaseline = "middle";
  pen.fillStyle = colors.text;
  pen.font = `600 ${colors.fontSize * scale}px sans-serif`;
  pen.fillText(title, line * 0.5, line * 0.75);
  pen.font = `${colors.fontSize * 0.84 * scale}px sans-serif`;
  return { canvas, pen };
}

export const lineHeight = (colors: Palette, scale: number): number => colors.fontSize * 1.5 * scale;

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
