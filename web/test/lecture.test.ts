import assert from "node:assert/strict";
import { test } from "node:test";
import { addressOf, lessonAt, matches, neighbor } from "../src/lecture";
import type { Lesson } from "../src/protocol";

const lesson = (id: string, more: Partial<Lesson> = {}): Lesson => ({
  id,
  pages: "33-34",
  title: "The mouse pulls",
  claim: "A spring.",
  exercise: "",
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

test("an address opens the lesson that covers its page", () => {
  const lessons = [lesson("a", { pages: "5, 7-9" }), lesson("b", { pages: "33-34" }), lesson("c", { pages: "8, 10" })];
  assert.equal(lessonAt(lessons, "#lecture/5")?.id, "a");
  assert.equal(lessonAt(lessons, "#lecture/8")?.id, "a");
  assert.equal(lessonAt(lessons, "#lecture/8/2")?.id, "c");
  assert.equal(lessonAt(lessons, "#lecture/10")?.id, "c");
  assert.equal(lessonAt(lessons, "#lecture/34")?.id, "b");
  for (const none of ["#lecture/6", "#lecture/8/3", "#lecture/8/0"]) assert.equal(lessonAt(lessons, none), null, none);
  for (const other of ["", "#s=abc", "#lecture/x", "#lecture/8/"]) assert.equal(lessonAt(lessons, other), undefined, other);
});

test("each lesson has an address, also beside others on the same pages", () => {
  const lessons = [lesson("a"), lesson("b"), lesson("c", { pages: "32-34" }), lesson("d", { pages: "34, 36" })];
  const addresses = lessons.map((each) => addressOf(lessons, each));
  assert.deepEqual(addresses, ["#lecture/33", "#lecture/33/2", "#lecture/32", "#lecture/36"]);
  assert.deepEqual(addresses.map((address) => lessonAt(lessons, address)), lessons);
});
