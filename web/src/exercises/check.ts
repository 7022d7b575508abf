// Compares the results of a reader's code with expected numbers.
import { short } from "../numbers";
import { runCode } from "./run";

export type Value = number | Value[];

export interface Case {
  at: string; // what is computed, and where
  arguments: unknown[]; // see run.ts
  expected: Value;
  source: string; // of the expected value
}

export interface Verdict {
  passed: boolean;
  text: string;
  isTry?: boolean; // the code ran
}

const kTolerance = 1e-6; // relative to the largest expected entry
const kFloor = 1e-9; // absolute

const entriesOf = (value: Value): number[] => (typeof value === "number" ? [value] : value.flatMap(entriesOf));

function kindOf(value: unknown): string {
  if (Array.isArray(value)) return `a list of ${value.length}`;
  return value === null ? "nothing: is a return missing?" : typeof value === "string" ? value : `a value of type ${typeof value}`;
}

// Describes the first difference; null: none.
export function difference(found: unknown, expected: Value): string | null {
  const largest = Math.max(...entriesOf(expected).map(Math.abs));
  const compare = (got: unknown, want: Value, place: string): string | null => {
    if (Array.isArray(want)) {
      if (!Array.isArray(got) || got.length !== want.length) return `${place} is ${kindOf(got)}, expected: ${kindOf(want)}`;
      for (const [i, entry] of want.entries()) {
        const inside = compare(got[i], entry, `${place}[${i}]`);
        if (inside !== null) return inside;
      }
      return null;
    }
    if (typeof got !== "number") return `${place} is ${kindOf(got)}, expected: ${short(want, 8)}`;
    return Math.abs(got - want) <= kTolerance * largest + kFloor ? null : `${place} is ${short(got, 8)}, expected: ${short(want, 8)}`;
  };
  return compare(found, expected, "your result");
}

// A call as a reader would write it, with all values.
export function callText(name: string, values: unknown[]): string {
  const literal = (value: unknown): string => {
    if (Array.isArray(value)) return `[${value.map(literal).join(", ")}]`;
    if (typeof value !== "object" || value === null) return String(value);
    return `{ ${Object.entries(value).map(([key, entry]) => `${key}: ${literal(entry)}`).join(", ")} }`;
  };
  return `${name}(${values.map(literal).join(", ")})`;
}

export async function check(code: string, name: string, cases: Case[]): Promise<Verdict> {
  const { results, failure, ran } = await runCode(code, name, cases.map((each) => each.arguments));
  if (failure !== null) return { passed: false, text: failure, isTry: ran };
  for (const [i, { at, arguments: values, expected, source }] of cases.entries()) {
    const wrong = difference(results[i], expected);
    if (wrong !== null) return { passed: false, text: `${at}: ${wrong} (${source}).\nThe call: ${callText(name, values)}`, isTry: true };
  }
  return { passed: true, text: `Correct: ${cases.length} results agree with ${[...new Set(cases.map(({ source }) => source))].join(" and ")}.`, isTry: true };
}
