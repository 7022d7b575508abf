// Decoder of LZMA, which packs WebAssembly a third better than the gzip of browsers. Format: "LZMA specification" of the
// LZMA SDK (Igor Pavlov, public domain), as `xz --format=lzma` writes it.

import { bytesOf } from "./pack";

const kDamaged = "this page is damaged or incomplete; download it again";

// Decodes bits whose probabilities it learns: an adaptive binary range coder.
class Bits {
  private range = 0xffffffff;
  private code = 0;
  private readonly chance: Uint16Array; // of a zero, in units of 1 / 2048

  constructor(
    private readonly bytes: Uint8Array,
    private place: number,
    contexts: number,
  ) {
    this.chance = new Uint16Array(contexts).fill(1024);
    for (let i = 0; i < 5; ++i) this.code = (this.code % 0x1000000) * 256 + this.next();
  }

  private next(): number {
    if (this.place >= this.bytes.length) throw new Error(kDamaged);
    return this.bytes[this.place++]!;
  }

  private normalize(): void {
    if (this.range >= 0x1000000) return;
    this.range *= 256;
    this.code = this.code * 256 + this.next();
  }

  bit(context: number): 0 | 1 {
    const chance = this.chance[context]!;
    const bound = (this.range >>> 11) * chance;
    const isZero = this.code < bound;
    if (isZero) {
      this.range = bound;
      this.chance[context] = chance + ((2048 - chance) >> 5);
    } else {
      this.range -= bound;
      this.code -= bound;
      this.chance[context] = chance - (chance >> 5);
    }
    this.normalize();
    return isZero ? 0 : 1;
  }

  // Bits of equal chances.
  plain(count: number): number {
    let value = 0;
    for (; count > 0; --count) {
      this.range = Math.floor(this.range / 2);
      const isOne = this.code >= this.range;
      if (isOne) this.code -= this.range;
      value = value * 2 + (isOne ? 1 : 0);
      this.normalize();
    }
    return value;
  }

  // A number of `count` bits, the highest first.
  number(context: number, count: number): number {
    let node = 1;
    for (let i = 0; i < count; ++i) node = 2 * node + this.bit(context + node);
    return node - (1 << count);
  }

  // The lowest first.
  reversed(context: number, count: number): number {
    let [node, value] = [1, 0];
    for (let i = 0; i < count; ++i) {
      const bit = this.bit(context + node);
      node = 2 * node + bit;
      value |= bit << i;
    }
    return value;
  }

  // A literal that differs from the byte `other` at the last distance.
  unlike(context: number, other: number): number {
    let node = 1;
    while (node < 0x100) {
      const expected = (other >> 7) & 1;
      other <<= 1;
      const bit = this.bit(context + ((1 + expected) << 8) + node);
      node = 2 * node + bit;
      if (bit === expected) continue;
      while (node < 0x100) node = 2 * node + this.bit(context + node);
    }
    return node & 0xff;
  }
}

// First contexts of the kinds of bits.
const kLengths = 2 + 2 * 16 * 8 + 256; // contexts of a kind of length
const kMatch = 0;
const kRepeat = kMatch + (12 << 4);
const kRepeat0 = kRepeat + 12;
const kRepeat1 = kRepeat0 + 12;
const kRepeat2 = kRepeat1 + 12;
const kLong = kRepeat2 + 12;
const kSlot = kLong + (12 << 4);
const kSpecial = kSlot + 4 * 64;
const kAlign = kSpecial + 128;
const kMatchLength = kAlign + 16;
const kRepeatLength = kMatchLength + kLengths;
const kLiteral = kRepeatLength + kLengths;

function lengthOf(bits: Bits, first: number, phase: number): number {
  if (bits.bit(first) === 0) return 2 + bits.number(first + 2 + 8 * phase, 3);
  if (bits.bit(first + 1) === 0) return 10 + bits.number(first + 2 + 128 + 8 * phase, 3);
  return 18 + bits.number(first + 2 + 256, 8);
}

function distanceOf(bits: Bits, length: number): number {
  const slot = bits.number(kSlot + 64 * Math.min(length - 2, 3), 6);
  if (slot < 4) return slot;
  const count = (slot >> 1) - 1;
  const first = (2 + (slot & 1)) * 2 ** count;
  if (slot < 14) return first + bits.reversed(kSpecial + first - slot, count);
  return first + bits.plain(count - 4) * 16 + bits.reversed(kAlign, 4);
}

export interface Packed {
  size: number; // bytes when unpacked
  lzma: string; // base64
}

// Throws an error if the data are damaged.
export function unpackLzma({ size, lzma }: Packed): Uint8Array<ArrayBuffer> {
  const out = new Uint8Array(size);
  const packed = bytesOf(lzma);
  const properties = packed[0]!;
  const [lc, lp, pb] = [properties % 9, Math.floor(properties / 9) % 5, Math.floor(properties / 45)];
  const bits = new Bits(packed, 13, kLiteral + (0x300 << (lc + lp)));
  const distances = [0, 0, 0, 0]; // less 1, the latest first
  let [at, state] = [0, 0];

  const literal = (): number => {
    const before = at > 0 ? out[at - 1]! : 0;
    const context = kLiteral + 0x300 * (((at & ((1 << lp) - 1)) << lc) + (before >> (8 - lc)));
    return state < 7 ? bits.number(context, 8) : bits.unlike(context, out[at - distances[0]! - 1]!);
  };
  const repeated = (phase: number): number => {
    if (bits.bit(kRepeat0 + state) === 0) {
      if (bits.bit(kLong + (state << 4) + phase) === 0) return 1;
    } else {
      const which = bits.bit(kRepeat1 + state) === 0 ? 1 : 2 + bits.bit(kRepeat2 + state);
      distances.unshift(...distances.splice(which, 1));
    }
    return lengthOf(bits, kRepeatLength, phase);
  };
  const matched = (phase: number): number => {
    const length = lengthOf(bits, kMatchLength, phase);
    distances.pop();
    distances.unshift(distanceOf(bits, length));
    return length;
  };

  while (at < size) {
    const phase = at & ((1 << pb) - 1);
    if (bits.bit(kMatch + (state << 4) + phase) === 0) {
      out[at] = literal();
      ++at;
      state = state < 4 ? 0 : state < 10 ? state - 3 : state - 6;
      continue;
    }
    const isRepeated = bits.bit(kRepeat + state) === 1;
    const length = (isRepeated ? repeated : matched)(phase);
    if (state >= 7) state = isRepeated ? 11 : 10;
    else state = isRepeated ? (length === 1 ? 9 : 8) : 7;
    const from = at - distances[0]! - 1;
    if (from < 0 || at + length > size) throw new Error(kDamaged);
    for (let i = 0; i < length; ++i) out[at + i] = out[from + i]!;
    at += length;
  }
  return out;
}
