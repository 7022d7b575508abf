// A text field for code with line numbers. Tab indents; after Escape it leaves the field.
import { element } from "../dom";

export function makeEditor(label: string, changed: () => void): { element: HTMLElement; field: HTMLTextAreaElement; show(code: string): void } {
  const numbers = element("pre", { "aria-hidden": "true" });
  const field = element("textarea", { "aria-label": label, spellcheck: "false", autocapitalize: "off", wrap: "off", title: "Escape, then Tab leaves the editor" });
  let leaves = false;
  const draw = (): void => {
    const count = field.value.split("\n").length;
    numbers.textContent = Array.from({ length: count }, (_, i) => i + 1).join("\n");
    field.rows = Math.min(Math.max(count + 1, 8), 24);
    numbers.scrollTop = field.scrollTop;
  };
  field.addEventListener("input", () => {
    draw();
    changed();
  });
  field.addEventListener("scroll", () => (numbers.scrollTop = field.scrollTop));
  field.addEventListener("keydown", (event) => {
    if (event.key === "Tab" && !event.shiftKey && !leaves) {
      event.preventDefault();
      document.execCommand("insertText", false, "  "); // unlike setRangeText it can be undone
    }
    leaves = event.key === "Escape";
  });
  const show = (code: string): void => {
    field.value = code;
    draw();
  };
  return { element: element("div", { class: "editor" }, numbers, field), field, show };
}
