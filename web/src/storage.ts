// What a browser remembers between visits. A browser that refuses to, as in private windows, forgets; nothing else breaks.
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
