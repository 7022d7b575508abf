// Animated GIF [GIF89a, CompuServe 1990]: one palette for all pictures, ordered dithering, LZW compression.
const kLevels = [6, 7, 6] as const; // levels of red, green and blue: 252 colors
const kCodeSize = 8;
const kClear = 1 << kCodeSize;
const kEnd = kClear + 1;
const kMostCodes = 4096;
const kBayer = [0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5]; // thresholds of 4 x 4 pixels

const word = (value: number): number[] => [value & 0xff, (value >> 8) & 0xff];

export class Gif {
  private readonly parts: BlobPart[] = [];

  constructor(
    private readonly width: number,
    private readonly height: number,
  ) {
    const palette = new Uint8Array(3 * 256);
    const [reds, greens, blues] = kLevels;
    for (let i = 0; i < reds * greens * blues; ++i) {
      const levels = [Math.floor(i / (greens * blues)), Math.floor(i / blues) % greens, i % blues];
      levels.forEach((level, c) => (palette[3 * i + c] = Math.round((255 * level) / (kLevels[c]! - 1))));
    }
    const head = [..."GIF89a"].map((letter) => letter.charCodeAt(0));
    const repeated = [0x21, 0xff, 11, ...[..."NETSCAPE2.0"].map((letter) => letter.charCodeAt(0)), 3, 1, 0, 0, 0];
    this.parts.push(Uint8Array.from([...head, ...word(width), ...word(height), 0xf7, 0, 0]), palette, Uint8Array.from(repeated));
  }

  // Adds a picture. `rgba` has 4 bytes per pixel; `delay` is its duration in hundredths of a second.
  add(rgba: Uint8ClampedArray, delay: number): void {
    const control = [0x21, 0xf9, 4, 0, ...word(delay), 0, 0];
    const image = [0x2c, 0, 0, 0, 0, ...word(this.width), ...word(this.height), 0, kCodeSize];
    this.parts.push(Uint8Array.from([...control, ...image]), blocks(compressed(this.colors(rgba))));
  }

  blob(): Blob {
    return new Blob([...this.parts, Uint8Array.of(0x3b)], { type: "image/gif" });
  }

  private colors(rgba: Uint8ClampedArray): Uint8Array {
    const pixels = new Uint8Array(this.width * this.height);
    for (let i = 0; i < pixels.length; ++i) {
      const threshold = (kBayer[4 * (Math.floor(i / this.width) % 4) + ((i % this.width) % 4)]! + 0.5) / 16;
      let color = 0;
      for (let c = 0; c < 3; ++c) {
        const top = kLevels[c]! - 1;
        color = color * kLevels[c]! + Math.min(top, Math.floor((rgba[4 * i + c]! / 255) * top + threshold));
      }
      pixels[i] = color;
    }
    return pixels;
  }
}

function compressed(pixels: Uint8Array): number[] {
  const bytes: number[] = [];
  let [bits, count, size] = [0, 0, kCodeSize + 1];
  const put = (code: number): void => {
    bits |= code << count;
    for (count += size; count >= 8; count -= 8, bits >>>= 8) bytes.push(bits & 0xff);
  };
  const known = new Map<number, number>(); // (code, next color) -> code
  let next = kEnd + 1;
  put(kClear);
  let last = pixels[0]!;
  for (let i = 1; i < pixels.length; ++i) {
    const longer = (last << kCodeSize) | pixels[i]!;
    const code = known.get(longer);
    if (code !== undefined) {
      last = code;
      continue;
    }
    put(last);
    if (next < kMostCodes) {
      known.set(longer, next);
      if (next === 1 << size) size += 1;
      next += 1;
    } else {
      put(kClear);
      known.clear();
      [size, next] = [kCodeSize + 1, kEnd + 1];
    }
    last = pixels[i]!;
  }
  put(last);
  put(kEnd);
  if (count > 0) bytes.push(bits & 0xff);
  return bytes;
}

function blocks(bytes: number[]): Uint8Array<ArrayBuffer> {
  const made = new Uint8Array(bytes.length + Math.ceil(bytes.length / 255) + 1);
  let at = 0;
  for (let i = 0; i < bytes.length; i += 255) {
    const block = bytes.slice(i, i + 255);
    made[at] = block.length;
    made.set(block, at + 1);
    at += 1 + block.length;
  }
  return made;
}
