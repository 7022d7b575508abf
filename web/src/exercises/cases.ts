// Expected numbers of the exercises. The engine computes them from its functions of two variables and its bodies.
import { messageOf } from "../dom";
import { chosen } from "../formulas";
import { short } from "../numbers";
import type { FunctionReply, TetReply } from "../protocol";
import type { Store } from "../store";
import type { Case } from "./check";

const kEngine = "the engine";

// A chain of masses in the plane: a spring joins the first one to the origin, and each further one to the one before.
export interface Chain {
  h: number; // [s]
  g: number; // [m/s^2]
  k: number; // [N/m]
  L: number; // length of a spring without force [m]
  m: number[]; // [kg]
  predicted: number[]; // q~
}

const kStates: { q: number[]; chain: Chain }[] = [
  { q: [0.9, -0.7], chain: { h: 0.1, g: 9.81, k: 60, L: 1, m: [0.5], predicted: [0.8, -0.5] } },
  { q: [0.6, -0.9, 1.3, -1.2], chain: { h: 0.05, g: 9.81, k: 200, L: 0.8, m: [0.5, 0.25], predicted: [0.7, -0.8, 1.2, -1.4] } },
  { q: [0.5, -0.4, 0.9, -1.3, 1.8, -1.1], chain: { h: 0.2, g: 1.62, k: 40, L: 0.9, m: [1, 2, 0.5], predicted: [0.4, -0.6, 1, -1.2, 1.7, -1.3] } },
];

// E of the chain as a formula for the engine: x and y are the entries i and j of q.
export function energyFormula(q: number[], { h, g, k, L, m, predicted }: Chain, i: number, j: number): string {
  const entry = (n: number): string => (n < 0 ? "0" : n === i ? "x" : n === j ? "y" : `(${q[n]})`);
  const moved = q.map((_, n) => `${m[n >> 1]!}/2*(${entry(n)}-(${predicted[n]}))^2`);
  const stretched = m.map((_, n) => `${k}/2*(sqrt((${entry(2 * n)}-${entry(2 * n - 2)})^2+(${entry(2 * n + 1)}-${entry(2 * n - 1)})^2)-${L})^2`);
  const lifted = m.map((mass, n) => `${mass}*${g}*${entry(2 * n + 1)}`);
  return `${moved.join("+")}+${h}^2*(${[...stretched, ...lifted].join("+")})`;
}

type Question = { name: string; start: [number, number]; settings: Record<string, string | number> };

const ask = (store: Store, question: Question): Promise<FunctionReply> =>
  store.source.ask<FunctionReply>({ ask: "function", iteration: 0, samples: 2, ...question });

// Value, gradient and Hessian of E by the engine.
async function derivatives(store: Store, q: number[], chain: Chain): Promise<{ value: number; g: number[]; H: number[][] }> {
  const g = q.map(() => 0);
  const H = q.map(() => q.map(() => 0));
  let value = 0;
  for (let i = 0; i < q.length; ++i)
    for (let j = i + 1; j < q.length; ++j) {
      const { model } = await ask(store, { name: energyFormula(q, chain, i, j), start: [q[i]!, q[j]!], settings: { max_iterations: 1 } });
      value = model.value;
      [g[i], g[j]] = model.gradient;
      [H[i]![i], H[j]![j]] = [model.xx, model.yy];
      H[i]![j] = H[j]![i] = model.xy;
    }
  return { value, g, H };
}

const point = (x: readonly number[]): string => `(${x.map((each) => short(each)).join(", ")})`;

export const chainCases = (what: "value" | "g" | "H") => (store: Store): Promise<Case[]> =>
  Promise.all(
    kStates.map(async ({ q, chain }) => {
      const expected = (await derivatives(store, q, chain))[what];
      return { at: `At q = ${point(q)}`, arguments: [q, chain], expected, source: kEngine };
    }),
  );

// Iterates of the engine with full or equal steps: [function, start, iterations, step length].
export const pathCases = (method: "newton" | "gradient_descent", runs: [string, [number, number], number, number][]) => (store: Store): Promise<Case[]> =>
  Promise.all(
    runs.map(async ([name, start, most, alpha]) => {
      const settings = { method, ...(method === "newton" ? { definiteness: "exact" } : {}), "line_search.test": "none", "line_search.alpha_max": alpha, max_iterations: most, tolerance: 1e-12 };
      const expected = (await ask(store, { name, start, settings })).path.map(({ x, y }) => [x, y]);
      const more = method === "newton" ? [] : [alpha];
      return { at: `${name} from ${point(start)}`, arguments: [name, start, expected.length - 1, ...more], expected, source: kEngine };
    }),
  );

// Step lengths of the engine along d = -g: [function, start, alphaMax, c, p].
export const stepCases = (runs: [string, [number, number], number, number, number][]) => async (store: Store): Promise<Case[]> => {
  const cases = await Promise.all(
    runs.map(async ([name, start, alphaMax, c, p]) => {
      const settings = { method: "gradient_descent", "line_search.alpha_max": alphaMax, "line_search.c": c, "line_search.p": p, max_iterations: 1 };
      const { model, iterations } = await ask(store, { name, start, settings });
      const d = model.gradient.map((slope) => -slope);
      const options = { alphaMax, c, p, tol: 1e-10 };
      return { at: `${name}, x = ${point(start)}, c = ${c}, p = ${p}`, arguments: [name, start, d, options], expected: iterations[0]!.alpha!, source: kEngine };
    }),
  );
  const stuck = { alphaMax: 1, c: 1e-4, p: 0.5, tol: 0.01 };
  return [...cases, { at: "rosenbrock, x = (−1.2, 1), tol = 0.01", arguments: ["rosenbrock", [-1.2, 1], [215.6, 88], stuck], expected: 0, source: "the rule that a stuck search returns 0" }];
};

const kTets = 6;

// Energy densities of the body on the screen.
export async function densityCases(store: Store): Promise<Case[]> {
  const side = store.side("a");
  if (chosen(side?.scene.settings ?? [], "material.model") !== "neo_hookean") throw new Error("The body on the screen is not neo-Hookean. Open this page of the lecture again.");
  const triangles = (side!.geometry?.tet.length ?? 0) / kTets;
  const tets = await Promise.all(
    Array.from({ length: kTets }, (_, i) => store.source.ask<TetReply>({ ask: "tet", side: "a", triangle: Math.floor(i * triangles) })),
  );
  const cases = tets.map(({ tet, F, young, poisson, energy_density }) => {
    const mu = young! / (2 * (1 + poisson!));
    const la = (young! * poisson!) / ((1 + poisson!) * (1 - 2 * poisson!));
    return { at: `Tet ${tet} of the body, F = ${F.map(point).join(" ")}`, arguments: [F, mu, la], expected: energy_density!, source: kEngine };
  });
  const turned = { at: "A rotation by 90 degrees", arguments: [[[0, -1, 0], [1, 0, 0], [0, 0, 1]], 1, 2], expected: 0, source: "the rule that a rotation stores no energy" };
  return [...cases, turned];
}

export const casesError = (reason: unknown): string => `The engine has no numbers to compare with: ${messageOf(reason)}`;
