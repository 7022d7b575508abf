// Input of the functions panel: function, start and method.
import { formulaElements } from "../formulas";
import { choice, numberField } from "../controls";
import { element } from "../dom";
import { choiceName } from "../names";
import type { FunctionQuestion, SettingValue } from "../protocol";

const kFunctions = [
  ["rosenbrock", "Rosenbrock's valley"],
  ["two_bump", "a dip beside a bump"],
  ["quadratic", "a quadratic, condition 100"],
  ["formula", "a formula of x and y"],
] as const;

const kStarts: Record<string, [number, number]> = {
  rosenbrock: [-0.8, 0.6],
  two_bump: [-0.4, 0.3],
  quadratic: [1.2, 0.9],
  formula: [1, 1],
};

const kStartHelp = "x of the start; drag the ring in the picture, or Shift and the arrow keys there";

const kMethods = ["newton", "newton_cg", "gradient_descent", "lbfgs", "nonlinear_cg"];
const kDefiniteness = ["auto", "on_demand", "progressive", "clamped", "absolute", "exact"];
const kTests = ["textbook", "slide", "none"];

export interface Preset extends Omit<FunctionQuestion, "samples"> {
  title: string;
  shows: string;
  model: boolean; // whether the quadratic model is visible
}

export const kPresets: Preset[] = [
  {
    title: "Zig-zag",
    shows:
      "Gradient descent: the negative gradient points across the valley, so the path zigzags and progresses slowly. Newton's method takes one iteration here.",
    name: "quadratic",
    start: [0.3, 1.3],
    settings: { method: "gradient_descent", max_iterations: 200 },
    model: false,
    iteration: 0,
  },
  {
    title: "Overshoot",
    shows:
      "Newton's method: iteration 1 jumps to the model's minimum and lands far up on the other side, because the orange model is accurate only nearby. Without a line search the step is accepted.",
    name: "rosenbrock",
    start: [-0.2, -0.2],
    settings: { method: "newton", "line_search.test": "none", definiteness: "exact" },
    model: true,
    iteration: 1,
  },
  {
    title: "Backtracking",
    shows:
      "The same start and direction, but trials without sufficient decrease of f are rejected (crosses), and the step is halved until one is accepted (dot).",
    name: "rosenbrock",
    start: [-0.2, -0.2],
    settings: { method: "newton", "line_search.test": "textbook" },
    model: true,
    iteration: 1,
  },
  {
    title: "Indefinite",
    shows:
      "Between dip and bump the Hessian is indefinite and the model has no minimum. Newton's method replaces the negative curvature by its absolute value.",
    name: "two_bump",
    start: [-0.2, 0.6],
    settings: { method: "newton", definiteness: "absolute" },
    model: true,
    iteration: 0,
  },
];

// Defaults of the form's settings.
const kDefaults: Record<string, SettingValue> = {
  method: "newton",
  definiteness: "auto",
  "line_search.test": "textbook",
  "line_search.alpha_max": 1,
  "line_search.c": 1e-4,
  "line_search.p": 0.5,
  tolerance: 1e-6,
  max_iterations: 200,
};

export class FunctionForm {
  readonly element = element("form", { class: "functions-form", "aria-label": "Function and method" });
  private readonly shown = element("div");
  readonly error = element("div", { class: "plot-error", role: "alert", id: "function-error" });
  private readonly formula = element("input", {
    type: "text",
    "aria-label": "Formula of x and y",
    "aria-describedby": "function-error",
    spellcheck: "false",
    value: "cosh(x) + (y - x)^2",
  });
  private readonly name = choice("f", "The function", kFunctions, "rosenbrock", () => this.nameChanged());
  private readonly x = numberField("start x", kStartHelp, 0, {}, () => this.changed());
  private readonly y = numberField("y", "y of the start", 0, {}, () => this.changed());
  private readonly fields = new Map<string, { read: () => SettingValue; write: (value: SettingValue) => void }>(); // by key
  private others: Record<string, SettingValue> = {}; // settings of a question that the form does not show

