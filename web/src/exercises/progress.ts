// What the reader has written and passed: kept by the browser, or until the page closes where storage is refused.
import { fieldsOf } from "../page";
import { recall, remember } from "../storage";
import type { Exercise } from "./exercises";

export interface Progress {
  passed: boolean;
  tries: number;
  code: string;
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
  return {
    passed: saved.passed === true,
    tries: typeof saved.tries === "number" ? saved.tries : 0,
    code: typeof saved.code === "string" ? saved.code : code,
  };
}

export function keepProgress({ id }: Exercise, progress: Progress): void {
  kept.set(id, JSON.stringify(progress));
  remember(`exercise.${id}`, kept.get(id)!);
}

// File for a lecturer: one object per exercise that the reader has tried.
export function progressFile(name: string, exercises: Exercise[]): string {
  const tried = exercises.map((exercise) => ({ name, exercise: exercise.id, ...progressOf(exercise) })).filter(({ tries }) => tries > 0);
  return JSON.stringify({ aspic_exercises: 1, exercises: tried }, null, 2);
}
