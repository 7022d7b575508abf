// Colors of the page, read from the style sheet.
const kPlain = ["background", "text", "faint", "line", "panel", "raised", "accent", "good", "bad"] as const;
const kSeries = [1, 2, 3, 4, 5, 7, 8, 9, 10, 11, 12] as const;
const kNames = [...kPlain, ...kSeries.map((i) => `series${i}` as const)];

type Name = (typeof kNames)[number];
export type Color = Name | `hsl(${string}`; // name in the style sheet, or a computed color

// Unlimited sequence of colors with distant hues.
export function furtherColor(i: number): Color {
  return `hsl(${((137.508 * i) % 360).toFixed(1)} ${i % 2 === 0 ? 60 : 35}% 50%)`;
}

function isName(color: Color): color is Name {
  return (kNames as string[]).includes(color);
}

function variableOf(name: Name): string {
  return `--${name.replace(/(\d+)/, "-$1")}`;
}

// Gives the variables the type of a color, so that their computed values are not light-dark() but one of its colors.
export function registerColors(): void {
  const type = { syntax: "<color>", inherits: true, initialValue: "#888888" };
  for (const name of kNames) CSS.registerProperty({ name: variableOf(name), ...type });
}

// Color as a canvas expects it.
export function inkOf(colors: Palette, color: Color): string {
  return isName(color) ? colors[color] : color;
}

// Color as a style sheet expects it.
export function cssOf(color: Color): string {
  return isName(color) ? `var(${variableOf(color)})` : color;
}

export interface Palette extends Record<Name, string> {
  font: string; // in the syntax of a canvas
  fontSize: number; // [CSS px]
}

export function samePalette(a: Palette | null, b: Palette): boolean {
  return a !== null && Object.entries(b).every(([name, value]) => a[name as keyof Palette] === value);
}

export function palette(of: HTMLElement): Palette {
  const style = getComputedStyle(of);
  const values = kNames.map((name) => [name, style.getPropertyValue(variableOf(name))]);
  const colors = Object.fromEntries(values) as Record<Name, string>;
  const fontSize = Number.parseFloat(style.fontSize) || 14;
  const size = Math.round(fontSize * 0.86); // uPlot scales whole numbers only
  return { ...colors, fontSize, font: `${size}px ${style.fontFamily || "sans-serif"}` };
}
