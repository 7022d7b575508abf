// Mean of pictures of one size, in linear light.
import { element } from "../dom";

const kFine = 4096; // entries of the table from linear light to sRGB
const linear = (x: number): number => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
const encoded = (x: number): number => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
const kLinear = Float32Array.from({ length: 256 }, (_, i) => linear(i / 255));
const kEncoded = Uint8ClampedArray.from({ length: kFine + 1 }, (_, i) => 255 * encoded(i / kFine));

export class MeanPicture {
  private readonly canvas: HTMLCanvasElement;
  private readonly context: CanvasRenderingContext2D;
  private count = 0;
  private readonly sums: Float32Array; // per pixel: red, green and blue times alpha, and alpha

  constructor(width: number, height: number) {
    this.canvas = Object.assign(element("canvas"), { width, height });
    this.context = this.canvas.getContext("2d", { willReadFrequently: true })!;
    this.sums = new Float32Array(4 * width * height);
  }

  add(picture: HTMLCanvasElement): void {
    const { width, height } = this.canvas;
    this.context.clearRect(0, 0, width, height);
    this.context.drawImage(picture, 0, 0);
    const { data } = this.context.getImageData(0, 0, width, height);
    for (let i = 0; i < data.length; i += 4) {
      const alpha = data[i + 3]!;
      for (let c = i; c < i + 3; ++c) this.sums[c]! += alpha * kLinear[data[c]!]!;
      this.sums[i + 3]! += alpha;
    }
    this.count += 1;
  }

  draw(): HTMLCanvasElement {
    const { width, height } = this.canvas;
    const image = this.context.createImageData(width, height);
    for (let i = 0; i < this.sums.length; i += 4) {
      const alpha = this.sums[i + 3]!;
      if (alpha === 0) continue;
      for (let c = i; c < i + 3; ++c) image.data[c] = kEncoded[Math.round((kFine * this.sums[c]!) / alpha)]!;
      image.data[i + 3] = Math.round(alpha / this.count);
    }
    this.context.putImageData(image, 0, 0);
    return this.canvas;
  }
}
