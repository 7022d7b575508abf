// Rows that a lil-gui folder lacks: numbers with a slider of any scale whose typed values may lie outside of its range,
// vectors, and formulas. A typed value is submitted on Enter or when the field loses the focus.
import { Controller, type GUI } from "lil-gui";
import { element } from "../dom";
import { choiceName, plainText } from "../names";
import type { Setting, SettingValue } from "../protocol";
import { numberText, parseNumber, toPosition, toValue, type Range } from "./scale";

const kSliderSteps = 500;

export interface Row {
  display(value: SettingValue): void; // unless the reader is changing it
  enable(enabled: boolean): unknown;
  mark(text: string): void; // a remark in the tooltip: "A: 1, B: 2"
}

type Model = { value: SettingValue };

// Text field that submits each text once; Escape restores the previous value.
function makeField(label: string, shown: () => string, commit: (text: string) => void): HTMLInputElement {
  const field = element("input", { type: "text", "aria-label": label, spellcheck: "false", autocomplete: "off" });
  field.addEventListener("change", () => commit(field.value));
  field.addEventListener("keydown", (event) => {
    if (event.key === "Enter") field.blur();
    if (event.key === "Escape") field.value = shown();
  });
  return field;
}

const textOf = (value: SettingValue): string => (typeof value === "number" ? numberText(value) : String(value));

function markRow(row: Controller, text: string): void {
  row.domElement.classList.toggle("differs", text !== "");
  row.domElement.title = text;
}

abstract class ValueRow extends Controller implements Row {
  protected held = false; // whether the mouse holds the slider
  private later: SettingValue | null = null; // value from the program while the reader changes the value

  constructor(
    gui: GUI,
    protected readonly model: Model,
    className: string,
  ) {
    super(gui, model, "value", className);
    this.$widget.addEventListener("focusout", () => this.catchUp());
  }

  display(value: SettingValue): void {
    this.later = value;
    if (!this.held && !this.isTyping()) this.catchUp();
  }

  override enable(enabled = true): this {
    super.enable(enabled);
    for (const input of this.$widget.querySelectorAll("input")) input.disabled = !enabled;
    return this;
  }

  mark(text: string): void {
    markRow(this, text);
  }

  protected catchUp(): void {
    if (this.later === null) return;
    this.model.value = this.later;
    this.later = null;
    this.updateDisplay();
  }

  private isTyping(): boolean {
    const focused = document.activeElement;
    return this.$widget.contains(focused) && focused instanceof HTMLInputElement && focused.type === "text";
  }
}

export class NumberRow extends ValueRow {
  private readonly slider: HTMLInputElement;
  private readonly field: HTMLInputElement;

  constructor(
    gui: GUI,
    label: string,
    model: Model,
    private readonly range: Range,
  ) {
    super(gui, model, "number-row");
    this.slider = element("input", { type: "range", "aria-label": `${label}, slider`, min: "0", max: String(kSliderSteps), step: "1" });
    // A text that is no number is a formula of the position; the program validates it.
    this.field = makeField(label, () => this.text(), (text) => this.setValue(parseNumber(text) ?? text));
    this.slider.addEventListener("pointerdown", () => (this.held = true));
    for (const end of ["pointerup", "pointercancel", "blur"]) this.slider.addEventListener(end, () => this.release());
    this.slider.addEventListener("input", () => this.setValue(this.slid(Number(this.slider.value) / kSliderSteps)));
    this.$widget.append(this.slider, this.field);
    this.updateDisplay();
  }

  override updateDisplay(): this {
    this.field.value = this.text();
    if (typeof this.model.value === "number" && !this.held) {
      this.slider.value = String(Math.round(toPosition(this.model.value, this.range) * kSliderSteps));
    }
    this.slider.setAttribute("aria-valuetext", this.text());
    return this;
  }

  // An arrow key moves to the next integer, even where that is a short distance on the slider.
  private slid(position: number): number {
    const value = toValue(position, this.range);
    const before = this.model.value;
    if (this.held || this.range.kind !== "integer" || value !== before) return value;
    return value + Math.sign(position - toPosition(before, this.range));
  }

  private release(): void {
    this.held = false;
    this.catchUp();
  }

  private text(): string {
    return textOf(this.model.value);
  }
}

// Text fields: one for each entry of a vector, or for a text.
class TextRow extends ValueRow {
  private readonly fields: HTMLInputElement[];

  constructor(gui: GUI, label: string, model: Model) {
    super(gui, model, "text-row");
    const name = (i: number): string => (Array.isArray(model.value) ? `${label} ${"xyz"[i] ?? i}` : label);
    this.fields = this.entries().map((_, i) => makeField(name(i), () => this.text(i), (text) => this.commit(i, text)));
    this.$widget.append(...this.fields);
    this.updateDisplay();
  }

  override updateDisplay(): this {
    this.fields.forEach((field, i) => (field.value = field.title = this.text(i)));
    return this;
  }

  private entries(): (number | string | boolean)[] {
    return [this.model.value].flat();
  }

  private text(i: number): string {
    return textOf(this.entries()[i] ?? "");
  }

  private commit(i: number, text: string): void {
    const { value } = this.model;
    const entry = parseNumber(text) ?? text;
    this.setValue(Array.isArray(value) ? value.map((known, j) => (j === i ? entry : known)) : entry);
  }
}

// Row of lil-gui for a list or a switch.
function plainRow(controller: Controller, model: Model): Row {
  const display = (value: SettingValue): void => {
    model.value = value;
    controller.updateDisplay();
  };
  return { display, enable: (enabled) => controller.enable(enabled), mark: (text) => markRow(controller, text) };
}

function named({ key, choices }: Setting): Record<string, string> {
  return Object.fromEntries(choices.map((value) => [choiceName(key, value), value]));
}

export function addRow(gui: GUI, setting: Setting, changed: (value: SettingValue) => void): Row {
  const model: Model = { value: setting.value };
  const unit = setting.unit.replace("^2", "²").replace("^3", "³");
  const name = unit === "" ? setting.label : `${setting.label} [${unit}]`;
  const dress = <C extends Controller>(controller: C): C => {
    controller.name(name).onChange(changed);
    controller.$name.title = `${plainText(setting.meaning)}\n${setting.key}`;
    return controller;
  };
  switch (setting.kind) {
    case "number":
    case "integer":
      return dress(new NumberRow(gui, name, model, setting));
    case "vector":
    case "text":
      return dress(new TextRow(gui, name, model));
    case "choice": {
      const controller = dress(gui.add(model, "value", named(setting)));
      controller.domElement.querySelectorAll("option").forEach((option, i) => (option.value = setting.choices[i]));
      return plainRow(controller, model);
    }
    case "switch":
      return plainRow(dress(gui.add(model, "value")), model);
  }
}
