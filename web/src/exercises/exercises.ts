// Exercises beside the pages of the lecture.
import type { Store } from "../store";
import { chainCases, densityCases, pathCases, stepCases } from "./cases";
import type { Case } from "./check";

export interface Exercise {
  id: string; // name of progress in the browser and in exported files
  lesson: string; // demonstration
  title: string;
  text: string;
  formula: string; // name in formulas.json or of a material; "": those of the page suffice
  entry: string; // function to write
  code: string; // at first
  hints: string[];
  solution: string;
  cases: (store: Store) => Promise<Case[]>;
}

const kChain =
  "A chain of masses hangs in the plane: a spring of length L joins mass 0 to the origin, and each further mass to the one before. q = [x0, y0, x1, y1, ...]; predicted is q~. m has one entry per mass, M one per coordinate: M = diag(m0, m0, m1, m1, ...).";
const kFunction = "f has f.value(x), f.gradient(x) and f.hessian(x) for x = [x0, x1].";

export const exercises: Exercise[] = [
  {
    id: "density",
    lesson: "05-09_equation_of_motion",
    title: "an energy density",
    text: "Write the energy density psi(F) of this body, the program's neo-Hookean material. F is a list of three rows; mu and la are the Lamé constants of the formula.",
    formula: "neo_hookean",
    entry: "psi",
    code: `function psi(F, mu, la) {
  const [a, b, c] = F; // rows
  return 0;
}
`,
    hints: ["I1 = tr F'F is the sum of the squares of all nine entries.", "J = det F = a . (b x c).", "Three terms: mu/2 (I1 - 3), -mu (J - 1) and (la + mu)/2 (J - 1)^2."],
    solution: `function psi(F, mu, la) {
  const [a, b, c] = F; // rows
  let I1 = 0;
  for (const row of F) for (const entry of row) I1 += entry * entry;
  const J = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  return mu / 2 * (I1 - 3) - mu * (J - 1) + (la + mu) / 2 * (J - 1) ** 2;
}
`,
    cases: densityCases,
  },
  {
    id: "energy",
    lesson: "26-31_optimization",
    title: "E of a time step",
    text: `${kChain} Write E(q).`,
    formula: "exercise_chain",
    entry: "E",
    code: `function E(q, { h, g, k, L, m, predicted }) {
  let sum = 0;
  for (let i = 0; i < m.length; ++i) {
    // mass i is at (q[2 * i], q[2 * i + 1])
  }
  return sum;
}
`,
    hints: [
      "M is diagonal: mass i contributes m[i]/2 times the squared distance between its place in q and that in predicted.",
      "The spring of mass i begins at the mass before, or at (0, 0) if i is 0. Math.hypot gives its length.",
      "Only V is multiplied by h^2: springs k/2 (length - L)^2 and weights m g y.",
    ],
    solution: `function E(q, { h, g, k, L, m, predicted }) {
  let sum = 0;
  for (let i = 0; i < m.length; ++i) {
    const [x, y] = [q[2 * i], q[2 * i + 1]];
    const [x0, y0] = i > 0 ? [q[2 * i - 2], q[2 * i - 1]] : [0, 0];
    const moved = (x - predicted[2 * i]) ** 2 + (y - predicted[2 * i + 1]) ** 2;
    const stretched = Math.hypot(x - x0, y - y0) - L;
    sum += m[i] / 2 * moved + h * h * (k / 2 * stretched ** 2 + m[i] * g * y);
  }
  return sum;
}
`,
    cases: chainCases("value"),
  },
  {
    id: "gradient",
    lesson: "32_one_minimization_per_step",
    title: "the gradient of E",
    text: `${kChain} Write the gradient of E(q) = 1/2 (q - q~)' M (q - q~) + h^2 V(q) as a list as long as q.`,
    formula: "exercise_chain",
    entry: "gradient",
    code: `function gradient(q, { h, g, k, L, m, predicted }) {
  const sum = q.map(() => 0);
  for (let i = 0; i < m.length; ++i) {
  }
  return sum;
}
`,
    hints: [
      "The first term gives M (q - q~): entry n is m[n >> 1] * (q[n] - predicted[n]).",
      "A spring pulls along its unit vector u from the mass before: dV/dq of its end is k (length - L) u, and of its beginning the negative.",
      "Gravity adds h^2 m g to the entries of y. The origin has no entries: skip the beginning of spring 0.",
    ],
    solution: `function gradient(q, { h, g, k, L, m, predicted }) {
  const sum = q.map(() => 0);
  for (let i = 0; i < m.length; ++i) {
    const u = [0, 1].map((r) => q[2 * i + r] - (i > 0 ? q[2 * i - 2 + r] : 0));
    const length = Math.hypot(...u);
    for (const r of [0, 1]) {
      const pull = h * h * k * (length - L) * u[r] / length;
      sum[2 * i + r] += m[i] * (q[2 * i + r] - predicted[2 * i + r]) + pull;
      if (i > 0) sum[2 * i - 2 + r] -= pull;
    }
    sum[2 * i + 1] += h * h * m[i] * g;
  }
  return sum;
}
`,
    cases: chainCases("g"),
  },
  {
    id: "descent",
    lesson: "38-42_gradient_descent",
    title: "gradient descent",
    text: `Write n iterations of gradient descent with the step length alpha. Return all n + 1 iterates, x first. ${kFunction}`,
    formula: "",
    entry: "descend",
    code: `function descend(f, x, n, alpha) {
  const path = [x];
  return path;
}
`,
    hints: ["The direction is d = -f.gradient(x).", "Each iteration makes a new list, x + alpha d; push it to path."],
    solution: `function descend(f, x, n, alpha) {
  const path = [x];
  for (let k = 0; k < n; ++k) {
    const g = f.gradient(x);
    x = [x[0] - alpha * g[0], x[1] - alpha * g[1]];
    path.push(x);
  }
  return path;
}
`,
    cases: pathCases("gradient_descent", [
      ["two_bump", [-0.4, 0.3], 20, 0.5],
      ["rosenbrock", [-0.8, 0.6], 50, 1e-3],
    ]),
  },
  {
    id: "hessian",
    lesson: "43-51_quadratic_model",
    title: "the Hessian of E",
    text: `${kChain} Write the exact Hessian of E(q) = 1/2 (q - q~)' M (q - q~) + h^2 V(q) as a list of rows.`,
    formula: "exercise_chain",
    entry: "hessian",
    code: `function hessian(q, { h, g, k, L, m, predicted }) {
  const H = q.map(() => q.map(() => 0));
  for (let i = 0; i < m.length; ++i) {
  }
  return H;
}
`,
    hints: [
      "The first term gives M: m[n >> 1] on the diagonal. Gravity is linear, so it gives nothing.",
      "With the unit vector u of a spring of length l, the block of its end is K = k (u u' + (1 - L / l) (I - u u')).",
      "h^2 K is added to the diagonal blocks of both masses of the spring, and -h^2 K to the two blocks between them.",
    ],
    solution: `function hessian(q, { h, g, k, L, m, predicted }) {
  const H = q.map(() => q.map(() => 0));
  for (let i = 0; i < m.length; ++i) {
    const u = [0, 1].map((r) => q[2 * i + r] - (i > 0 ? q[2 * i - 2 + r] : 0));
    const l = Math.hypot(...u);
    for (const r of [0, 1]) {
      H[2 * i + r][2 * i + r] += m[i];
      for (const s of [0, 1]) {
        const uu = u[r] * u[s] / l ** 2;
        const K = h * h * k * (uu + (1 - L / l) * ((r === s) - uu));
        H[2 * i + r][2 * i + s] += K;
        if (i === 0) continue;
        H[2 * i - 2 + r][2 * i - 2 + s] += K;
        H[2 * i + r][2 * i - 2 + s] -= K;
        H[2 * i - 2 + r][2 * i + s] -= K;
      }
    }
  }
  return H;
}
`,
    cases: chainCases("H"),
  },
  {
    id: "newton",
    lesson: "54-59_overshoot",
    title: "Newton's method",
    text: `Write n iterations of Newton's method with full steps, x + d. Return all n + 1 iterates, x first. Where does it overshoot? ${kFunction}`,
    formula: "",
    entry: "newton",
    code: `function newton(f, x, n) {
  const path = [x];
  return path;
}
`,
    hints: ["d solves H d = -g with g = f.gradient(x) and H = f.hessian(x), a list of two rows.", "Of two equations Cramer's rule gives d, with det = H[0][0] H[1][1] - H[0][1] H[1][0]."],
    solution: `function newton(f, x, n) {
  const path = [x];
  for (let k = 0; k < n; ++k) {
    const [g, H] = [f.gradient(x), f.hessian(x)];
    const det = H[0][0] * H[1][1] - H[0][1] * H[1][0];
    const d = [(H[0][1] * g[1] - H[1][1] * g[0]) / det, (H[1][0] * g[0] - H[0][0] * g[1]) / det];
    x = [x[0] + d[0], x[1] + d[1]];
    path.push(x);
  }
  return path;
}
`,
    cases: pathCases("newton", [
      ["rosenbrock", [-1.2, 1], 5, 1],
      ["two_bump", [-0.6, 0.2], 4, 1],
    ]),
  },
  {
    id: "line_search",
    lesson: "60-61_backtracking",
    title: "a backtracking line search",
    text: `Write the line search: return the first of alphaMax, p alphaMax, p^2 alphaMax, ... with f(x + alpha d) <= f(x) + c alpha d'g, or 0 once alpha is below tol. ${kFunction}`,
    formula: "",
    entry: "lineSearch",
    code: `function lineSearch(f, x, d, { alphaMax, c, p, tol }) {
  let alpha = alphaMax;
  return alpha;
}
`,
    hints: ["d'g is the slope along d: d[0] g[0] + d[1] g[1] with g = f.gradient(x). It is negative if d leads downhill.", "Multiply alpha by p while the trial fails the test, and return 0 as soon as alpha < tol: you are stuck."],
    solution: `function lineSearch(f, x, d, { alphaMax, c, p, tol }) {
  const g = f.gradient(x);
  const slope = d[0] * g[0] + d[1] * g[1];
  let alpha = alphaMax;
  while (f.value([x[0] + alpha * d[0], x[1] + alpha * d[1]]) > f.value(x) + c * alpha * slope) {
    alpha *= p;
    if (alpha < tol) return 0; // stuck
  }
  return alpha;
}
`,
    cases: stepCases([
      ["rosenbrock", [-1.2, 1], 1, 1e-4, 0.5],
      ["rosenbrock", [0.3, -0.5], 2, 0.4, 0.8],
      ["two_bump", [-0.2, 0.6], 8, 0.1, 0.7],
    ]),
  },
];
