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

// A picture with its title above and its legend below, in columns. `scale`: pixels per CSS pixel.
export function titled(source: HTMLCanvasElement, title: string, colors: Palette, scale: number, signs: readonly Sign[]): HTMLCanvasElement {
  const line = colors.fontSize * 1.5 * scale; // height of a line [px]
  const columns = Math.max(1, Math.floor(source.width / (line * 14)));
  const canvas = element("canvas");
  canvas.width = source.width;
  canvas.height = source.height + line * (2 + Math.ceil(signs.length / columns));
  const pen = canvas.getContext("2d")!;
  pen.fillStyle = colors.panel;
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.drawImage(source, 0, line * 1.5);
  pen.textBaseline = "middle";
  pen.fillStyle = colors.text;
  pen.font = `600 ${colors.fontSize * scale}px sans-serif`;
  pen.fillText(title, line * 0.5, line * 0.75);
  pen.font = `${colors.fontSize * 0.84 * scale}px sans-serif`;
  signs.forEach(({ sign, color, text }, i) => {
    const x = line * 0.5 + (i % columns) * ((canvas.width - line) / columns);
    const y = source.height + line * (2.1 + Math.floor(i / columns));
    pen.fillStyle = inkOf(colors, color);
    pen.fillText(sign, x, y);
    pen.fillStyle = colors.text;
    pen.fillText(text, x + line * 1.5, y);
  });
  return canvas;
}
