// Card with the values at a clicked point: its vertex and its tet. It follows the moving body.
import { button, element, messageOf } from "../dom";
import type { Highlight } from "../page";
import type { Scene, SideName, TetReply, Vec3, VertexReply } from "../protocol";
import type { Store } from "../store";
import { bodyOfTet } from "./bodies";
import { isFinite3 } from "./lens";
import type { Hit } from "./picking";
import { matrixText, valueText, vectorText } from "./values";

type Row = [label: string, value: string];

const kPause = 200; // pause between two questions [ms]

export class Card {
  readonly element = element("section", { class: "view-card", "data-card": true, "aria-label": "Values at the point" });
  marks: Highlight[] = []; // the vertex and the tet that the values belong to
  private readonly vertex = new Section(true);
  private readonly fields = new Section(false);
  private readonly tet = new Section(true);
  private chosen: { triangle: number; vertex: number } | null = null;
  private asking = false;
  private stale = false;
  private timer = 0;

  constructor(
    private readonly store: Store,
    private readonly side: SideName,
    private readonly changed: () => void,
  ) {
    const close = button({ text: "×", label: "Close" }, () => this.close());
    this.element.hidden = true;
    this.element.append(close, this.vertex.element, this.fields.element, this.tet.element);
  }

  open(hit: Hit, vertex: number): void {
    this.chosen = { triangle: hit.triangle, vertex };
    this.refresh();
  }

  close(): void {
    this.chosen = null;
    this.marks = [];
    this.element.hidden = true;
    clearTimeout(this.timer);
    this.timer = 0;
    this.changed();
  }

  // Repeats the request after a pause, because the body has moved.
  refresh(): void {
    if (!this.chosen) return;
    this.stale = true;
    if (this.asking || this.timer !== 0) return;
    this.stale = false;
    this.timer = window.setTimeout(() => {
      this.timer = 0;
      if (this.stale) this.refresh();
    }, kPause);
    void this.ask(this.chosen);
  }

  private async ask(chosen: { triangle: number; vertex: number }): Promise<void> {
    this.asking = true;
    const { side } = this;
    const { source } = this.store;
    const [vertex, tet] = await Promise.allSettled([
      source.ask<VertexReply>({ ask: "vertex", side, vertex: chosen.vertex }),
      source.ask<TetReply>({ ask: "tet", side, triangle: chosen.triangle }),
    ]);
    this.asking = false;
    const scene = this.store.side(side)?.scene;
    if (chosen === this.chosen && scene) this.fill(scene, vertex, tet);
    if (this.stale && this.timer === 0) this.refresh();
  }

  private fill(scene: Scene, vertex: PromiseSettledResult<VertexReply>, tet: PromiseSettledResult<TetReply>): void {
    this.marks = [];
    if (vertex.status === "fulfilled") {
      const { value } = vertex;
      this.vertex.show(value.vertex < 0 ? "Point of the skin" : `Vertex ${value.vertex}`, vertexRows(value));
      this.fields.show("Fields there", fieldRows(value, scene));
      this.mark([value.position]);
    } else {
      this.vertex.show("Vertex", [["no answer", messageOf(vertex.reason)]]);
      this.fields.show("Fields there", []);
    }
    if (tet.status === "fulfilled") {
      const body = scene.bodies.length > 1 ? ` of ${scene.bodies[bodyOfTet(tet.value.tet, scene.body_tets)]}` : "";
      this.tet.show(`Tet ${tet.value.tet}${body}`, tetRows(tet.value));
      this.mark(tet.value.positions);
    } else this.tet.show("Tet", [["no answer", messageOf(tet.reason)]]);
    this.element.hidden = false;
    this.changed();
  }

  private mark(positions: Vec3[]): void {
    if (positions.every(isFinite3)) this.marks.push({ positions, text: "" });
  }
}

// Rows under a title that folds them. The elements persist when values change, so that the reader can press them.
class Section {
  private readonly title = element("summary");
  private readonly table = element("table");
  readonly element = element("details", {}, this.title, this.table);

  constructor(open: boolean) {
    this.element.open = open;
  }

  show(title: string, rows: Row[]): void {
    this.title.textContent = title;
    const cells = ([label, value]: Row): HTMLElement[] => [element("th", { scope: "row" }, label), element("td", {}, value)];
    this.table.replaceChildren(...rows.map((row) => element("tr", {}, ...cells(row))));
  }
}

function vertexRows(reply: VertexReply): Row[] {
  const first = reply.first_entry;
  if (reply.mass === undefined) return [["position", vectorText(reply.position, "m")]];
  return [
    ...(reply.vertex < 0 ? [] : [["entries", `q[${first}], q[${first + 1}], q[${first + 2}]`] as Row]),
    ["position", vectorText(reply.position, "m")],
    ["rest", vectorText(reply.rest, "m")],
    ["velocity", vectorText(reply.velocity, "m/s")],
    ["mass", valueText(reply.mass, "kg")],
    ["pinned", reply.pinned ? "yes" : "no"],
  ];
}

function fieldRows(reply: VertexReply, scene: Scene): Row[] {
  const fields = scene.fields.filter((field) => field.name in reply.values);
  return fields.map((field) => [field.label, valueText(reply.values[field.name], field.unit)]);
}

function tetRows(reply: TetReply): Row[] {
  return [
    ["corners", reply.corners.join(", ")],
    ["F", matrixText(reply.F, "")],
    ["J = det F", valueText(reply.J, "")],
    ["stretches", vectorText(reply.stretches, "")],
    ["Cauchy stress", matrixText(reply.cauchy, "Pa")],
    ["von Mises", valueText(reply.von_mises, "Pa")],
    ["energy density", valueText(reply.energy_density, "J/m^3")],
    ["energy", valueText(reply.energy, "J")],
    ["rest volume", valueText(reply.volume, "m^3")],
    ["quality", valueText(reply.quality, "")],
    ["E", valueText(reply.young, "Pa")],
    ["ν", valueText(reply.poisson, "")],
    ["density", valueText(reply.density, "kg/m^3")],
  ];
}
