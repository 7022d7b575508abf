// Creates elements in one call, and wraps browser functions that need more than one line.
export type Child = Node | string | null;

export function element<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  attributes: Record<string, string | boolean | undefined> = {},
  ...children: Child[]
): HTMLElementTagNameMap[Tag] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === true) made.setAttribute(name, "");
    else if (value !== false && value !== undefined) made.setAttribute(name, value);
  }
  made.append(...children.filter((child) => child !== null));
  return made;
}

export function listOf(texts: readonly string[]): HTMLUListElement {
  return element("ul", {}, ...texts.map((text) => element("li", {}, text)));
}

// Outlines in a square of 24 units.
const kIcons = {
  play: "M7 4l13 8-13 8z",
  pause: "M7 4h4v16H7zM14 4h4v16h-4z",
  step: "M5 4l10 8-10 8zM17 4h3v16h-3z",
  iterate: "M12 4a8 8 0 1 0 8 8h-3a5 5 0 1 1-5-5v3l6-4.5L12 1z",
  reset: "M5 4h3v16H5zM20 4v16L9 12z",
  close: "M6 4l6 6 6-6 2 2-6 6 6 6-2 2-6-6-6 6-2-2 6-6-6-6z",
  theme: "M12 3a9 9 0 1 0 0 18 9 9 0 0 0 0-18zm0 2v14a7 7 0 0 1 0-14z",
} as const;
export type IconName = keyof typeof kIcons;

export function svgElement(tag: string, attributes: Record<string, string>, ...children: SVGElement[]): SVGElement {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

export function icon(name: IconName): SVGElement {
  const path = svgElement("path", { d: kIcons[name], "fill-rule": "evenodd" });
  return svgElement("svg", { viewBox: "0 0 24 24", "aria-hidden": "true", class: "icon" }, path);
}

export interface ButtonOptions {
  text?: string;
  icon?: IconName;
  label?: string; // name for screen readers, if it differs from the text
  title?: string;
  steers?: boolean; // disabled in a page that only watches
}

export function button(options: ButtonOptions, run: () => void): HTMLButtonElement {
  const made = element(
    "button",
    { type: "button", title: options.title ?? options.label ?? "", "data-steers": options.steers ?? false },
    options.icon ? icon(options.icon) : null,
    options.text ?? null,
  );
  if (options.label) made.setAttribute("aria-label", options.label);
  made.addEventListener("click", (event) => {
    // After a click by mouse the shortcuts keep the keyboard: Space plays and does not click again.
    if (event.detail > 0) made.blur();
    run();
  });
  return made;
}

export function labeled(text: string, control: HTMLElement, title = ""): HTMLLabelElement {
  return element("label", { title, class: "labeled" }, element("span", {}, text), control);
}

// Opens a modal dialog, which is removed when it closes.
export function openDialog(title: string, content: Child[], className = ""): HTMLDialogElement {
  const heading = element("h2", {}, title);
  const dialog = element("dialog", { "aria-label": title, class: className });
  const close = button({ icon: "close", label: "Close" }, () => dialog.close());
  dialog.append(element("header", {}, heading, close), ...content.filter((child) => child !== null));
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
  return dialog;
}

// Opens a dialog with a form. It closes when `run` has succeeded; otherwise it shows why it failed.
export function openForm(title: string, fields: Child[], submit: string, run: () => Promise<unknown>, after: Child[] = []): void {
  const problem = element("p", { class: "problem", role: "alert" });
  const submitter = element("button", { type: "submit", class: "primary" }, submit);
  const form = element("form", {}, ...fields, problem, element("div", { class: "actions" }, submitter));
  const dialog = openDialog(title, [form, ...after]);
  form.addEventListener("click", () => (problem.textContent = ""));
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    submitter.disabled = true;
    run()
      .then(() => dialog.close())
      .catch((reason: unknown) => (problem.textContent = messageOf(reason)))
      .finally(() => (submitter.disabled = false));
  });
}

export function selectOf(options: readonly (readonly [value: string, text: string])[]): HTMLSelectElement {
  return element("select", {}, ...options.map(([value, text]) => element("option", { value }, text)));
}

// File name from letters, digits and characters that every file system accepts.
export function fileName(name: string, extension: string): string {
  const plain = name.replace(/[^\w.-]+/g, "_").replace(/^[_.]+|_+$/g, "");
  return `${plain || "aspic"}.${extension}`;
}

export function saveFile(name: string, content: Blob): void {
  const url = URL.createObjectURL(content);
  element("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 60_000);
}

export function png(canvas: HTMLCanvasElement): Promise<Blob> {
  return new Promise((resolve, reject) =>
    canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("there is no picture"))), "image/png"),
  );
}

export async function downloadCanvas(name: string, canvas: HTMLCanvasElement): Promise<void> {
  saveFile(fileName(name, "png"), await png(canvas));
}

export function chooseFiles(attributes: { accept?: string; multiple?: boolean }): Promise<File[]> {
  const input = element("input", { type: "file", ...attributes });
  return new Promise((resolve) => {
    for (const end of ["change", "cancel"]) input.addEventListener(end, () => resolve([...(input.files ?? [])]));
    input.click();
  });
}

export function messageOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
