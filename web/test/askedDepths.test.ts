import assert from "node:assert/strict";
import { test } from "node:test";
import { AskedDepths } from "../src/capture/askedDepths";

test("notches continue from the latest request", () => {
  const asked = new AskedDepths();
  asked.ask(1, 0);
  asked.ask(2, 0);
  asked.hear(0); // still under way
  assert.equal(asked.last(0), 2);
  asked.hear(1);
  assert.equal(asked.last(1), 2);
  asked.ask(3, 1);
  asked.hear(1);
  assert.equal(asked.last(1), 3);
  asked.hear(3); // 2 was skipped
  assert.equal(asked.last(3), 3);
});

test("reported depths may differ in last digits", () => {
  const asked = new AskedDepths();
  asked.ask(0.005007513224813856, 0);
  asked.ask(0.005462741699796928, 0);
  asked.hear(0.005007513224813852);
  assert.equal(asked.last(0.005007513224813852), 0.005462741699796928);
});

test("depths of other pages and tips count", () => {
  const asked = new AskedDepths();
  asked.ask(1, 0);
  asked.hear(0.3); // set by the mouse
  assert.equal(asked.last(0.3), 0.3);
  asked.ask(0.5, 0.3);
  asked.hear(null);
  assert.equal(asked.last(0), 0);
});
