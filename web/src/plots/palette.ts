// The page's colours, as the style sheet has them now.
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
} as const;

export type Colour = keyof typeof kNames;

export interface Palette extends Record<Colour, string> {
  font: string; // of a canvas
  fontSize: number; // [CSS px]
}

export function sameLook(a: Palette | null, b: Palette): boolean {
  return a !== null && Object.entries(b).every(([name, value]) => a[name as keyof Palette] === value);
}

export function palette(of: HTMLElement): Palette {
  const style = getComputedStyle(of);
  const colours = Object.fromEntries(
    Object.entries(kNames).map(([name, variable]) => [name, style.getPropertyValue(variable).trim() || "#888888"]),
  ) as Record<Colour, string>;
  const fontSize = Number.parseFloat(style.fontSize) || 14;
  return { ...colours, fontSize, font: `${fontSize * 0.86}px ${style.fontFamily || "sans-serif"}` };
}
