// Arrays and a JSON header in one text of bytes, as apps/viewer/recording_code.h packs them: u32 length of the JSON,
// the JSON, zeros up to a multiple of 4, then the arrays listed in its "arrays". All numbers are little-endian.
const kTypes = { u8: Uint8Array, u16: Uint16Array, u32: Uint32Array, f32: Float32Array };
export type Numbers = Uint8Array | Uint16Array | Uint32Array | Float32Array;

// Content of the page's element with this id, as the program writes it; null if there is none.
export function embedded<Content = string>(id: string): Content | null {
  const found = document.getElementById(id);
  return found ? (JSON.parse(found.textContent ?? "") as Content) : null;
}

export function bytesOf(base64: string): Uint8Array<ArrayBuffer> {
  return Uint8Array.from(atob(base64.trim()), (character) => character.charCodeAt(0));
}

// Bytes of base64 of gzip.
export async function unpacked(text: string): Promise<ArrayBuffer> {
  const stream = new Blob([bytesOf(text)]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

export class Pack<Head> {
  readonly head: Head;
  readonly arrays = new Map<string, Numbers>();

  constructor(bytes: ArrayBuffer) {
    const length = new DataView(bytes).getUint32(0, true);
    const json = new TextDecoder().decode(new Uint8Array(bytes, 4, length));
    const head = JSON.parse(json) as Head & { arrays: { name: string; type: keyof typeof kTypes; at: number; count: number }[] };
    this.head = head;
    const start = Math.ceil((4 + length) / 4) * 4;
    for (const { name, type, at, count } of head.arrays)
      this.arrays.set(name, new kTypes[type](bytes, start + at, count));
  }

  array(name: string): Numbers {
    const found = this.arrays.get(name);
    if (!found) throw new Error(`there is no '${name}'`);
    return found;
  }

  floats(name: string): Float32Array {
    return this.array(name) as Float32Array;
  }

  indices(name: string): Uint32Array {
    return this.array(name) as Uint32Array;
  }

  bytes(name: string): Uint8Array {
    return this.array(name) as Uint8Array;
  }
}
