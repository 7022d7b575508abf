// Runs a reader's code in a worker with a time limit.
import { startWorker } from "../host";

const kTimeLimit = 5000; // [ms]

export interface Run {
  results: unknown[]; // of the calls; numbers that are not finite as text: "NaN"
  failure: string | null; // names the line; then there are no results
  ran: boolean; // not for syntax errors and endless loops
}

// Calls the function for each list of arguments. A text among them names a planar function of the engine. The worker's
// script contains the text of this function, so it uses nothing outside.
function serve(name: string, entry: unknown): void {
  const planar: Record<string, unknown> = {
    rosenbrock: {
      value: ([x, y]: number[]) => (1 - x!) ** 2 + 100 * (y! - x! * x!) ** 2,
      gradient: ([x, y]: number[]) => [-2 * (1 - x!) - 400 * x! * (y! - x! * x!), 200 * (y! - x! * x!)],
      hessian: ([x, y]: number[]) => [[2 - 400 * (y! - 3 * x! * x!), -400 * x!], [-400 * x!, 200]],
    },
    two_bump: {
      value: ([x, y]: number[]) => x! * Math.exp(-x! * x! - y! * y!),
      gradient: ([x, y]: number[]) => [(1 - 2 * x! * x!) * Math.exp(-x! * x! - y! * y!), -2 * x! * y! * Math.exp(-x! * x! - y! * y!)],
      hessian: ([x, y]: number[]) => {
        const e = Math.exp(-x! * x! - y! * y!);
        const xy = (4 * x! * x! - 2) * y! * e;
        return [[(4 * x! * x! - 6) * x! * e, xy], [xy, (4 * y! * y! - 2) * x! * e]];
      },
    },
  };
  const plain = (_: string, value: unknown): unknown => {
    if (typeof value === "number" && !Number.isFinite(value)) return String(value);
    return ArrayBuffer.isView(value) ? Array.from(value as Float64Array) : value;
  };
  onmessage = ({ data }: MessageEvent<{ message: unknown[][] }>) => {
    try {
      if (typeof entry !== "function") throw new Error(`There is no function ${name}.`);
      const results = data.message.map((call) => entry(...call.map((value) => (typeof value === "string" ? planar[value] : value))));
      postMessage(JSON.stringify({ results }, plain));
    } catch (error) {
      const { message = `The code throws ${String(error)}.`, stack = "" } = (error ?? {}) as Partial<Error>;
      postMessage(JSON.stringify({ results: [], error: String(message), stack: String(stack) }));
    }
  };
}

// First place of a stack in the code of `lines` lines; null: none.
export function lineOf(stack: string, lines: number): number | null {
  const places = [...stack.matchAll(/blob:[^\s)]*:(\d+):\d+/g)].map(([, line]) => Number(line));
  return places.find((line) => line <= lines) ?? null;
}

const kOutside = "A return outside a function. Keep the line that begins the function and its last brace; Start again restores them.";

// An unclosed bracket is noticed below the code.
function failureOf(message: string, line: number | null, lines: number): string {
  const text = /illegal return|return not in function|return outside/i.test(message) ? kOutside : message.replace(/^Uncaught /, "");
  if (line === null) return text;
  return line > lines ? `${text}. Is a bracket, a text or a comment not closed?` : `Line ${line}: ${text}`;
}

export function runCode(code: string, name: string, calls: unknown[][]): Promise<Run> {
  const lines = code.split("\n").length;
  const worker = startWorker<unknown[][]>(`${code}\n;(${serve.toString()})("${name}", typeof ${name} === "undefined" ? undefined : ${name});`);
  const answer = new Promise<Run>((resolve) => {
    const fail = (failure: string, ran = false): void => resolve({ results: [], failure, ran });
    setTimeout(() => fail(`Stopped after ${kTimeLimit / 1000} s: does a loop never end?`), kTimeLimit);
    worker.onmessage = (data) => {
      if (typeof data !== "string" || !/^{"(results|kind)"/.test(data)) return; // posted by the code itself
      const { kind, why, line, results, error, stack } = JSON.parse(data);
      if (kind === "ended") fail(failureOf(why, line, lines));
      else if (error !== undefined) fail(failureOf(error, lineOf(stack, lines), lines), true);
      else resolve({ results, failure: null, ran: true });
    };
    worker.send(calls, false);
  });
  return answer.finally(() => worker.end());
}
