// Notifies the source once for each drawn picture. A hidden page draws nothing and delays the notification.
import type { Source } from "../source";

const kHiddenPause = 500; // [ms]

export class Pace {
  private waiting = 0; // received pictures that are not drawn yet
  private timer = 0;

  constructor(
    private readonly source: Source,
    private readonly redraw: () => void,
  ) {}

  came(): void {
    this.waiting += 1;
    this.go();
  }

  // Also called when the page becomes hidden or visible: hidden pages have no frames.
  go(): void {
    if (!document.hidden) this.redraw();
    else if (this.waiting > 0 && this.timer === 0) this.timer = window.setTimeout(() => this.drawn(), kHiddenPause);
  }

  drawn(): void {
    clearTimeout(this.timer);
    this.timer = 0;
    const count = this.waiting;
    this.waiting = 0;
    for (let i = 0; i < count; ++i) this.source.ready();
  }
}