  constructor(private readonly changed: () => void) {
    this.formula.addEventListener("change", changed);
    this.element.addEventListener("submit", (event) => {
      event.preventDefault();
      changed();
    });
    const row = (...children: HTMLElement[]): HTMLElement => element("div", { class: "pair" }, ...children);
    this.element.append(
      row(this.name.element),
      this.formula,
      this.shown,
      this.error,
      row(this.x.element, this.y.element),
      row(
        this.pick("method", "method", "Method that computes the direction", kMethods),
        this.pick("definiteness", "definiteness", "Modification of an indefinite Hessian", kDefiniteness),
      ),
      row(
        this.pick("line_search.test", "line search", "Acceptance test of a trial", kTests),
        this.number("line_search.alpha_max", "α max", "Step length of the first trial", { min: 1e-12, max: 1e6 }),
        this.number("line_search.c", "c", "Sufficient decrease", { min: 0, max: 1 }),
        this.number("line_search.p", "p", "Factor between trials", { min: 0.001, max: 0.99 }),
      ),
      row(
        this.number("tolerance", "tolerance", "Tolerance of the gradient's norm", { min: 0 }),
        this.number("max_iterations", "Max. iterations", "Maximum number of iterations", { min: 1, max: 500, step: 1 }),
      ),
    );
    this.fill({ name: "rosenbrock", start: kStarts.rosenbrock, settings: {} });
  }

  get start(): [number, number] {
    return [this.x.input.valueAsNumber || 0, this.y.input.valueAsNumber || 0];
  }

  setStart(x: number, y: number): void {
    this.x.input.value = String(Number(x.toPrecision(4)));
    this.y.input.value = String(Number(y.toPrecision(4)));
    this.changed();
  }

  question(iteration: number, samples: number): FunctionQuestion {
    const settings = { ...this.others };
    for (const [key, field] of this.fields) settings[key] = field.read();
    const name = this.name.select.value === "formula" ? this.formula.value : this.name.select.value;
    return { name, start: this.start, settings, iteration, samples };
  }

  fill({ name, start, settings }: Pick<FunctionQuestion, "name" | "start" | "settings">): void {
    const named = name !== "formula" && kFunctions.some(([known]) => known === name);
    this.name.select.value = named ? name : "formula";
    if (!named) this.formula.value = name;
    this.showFormula();
    [this.x.input.valueAsNumber, this.y.input.valueAsNumber] = start;
    this.others = Object.fromEntries(Object.entries(settings).filter(([key]) => !this.fields.has(key)));
    for (const [key, field] of this.fields) field.write(settings[key] ?? kDefaults[key]);
  }

  // Shows a named function as a formula and any other as a text field.
  private showFormula(): void {
    const name = this.name.select.value;
    this.formula.hidden = name !== "formula";
    this.shown.replaceChildren(...formulaElements(name));
  }

  private nameChanged(): void {
    this.showFormula();
    [this.x.input.valueAsNumber, this.y.input.valueAsNumber] = kStarts[this.name.select.value];
    this.changed();
  }

  private pick(key: string, text: string, title: string, values: string[]): HTMLElement {
    const options = values.map((value) => [value, choiceName(`solver.${key}`, value)] as const);
    const made = choice(text, title, options, "", this.changed);
    this.fields.set(key, { read: () => made.select.value, write: (value) => (made.select.value = String(value)) });
    return made.element;
  }

  private number(key: string, text: string, title: string, limits: Parameters<typeof numberField>[3]): HTMLElement {
    const { element, input } = numberField(text, title, 0, limits, this.changed);
    this.fields.set(key, {
      read: () => (Number.isFinite(input.valueAsNumber) ? input.valueAsNumber : kDefaults[key]),
      write: (value) => (input.value = brief(Number(value))),
    });
    return element;
  }
}

// 1e-6 rather than 0.000001
function brief(value: number): string {
  return value !== 0 && Math.abs(value) < 1e-3 ? value.toExponential() : String(value);
}
