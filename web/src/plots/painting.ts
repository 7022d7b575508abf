// Lines and texts painted over a chart.
import type uPlot from "uplot";
import type { Ink } from "../view/marks";
import type { Palette } from "./palette";

// Pen for texts over a chart. Call `context.restore()` when done.
export function inkOn(u: uPlot, colors: Palette, color: string): Ink {
  const context = u.ctx;
  const em = 0.82 * colors.fontSize * (u.bbox.width / u.over.clientWidth || 1);
  context.save();
  context.setLineDash([]);
  context.font = `${em}px sans-serif`;
  return { context, em, text: color, halo: colors.panel, accent: color };
}

export function paintVerticalLine(u: uPlot, at: number, color: string, opacity = 1): void {
  const x = Math.round(u.valToPos(at, "x", true));
  const { left, top, width, height } = u.bbox;
  if (x < left || x > left + width) return;
  u.ctx.save();
  u.ctx.setLineDash([]);
  u.ctx.strokeStyle = color;
  u.ctx.globalAlpha = opacity;
  u.ctx.lineWidth = 2;
  u.ctx.beginPath();
  u.ctx.moveTo(x, top);
  u.ctx.lineTo(x, top + height);
  u.ctx.stroke();
  u.ctx.restore();
}
