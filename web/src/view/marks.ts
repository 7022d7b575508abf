// Text and thin shapes over a view, drawn with a 2-D canvas and readable over any background.
import { short, tickTexts } from "../numbers";
import type { Highlight } from "../page";
import type { Field, StepRow, Vec3 } from "../protocol";
import { colorAt, type MapName } from "./colorMaps";
import { contactText, kContactMap } from "./contacts";
import { apart, type Box } from "./labels";
import { isBehind, pixelsPerMeter, project, type Lens } from "./lens";
import { fraction, logTicks, roundStep, ticks, type ColorRange } from "./ranges";
import { unitText, valueText } from "./values";

export interface Ink {
  context: CanvasRenderingContext2D;
  text: string; // color of texts
  halo: string;
  accent: string;
  em: number; // height of text [px]
}

type Point = [number, number];

export function text(ink: Ink, words: string, x: number, y: number, align: CanvasTextAlign = "left"): void {
  const { context } = ink;
  context.textAlign = align;
  context.textBaseline = "middle";
  context.lineJoin = "round";
  context.lineWidth = 0.3 * ink.em;
  context.strokeStyle = ink.halo;
  context.strokeText(words, x, y);
  context.fillStyle = ink.text;
  context.fillText(words, x, y);
}

// Draws a number above a dot.
export function label(ink: Ink, words: string, x: number, y: number): void {
  ink.context.fillStyle = ink.accent;
  ink.context.fillRect(x - 1.5, y - 1.5, 3, 3);
  text(ink, words, x, y - 0.75 * ink.em, "center");
}

function stroke(ink: Ink, points: Point[], width: number, color: string): void {
  const { context } = ink;
  context.lineJoin = context.lineCap = "round";
  for (const [w, style] of [[width + 2, ink.halo], [width, color]] as const) {
    context.lineWidth = w;
    context.strokeStyle = style;
    context.beginPath();
    points.forEach(([x, y], i) => (i === 0 ? context.moveTo(x, y) : context.lineTo(x, y)));
    context.stroke();
  }
}

function dot(ink: Ink, [x, y]: Point, radius: number, color: string): void {
  const { context } = ink;
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fillStyle = color;
  context.fill();
  context.lineWidth = 1.5;
  context.strokeStyle = ink.halo;
  context.stroke();
}

function onScreen(lens: Lens, p: Vec3): Point | null {
  const [x, y, depth] = project(lens, p);
  return isBehind(lens, depth) || !Number.isFinite(x + y) ? null : [x, y];
}

// Draws the mouse's spring from the body to the cursor, with its force.
export function spring(ink: Ink, lens: Lens, point: Vec3, target: Vec3, force: Vec3 | null): void {
  const [from, to] = [onScreen(lens, point), onScreen(lens, target)];
  if (!from || !to) return;
  const size = Math.hypot(to[0] - from[0], to[1] - from[1]);
  const [ux, uy] = size > 0 ? [(to[0] - from[0]) / size, (to[1] - from[1]) / size] : [0, 0];
  if (size > 2) stroke(ink, [from, to], 2, ink.accent);
  if (size > 12) {
    const back = (side: number): Point => [to[0] - 10 * ux - side * 5 * uy, to[1] - 10 * uy + side * 5 * ux];
    stroke(ink, [back(1), to, back(-1)], 2, ink.accent);
  }
  dot(ink, from, 4, ink.accent);
  const newtons = force ? Math.hypot(...force) : NaN;
  if (!Number.isFinite(newtons)) return;
  const words = valueText(newtons, "N", 3);
  const fits = to[0] + ink.em + ink.context.measureText(words).width < lens.width;
  text(ink, words, to[0] + (fits ? ink.em : -ink.em), to[1] - ink.em, fits ? "left" : "right");
}

export function ring(ink: Ink, [x, y]: Point, radius: number, words: string): void {
  const { context } = ink;
  for (const [width, color] of [[3.5, ink.halo], [1.5, ink.accent]] as const) {
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    context.lineWidth = width;
    context.strokeStyle = color;
    context.stroke();
  }
  text(ink, words, x + radius + 0.4 * ink.em, y - radius);
}

