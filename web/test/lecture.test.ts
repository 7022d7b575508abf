import assert from "node:assert/strict";
import { test } from "node:test";
import { lessonOf, matches, neighbor } from "../src/lecture";
import type { Lesson } from "../src/protocol";

const lesson = (id: string, more: Partial<Lesson> = {}): Lesson => ({
  id,
  pages: "33-34",
  title: "The mouse pulls",
  claim: "A spring.",
  look: "",
  panel: "energy",
  ...more,
});

test("search ignores order and case of words", () => {
  assert.ok(matches(lesson("a"), "SPRING mouse"));
  assert.ok(matches(lesson("a"), "33"));
  assert.ok(matches(lesson("a"), ""));
  assert.ok(!matches(lesson("a"), "spring hammer"));
});

test("previous and next skip missing lessons", () => {
  const lessons = [lesson("a"), lesson("b", { missing: "a film" }), lesson("c")];
  assert.equal(neighbor(lessons, lessons[0], 1), lessons[2]);
  assert.equal(neighbor(lessons, lessons[2], -1), lessons[0]);
  assert.equal(neighbor(lessons, lessons[2], 1), null);
  assert.equal(neighbor(lessons, null, 1), lessons[0]);
});

test("a page of the lecture has the lesson that covers it", () => {
  const lessons = [lesson("a", { pages: "5, 7-9" }), lesson("b", { pages: "33-34" }), lesson("c", { pages: "8, 10" })];
  assert.equal(lessonOf(lessons, 5)?.id, "a");
  assert.equal(lessonOf(lessons, 8)?.id, "a");
  assert.equal(lessonOf(lessons, 10)?.id, "c");
  assert.equal(lessonOf(lessons, 34)?.id, "b");
  assert.equal(lessonOf(lessons, 6), null);
});
