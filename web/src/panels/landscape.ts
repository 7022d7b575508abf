// Energy landscape of one iteration: E over the plane through its direction d, and the quadratic model beside it.
import { fieldsOf, type Page, type Panel } from "../page";
import type { IterationReply } from "../protocol";
import type { Store } from "../store";
import type { Chosen } from "../plots/chosen";
import { checkbox, oncePerFrame } from "../controls";
import { button, downloadCanvas, element } from "../dom";
import { gridOf, quadraticFrom } from "../plots/grid";
import { short } from "../numbers";
import { SurfaceView } from "../plots/surface";
import { addModelMinimum, addRejected, type SurfaceContent } from "../plots/surfaceContent";

export class LandscapePanel implements Panel {
  readonly name = "landscape";
  readonly title = "Landscape";
  readonly isTall = true; // a surface needs room
  readonly element = element("div", { class: "plot-panel", role: "group", "aria-label": "Energy landscape" });
  private readonly view = new SurfaceView();
  private readonly follow = checkbox("follow", "Follow the newest step", true, (on) => this.chosen.follow(on));
  private readonly model = checkbox("quadratic model", "Show the quadratic model of E", true, () => this.draw());
  private readonly log = checkbox("log height", "Logarithmic heights above the lowest value of E here", false, () => this.draw());
  private readonly where = element("strong");
  private readonly text = element("p", { class: "plot-note" });
  private readonly note = element("div", { class: "plot-note", role: "status" });
  private reply: IterationReply | null = null;
  private readonly refresh = oncePerFrame(() => this.element.isConnected && this.ask());
  readonly show = this.refresh;

  constructor(
    private readonly store: Store,
    page: Page,
    private readonly chosen: Chosen,
  ) {
    const bar = element(
      "div",
      { class: "plot-bar" },
      button({ text: "◀", title: "The iteration before" }, () => this.chosen.walk(-1)),
      this.where,
      button({ text: "▶", title: "The iteration after" }, () => this.chosen.walk(1)),
      this.follow.element,
      this.model.element,
      this.log.element,
      button({ text: "PNG", title: "Save the picture" }, () => this.savePng()),
      this.note,
    );
    const side = element("div", { class: "surface-side" }, element("div", { class: "surface-texts" }, this.view.legend, this.text));
    const fill = element("div", { class: "plot-fill" }, this.view.element);
    this.element.append(bar, element("div", { class: "plot-columns plot-fill" }, fill, side));
    for (const event of ["changed", "rows", "answered"] as const) this.chosen.on(event, this.refresh);
    page.keep("landscape", {
      save: () => ({ model: this.model.input.checked, log: this.log.input.checked }),
      restore: (saved) => this.restore(saved),
    });
  }

  private ask(): void {
    const { step, iteration } = this.chosen;
    this.follow.input.checked = this.chosen.following;
    const count = this.chosen.row()?.iterations.length ?? 0;
    this.where.textContent =
      count > 0 ? `step ${step}, iteration ${iteration} of 0 to ${count - 1}` : step > 0 ? `step ${step}` : "no step yet";
    const none = "This integrator does not minimize, so there is no landscape.";
    if (count === 0) return this.settle(null, this.chosen.isImplicit() ? "No iteration has been computed yet." : none);
    this.chosen.request();
    const seen = this.chosen.seen;
    if (!seen) return this.settle(null, "Computing E around the iteration ...");
    if (!seen.reply) return this.settle(null, `Not available: ${seen.why}`);
    const shown = `Shown: step ${seen.at.step}, iteration ${seen.at.iteration}; the chosen one is being computed.`;
    this.settle(seen.reply, this.chosen.isSeen() ? "" : shown);
  }

  private settle(reply: IterationReply | null, note: string): void {
    this.note.textContent = note;
    if (reply === this.reply && reply !== null) return;
    this.reply = reply;
    this.draw();
  }

