// The iteration that the microscope and the landscape show: the newest, or the reader's choice.
import { Newest } from "../newest";
import type { ChosenIteration, Page } from "../page";
import type { IterationReply, IterationRow, SideName, StepRow } from "../protocol";
import { Refusal } from "../source";
import type { Store } from "../store";
import { kUnknownStep } from "../stepFields";
import { messageOf } from "../dom";
import { Emitter } from "../emitter";

const kFollowEvery = 500; // [ms]
const kRest = 4; // after each answer the program continues this many times the answer's duration before the next question
const kRemembered = 12;

interface Events {
  changed: void; // another iteration was chosen
  rows: void; // the list of steps has changed
  answered: void; // the program has answered about an iteration
}

export interface Seen {
  at: ChosenIteration;
  reply: IterationReply | null;
  why: string; // reason for a missing reply
}

function keyOf({ side, step, iteration }: ChosenIteration): string {
  return `${side} ${step} ${iteration}`;
}

export class Chosen extends Emitter<Events> {
  side: SideName = "a";
  step = 0; // 0: no step yet
  iteration = 0;
  following = true;
  private timer: ReturnType<typeof setTimeout> | null = null;
  seen: Seen | null = null; // newest answer
  private asked = "";
  private restsUntil = 0; // performance.now() of the next allowed question [ms]
  private underWay: StepRow | null = null;
  private withUnderWay: StepRow[] = [];
  private readonly replies = new Map<string, IterationReply>();
  private readonly questions = new Newest((at: ChosenIteration) => this.ask(at));

  constructor(
    private readonly store: Store,
    private readonly page: Page,
  ) {
    super();
    store.on("steps", ({ side, from }) => {
      this.forget(side, from);
      this.newRows();
    });
    store.on("scene", () => {
      this.replies.clear();
      this.asked = "";
      this.newRows();
    });
    store.on("gone", () => this.side === "b" && this.choose("a", this.newest("a")?.step ?? 0, 0));
    store.on("state", () => this.newRows());
    page.on("chosen", (at) => {
      if (keyOf(at) === keyOf(this)) return;
      this.following = false;
      this.set(at.side, at.step, at.iteration);
    });
    this.followNow();
  }

  row(): StepRow | null {
    return this.rowOf(this.step);
  }

  // Steps of the side, and the known part of the step under way.
  rows(): readonly StepRow[] {
    const steps = this.store.side(this.side)?.steps ?? [];
    const state = this.store.state?.[this.side];
    if (!state || state.iteration < 0 || !state.iterations?.length) return steps;
    const known = this.underWay;
    if (
      known?.iterations !== state.iterations ||
      known.step !== state.step + 1 ||
      this.withUnderWay.length !== steps.length + 1
    ) {
      this.underWay = unfinished(state.step + 1, state.time, state.iterations);
      this.withUnderWay = [...steps, this.underWay];
    }
    return this.withUnderWay;
  }

  // Whether the integrator of the side minimizes.
  isImplicit(): boolean {
    return this.store.side(this.side)?.scene.implicit ?? true;
  }

  isUnderWay(): boolean {
    return this.row() !== null && this.row() === this.underWay;
  }

  iterationRow(): IterationRow | null {
    return this.row()?.iterations[this.iteration] ?? null;
  }

  // Chooses an iteration for the reader; it remains chosen.
  choose(side: SideName, step: number, iteration: number): void {
    this.following = false;
    this.announce(side, step, iteration);
  }

  // Chooses the same step of the other side, or its newest.
  chooseSide(side: SideName): void {
    const same = this.store.side(side)?.steps.find((s) => s.step === this.step);
    this.announce(side, ((!this.following && same) || this.newest(side))?.step ?? 0, 0);
  }

  // Moves to the previous or next iteration, across steps.
  walk(by: 1 | -1): void {
    const row = this.row();
    if (!row) return;
    const next = this.iteration + by;
    if (next >= 0 && next < row.iterations.length) return this.choose(this.side, this.step, next);
    const neighbor = this.rowOf(this.step + by);
    if (neighbor) this.choose(this.side, neighbor.step, by > 0 ? 0 : Math.max(0, neighbor.iterations.length - 1));
  }

