// A table of any length: only visible rows are elements.
import { oncePerFrame } from "../controls";
import { element } from "../dom";

export interface RowColumn {
  title: string;
  meaning: string;
  class?: string;
  text: (row: number) => string;
}

export interface RowsOptions {
  label: string;
  columns: RowColumn[];
  rowClass: (row: number) => string;
  choose: (row: number) => void;
}

export class Rows {
  readonly element = element("div", { class: "rows", tabindex: "0", role: "grid" });
  private readonly body = element("tbody");
  private readonly redraw = oncePerFrame(() => this.draw());
  private count = 0;
  private chosen = -1;
  private drawn = "";

  constructor(private readonly options: RowsOptions) {
    this.element.setAttribute("aria-label", `${options.label}; the arrow keys choose a row`);
    const titles = options.columns.map((c) => element("th", { title: c.meaning, class: c.class }, c.title));
    this.element.append(element("table", {}, element("thead", {}, element("tr", {}, ...titles)), this.body));
    this.element.addEventListener("scroll", this.redraw);
    this.element.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(this.redraw).observe(this.element);
  }

  // Scrolls the chosen row into view.
  show(count: number, chosen: number): void {
    const moved = chosen !== this.chosen || count !== this.count;
    this.count = count;
    this.chosen = chosen;
    this.drawn = "";
    if (moved && chosen >= 0) this.reveal();
    this.redraw();
  }

  private rowHeight(): number {
    return 1.6 * (Number.parseFloat(getComputedStyle(this.element).fontSize) || 12);
  }

  private reveal(): void {
    const height = this.rowHeight();
    const top = this.chosen * height;
    const room = this.element.clientHeight - 2 * height;
    if (top < this.element.scrollTop || top > this.element.scrollTop + room) {
      this.body.replaceChildren(this.gap(this.count * height)); // makes room to scroll
      this.element.scrollTop = Math.max(0, top - room / 2);
    }
  }

  private draw(): void {
    const height = this.rowHeight();
    const first = Math.max(0, Math.floor(this.element.scrollTop / height) - 4);
    const last = Math.min(this.count, first + Math.ceil(this.element.clientHeight / height) + 8);
    const state = [first, last, this.count, this.chosen, height].join();
    if (state === this.drawn) return;
    this.drawn = state;
    const rows = [];
    for (let row = first; row < last; ++row) rows.push(this.row(row));
    this.body.replaceChildren(this.gap(first * height), ...rows, this.gap((this.count - last) * height));
    this.element.setAttribute("aria-rowcount", String(this.count));
  }

  private gap(height: number): HTMLTableRowElement {
    const cell = element("td", { colspan: String(this.options.columns.length), style: `height:${height}px;padding:0` });
    const row = element("tr", { "aria-hidden": "true" }, cell);
    row.hidden = height <= 0;
    return row;
  }

  private row(index: number): HTMLTableRowElement {
    const cells = this.options.columns.map((column) =>
      element("td", { class: column.class, role: "gridcell" }, column.text(index)),
    );
    const attributes = { "aria-selected": String(index === this.chosen), class: this.options.rowClass(index) };
    const made = element("tr", attributes, ...cells);
    made.addEventListener("click", () => this.options.choose(index));
    return made;
  }

  private key(event: KeyboardEvent): void {
    const page = Math.max(1, Math.floor(this.element.clientHeight / this.rowHeight()) - 2);
    const moves: Record<string, number> = {
      ArrowUp: this.chosen - 1,
      ArrowDown: this.chosen + 1,
      PageUp: this.chosen - page,
      PageDown: this.chosen + page,
      Home: 0,
      End: this.count - 1,
    };
    const to = moves[event.key];
    if (to === undefined || this.count === 0) return;
    event.preventDefault();
    event.stopPropagation();
    this.options.choose(Math.max(0, Math.min(this.count - 1, to)));
  }
}
