import assert from "node:assert/strict";
import { File } from "node:buffer"; // no global of Node.js 18
import { deflateRawSync } from "node:zlib";
import { test } from "node:test";
import { shelvesOf } from "../src/gallery";
import { isSceneOrMesh, mainFile, placed, prepareUpload } from "../src/upload";
import { unzip } from "../src/unzip";

const bytes = (text: string) => new TextEncoder().encode(text);
const file = (name: string, text: string) => new File([text], name) as unknown as globalThis.File;

test("the scene among several files is opened", () => {
  assert.equal(mainFile(["bunny.msh", "a/b/inner.toml", "a/outer.toml"]), "a/outer.toml");
  assert.equal(mainFile(["readme.txt", "bunny.obj"]), "bunny.obj");
  assert.equal(mainFile(["readme.txt"]), null);
  assert.ok(isSceneOrMesh("A.OBJ") && isSceneOrMesh("b.zip") && !isSceneOrMesh("c.json"));
});

test("files are placed where the scene expects", () => {
  const files = [
    { name: "beam.toml", bytes: bytes('mesh = "../assets/beam.msh"\nskin = "skin.obj"') },
    { name: "beam.msh", bytes: bytes("") },
    { name: "skin.obj", bytes: bytes("") },
    { name: "other.csv", bytes: bytes("") },
  ];
  assert.deepEqual(placed(files, "beam.toml").map(({ name }) => name), ["scene/beam.toml", "assets/beam.msh", "scene/skin.obj", "scene/other.csv"]);
});

test("file names stay inside the upload", () => {
  const files = [
    { name: "a.toml", bytes: bytes('mesh = "../../../etc/b.msh"') },
    { name: "b.msh", bytes: bytes("") },
  ];
  for (const { name } of placed(files, "a.toml")) assert.doesNotMatch(name, /\.\.|^\//);
});

test("rejects uploads without scene or mesh", async () => {
  await assert.rejects(prepareUpload([file("a.txt", "hello")]), /a\.txt: contains no scene/);
});

test("an upload is packed for the program", async () => {
  const { scene, files } = await prepareUpload([file("a.msh", "mesh")]);
  assert.equal(scene, "a.msh");
  assert.deepEqual(files.map(({ name }) => name), ["a.msh"]);
  assert.match(files[0]!.gzip, /^H4sI/);
});

// One deflated file and one stored, with the sizes in the central directory alone.
function archive(): ArrayBuffer {
  const entries = [
    { name: "s/a.toml", method: 8, content: "x = 1\n".repeat(100) },
    { name: "s/b.msh", method: 0, content: "mesh" },
  ];
  const parts: Buffer[] = [];
  const directory: Buffer[] = [];
  let at = 0;
  for (const { name, method, content } of entries) {
    const data = method === 8 ? deflateRawSync(content) : Buffer.from(content);
    const local = Buffer.alloc(30);
    local.writeUInt32LE(0x04034b50, 0);
    local.writeUInt16LE(name.length, 26);
    const central = Buffer.alloc(46);
    central.writeUInt32LE(0x02014b50, 0);
    central.writeUInt16LE(method, 10);
    central.writeUInt32LE(data.length, 20);
    central.writeUInt32LE(content.length, 24);
    central.writeUInt16LE(name.length, 28);
    central.writeUInt32LE(at, 42);
    parts.push(local, Buffer.from(name), data);
    directory.push(central, Buffer.from(name));
    at += 30 + name.length + data.length;
  }
  const end = Buffer.alloc(22);
  end.writeUInt32LE(0x06054b50, 0);
  for (const place of [8, 10]) end.writeUInt16LE(entries.length, place);
  end.writeUInt32LE(at, 16);
  return new Uint8Array(Buffer.concat([...parts, ...directory, end])).buffer;
}

test("an archive is unpacked within its limit", () => {
  const files = unzip(archive(), 1000);
  assert.deepEqual(files.map(({ name }) => name), ["s/a.toml", "s/b.msh"]);
  assert.equal(new TextDecoder().decode(files[0]!.bytes), "x = 1\n".repeat(100));
  assert.throws(() => unzip(archive(), 500), /exceed/);
});

test("a damaged archive is refused", () => {
  assert.throws(() => unzip(new ArrayBuffer(10), 1000), /damaged/);
  assert.throws(() => unzip(archive().slice(20), 1000), /damaged|exceed/);
});

test("scenes are grouped by folder", () => {
  const shelves = shelvesOf([
    { name: "bunny.toml", about: "", picture: "", path: "/s/bunny.toml" },
    { name: "lecture/33_mouse.toml", about: "", picture: "", path: "/s/lecture/33_mouse.toml" },
  ]);
  assert.deepEqual(shelves.map(({ title, entries }) => [title, entries[0]!.name]), [["Scenes", "bunny"], ["Lecture", "33_mouse"]]);
});
