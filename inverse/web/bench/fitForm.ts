// The fit of the kept readings: aspic fit runs beside the program, and its report opens in a page of its own.
import { button, element } from "../../../web/src/dom";
import type { Page } from "../../../web/src/page";
import type { Store } from "../../../web/src/store";
import type { Bench, FitState } from "./protocol";

const kPeriod = 500; // between two questions about a running fit [ms]

export class FitForm {
  readonly element = element("section", { "aria-label": "Fit" });
  private readonly start = button({ text: "Fit the stiffness", title: "Write the readings as a data set and run aspic fit on it", steers: true }, () => this.send("fit"));
  private readonly stop = button({ text: "Stop", title: "Stop the fit; the present material becomes its result", steers: true }, () => this.send("stop_fit"));
  private readonly open = button({ text: "Open the report", title: "Open the report of the fit in a new page" }, () => void this.openReport());
  private readonly status = element("p", { class: "bench-status", role: "status" });
  private readonly folder = element("p", { class: "faint" });
  private fit: FitState | null = null;
  private readings = 0;
  private isPolling = false;

  constructor(
    private readonly store: Store,
    private readonly page: Page,
  ) {
    const row = element("div", { class: "bench-row" }, this.start, this.stop, this.open);
    this.element.append(element("h3", {}, "Fit"), row, this.status, this.folder);
    store.on("role", () => this.show());
    this.show();
  }

  // Follows a change of the bench, such as the start of a fit.
  follow(bench: Bench): void {
    this.readings = bench.readings.length;
    this.show();
    if (this.readings > 0 && !this.isPolling) void this.poll(); // a page that only watches sends nothing
  }

  private async poll(): Promise<void> {
    this.isPolling = true;
    try {
      do {
        this.fit = (await this.store.source.ask({ ask: "fit_state" })) as FitState | null;
        this.show();
        if (this.fit?.running) await new Promise((resolve) => setTimeout(resolve, kPeriod));
      } while (this.fit?.running);
    } catch {
      // The connection is lost; the next message of the bench polls again.
    }
    this.isPolling = false;
  }

  private show(): void {
    const { fit } = this;
    this.start.disabled = !this.store.steers || this.readings === 0 || fit?.running === true;
    this.stop.disabled = !this.store.steers || fit?.running !== true;
    this.open.hidden = fit?.has_report !== true;
    this.status.textContent = fit?.line ?? "Keep readings at several places, then fit Young's modulus of every tet.";
    this.folder.textContent = fit ? `Data set and results: ${fit.folder}` : "";
  }

  private async openReport(): Promise<void> {
    const { base64 } = (await this.store.source.ask({ ask: "fit_report" })) as { base64: string };
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    window.open(URL.createObjectURL(new Blob([bytes], { type: "text/html" })));
  }

  private send(command: "fit" | "stop_fit"): void {
    void this.store.source.request({ do: command }).catch(this.page.report);
  }
}
