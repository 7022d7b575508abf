// Toolbar: time controls, and buttons that open everything else.
import { button, element, icon, type ButtonOptions } from "./dom";
import { explanationText, statusName } from "./names";
import type { Page } from "./page";
import type { SideName, State } from "./protocol";
import { openShortcutList, shortcutButton } from "./shortcuts";
import type { Store } from "./store";
import type { Theme } from "./theme";
import { makeTimeline, placeText } from "./timeline";

const kSpeeds = [0.05, 0.1, 0.25, 0.5, 1, 2, 5, 10];

export function makeToolbar(root: HTMLElement, store: Store, page: Page, theme: Theme, tools: HTMLElement[]): void {
  root.append(
    makeTransport(store, page),
    makeName(store),
    makeTimeline(store, page),
    makeStatus(store),
    element("div", { class: "group" }, ...tools, ...makeReader(page, theme)),
  );
  store.on("state", (state) => {
    const title = `${store.name} · ${state.playing ? "playing" : `paused, ${placeText(state)}`} · Aspic`;
    if (document.title !== title) document.title = title;
  });
}

function makeName(store: Store): HTMLElement {
  const name = element("strong", { class: "scene-name" });
  store.on("scene", () => {
    name.textContent = name.title = store.name;
  });
  return name;
}

function makeTransport(store: Store, page: Page): HTMLElement {
  const { source } = store;
  const add = (key: string, does: string, options: ButtonOptions, run: () => void): HTMLButtonElement =>
    shortcutButton(page, { key, does, group: "Simulation", run }, { ...options, steers: source.live });
  let wanted: boolean | null = null; // requested value until the program answers
  const toggle = (): void => {
    wanted = !(wanted ?? store.state?.playing ?? false);
    source
      .request({ do: wanted ? "play" : "pause" })
      .catch(page.report)
      .finally(() => (wanted = null));
  };
  const play = add(" ", "Play or pause", { icon: "play", label: "Play" }, toggle);
  let played = false;
  store.on("state", (state) => {
    const { playing } = state;
    if ((wanted ?? played) && !playing) explainStop(state, store, page);
    played = playing;
    if (play.getAttribute("aria-pressed") === String(playing)) return;
    play.replaceChildren(icon(playing ? "pause" : "play"));
    play.setAttribute("aria-label", playing ? "Pause" : "Play");
    play.setAttribute("aria-pressed", String(playing));
  });
  const step = add("s", "One time step", { icon: "step", label: "Step" }, () => source.send({ do: "step" }));
  const reset = add("r", "Back to the start", { icon: "reset", label: "Reset" }, () => source.send({ do: "reset" }));
  const iteration = { icon: "iterate", text: "1 iteration" } as const;
  const iterate = source.live ? add("i", "One iteration of the minimizer", iteration, () => source.send({ do: "iterate" })) : null;
  return element("div", { class: "group" }, reset, play, step, iterate, makeSpeed(store));
}

// Explains a stop that nobody requested, such as an explicit scheme that blew up.
function explainStop(state: State, store: Store, page: Page): void {
  const name = state.a.words ? "a" : "b";
  const words = state[name]?.words;
  if (!words) return;
  const who = state.b ? `${store.title(name)} stopped` : "Stopped";
  page.notice(`${who}. ${explanationText(words, store.side(name)?.scene.settings ?? []).join(" ")}`, "error");
}

function makeSpeed(store: Store): HTMLElement {
  const select = element("select", {
    "aria-label": "Speed",
    title: "Target speed: simulated seconds per second",
    "data-steers": store.source.live,
  });
  const offer = (speed: number): void => {
    const speeds = kSpeeds.includes(speed) ? kSpeeds : [...kSpeeds, speed].sort((x, y) => x - y);
    select.replaceChildren(...speeds.map((value) => element("option", { value: String(value) }, `${value}x`)));
    select.value = String(speed);
  };
  offer(1);
  select.addEventListener("change", () => store.source.send({ do: "speed", value: Number(select.value) }));
  store.on("state", ({ speed }) => {
    if (select.value !== String(speed)) offer(speed);
  });
  return select;
}

// Status of the last step in a word, with its explanation as a tooltip.
function makeStatus(store: Store): HTMLElement {
  const rate = element("span", { class: "rate faint", title: "Measured speed: simulated seconds per second of wall time" });
  const makeChip = (): HTMLButtonElement => element("button", { type: "button", class: "chip", hidden: true });
  const chips = { a: makeChip(), b: makeChip() };
  store.on("state", (state) => {
    rate.textContent = state.rate > 0 ? `${Number(state.rate.toPrecision(2))}x real time` : "";
    showChip(chips.a, store, "a");
    showChip(chips.b, store, "b");
  });
  return element("div", { class: "group status" }, chips.a, chips.b, rate);
}

// Whether the displayed step did not converge.
function failed(store: Store, name: SideName): boolean {
  const rows = store.side(name)?.steps ?? [];
  const row = rows[(store.state?.[name]?.step ?? 0) - (rows[0]?.step ?? 1)];
  return row?.converged === false;
}

function showChip(chip: HTMLButtonElement, store: Store, name: SideName): void {
  const side = store.state?.[name] ?? null;
  chip.hidden = !side || side.status === "";
  if (!side) return;
  const bad = failed(store, name);
  const text = `${store.state?.b ? `${name.toUpperCase()}: ` : ""}${statusName(side.status)}`;
  const plain = bad ? "The last step did not converge." : "The last step converged.";
  const tip = side.words ? explanationText(side.words, store.side(name)?.scene.settings ?? []).join("\n") : plain;
  if (chip.dataset.tip === tip && chip.textContent === text) return;
  chip.textContent = text;
  chip.dataset.tip = tip;
  chip.setAttribute("aria-label", `Last step: ${text}. ${tip}`);
  chip.classList.toggle("bad", bad || side.words !== null);
}

function makeReader(page: Page, theme: Theme): HTMLElement[] {
  const help = shortcutButton(
    page,
    { key: "?", does: "Keyboard shortcuts", group: "Panels", run: () => openShortcutList(page) },
    { text: "?", label: "Keyboard shortcuts" },
  );
  return [
    button({ text: "A-", label: "Smaller letters", title: "Smaller letters (<)" }, () => theme.scale(-1)),
    button({ text: "A+", label: "Larger letters", title: "Larger letters (>)" }, () => theme.scale(1)),
    button({ icon: "theme", label: "Light or dark", title: "Light or dark (T)" }, () => theme.toggle()),
    help,
  ];
}