// Draws vertices and edges of tets, with labels that do not overlap and end left of `right`.
export function highlights(ink: Ink, lens: Lens, marked: readonly Highlight[], right: number): void {
  const { em } = ink;
  const labels: (Box & { words: string; top: Point })[] = [];
  for (const { positions, text: words } of marked) {
    const top = outline(ink, lens, positions);
    if (!top || words === "") continue;
    const width = ink.context.measureText(words).width;
    const fits = top[0] + 0.9 * em + width < right;
    const x = Math.max(0.3 * em, fits ? top[0] + 0.6 * em : Math.min(top[0] - 0.6 * em, right - 0.3 * em) - width);
    labels.push({ words, top, x, y: top[1] - 0.8 * em, width, height: 1.4 * em });
  }
  for (const { words, top, x, y } of apart(labels, 0.7 * em, lens.height - 0.7 * em)) {
    if (Math.abs(y - top[1]) > 1.2 * em) stroke(ink, [top, [x, y]], 1, ink.accent);
    text(ink, words, x, y);
  }
}

// Draws the edges and returns the highest corner.
function outline(ink: Ink, lens: Lens, positions: Vec3[]): Point | null {
  const points = positions.map((p) => onScreen(lens, p));
  if (points.length === 0 || points.some((p) => p === null)) return null;
  const corners = points as Point[];
  corners.forEach((corner, i) => corners.slice(i + 1).forEach((other) => stroke(ink, [corner, other], 2.5, ink.accent)));
  for (const corner of corners) dot(ink, corner, 3.5, ink.accent);
  return corners.reduce((best, p) => (p[1] < best[1] ? p : best));
}

// Draws the directions of the scene's axes in the lower left corner.
export function axes(ink: Ink, lens: Lens): void {
  const size = 2.2 * ink.em;
  const [x0, y0] = [1.6 * ink.em + size, lens.height - 1.6 * ink.em - size];
  const colors = ["#d1495b", "#3f9142", "#3a6fd8"];
  const ends = [0, 1, 2].map((c) => ({ c, x: lens.right[c], y: -lens.up[c], depth: lens.forward[c] }));
  for (const { c, x, y } of ends.sort((a, b) => b.depth - a.depth)) {
    stroke(ink, [[x0, y0], [x0 + size * x, y0 + size * y]], 0.13 * ink.em, colors[c]);
    text(ink, "xyz"[c], x0 + 1.28 * size * x, y0 + 1.28 * size * y, "center");
  }
}

// Draws names of bodies beside samples of their colors in the upper left corner, as many as fit. Returns the lower right
// corner of the legend.
export function bodyLegend(ink: Ink, lens: Lens, bodies: readonly { name: string; color: string }[]): Point {
  const { em } = ink;
  const room = Math.max(1, Math.floor(lens.height / (3 * em)));
  const names = bodies.slice(0, room).map(({ name }, i) => (bodies.length > room && i === room - 1 ? `${name} and ${bodies.length - room} more` : name));
  names.forEach((name, i) => {
    const y = (1.6 + 1.5 * i) * em;
    dot(ink, [1.4 * em, y], 0.45 * em, bodies[i]!.color);
    text(ink, name, 2.3 * em, y);
  });
  const widths = names.map((name) => ink.context.measureText(name).width);
  return names.length === 0 ? [0, 0] : [2.3 * em + Math.max(...widths), (0.8 + 1.5 * names.length) * em];
}

export const kBarWidth = 8.5; // width of the strip beside the view for the color bar [em]

