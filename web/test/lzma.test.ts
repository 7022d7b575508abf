import assert from "node:assert/strict";
import { test } from "node:test";
import { unpackLzma } from "../src/lzma";

// By: xz --format=lzma --lzma1=preset=9e,lc=4,pb=0
const kPacked = "BAAAAAT//////////wAgnFxohjRi2wf/hYc9olj7HZ+AW8drfczUWmVbybNKlJtDQ9nHhnCKG866JTwNTdkb32M6lmgfORNBFtK7cyp8So0F/xO+K6AFcYa6pZiG3xK7HDL/Ghq4gxkYfgr4Ku/H9SPE1RbizV3gKAP+rz6D+N2Q2ygmOIo0NAO2Xbtt7TatJzfMA8BIPZ//1E9zIA==";
const kSize = 319;

// Has long matches, repeated distances and literals.
function text(): string {
  const symbols = Array.from({ length: 120 }, (_, i) => String.fromCharCode(33 + ((i * 7) % 90)));
  return `${"An elastic body minimizes its energy. ".repeat(3)}${symbols.join("")}${" elastic elastic body".repeat(4)}\n`;
}

test("unpacks what xz has packed", () => {
  assert.equal(new TextDecoder().decode(unpackLzma({ size: kSize, lzma: kPacked })), text());
});

test("incomplete data are refused", () => {
  assert.throws(() => unpackLzma({ size: kSize, lzma: kPacked.slice(0, 100) }), /damaged/);
});

test("matches outside the data are refused", () => {
  assert.throws(() => unpackLzma({ size: 60, lzma: kPacked }), /damaged/);
});
