// Vertical line through a chart that marks a position.
import type uPlot from "uplot";

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
