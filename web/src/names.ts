// Display names of the keys in scenes and reports.
import type { Setting } from "./protocol";

// Values whose display name is not the key with a capital letter.
const kChoices: Record<string, string> = {
  // Material models.
  neo_hookean: "Neo-Hookean",
  neo_hookean_fibres: "Neo-Hookean with fibres",
  stable_neo_hookean: "Stable neo-Hookean",
  neo_hookean_log: "Neo-Hookean, log J",
  neo_hookean_log_j2: "Neo-Hookean, log J, quadratic J",
  neo_hookean_isochoric: "Neo-Hookean, isochoric",
  neo_hookean_2020: "Neo-Hookean (2020)",
  stvk: "Saint Venant-Kirchhoff",
  corotated: "Corotated linear",
  arap: "As rigid as possible",
  mooney_rivlin: "Mooney-Rivlin",
  // Integrators.
  backward_euler: "Backward Euler",
  linearly_implicit_euler: "Linearly implicit Euler",
  bdf2: "BDF2",
  tr_bdf2: "TR-BDF2",
  midpoint: "Implicit midpoint",
  trapezoid: "Trapezoidal rule",
  symplectic_euler: "Symplectic Euler",
  forward_euler: "Forward Euler",
  rk4: "Runge-Kutta 4",
  quasi_static: "Quasi-static",
  // Solvers.
  newton_cg: "Newton-CG",
  lbfgs: "L-BFGS",
  nonlinear_cg: "Nonlinear CG",
  auto: "Automatic",
  on_demand: "Clamped on demand",
  progressive: "Clamped progressively",
  clamped: "Clamped eigenvalues",
  absolute: "Absolute values",
  block_jacobi: "Block Jacobi",
  mass: "Mass matrix",
  best: "Best of all",
  zero: "Rest shape",
  current: "Current positions",
  extrapolated: "Free flight",
  accelerated: "Accelerated flight",
  scale: "Force scale",
  decrement: "Newton decrement",
  textbook: "Textbook",
  slide: "As on the slide",
};

// Names of values that mean something else under these keys.
const kChoicesOf: Record<string, Record<string, string>> = {
  "solver.criterion": { absolute: "Force in N" },
  "solver.line_search.test": { none: "None: first trial" },
};

export function choiceName(key: string, value: string): string {
  const known = kChoicesOf[key]?.[value] ?? kChoices[value];
  if (known) return known;
  const words = value.replaceAll("_", " ");
  return words.charAt(0).toUpperCase() + words.slice(1);
}

const kStatuses: Record<string, string> = {
  round_off: "converged to round-off",
  budget: "out of time",
  iteration_limit: "iteration limit",
  no_descent: "no descent",
  undefined: "blew up",
};

export function statusName(status: string): string {
  return kStatuses[status] ?? status.replaceAll("_", " ");
}

// "Young's modulus" of the label "Young's modulus E".
const withoutSymbol = (label: string): string => label.replace(/ (\S|\S+_\S+)$/, "");

// Message about a refused value of a setting, without the syntax of scenes and the command line.
export function refusalText(why: string, { label }: Pick<Setting, "label">): string {
  const limit = /must be ([^()]*?)\s*(?:\(|$)/.exec(why)?.[1];
  if (limit === undefined) return `${withoutSymbol(label)}: ${why.replace(/^--set .*?: /, "")}`;
  return `${withoutSymbol(label)} must be ${limit === "> 0" ? "positive" : limit}.`;
}

// The place and the remedy of an explanation: what is set, and what to choose instead, by the names of the settings.
export function settingText(text: string, settings: readonly Pick<Setting, "key" | "label">[], isRemedy: boolean): string {
  const [, key = "", quoted, plain] = /^([\w.]+) = (?:"(\w+)"|([-+.\w]+))$/.exec(text) ?? [];
  const value = quoted ?? plain;
  const label = settings.find((setting) => setting.key === key)?.label;
  if (value === undefined || !label) return text;
  if (key === "solver.line_search.test" && value === "none") return "Line search is off";
  const name = quoted === undefined ? value : `"${choiceName(key, value)}"`;
  if (!isRemedy) return `${label} is ${name}`;
  return quoted === undefined ? `Set ${label} to ${name}` : `Choose ${name}`;
}

type Explanation = { cause: string; place: string; remedy: string };

// The explanation of a failed step by the names of the settings, in sentences.
export function explanationText({ cause, place, remedy }: Explanation, settings: readonly Pick<Setting, "key" | "label">[]): string[] {
  return [cause, settingText(place, settings, false), settingText(remedy, settings, true)].map(sentence).filter((text) => text !== "");
}

// Starts with a capital, unless the text starts with a key of a scene, and ends with a period.
export function sentence(text: string): string {
  const trimmed = text.trim();
  if (trimmed === "") return "";
  const isKey = /^\S*[._=]\S/.test(trimmed);
  return (isKey ? trimmed[0]! : trimmed[0]!.toUpperCase()) + trimmed.slice(1) + (/[.!?]$/.test(trimmed) ? "" : ".");
}

// Text without Markdown: `code`, **strong**, [link](target).
export function plainText(markdown: string): string {
  return markdown
    .replace(/\[([^\]]+)\]\([^)]*\)/g, "$1")
    .replace(/\*\*([^*]+)\*\*/g, "$1")
    .replace(/`([^`]*)`/g, "$1");
}
