import assert from "node:assert/strict";
import { test } from "node:test";
import { unpackXz } from "../src/xz";

const kText = "An elastic body minimizes its energy. ".repeat(3);
// By: xz --check=crc32 --lzma2=preset=9e,lc=4,pb=0
const kPacked =
  "/Td6WFoAAAFpIt42AgAhARwAAAAQz1jM4ABxACwEACCcXGiGNGLbB/+Fhz2iWPsdn4Bbx2t9zNRaZVvJs0qUm0ND2ceGcIobjYAAAMRwdpQAAURyOi+YCpBCmQ0BAAAAAAFZWg==";

const textOf = async (base64: string): Promise<string> => new TextDecoder().decode(await unpackXz(base64));

test("unpacks what xz has packed", async () => {
  assert.deepEqual(await Promise.all([textOf(kPacked), textOf(kPacked)]), [kText, kText]);
});

test("damaged data are refused", async () => {
  const changed = kPacked.replace("GiGNGLbB", "GiGNGLbC");
  for (const damaged of ["", kPacked.slice(0, 40), kPacked.slice(0, 100), kPacked.slice(0, 132), changed, btoa("no xz"), "#"]) await assert.rejects(unpackXz(damaged), /damaged/);
  assert.equal(await textOf(kPacked), kText);
});
