// Lecture mode: the pages of the lecture as a list, each opening its demonstration. A recorded mouse plays until the
// reader drags the body.
import { button, element } from "./dom";
import { ExercisePanel } from "./exercises/panel";
import { formulaElements } from "./formulas";
import { Judge } from "./judgment";
import type { Page } from "./page";
import type { FunctionQuestion, Lesson } from "./protocol";
import { shortcutButton } from "./shortcuts";
import { makeSlides } from "./slides";
import type { Store } from "./store";

export function matches(lesson: Lesson, words: string): boolean {
  const text = `${lesson.pages} ${lesson.title} ${lesson.claim} ${lesson.exercise}`.toLowerCase();
  const all = words.toLowerCase().split(/\s+/);
  return all.every((word) => text.includes(word));
}

// Next available lesson, forward (1) or backward (-1).
export function neighbor(lessons: Lesson[], from: Lesson | null, by: 1 | -1): Lesson | null {
  const shown = lessons.filter((lesson) => !lesson.missing);
  if (!from) return shown[0] ?? null;
  return shown[shown.indexOf(from) + by] ?? null;
}

// Pages of a lesson: "5, 7-9" gives 5, 7, 8, 9.
function pageNumbers({ pages }: Lesson): number[] {
  return pages.split(",").flatMap((range) => {
    const [first, last = first] = range.split("-").map(Number);
    return Array.from({ length: last! - first! + 1 }, (_, k) => first! + k);
  });
}

const lessonsOf = (lessons: Lesson[], page: number): Lesson[] => lessons.filter((lesson) => pageNumbers(lesson).includes(page));

// Lesson that the address chooses: "#lecture/33" the first of page 33, "#lecture/33/2" its second. null: none;
// undefined: the address is not about the lecture.
export function lessonAt(lessons: Lesson[], hash: string): Lesson | null | undefined {
  const [match, page, part = 1] = /^#lecture\/(\d+)(?:\/(\d+))?$/.exec(hash) ?? [];
  if (!match) return undefined;
  return lessonsOf(lessons, Number(page))[Number(part) - 1] ?? null;
}

// Address that opens the lesson: of its pages the one on which fewest lessons precede it.
export function addressOf(lessons: Lesson[], lesson: Lesson): string {
  const places = pageNumbers(lesson).map((page) => ({ page, part: lessonsOf(lessons, page).indexOf(lesson) + 1 }));
  const { page, part } = places.reduce((best, place) => (place.part < best.part ? place : best));
  return part === 1 ? `#lecture/${page}` : `#lecture/${page}/${part}`;
}

function pagesText({ pages }: Lesson): string {
  return /[-,]/.test(pages) ? `Pages ${pages}` : `Page ${pages}`;
}

function questionElements({ question, answer = "" }: Lesson): HTMLElement[] {
  if (!question) return [];
  return [element("p", { class: "question" }, question), element("details", {}, element("summary", {}, "Answer"), answer)];
}

export class Lecture {
  private lessons: Lesson[] = [];
  private current: Lesson | null = null;
  private replaying = false;
  private hasReadAddress = false;
  private readonly card = element("article", { class: "lesson", "aria-live": "polite" });
  private readonly judge = new Judge();
  private readonly exercise: ExercisePanel;
  private readonly loading = element("p", { class: "faint", role: "status" }, "Loading the demonstration ...");
  private readonly replay = element("p", { class: "replay", hidden: true });
  private readonly list = element("ol", { class: "lessons" });
  private readonly search = element("input", { type: "search", placeholder: "Search", "aria-label": "Search the lecture" });
  private readonly previous = button({ text: "Previous", steers: true }, () => this.move(-1));
  private readonly next = button({ text: "Next", steers: true }, () => this.move(1));
  readonly opener: HTMLButtonElement;

  constructor(
    private readonly root: HTMLElement,
    private readonly store: Store,
    private readonly page: Page,
    private readonly showFunction: (question: FunctionQuestion) => void,
  ) {
    this.exercise = new ExercisePanel(store);
    const shortcut = { key: "l", does: "The lecture's pages", group: "Panels", run: () => this.toggle() } as const;
    this.opener = shortcutButton(page, shortcut, { text: "Lecture" });
    this.opener.hidden = true;
    const slides = makeSlides(page, this.card, (by) => this.move(by), () => this.startSlides());
    const turn = element("div", { class: "turn" }, this.previous, this.next, slides);
    root.append(turn, this.card, this.replay, this.search, this.list);
    this.search.addEventListener("input", () => this.fill());
    store.on("hello", (hello) => this.greet(hello.lessons));
    store.on("role", (steers) => {
      if (steers && !this.hasReadAddress) this.openFromAddress();
    });
    addEventListener("hashchange", () => this.openFromAddress());
    store.on("state", ({ replaying, playing }) => this.showReplay(replaying, playing));
  }

