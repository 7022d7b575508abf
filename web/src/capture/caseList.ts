// The recorded load cases and the controls that record more.
import { button, element } from "../dom";
import type { Page } from "../page";
import { numberField } from "../controls";
import { plural, withUnit } from "../plots/numbers";
import type { Capture, Command, ProbeState } from "../protocol";
import type { Store } from "../store";
import type { Display } from "../view/display";

const kDepths = 3; // load cases per site
const kDeep = 0.6; // deepest indentation of a series, in tip radii

export class CaseList {
  readonly element = element("section", { class: "capture-cases", "aria-label": "Recorded cases" });
  private readonly record = this.make("Record this pose", "Record force and markers of this pose, with measurement noise (Y)", () => ({ do: "record" }));
  private readonly recordDepths = this.make(`${kDepths} depths here`, "Three load cases at equal steps of depth", () => ({ do: "record", depths: kDepths }));
  private readonly sites = numberField("places", "Number of pokes, as far apart as possible", 12, { min: 1, max: 200, step: 1 }, () => {});
  private readonly all = this.make("Poke all over", "Poke and record automatically, at sites as far apart as possible", () => this.pokeAll());
  private readonly noise = numberField("noise [%]", "Standard deviation of positions and forces, relative to the largest motion and the force", 1, { min: 0, max: 100 }, (value) =>
    this.send({ do: "bench", noise: value / 100 }),
  );
  private readonly seed = numberField("seed", "Equal numbers give equal noise", 1, { min: 0, step: 1 }, (seed) => this.send({ do: "bench", seed }));
  private readonly list = element("ol", { class: "capture-list", "aria-label": "Cases" });
  private readonly count = element("span", { class: "faint", role: "status" });
  private readonly clear = this.make("Forget all", "Delete all recorded cases", () => ({ do: "forget" }));
  private readonly save = button({ text: "Save data set…", title: "Save a folder for aspic fit on the program's machine", steers: true }, () => this.saveAs());
  private reported = "";

  constructor(
    private readonly store: Store,
    private readonly page: Page,
    private readonly display: Display,
  ) {
    page.shortcut({ key: "y", does: "Record the pose of the tip", group: "Simulation", run: () => this.record.disabled || this.record.click() });
    this.element.append(
      element("h3", {}, "2  Record"),
      element("div", { class: "capture-row" }, this.record, this.recordDepths),
      element("div", { class: "capture-row" }, this.all, this.sites.element),
      element("div", { class: "capture-row" }, this.noise.element, this.seed.element),
      this.list,
      element("div", { class: "capture-row" }, this.count, this.clear, this.save),
    );
    this.show(null);
    this.follow(null);
  }

  // Enables the controls that the tip's state allows.
  follow(probe: ProbeState | null): void {
    const ready = probe !== null && probe.wanted !== 0 && this.store.steers;
    this.record.disabled = this.recordDepths.disabled = !ready;
  }

  show(capture: Capture | null): void {
    const cases = capture?.cases ?? [];
    this.count.textContent = cases.length === 0 ? "Nothing recorded yet." : `${plural(cases.length, "case")} recorded`;
    this.clear.disabled = this.save.disabled = cases.length === 0 || !this.store.steers;
    if (capture) this.noise.show(String(Number((100 * capture.noise).toPrecision(3))));
    if (capture) this.seed.show(String(capture.seed));
    const reported = JSON.stringify(cases);
    if (reported === this.reported) return;
    this.reported = reported;
    const items = cases.map(({ name, depth, push }, i) => {
      const forget = button({ icon: "close", label: `Forget ${name}`, steers: true }, () => this.send({ do: "forget", case: i }));
      const words = [element("span", {}, name), element("span", { class: "faint" }, withUnit(depth, "m", 2)), element("span", {}, withUnit(push, "N", 3))];
      return element("li", {}, ...words, forget);
    });
    this.list.replaceChildren(...items);
    this.list.scrollTop = this.list.scrollHeight;
  }

  private pokeAll(): Command {
    const { tipShape: shape, tipContact: contact, tipRadius } = this.display.settings;
    const radius = tipRadius > 0 ? tipRadius : (this.store.capture?.radius ?? 0);
    return { do: "poke_all", sites: this.sites.input.valueAsNumber || 12, depths: 2, depth: kDeep * radius, shape, contact, radius };
  }

  private saveAs(): void {
    const folder = prompt("Folder of the data set, on the program's machine", `${this.store.name}_capture`);
    const saved = (): void => this.page.notice(`Saved. Fit it with: aspic fit ${folder}`);
    if (folder) this.store.source.request({ do: "save_capture", folder }).then(saved, this.page.report);
  }

  private make(text: string, title: string, command: () => Command): HTMLButtonElement {
    return button({ text, title, steers: true }, () => void this.send(command()));
  }

  private send(command: Command): Promise<unknown> {
    return this.store.source.request(command).catch(this.page.report);
  }
}
