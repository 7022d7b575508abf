// Texts over the view: they neither overlap nor leave a narrow view. Labels of axes with huge ranges.
import assert from "node:assert/strict";
import { test } from "node:test";
import { powersOfTen, ranged } from "../src/plots/axes";
import type { StepRow } from "../src/protocol";
import type { Lens } from "../src/view/lens";
import { bodyLegend, contactLegend, type Ink } from "../src/view/marks";

interface Drawn {
  text: string;
  left: number;
  right: number;
  y: number;
}

const kEm = 14;

// A canvas that notes where texts are; letters have half the width of their height.
function canvas(): { ink: Ink; drawn: Drawn[] } {
  const drawn: Drawn[] = [];
  const width = (text: string): number => 0.5 * kEm * text.length;
  const context = {
    textAlign: "left",
    measureText: (text: string) => ({ width: width(text) }),
    fillText(text: string, x: number, y: number) {
      const left = this.textAlign === "right" ? x - width(text) : this.textAlign === "center" ? x - width(text) / 2 : x;
      drawn.push({ text, left, right: left + width(text), y });
    },
    createLinearGradient: () => ({ addColorStop: () => {} }),
    ...Object.fromEntries(["strokeText", "fillRect", "beginPath", "arc", "fill", "stroke"].map((name) => [name, () => {}])),
  };
  return { ink: { context: context as unknown as CanvasRenderingContext2D, em: kEm, text: "", halo: "", accent: "" }, drawn };
}

test("legends keep apart in views of any width", () => {
  const row = { contacts: 50, min_gap: 3.7e-5, min_gap_pair: "bunny and floor", max_pressure: 26300 } as StepRow;
  for (const width of [360, 390, 768, 1280]) {
    const { ink, drawn } = canvas();
    const lens = { width, height: 700 } as Lens;
    const taken = bodyLegend(ink, lens, ["first", "second"].map((name) => ({ name, color: "" })));
    contactLegend(ink, lens, { largest: 26300, row }, taken);
    for (const { text, left, right } of drawn) assert.ok(left >= 0 && right <= width, `${text} at ${left} to ${right} of ${width} px`);
    drawn.forEach((p, i) => drawn.slice(0, i).forEach((q) => assert.ok(p.right <= q.left || q.right <= p.left || Math.abs(p.y - q.y) >= kEm, `${p.text} on ${q.text} at ${width} px`)));
  }
});

test("a range up to the largest numbers is finite", () => {
  assert.deepEqual(ranged(2, 9e307, true), [1, 1e308]);
});

test("a logarithmic axis has ticks for any range", () => {
  for (const [low, high] of [[1e-5, 1e82], [1e-308, 1e308], [0.1, 10], [3e20, 2e22]] as const) {
    const ticks = powersOfTen(low, high, 8);
    assert.ok(ticks.length >= 2 && ticks.length <= 9, `${low} ${high}: ${ticks}`);
    assert.ok(ticks.every((tick) => tick >= low * (1 - 1e-9) && tick <= high * (1 + 1e-9)));
  }
});
