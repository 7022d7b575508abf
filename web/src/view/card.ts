// A card with the numbers behind a clicked point: its vertex and its tet. Follows the body while it moves.
import type { Highlight } from "../page";
import type { MaybeNumber, Scene, SideName, TetReply, Vec3, VertexReply } from "../protocol";
import type { Store } from "../store";
import type { Hit } from "./picking";
import { readable, withUnit } from "./ranges";

type Row = [label: string, value: string];

const kPause = 200; // between two questions [ms]

export class Card {
  readonly element = document.createElement("section");
  marks: Highlight[] = []; // what the numbers belong to
  private readonly body = document.createElement("div");
  private chosen: { triangle: number; vertex: number } | null = null;
  private asking = false;
  private stale = false;
  private timer = 0;

  constructor(
    private readonly store: Store,
    private readonly side: SideName,
    private readonly changed: () => void,
  ) {
    const close = document.createElement("button");
    close.textContent = "×";
    close.ariaLabel = "Close";
    close.addEventListener("click", () => this.close());
    this.element.className = "view-card";
    this.element.dataset.card = "";
    this.element.ariaLabel = "Values at the point";
    this.element.hidden = true;
    this.element.append(close, this.body);
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

  // The body has moved: asks again, after a pause.
  refresh(): void {
    if (!this.chosen) return;
    this.stale = true;
    if (this.asking || this.timer !== 0) return;
    this.stale = false;
    this.timer = window.setTimeout(() => this.rest(), kPause);
    void this.ask(this.chosen);
  }

  private rest(): void {
    this.timer = 0;
    if (this.stale) this.refresh();
  }

  private async ask(chosen: { triangle: number; vertex: number }): Promise<void> {
    this.asking = true;
    const { side } = this;
    const asked = [
      this.store.source.ask<VertexReply>({ ask: "vertex", side, vertex: chosen.vertex }),
      this.store.source.ask<TetReply>({ ask: "tet", side, triangle: chosen.triangle }),
    ] as const;
    const [vertex, tet] = await Promise.allSettled(asked);
    this.asking = false;
    const scene = this.store.side(side)?.scene;
    if (chosen === this.chosen && scene) this.fill(scene, vertex, tet);
    if (this.stale && this.timer === 0) this.refresh();
  }

  private fill(scene: Scene, vertex: PromiseSettledResult<VertexReply>, tet: PromiseSettledResult<TetReply>): void {
    this.marks = [];
    const parts: HTMLElement[] = [];
    if (vertex.status === "fulfilled") {
      const { value } = vertex;
      parts.push(...section(value.vertex < 0 ? "Point of the skin" : `Vertex ${value.vertex}`, vertexRows(value, scene)));
      this.marks.push({ positions: [value.position], text: "" });
    } else parts.push(...section("Vertex", [["not told", reason(vertex.reason)]]));
    if (tet.status === "fulfilled") {
      parts.push(...section(`Tet ${tet.value.tet}`, tetRows(tet.value)));
      this.marks.push({ positions: tet.value.positions, text: "" });
    } else parts.push(...section("Tet", [["not told", reason(tet.reason)]]));
    this.body.replaceChildren(...parts);
    this.element.hidden = false;
    this.changed();
  }
}

function reason(why: unknown): string {
  return why instanceof Error ? why.message : String(why);
}

function number(value: MaybeNumber, unit = ""): string {
  return value === null ? "not finite" : withUnit(value, unit, 4);
}

function vector(values: Vec3, unit: string): string {
  const largest = Math.max(...values.map(Math.abs));
  return `${values.map((x) => readable(x, largest * 1e-4)).join("  ")} ${unit}`;
}

function matrix(rows: [Vec3, Vec3, Vec3], unit: string): string {
  const largest = Math.max(...rows.flat().map(Math.abs));
  const texts = rows.map((row) => row.map((x) => readable(x, largest * 1e-3)));
  const width = Math.max(...texts.flat().map((text) => text.length));
  return texts.map((row) => row.map((text) => text.padStart(width, "\u2007")).join("  ")).join("\n") + (unit && ` ${unit}`);
}

function vertexRows(reply: VertexReply, scene: Scene): Row[] {
  const first = reply.first_entry;
  const fields = scene.fields.filter((field) => field.name in reply.values);
  return [
    ...(reply.vertex < 0 ? [] : [["entries", `q[${first}], q[${first + 1}], q[${first + 2}]`] as Row]),
    ["position", vector(reply.position, "m")],
    ["rest", vector(reply.rest, "m")],
    ["velocity", vector(reply.velocity, "m/s")],
    ["mass", `${readable(reply.mass)} kg`],
    ["pinned", reply.pinned ? "yes" : "no"],
    ...fields.map((field): Row => [field.label, number(reply.values[field.name], field.unit)]),
  ];
}

function tetRows(reply: TetReply): Row[] {
  return [
    ["corners", reply.corners.join(", ")],
    ["F", matrix(reply.F, "")],
    ["J = det F", number(reply.J)],
    ["stretches", vector(reply.stretches, "")],
    ["Cauchy stress", matrix(reply.cauchy, "Pa")],
    ["von Mises", number(reply.von_mises, "Pa")],
    ["energy density", number(reply.energy_density, "J/m³")],
    ["energy", number(reply.energy, "J")],
    ["rest volume", `${readable(reply.volume)} m³`],
    ["quality", number(reply.quality)],
    ["E", number(reply.young, "Pa")],
    ["ν", number(reply.poisson)],
    ["density", `${readable(reply.density)} kg/m³`],
  ];
}

function section(title: string, rows: Row[]): HTMLElement[] {
  const heading = document.createElement("h3");
  heading.textContent = title;
  const table = document.createElement("table");
  for (const [label, value] of rows) {
    const row = table.insertRow();
    const head = document.createElement("th");
    head.scope = "row";
    head.textContent = label;
    row.append(head);
    row.insertCell().textContent = value;
  }
  return [heading, table];
}
