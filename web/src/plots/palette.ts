// Colors of the page, read from the style sheet.
const kNames = {
  text: "--text",
  faint: "--faint",
  line: "--line",
  panel: "--panel",
  raised: "--raised",
  accent: "--accent",
  good: "--good",
  bad: "--bad",
  series1: "--series-1",
  series2: "--series-2",
  series3: "--series-3",
  series4: "--series-4",
  series5: "--series-5",
  series6: "--series-6",
  series7: "--series-7",
  series8: "--series-8",
  series9: "--series-9",
  series10: "--series-10",
  series11: "--series-11",
  series12: "--series-12",
  series13: "--series-13",
  series14: "--series-14",
} as const;

type Name = keyof typeof kNames;
export type Color = Name | `hsl(${string}`; // name in the style sheet, or a computed color

// Unlimited sequence of colors with distant hues.
export function furtherColor(i: number): Color {
  return `hsl(${((137.508 * i) % 360).toFixed(1)} ${i % 2 === 0 ? 60 : 35}% 50%)`;
}

// Color as a canvas expects it.
export function inkOf(colors: Palette, color: Color): string {
  return color in kNames ? colors[color as Name] : color;
}

// Color as a style sheet expects it.
export function cssOf(color: Color): string {
  return color in kNames ? `var(${kNames[color as Name]})` : color;
}

export interface Palette extends Record<Name, string> {
  font: string; // in the syntax of a canvas
  fontSize: number; // [CSS px]
}

export function sameLook(a: Palette | null, b: Palette): boolean {
  return a !== null && Object.entries(b).every(([name, value]) => a[name as keyof Palette] === value);
}

export function palette(of: HTMLElement): Palette {
  const style = getComputedStyle(of);
  const colors = Object.fromEntries(
    Object.entries(kNames).map(([name, variable]) => [name, style.getPropertyValue(variable).trim() || "#888888"]),
  ) as Record<Name, string>;
  const fontSize = Number.parseFloat(style.fontSize) || 14;
  return { ...colors, fontSize, font: `${fontSize * 0.86}px ${style.fontFamily || "sans-serif"}` };
}