// Breaks a text into the fewest lines of this width.
function wrapped(ink: Ink, words: string, width: number): string[] {
  const lines: string[] = [];
  for (const word of words.split(" ")) {
    const longer = `${lines[lines.length - 1] ?? ""} ${word}`.trim();
    if (lines.length > 0 && ink.context.measureText(longer).width <= width) lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return lines;
}

// Draws text in lines that end left of the right edge.
export function paragraph(ink: Ink, lens: Lens, words: string, x: number, y: number): void {
  const lines = wrapped(ink, words, Math.max(8 * ink.em, lens.width - x - ink.em));
  lines.forEach((line, i) => text(ink, line, x, y + 1.25 * i * ink.em));
}

// Draws the colors of a field with ticks in a strip right of the view, which the body does not reach.
export function colorBar(ink: Ink, lens: Pick<Lens, "width" | "height">, field: Pick<Field, "label" | "unit">, range: ColorRange, map: MapName): void {
  const { em } = ink;
  ink.context.fillStyle = ink.halo;
  ink.context.fillRect(lens.width, 0, kBarWidth * em + 1, lens.height);
  const title = `${field.label}${field.unit && ` [${unitText(field.unit)}]`}${range.log ? ", logarithmic" : ""}`;
  const right = lens.width + (kBarWidth - 0.6) * em;
  const lines = wrapped(ink, title, (kBarWidth - 1) * em);
  lines.forEach((line, i) => text(ink, line, right, (1 + 1.25 * i) * em, "right"));
  const [left, top, width] = [right - 1.1 * em, (1.25 * lines.length + 1.2) * em, 1.1 * em];
  const height = Math.min(16 * em, lens.height - top - 1.2 * em);
  if (height < 3 * em) return;
  let values = range.log ? logTicks(range.low, range.high) : ticks(range.low, range.high, height / (2.6 * em));
  let words = range.log || values.length < 2 ? values.map((value) => short(value)) : tickTexts(values);
  // The ends, where no tick is near.
  const place = (value: number): number => top + height * (1 - fraction(range, value));
  for (const end of range.high > range.low ? [range.low, range.high] : [])
    if (values.every((value) => Math.abs(place(value) - place(end)) > 1.2 * em)) [values, words] = [[...values, end], [...words, short(end, 3)]];
  const { context } = ink;
  context.fillStyle = range.high > range.low ? gradient(context, map, [0, top + height], [0, top]) : `rgb(${colorAt(map, 0.5).join()})`;
  context.fillRect(left, top, width, height);
  context.lineWidth = 1;
  context.strokeStyle = ink.text;
  context.strokeRect(left - 0.5, top - 0.5, width + 1, height + 1);
  values.forEach((value, i) => {
    const y = place(value);
    ink.context.fillStyle = ink.text;
    ink.context.fillRect(left - 0.35 * em, y - 0.5, 0.35 * em, 1);
    text(ink, words[i], left - 0.6 * em, y, "right");
  });
}

// Colors of a map along a line.
function gradient(context: CanvasRenderingContext2D, map: MapName, from: Point, to: Point): CanvasGradient {
  const made = context.createLinearGradient(...from, ...to);
  for (let t = 0; t <= 1; t += 1 / 32) made.addColorStop(t, `rgb(${colorAt(map, t).join()})`);
  return made;
}

const kContactTitle = "contact pressure 0";

// Draws the colors of the contact points with a summary in the upper right corner, or below what is already in the upper
// corners: `taken` is its lower right corner.
export function contactLegend(ink: Ink, lens: Lens, { largest, row }: { largest: number; row: StepRow | null }, taken: Point): void {
  const { context, em } = ink;
  const right = lens.width - 1.2 * em;
  const most = valueText(largest, "Pa", 3);
  const around = context.measureText(kContactTitle).width + context.measureText(most).width + em;
  const width = Math.min(8 * em, right - 1.2 * em - around);
  const lines = row ? wrapped(ink, contactText(row), right - 1.2 * em) : [];
  const widest = Math.max(around + width, ...lines.map((line) => context.measureText(line).width));
  const top = 1.1 * em + (right - widest < taken[0] + em ? taken[1] : 0);
  lines.forEach((line, i) => text(ink, line, right, top + (2 + 1.4 * i) * em, "right"));
  const left = right - context.measureText(most).width - 0.5 * em - width;
  context.fillStyle = gradient(context, kContactMap, [left, 0], [left + width, 0]);
  context.fillRect(left, top, width, em);
  text(ink, most, right, top + em / 2, "right");
  text(ink, kContactTitle, left - 0.5 * em, top + em / 2, "right");
}

// Draws a round length below the middle of an orthographic view.
export function scaleBar(ink: Ink, lens: Lens): void {
  if (lens.extent <= 0) return;
  const scale = pixelsPerMeter(lens, 0);
  const step = roundStep(lens.width / 6 / scale);
  const [x, y, half] = [lens.width / 2, lens.height - 1.3 * ink.em, (scale * step) / 2];
  stroke(ink, [[x - half, y], [x + half, y]], 0.13 * ink.em, ink.text);
  for (const end of [x - half, x + half]) stroke(ink, [[end, y - 0.35 * ink.em], [end, y + 0.35 * ink.em]], 0.13 * ink.em, ink.text);
  text(ink, valueText(step, "m"), x, y - 1.1 * ink.em, "center");
}

export function gridNote(ink: Ink, lens: Lens, step: number): void {
  text(ink, `grid ${valueText(step, "m")}`, 1.2 * ink.em, lens.height - 0.9 * ink.em);
}
