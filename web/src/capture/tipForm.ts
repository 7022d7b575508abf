// Shape and depth of the tip, set by slider, number or keys.
import { button, element } from "../dom";
import type { Page } from "../page";
import { choice, numberField } from "../controls";
import { short } from "../plots/numbers";
import type { ProbeState, TipChoice } from "../protocol";
import type { Store } from "../store";
import { kChoices, type Display } from "../view/display";
import { AskedDepths } from "./askedDepths";

const kNotches = 40; // steps of the slider and the keys per tip radius
const kDeepest = 1.5; // end of the slider, in tip radii

const valuesFirst = (choices: Record<string, string>) => Object.entries(choices).map(([label, value]) => [value, label] as const);

export class TipForm {
  readonly element = element("section", { class: "capture-tip", "aria-label": "Tip" });
  private readonly slider = element("input", { type: "range", min: "0", max: "1", step: "any", "aria-label": "Depth, slider" });
  private readonly depth = numberField("Depth [m]", "Indentation since first contact", 0, {}, (value) => this.press(value));
  private readonly radius: ReturnType<typeof numberField>;
  private readonly lift = button({ text: "Lift", title: "Remove the tip", steers: true }, () => this.store.source.send({ do: "lift" }));
  private probe: ProbeState | null = null;
  private readonly asked = new AskedDepths();

  constructor(
    private readonly store: Store,
    page: Page,
    private readonly display: Display,
  ) {
    const { settings } = display;
    const changeShape = (value: string): void => display.change({ tipShape: value as TipChoice["shape"] });
    const shape = choice("Tip", "Shape of the tip", valuesFirst(kChoices.tipShape), settings.tipShape, changeShape);
    const contact = choice(
      "Contact",
      "Bonded: the tip sticks to the surface and can also pull. Sliding: it pushes without friction.",
      valuesFirst(kChoices.tipContact),
      settings.tipContact,
      (value) => display.change({ tipContact: value as TipChoice["contact"] }),
    );
    const changeRadius = (tipRadius: number): void => display.change({ tipRadius });
    this.radius = numberField("Radius [m]", "Radius of the next tip; 0: chosen by the program", settings.tipRadius, { min: 0 }, changeRadius);
    display.on("changed", () => {
      shape.select.value = settings.tipShape;
      contact.select.value = settings.tipContact;
      this.radius.show(short(settings.tipRadius));
    });
    this.slider.addEventListener("input", () => this.probe && this.press(this.slider.valueAsNumber * kDeepest * this.probe.radius));
    this.element.append(
      element("h3", {}, "1  Touch and press"),
      element("div", { class: "capture-row" }, shape.element, contact.element, this.radius.element),
      element("div", { class: "capture-row capture-depth" }, this.depth.element, this.slider, this.lift),
    );
    page.shortcut({ key: "j", does: "Push the indenter deeper", group: "Capture", run: () => this.notch(1) });
    page.shortcut({ key: "u", does: "Pull the indenter back", group: "Capture", run: () => this.notch(-1) });
    this.show(null);
  }

  show(probe: ProbeState | null): void {
    this.probe = probe;
    this.asked.hear(probe?.wanted ?? null);
    this.slider.disabled = this.depth.input.disabled = probe === null || !this.store.steers;
    this.lift.disabled = probe === null || !this.store.steers;
    if (!probe) return;
    if (!this.slider.matches(":active")) this.slider.value = String(probe.wanted / (kDeepest * probe.radius));
    this.depth.show(String(Number(probe.wanted.toPrecision(3))));
    if (this.display.settings.tipRadius === 0) this.radius.input.placeholder = short(probe.radius);
  }

  private notch(by: number): void {
    if (this.probe) this.press(this.asked.last(this.probe.wanted) + (by * this.probe.radius) / kNotches);
  }

  private press(depth: number): void {
    if (!this.probe) return;
    this.asked.ask(depth, this.probe.wanted);
    this.store.source.send({ do: "press", depth });
    if (!this.store.state?.playing) this.store.source.send({ do: "play" });
  }
}
