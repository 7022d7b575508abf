// The two canvases of a view, the body below and texts and thin shapes above, and a message over them.
import { element, png } from "../dom";
import type { Lens } from "./lens";
import { Overlay, type Marks, type Style } from "./overlay";
import { MeanPicture } from "./meanPicture";
import { Stage } from "./stage";

export class Screen {
  readonly canvas = element("canvas");
  readonly overlay = new Overlay();
  readonly message = element("div", { class: "view-message", hidden: true });
  readonly stage: Stage | null = null; // null without WebGL

  constructor() {
    try {
      this.stage = new Stage(this.canvas);
    } catch {
      this.showMessage(
        "This browser cannot draw in 3-D: WebGL 2 is missing or disabled. Enable hardware acceleration in its " +
          "settings, or use a current Firefox, Chromium or Safari. Plots and numbers work without it.",
      );
    }
  }

  showMessage(words: string): void {
    this.message.textContent = words;
    this.message.hidden = words === "";
  }

  // `width`: of the lens and the strip beside it [px]. `ratio`: device pixels per pixel.
  draw(lens: Lens, width: number, ratio: number, style: Style, marks: Marks): void {
    if (!this.stage) return;
    const { canvas } = this.overlay;
    const [columns, rows] = [Math.floor(width * ratio), Math.floor(lens.height * ratio)];
    if (canvas.width !== columns || canvas.height !== rows || this.canvas.width !== Math.floor(lens.width * ratio)) {
      this.stage.renderer.setPixelRatio(ratio);
      this.stage.renderer.setSize(lens.width, lens.height, false);
      this.canvas.style.width = `${lens.width}px`;
      [canvas.width, canvas.height] = [columns, rows];
    }
    this.stage.render(lens, style.accent);
    this.overlay.draw(lens, style, marks);
  }

  // PNG of both canvases, right after drawing.
  picture(body = this.canvas): Promise<Blob> {
    const { width, height } = this.overlay.canvas;
    const canvas = Object.assign(element("canvas"), { width, height });
    const context = canvas.getContext("2d")!;
    for (const layer of [body, this.overlay.canvas]) context.drawImage(layer, 0, 0);
    return png(canvas);
  }

  // PNG in soft light: the mean of pictures that differ in the directions of light.
  softPicture(lens: Lens, style: Style, samples: number): Promise<Blob> {
    const mean = new MeanPicture(this.canvas.width, this.canvas.height);
    for (let i = 0; i < samples; ++i) {
      this.stage?.lightSoftly(i, samples);
      this.stage?.render(lens, style.accent);
      mean.add(this.canvas);
    }
    return this.picture(mean.draw());
  }
}
