// A dial with a needle, like a spring balance. Its scale grows with the value.
import { element, svgElement } from "../dom";
import { prefixOf, short } from "../plots/numbers";
import { roundStep } from "../view/ranges";

const kFrom = -120; // angle of zero, from the top [degrees]
const kSweep = 240;
const kParts = 5; // intervals of the scale

export function angleOf(value: number, full: number): number {
  return kFrom + kSweep * Math.min(1.04, Math.max(0, full > 0 ? value / full : 0));
}

// Full scale of the dial. It shrinks only by factors of four or more, so that the needle stays calm.
export function fullScale(value: number, before: number): number {
  const wanted = value > 0 ? roundStep(1.15 * value) : before;
  return wanted > before || wanted < before / 4 ? wanted : before;
}

export class Dial {
  readonly element = element("div", { class: "dial", "aria-hidden": "true" });
  private readonly needle = svgElement("line", { x1: "0", y1: "6", x2: "0", y2: "-36", class: "dial-needle" });
  private readonly numbers: SVGElement[] = [];
  private readonly svg = svgElement("svg", { viewBox: "-50 -50 100 88" });
  private full = 0;

  constructor(private readonly unit: string) {
    const [x, y] = onCircle(40, kFrom);
    this.svg.append(svgElement("path", { d: `M${x} ${y}A40 40 0 1 1 ${-x} ${y}`, class: "dial-scale" }));
    for (let i = 0; i <= kParts; ++i) {
      const angle = kFrom + (kSweep * i) / kParts;
      const [[x1, y1], [x2, y2], [x3, y3]] = [onCircle(40, angle), onCircle(36, angle), onCircle(29, angle)];
      this.svg.append(svgElement("line", { x1: `${x1}`, y1: `${y1}`, x2: `${x2}`, y2: `${y2}`, class: "dial-tick" }));
      this.numbers.push(svgElement("text", { x: `${x3}`, y: `${y3 + 2.4}`, class: "dial-number" }));
    }
    this.svg.append(...this.numbers, this.needle, svgElement("circle", { r: "3", class: "dial-hub" }));
    this.element.append(this.svg);
    this.show(0);
  }

  show(value: number): void {
    const full = fullScale(value, this.full);
    if (full !== this.full || this.numbers[0]!.textContent === "") this.rescale(full);
    this.needle.setAttribute("transform", `rotate(${angleOf(value, this.full).toFixed(2)})`);
  }

  private rescale(full: number): void {
    this.full = full;
    const { factor, letter } = prefixOf(full || 1);
    this.numbers.forEach((number, i) => {
      const value = ((full || 1) * i) / kParts / factor;
      number.textContent = i === kParts ? `${short(value, 2)} ${letter}${this.unit}` : short(value, 2);
    });
  }
}

function onCircle(radius: number, degrees: number): [number, number] {
  const angle = (degrees * Math.PI) / 180;
  return [radius * Math.sin(angle), -radius * Math.cos(angle)];
}
