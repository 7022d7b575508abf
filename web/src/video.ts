// Screenshots and videos of the views.
import { button, downloadCanvas, element, fileName, messageOf, saveFile } from "./dom";
import type { Page } from "./page";
import { shortcutButton } from "./shortcuts";
import type { Store } from "./store";

export interface Layers {
  canvases: HTMLCanvasElement[]; // canvases of one view, from bottom to top
  label: string; // "": no label
}
export type DrawViews = () => Layers[];

const kFramesPerSecond = 30;
const kBitsPerSecond = 8_000_000;
const kChunk = 250; // length of a chunk [ms]
const kLongestWait = 30_000; // longest wait for the first picture of a slow encoder [ms]
const kTypes = ["video/mp4;codecs=avc1", "video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"];

const hasPicture = (chunks: Blob[]): boolean => chunks.some(({ size }) => size > 0);

// Draws the views side by side over the background of the page.
function compose(target: HTMLCanvasElement, views: Layers[]): void {
  const widths = views.map(({ canvases }) => Math.max(0, ...canvases.map((canvas) => canvas.width)));
  const heights = views.map(({ canvases }) => Math.max(0, ...canvases.map((canvas) => canvas.height)));
  // Encoders require even sizes.
  const width = widths.reduce((sum, each) => sum + each, 0) & ~1;
  const height = Math.max(0, ...heights) & ~1;
  const context = target.getContext("2d");
  if (!context || width === 0 || height === 0) throw new Error("there is nothing to show");
  if (target.width !== width || target.height !== height) Object.assign(target, { width, height });
  const style = getComputedStyle(document.body);
  context.fillStyle = style.backgroundColor;
  context.fillRect(0, 0, width, height);
  let left = 0;
  views.forEach(({ canvases, label }, i) => {
    for (const canvas of canvases) context.drawImage(canvas, left, 0);
    const em = parseFloat(style.fontSize) * devicePixelRatio;
    context.font = `${em}px ${style.fontFamily}`;
    context.textAlign = "center";
    context.fillStyle = style.color;
    context.fillText(label, left + widths[i] / 2, 1.5 * em);
    left += widths[i];
  });
}

// Draws a picture centered in a canvas, as large as fits. A video keeps its size when the layout changes.
function drawWithin(target: HTMLCanvasElement, picture: HTMLCanvasElement): void {
  const context = target.getContext("2d")!;
  const scale = Math.min(target.width / picture.width, target.height / picture.height);
  const [width, height] = [scale * picture.width, scale * picture.height];
  context.fillStyle = getComputedStyle(document.body).backgroundColor;
  context.fillRect(0, 0, target.width, target.height);
  context.drawImage(picture, (target.width - width) / 2, (target.height - height) / 2, width, height);
}

export function makeScreenshotButton(store: Store, page: Page, draw: DrawViews): HTMLButtonElement {
  const run = (): void => {
    const canvas = element("canvas");
    try {
      compose(canvas, draw());
    } catch (reason) {
      return page.notice(`No picture: ${messageOf(reason)}`, "error");
    }
    const name = `${store.name}_${store.state?.a.step ?? 0}`;
    downloadCanvas(name, canvas).catch(page.report);
  };
  return shortcutButton(page, { key: "p", does: "Picture of the view (PNG)", group: "File", run }, { text: "Picture (PNG)" });
}

export class Video {
  readonly opener: HTMLButtonElement;
  readonly indicator: HTMLButtonElement; // visible while it records
  private recorder: MediaRecorder | null = null;
  private chunks: Blob[] = [];
  private started = 0;
  private ended = Infinity; // time of the reader's stop; a slow encoder may have no picture yet

  constructor(
    private readonly store: Store,
    private readonly page: Page,
    private readonly draw: DrawViews,
  ) {
    const run = (): void => (this.recorder ? this.stop() : this.start());
    const shortcut = { key: "Shift+V", does: "Record a video of the view, or end it", group: "File", run } as const;
    this.opener = shortcutButton(page, shortcut, { text: "Record a video" });
    this.indicator = button({ title: "End the video (Shift+V)", label: "End the video" }, () => this.stop());
    this.indicator.className = "recording";
    this.indicator.hidden = true;
  }

  // Draws the present views on the canvas.
  picture(canvas: HTMLCanvasElement): void {
    compose(canvas, this.draw());
  }

  get isRecording(): boolean {
    return this.recorder !== null;
  }

  start(): void {
    const type = typeof MediaRecorder === "undefined" ? undefined : kTypes.find((t) => MediaRecorder.isTypeSupported(t));
    if (!type) return this.page.notice("This browser cannot record videos; aspic render can.", "error");
    try {
      const canvas = element("canvas");
      compose(canvas, this.draw());
      this.record(canvas, type);
    } catch (reason) {
      this.page.notice(`No video: ${messageOf(reason)}`, "error");
    }
  }

  private record(canvas: HTMLCanvasElement, type: string): void {
    const stream = canvas.captureStream(kFramesPerSecond);
    const recorder = new MediaRecorder(stream, { mimeType: type, videoBitsPerSecond: kBitsPerSecond });
    const chunks: Blob[] = [];
    recorder.ondataavailable = (event) => chunks.push(event.data);
    recorder.onstop = () => {
      stream.getTracks().forEach((track) => track.stop());
      if (!hasPicture(chunks)) return this.page.notice("The browser created no picture of the video.", "error");
      const extension = type.startsWith("video/mp4") ? "mp4" : "webm";
      saveFile(fileName(this.store.name, extension), new Blob(chunks, { type }));
    };
    recorder.onerror = () => {
      this.page.notice("The browser ended the video.", "error");
      this.finish();
    };
    recorder.start(kChunk);
    this.recorder = recorder;
    this.chunks = chunks;
    [this.started, this.ended] = [performance.now(), Infinity];
    this.follow(canvas, element("canvas"));
  }

  private follow(canvas: HTMLCanvasElement, picture: HTMLCanvasElement): void {
    if (!this.recorder) return;
    try {
      compose(picture, this.draw());
      drawWithin(canvas, picture);
    } catch {
      return this.finish(); // the views no longer exist
    }
    const wait = performance.now() - this.ended;
    if (wait >= 0 && (hasPicture(this.chunks) || wait > kLongestWait)) return this.finish();
    const seconds = Math.floor((performance.now() - this.started) / 1000);
    this.indicator.hidden = false;
    this.indicator.textContent = `${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, "0")}`;
    this.opener.textContent = "End the video";
    requestAnimationFrame(() => this.follow(canvas, picture));
  }

  // Ends the video as soon as it has a picture.
  stop(): void {
    this.ended = Math.min(this.ended, performance.now());
  }

  private finish(): void {
    if (this.recorder?.state === "recording") this.recorder.stop();
    this.recorder = null;
    this.indicator.hidden = true;
    this.opener.textContent = "Record a video";
  }
}
