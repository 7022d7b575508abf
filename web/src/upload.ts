// Packs files of the reader's machine for the command "load": a scene with its meshes, or a single mesh.
import { saveFile } from "./dom";
import { bytesOf } from "./pack";
import type { FileReply, SceneFilesReply, TextReply, UploadedFile } from "./protocol";
import { type NamedBytes, unzip } from "./unzip";

const kMostBytes = 200e6; // limit for all files together
const kMostPacked = 15e6; // longest message that the program accepts, in characters
const kMeshes = ["msh", "vtu", "mesh", "ele", "node", "obj", "ply", "stl", "off"];

const baseName = (path: string): string => path.slice(path.lastIndexOf("/") + 1);
const extensionOf = (name: string): string => (/\.([^./]+)$/.exec(name)?.[1] ?? "").toLowerCase();

export function isSceneOrMesh(name: string): boolean {
  return ["toml", "zip", ...kMeshes].includes(extensionOf(name));
}

// The scene in the fewest folders, or else a mesh. Null: neither.
export function mainFile(names: readonly string[]): string | null {
  const depth = (name: string): number => name.split("/").length;
  const scenes = names.filter((name) => extensionOf(name) === "toml");
  const meshes = names.filter((name) => kMeshes.includes(extensionOf(name)));
  return [...(scenes.length > 0 ? scenes : meshes)].sort((x, y) => depth(x) - depth(y))[0] ?? null;
}

// Browsers drop the folders of files. Files that a scene names are placed where it expects them, possibly in the parent
// of its folder.
export function placed(files: readonly NamedBytes[], scene: string): NamedBytes[] {
  const main = files.find(({ name }) => name === scene);
  if (!main || extensionOf(scene) !== "toml" || scene.includes("/")) return [...files];
  const text = new TextDecoder().decode(main.bytes);
  const named = [...text.matchAll(/["']([^"'\n]+)["']/g)].map((match) => match[1]!);
  return files.map((file) => {
    if (file === main) return { ...file, name: `scene/${scene}` };
    const wanted = named.find((path) => baseName(path) === baseName(file.name)) ?? file.name;
    const parts = ["scene"];
    for (const part of wanted.split("/")) {
      if (part === "..") parts.pop();
      else if (part !== "" && part !== ".") parts.push(part);
    }
    return { ...file, name: parts.join("/") };
  });
}

export async function prepareUpload(files: readonly File[]): Promise<Pick<SceneFilesReply, "scene" | "files">> {
  const total = files.reduce((sum, file) => sum + file.size, 0);
  if (total > kMostBytes) throw tooLarge(total);
  const read: NamedBytes[] = [];
  for (const file of files) {
    const bytes = await file.arrayBuffer();
    if (extensionOf(file.name) === "zip") read.push(...unzip(bytes, kMostBytes));
    else read.push({ name: file.name, bytes: new Uint8Array(bytes) });
  }
  const main = mainFile(read.map(({ name }) => name));
  if (!main) throw new Error(`${files.map((file) => file.name).join(", ")}: contains no scene (.toml) and no mesh (.${kMeshes.join(", .")})`);
  const ready = placed(read, main);
  const scene = ready[read.findIndex(({ name }) => name === main)]!.name;
  const packed = await Promise.all(ready.map(async ({ name, bytes }) => ({ name, gzip: await gzipBase64(bytes) })));
  if (packedSize(packed) > kMostPacked) throw tooLarge(total);
  return { scene, files: packed };
}

export function packedSize(files: readonly UploadedFile[]): number {
  return files.reduce((sum, { gzip }) => sum + gzip.length, 0);
}
export const isTooLarge = (files: readonly UploadedFile[]): boolean => packedSize(files) > kMostPacked;

function tooLarge(bytes: number): Error {
  const size = `${Math.round(bytes / 1e6)} MB`;
  return new Error(`${size} are too large to upload; load the scene by its path on the machine of the program`);
}

async function gzipBase64(bytes: Uint8Array<ArrayBuffer>): Promise<string> {
  return base64Of(await bytesThrough(new CompressionStream("gzip"), bytes));
}

// Compresses or decompresses. Rejects a result of more than `most` bytes with a RangeError.
export async function bytesThrough(
  packer: CompressionStream | DecompressionStream,
  bytes: Uint8Array<ArrayBuffer>,
  most = Infinity,
): Promise<Uint8Array<ArrayBuffer>> {
  const reader = new Blob([bytes]).stream().pipeThrough(packer).getReader();
  const parts: Uint8Array<ArrayBuffer>[] = [];
  let total = 0;
  for (let next = await reader.read(); !next.done; next = await reader.read()) {
    parts.push(next.value);
    total += next.value.length;
    if (total > most) {
      void reader.cancel();
      throw new RangeError(`more than ${most} bytes`);
    }
  }
  return new Uint8Array(await new Blob(parts).arrayBuffer());
}

const kPortion = 0x6000; // a multiple of 3, and within the argument limit of a call

export function base64Of(bytes: Uint8Array): string {
  let text = "";
  for (let at = 0; at < bytes.length; at += kPortion)
    text += btoa(String.fromCharCode(...bytes.subarray(at, at + kPortion)));
  return text;
}

export function saveReply(reply: TextReply | FileReply): void {
  saveFile(reply.name, new Blob(["text" in reply ? reply.text : bytesOf(reply.base64)]));
}
