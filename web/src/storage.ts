// Values that the browser keeps between visits. Where storage is refused, as in private windows, they are lost without
// an error.
export function recall(key: string): string | null {
  try {
    return localStorage.getItem(`aspic.${key}`);
  } catch {
    return null;
  }
}

export function remember(key: string, value: string): void {
  try {
    localStorage.setItem(`aspic.${key}`, value);
  } catch {
    return;
  }
}
