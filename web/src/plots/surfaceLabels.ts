// Texts in the picture of a surface: numbers at its axes and names of marks, as elements over the canvas.
import * as THREE from "three";
import { ticks } from "../view/ranges";
import { valueAtHeight } from "./grid";
import { short, tickTexts } from "../numbers";
import type { Color } from "./palette";
import type { SurfaceContent } from "./surfaceContent";
import type { Frame } from "./surfaceParts";

export interface Label {
  text: string;
  place: THREE.Vector3;
  color: Color;
  important: boolean; // placed first; others that would overlap it are omitted
}

export interface Placed {
  label: Label;
  x: number; // left and middle [CSS px]
  y: number;
}

// Positions of the texts on the screen. A text that would overlap another is omitted.
export function placed(
  labels: readonly Label[],
  axes: readonly Label[],
  camera: THREE.Camera,
  size: { width: number; height: number },
  em: number,
): Placed[] {
  const taken: { x: number; y: number; width: number }[] = [];
  const out: Placed[] = [];
  const add = (label: Label, beside: boolean): void => {
    const at = label.place.clone().project(camera);
    const width = label.text.length * em * 0.58;
    const left = (at.x * 0.5 + 0.5) * size.width + (beside ? 9 : -width / 2);
    const y = (-at.y * 0.5 + 0.5) * size.height + (beside ? (label.important ? -9 : 9) : 0);
    const x = Math.min(size.width - width - 2, Math.max(2, left));
    if (y < 0 || y > size.height) return;
    if (taken.some((t) => Math.abs(t.y - y) < em * 1.1 && x < t.x + t.width + 3 && t.x < x + width + 3)) return;
    taken.push({ x, y, width });
    out.push({ label, x, y });
  };
  for (const label of labels) if (label.important) add(label, true);
  for (const label of axes) add(label, false);
  for (const label of labels) if (!label.important) add(label, true);
  return out;
}

// Labels along the base's edges nearest to the reader, and along the leftmost post.
export function axisLabels(frame: Frame, names: SurfaceContent["axes"], camera: THREE.Camera): Label[] {
  const { x, y } = frame.grid;
  const [w, d] = [frame.width / 2, frame.depth / 2];
  const front = camera.position.z >= 0 ? d : -d;
  const side = camera.position.x >= 0 ? w : -w;
  const out: Label[] = [];
  const add = (text: string, place: THREE.Vector3, color: Color = "faint"): void =>
    void out.push({ text, place, color, important: false });
  const alongX = ticks(x[0]!, x[x.length - 1]!, 4);
  const alongY = ticks(y[0]!, y[y.length - 1]!, 4);
  add(names.x, new THREE.Vector3(0, -0.02, front * 1.34), "text");
  add(names.y, new THREE.Vector3(side * 1.42, -0.02, 0), "text");
  tickTexts(alongX).forEach((text, i) => add(text, new THREE.Vector3(frame.across(alongX[i]!), -0.02, front * 1.12)));
  tickTexts(alongY).forEach((text, i) => add(text, new THREE.Vector3(side * 1.12, -0.02, frame.away(alongY[i]!))));
  const onScreen = (p: THREE.Vector3): number => p.clone().project(camera).x;
  const post = frame.corners.reduce((left, p) => (onScreen(p) < onScreen(left) ? p : left));
  const toValue = valueAtHeight(frame.range, frame.scale);
  const { low, high } = frame.range;
  const even = frame.scale === "linear";
  const linear = even && high - low > 1e-3 * Math.max(Math.abs(low), Math.abs(high)); // avoids numbers of many digits
  const above = even ? ticks(0, high - low, 4).map((v) => low + v) : [0, 0.25, 0.5, 0.75, 1].map(toValue);
  const heights = linear ? ticks(low, high, 4) : above;
  const texts = linear ? tickTexts(heights) : heights.map((v) => short(v - low, 2));
  add(linear ? names.value : `${names.value} − lowest`, new THREE.Vector3(post.x, frame.tall * 1.12, post.z), "text");
  texts.forEach((text, i) =>
    add(text, new THREE.Vector3(post.x * 1.1, frame.height(heights[i]) * frame.tall, post.z * 1.1)),
  );
  return out;
}
