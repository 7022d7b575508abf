// Reads the ZIP archives of the program.
import { unzipSync } from "three/addons/libs/fflate.module.js";

export interface NamedBytes {
  name: string;
  bytes: Uint8Array<ArrayBuffer>;
}

const kMostFiles = 1000;

// `most`: maximum bytes of all files together, so that a small archive cannot exhaust the memory.
export function unzip(archive: ArrayBuffer, most: number): NamedBytes[] {
  let [count, size] = [0, 0];
  let excess = "";
  const fits = ({ name, originalSize }: { name: string; originalSize: number }): boolean => {
    [count, size] = [count + 1, size + originalSize];
    if (count > kMostFiles) excess = `the ZIP archive contains more than ${kMostFiles} files`;
    if (size > most) excess = `the files in the ZIP archive exceed ${Math.round(most / 1e6)} MB`;
    if (excess) throw new Error(excess);
    return !name.endsWith("/");
  };
  try {
    const files = unzipSync(new Uint8Array(archive), { filter: fits });
    return Object.entries(files).map(([name, bytes]) => ({ name, bytes: bytes as Uint8Array<ArrayBuffer> }));
  } catch {
    throw new Error(excess || "the ZIP archive is damaged or of an unsupported kind");
  }
}
