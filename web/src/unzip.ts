// Reads ZIP archives of the program: files stored or deflated, without encryption.
export interface NamedBytes {
  name: string;
  bytes: Uint8Array<ArrayBuffer>;
}

const kEnd = 0x06054b50;
const kEntry = 0x02014b50;
const kLocal = 0x04034b50;
const kEndSize = 22;
const kLongestComment = 0xffff;
const kMostFiles = 1000;

const damaged = (): Error => new Error("the ZIP archive is damaged or of an unsupported kind");

// `most`: limit of bytes of all files together, so that a small archive cannot exhaust the memory.
export async function unzip(archive: ArrayBuffer, most: number): Promise<NamedBytes[]> {
  const view = new DataView(archive);
  const files: NamedBytes[] = [];
  let left = most;
  try {
    const end = endOf(view);
    const count = view.getUint16(end + 10, true);
    if (count > kMostFiles) throw new Error(`the ZIP archive contains ${count} files; the limit is ${kMostFiles}`);
    let at = view.getUint32(end + 16, true);
    for (let i = 0; i < count; ++i) {
      if (view.getUint32(at, true) !== kEntry) throw damaged();
      const nameLength = view.getUint16(at + 28, true);
      const name = new TextDecoder().decode(new Uint8Array(archive, at + 46, nameLength));
      if (!name.endsWith("/")) {
        const bytes = await contentOf(view, at, left);
        left -= bytes.length;
        files.push({ name, bytes });
      }
      at += 46 + nameLength + view.getUint16(at + 30, true) + view.getUint16(at + 32, true);
    }
  } catch (reason) {
    throw reason instanceof RangeError ? damaged() : reason;
  }
  return files;
}

function endOf(view: DataView): number {
  const first = Math.max(0, view.byteLength - kEndSize - kLongestComment);
  for (let at = view.byteLength - kEndSize; at >= first; --at) if (view.getUint32(at, true) === kEnd) return at;
  throw damaged();
}

async function contentOf(view: DataView, entry: number, most: number): Promise<Uint8Array<ArrayBuffer>> {
  const [flags, method] = [view.getUint16(entry + 8, true), view.getUint16(entry + 10, true)];
  const packedSize = view.getUint32(entry + 20, true);
  const local = view.getUint32(entry + 42, true);
  if (flags & 1 || view.getUint32(local, true) !== kLocal || (method !== 0 && method !== 8)) throw damaged();
  const start = local + 30 + view.getUint16(local + 26, true) + view.getUint16(local + 28, true);
  const packed = new Uint8Array(view.buffer as ArrayBuffer, start, packedSize);
  if (method === 0) return within([packed], most);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  const parts: Uint8Array[] = [];
  let size = 0;
  const reader = stream.getReader();
  for (;;) {
    const { done, value } = await reader.read().catch(() => Promise.reject(damaged()));
    if (done) return within(parts, most);
    size += value.length;
    if (size > most) return within([...parts, value], most);
    parts.push(value);
  }
}

function within(parts: Uint8Array[], most: number): Uint8Array<ArrayBuffer> {
  const size = parts.reduce((sum, part) => sum + part.length, 0);
  if (size > most) throw new Error(`the files in the ZIP archive exceed ${Math.round(most / 1e6)} MB`);
  const bytes = new Uint8Array(size);
  let at = 0;
  for (const part of parts) {
    bytes.set(part, at);
    at += part.length;
  }
  return bytes;
}
