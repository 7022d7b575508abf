// Decompresses what site.mjs has packed by xz, which packs WebAssembly a quarter better than the gzip of browsers.
import { XzReadableStream } from "xz-decompress";
import { bytesOf } from "./pack";

// Bytes of base64 of xz. Rejects if the data are damaged.
export async function unpackXz(base64: string): Promise<Uint8Array<ArrayBuffer>> {
  try {
    const stream = new XzReadableStream(new Blob([bytesOf(base64)]).stream());
    return new Uint8Array(await new Response(stream).arrayBuffer());
  } catch {
    throw new Error("this page is damaged or incomplete; download it again");
  }
}
