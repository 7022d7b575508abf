// Dialog that opens a second simulation beside the first.
import { button, element, labeled, openForm } from "./dom";
import type { Page } from "./page";
import { faultOfOverrides, parseOverrides, presets } from "./presets";
import type { Scene } from "./protocol";
import { shortcutButton } from "./shortcuts";
import type { Store } from "./store";

export function makeCompareButton(store: Store, page: Page): HTMLElement {
  const run = (): void => {
    const scene = store.side("a")?.scene;
    if (store.side("b")) store.source.send({ do: "end_compare" });
    else if (scene) openCompare(store, scene);
  };
  const shortcut = { key: "c", does: "Compare two simulations (A/B), or end it", group: "Panels", run } as const;
  const made = shortcutButton(page, shortcut, { text: "A/B", label: "Compare two simulations", steers: true });
  const show = (): void => {
    const comparing = store.side("b") !== null;
    made.textContent = comparing ? "End A/B" : "A/B";
    made.setAttribute("aria-label", comparing ? "End the comparison" : "Compare two simulations");
  };
  for (const event of ["scene", "gone"] as const) store.on(event, show);
  return made;
}

function openCompare(store: Store, scene: Scene): void {
  const label = element("input", { type: "text", maxlength: "60", required: true });
  const overrides = element("textarea", { rows: "4", spellcheck: "false", placeholder: "material.young=1e6" });
  const choices = presets(scene).map((preset) =>
    button({ text: preset.title, title: preset.overrides.join("\n") }, () => {
      label.value = preset.label;
      overrides.value = preset.overrides.join("\n");
    }),
  );
  const run = async (): Promise<void> => {
    const lines = parseOverrides(overrides.value);
    const fault = faultOfOverrides(lines);
    if (fault !== "") throw new Error(fault);
    await store.source.request({ do: "compare", overrides: lines, label: label.value.trim() || "B" });
  };
  const fields = [
    element("p", {}, "Side A does not change. Side B is the same scene with these differences:"),
    element("div", { class: "choices" }, ...choices),
    labeled("Overrides of side B, one KEY=VALUE per line", overrides),
    labeled("Name of side B", label),
  ];
  openForm("Compare two simulations", fields, "Compare", run);
  choices[0]?.focus();
}