  private draw(): void {
    const content = this.reply ? this.content(this.reply) : null;
    this.view.show(content);
    this.text.textContent = content ? this.explanation(this.reply!) : "";
  }

  private content(reply: IterationReply): SurfaceContent {
    const grid = gridOf(reply.slice);
    const showModel = this.model.input.checked;
    const accepted = reply.trials.find((t) => t.accepted)?.value ?? null;
    const content: SurfaceContent = {
      label: `Energy landscape of step ${reply.step}, iteration ${reply.iteration}`,
      grid,
      axes: { x: "s: along d (1 = full step)", y: "t: across", value: "E" },
      model: showModel ? reply.slice.model : null,
      path: reply.path.map((p) => ({ x: p.s, y: p.t, value: p.value })),
      blocked: reply.slice.blocked,
      draped: false,
      direction: { from: { x: 0, y: 0 }, to: { x: Math.min(1, grid.x[grid.x.length - 1]), y: 0 } },
      marks: [],
      signs: [
        { sign: "▇", color: "series3", text: "E, by color and height" },
        { sign: "╌", color: "accent", text: "direction d" },
      ],
      keep: [reply.value, accepted],
      log: this.log.input.checked,
    };
    const { marks, signs } = content;
    if (showModel) signs.push({ sign: "▇", color: "series2", text: "quadratic model" });
    addRejected(content, reply.trials.filter((t) => !t.accepted).map(({ alpha, value }) => ({ x: alpha, y: 0, value })));
    const quadratic = quadraticFrom({ ...grid, value: reply.slice.model });
    if (showModel) addModelMinimum(content, quadratic, ({ x, y }) => `s = ${short(x, 3)}, t = ${short(y, 3)}`);
    marks.push({ x: 0, y: 0, value: reply.value, shape: "ring", color: "series5", size: 13, label: "start" });
    signs.push({ sign: "○", color: "series5", text: `start: E = ${short(reply.value, 6)}` });
    if (reply.alpha > 0) {
      const lower = accepted === null ? "" : `, E lower by ${short(reply.value - accepted, 3)}`;
      marks.push({ x: reply.alpha, y: 0, value: accepted, shape: "dot", color: "good", size: 13, label: "accepted" });
      signs.push({ sign: "●", color: "good", text: `accepted: α = ${short(reply.alpha, 3)}${lower}` });
    } else signs.push({ sign: "✕", color: "series11", text: "no step was found along d" });
    signs.push({ sign: "•─", color: "text", text: "iterates, projected" });
    if (reply.slice.blocked.length > 0) signs.push({ sign: "▇", color: "bad", text: "beyond the largest step that contact allows" });
    return content;
  }

  private explanation(reply: IterationReply): string {
    const cut = this.view.cutAbove;
    const sentences = [
      "This is E over the plane x + s d + t v through the iterate x: d is the direction of the solver; v is as long, orthogonal to d, and points toward steepest descent.",
      "Newton's method steps to the minimum of the orange model. Where the model differs from the surface, the line search shortens the step.",
    ];
    if (cut !== null) sentences.push(`Walls above E = ${short(cut, 4)} are cut off.`);
    const blocked = new Set(reply.slice.blocked);
    if (reply.slice.value.some((v, i) => v === null && !blocked.has(i))) sentences.push("Holes: E is infinite there.");
    if (blocked.size > 0) sentences.push("The red region is beyond contact: no straight path from x leads there.");
    if (this.log.input.checked) sentences.push("Heights are logarithmic.");
    return sentences.join(" ");
  }

  private savePng(): void {
    const { step, iteration } = this.chosen;
    const { name } = this.store;
    const picture = this.view.picture(`${name}: energy landscape of step ${step}, iteration ${iteration}`);
    if (picture) void downloadCanvas(`${name}_landscape_${step}_${iteration}`, picture);
  }

  private restore(saved: unknown): void {
    const kept = fieldsOf(saved);
    this.model.input.checked = kept.model !== false;
    this.log.input.checked = kept.log === true;
    this.draw();
  }
}
