// What the signs in a picture of a surface mean.
import { element } from "./dom";
import type { Colour } from "./palette";

export interface Sign {
  sign: string;
  colour: Colour;
  text: string;
}

export function legendOf(signs: readonly Sign[]): HTMLDListElement {
  const list = element("dl", { class: "surface-legend" });
  for (const { sign, colour, text } of signs) {
    const term = element("dt", {}, sign);
    term.style.color = `var(--${colour.replace(/(\d)/, "-$1")})`;
    list.append(term, element("dd", {}, text));
  }
  return list;
}

export function legendLines(signs: readonly Sign[]): string[] {
  return [signs.map(({ sign, text }) => `${sign} ${text}`).join("   ")];
}
