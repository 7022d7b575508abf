// What the reader has written and passed: kept by the browser, or until the page closes where storage is refused.
import { fieldsOf } from "../page";
import { recall, remember } from "../storage";
import type { Exercise } from "./exercises";

export interface Progress {
  passing: string; // the last code that passed; "": none
  tries: number;
  hints: number; // shown
  solution: boolean; // was shown
  code: string; // as it is
}

const kept = new Map<string, string>();

const parsed = (text: string): unknown => {
  try {
    return JSON.parse(text);
  } catch {
    return null;
  }
};

export function progressOf({ id, code }: Exercise): Progress {
  const saved = fieldsOf(parsed(kept.get(id) ?? recall(`exercise.${id}`) ?? ""));
  const number = (value: unknown): number => (typeof value === "number" ? value : 0);
  return {
    passing: typeof saved.passing === "string" ? saved.passing : "",
    tries: number(saved.tries),
    hints: number(saved.hints),
    solution: saved.solution === true,
    code: typeof saved.code === "string" ? saved.code : code,
  };
}

export function keepProgress({ id }: Exercise, progress: Progress): void {
  kept.set(id, JSON.stringify(progress));
  remember(`exercise.${id}`, kept.get(id)!);
}

// File for a lecturer: one object per exercise that the reader has tried, with the code that passed or else the last one.
export function progressFile(name: string, exercises: Exercise[]): string {
  const tried = exercises
    .map((exercise) => ({ exercise: exercise.id, ...progressOf(exercise) }))
    .filter(({ tries }) => tries > 0)
    .map(({ passing, code, ...rest }) => ({ name, ...rest, passed: passing !== "", code: passing || code }));
  return JSON.stringify({ aspic_exercises: 1, exercises: tried }, null, 2);
}