  follow(on: boolean): void {
    this.following = on;
    if (on) this.followNow();
    this.emit("changed", undefined);
  }

  // Requests the chosen iteration from the program once and emits `answered` with the answer. While steps arrive fast the
  // answer may be about an earlier choice: the program interrupts its steps for each question.
  request(): void {
    const at = { side: this.side, step: this.step, iteration: this.iteration };
    const key = keyOf(at);
    if (key === this.asked || !this.iterationRow() || this.isResting()) return;
    this.asked = key;
    const known = this.replies.get(key);
    if (known) this.take({ at, reply: known, why: "" });
    else this.questions.push(at);
  }

  // Whether `seen` belongs to the chosen iteration.
  isSeen(): boolean {
    return this.seen !== null && keyOf(this.seen.at) === keyOf(this);
  }

  private isResting(): boolean {
    const flies = this.following && this.store.state?.playing === true;
    return flies && (this.questions.busy || performance.now() < this.restsUntil);
  }

  private async ask(at: ChosenIteration): Promise<void> {
    const begun = performance.now();
    try {
      const reply = await this.store.source.ask<IterationReply>({ ask: "iteration", ...at });
      this.replies.set(keyOf(at), reply);
      const [oldest] = this.replies.keys();
      if (this.replies.size > kRemembered) this.replies.delete(oldest);
      this.take({ at, reply, why: "" });
    } catch (reason) {
      // A question that was interrupted is repeated after the next report of the program.
      const isInterrupted = reason instanceof Refusal && reason.isInterrupted;
      if (!isInterrupted) this.take({ at, reply: null, why: messageOf(reason) });
      else if (this.asked === keyOf(at)) this.asked = "";
    }
    const now = performance.now();
    this.restsUntil = now + kRest * (now - begun);
  }

  private take(seen: Seen): void {
    this.seen = seen;
    this.emit("answered", undefined);
  }

  private rowOf(step: number): StepRow | null {
    const steps = this.rows();
    const guess = steps[step - (steps[0]?.step ?? 1)];
    return guess?.step === step ? guess : (steps.find((row) => row.step === step) ?? null);
  }

  private newest(side: SideName): StepRow | null {
    const steps = side === this.side ? this.rows() : (this.store.side(side)?.steps ?? []);
    return steps[steps.length - 1] ?? null;
  }

  // Discards the steps after a rewind.
  private forget(side: SideName, from: number): void {
    const isVoid = (key: string): boolean => key.split(" ")[0] === side && Number(key.split(" ")[1]) > from;
    for (const key of this.replies.keys()) if (isVoid(key)) this.replies.delete(key);
    if (isVoid(this.asked)) this.asked = "";
  }

  private newRows(): void {
    this.emit("rows", undefined);
    const steppedByHand = (this.store.state?.[this.side]?.iteration ?? -1) >= 0;
    if (!this.row() || (this.following && steppedByHand)) return this.followNow();
    if (this.following && this.timer === null) {
      this.timer = setTimeout(() => {
        this.timer = null;
        if (this.following) this.followNow();
      }, kFollowEvery);
    }
  }

  private followNow(): void {
    const row = this.newest(this.side);
    if (!row) return this.set(this.side, 0, 0);
    const underWay = this.store.state?.[this.side]?.iteration ?? -1;
    const last = Math.max(0, row.iterations.length - 1);
    this.announce(this.side, row.step, underWay >= 0 ? last : Math.min(this.iteration, last));
  }

  private set(side: SideName, step: number, iteration: number): void {
    [this.side, this.step, this.iteration] = [side, step, iteration];
    this.emit("changed", undefined);
  }

  private announce(side: SideName, step: number, iteration: number): void {
    const before = keyOf(this);
    this.set(side, step, iteration);
    if (step > 0 && keyOf(this) !== before) this.page.emit("chosen", { side, step, iteration });
  }
}

// Row of a step that is under way.
function unfinished(step: number, time: number, iterations: IterationRow[]): StepRow {
  const work = { mouse_work: null, tool_work: null, explanation: null };
  return { ...kUnknownStep, step, time, status: "under way", converged: true, iterations, ...work };
}