  private greet(lessons: Lesson[]): void {
    const known = this.current?.id;
    this.lessons = lessons;
    this.current = lessons.find((lesson) => lesson.id === known) ?? null;
    this.opener.hidden = lessons.length === 0;
    if (lessons.length === 0) this.root.hidden = true;
    this.fill();
  }

  private openFromAddress(): void {
    this.hasReadAddress = true;
    const lesson = lessonAt(this.lessons, location.hash);
    if (lesson === undefined) return;
    if (lesson === null) return this.page.notice(`The lecture has no demonstration at ${location.hash}.`);
    if (this.root.hidden) this.show(true);
    void this.open(lesson);
  }

  private toggle(): void {
    if (this.lessons.length === 0) return;
    this.show(this.root.hidden === true);
  }

  private startSlides(): boolean {
    if (this.lessons.length === 0) return false;
    this.show(true);
    if (this.current) return true;
    const wished = lessonAt(this.lessons, location.hash); // it may still be loading
    if (wished) void this.open(wished);
    else this.move(1);
    return true;
  }

  private show(visible: boolean): void {
    this.root.hidden = !visible;
    this.opener.setAttribute("aria-expanded", String(visible));
  }

  private fill(): void {
    const found = this.lessons.filter((lesson) => matches(lesson, this.search.value));
    this.list.replaceChildren(...found.map((lesson) => element("li", {}, this.entry(lesson))));
    if (found.length === 0) this.list.append(element("li", { class: "faint" }, "No page matches."));
    this.previous.hidden = this.next.hidden = this.current === null;
    this.previous.classList.toggle("faint", neighbor(this.lessons, this.current, -1) === null);
    this.next.classList.toggle("faint", neighbor(this.lessons, this.current, 1) === null);
  }

  private entry(lesson: Lesson): HTMLElement {
    const title = lesson.missing ? `Not shown: ${lesson.missing}` : lesson.claim;
    const entry = button({ title, steers: !lesson.missing }, () => {
      if (lesson.missing) this.page.notice(`${pagesText(lesson)}, ${lesson.title}: ${lesson.missing}`);
      else void this.open(lesson);
    });
    entry.append(element("span", { class: "pages" }, lesson.pages), element("span", {}, lesson.title));
    if (lesson.missing) entry.append(element("small", {}, lesson.missing));
    entry.setAttribute("aria-disabled", String(Boolean(lesson.missing)));
    if (lesson === this.current) entry.setAttribute("aria-current", "true");
    if (!this.store.steers) entry.disabled = !lesson.missing;
    return entry;
  }

  private move(by: 1 | -1): void {
    const lesson = neighbor(this.lessons, this.current, by);
    if (lesson) void this.open(lesson);
    else this.page.notice(by === 1 ? "This is the last page." : "This is the first page.");
  }

  // The text appears at once, the demonstration when its scene is loaded.
  private async open(lesson: Lesson): Promise<void> {
    const before = this.current;
    this.current = lesson;
    this.write(lesson);
    this.card.append(this.loading);
    try {
      await this.store.source.request({ do: "lesson", lesson: lesson.id });
    } catch (reason) {
      if (this.current === lesson) {
        this.current = before;
        if (before) this.write(before);
        else this.card.replaceChildren();
      }
      return this.page.report(reason);
    }
    if (this.current !== lesson) return; // turned meanwhile
    this.loading.remove();
    this.page.emit("cleared", undefined);
    history.replaceState(null, "", new URL(addressOf(this.lessons, lesson), location.href)); // for links and reloads
    this.page.emit("lesson", undefined);
    this.page.emit("panel", lesson.panel);
    this.page.emit("scale", lesson.log ? "log" : "linear");
    if (lesson.function) this.showFunction(lesson.function);
  }

  private write(lesson: Lesson): void {
    this.replay.hidden = !this.replaying; // the recorded mouse of an earlier lesson
    this.card.replaceChildren(
      element("h2", {}, `${pagesText(lesson)}: ${lesson.title}`),
      element("p", { class: "claim" }, lesson.claim),
      ...formulaElements(lesson.id),
      element("p", {}, lesson.exercise),
      ...questionElements(lesson),
      this.judge.root,
      this.exercise.root,
    );
    this.judge.show(lesson.id);
    this.exercise.show(lesson.id);
    this.fill();
    this.list.querySelector("[aria-current]")?.scrollIntoView({ block: "nearest" });
    this.root.scrollTo(0, 0);
    document.scrollingElement?.scrollTo(0, 0); // on a phone the whole page scrolls; show the view first
  }

  private showReplay(replaying: boolean, playing: boolean): void {
    const paused = "The recorded drag is paused: press Space to continue, or drag to take over.";
    const shown = playing ? "Replaying a recorded drag. Drag to take over." : paused;
    const text = replaying ? shown : "The recorded drag has ended. Drag the body yourself.";
    if (replaying === this.replaying && (!replaying || text === this.replay.textContent)) return;
    this.replaying = replaying;
    this.replay.hidden = false;
    this.replay.textContent = text;
  }
}
