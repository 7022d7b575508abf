// matplotlib's viridis: even in lightness, told apart by all eyes.
const kViridis = [
  [0.267, 0.005, 0.329],
  [0.283, 0.141, 0.458],
  [0.254, 0.265, 0.53],
  [0.207, 0.372, 0.553],
  [0.164, 0.471, 0.558],
  [0.128, 0.567, 0.551],
  [0.135, 0.659, 0.518],
  [0.267, 0.749, 0.441],
  [0.478, 0.821, 0.318],
  [0.741, 0.873, 0.15],
  [0.993, 0.906, 0.144],
] as const;

// Red, green, blue (sRGB) for t in [0, 1].
export function viridis(t: number): [number, number, number] {
  const at = Math.min(1, Math.max(0, t)) * (kViridis.length - 1);
  const i = Math.min(Math.floor(at), kViridis.length - 2);
  const [low, high] = [kViridis[i]!, kViridis[i + 1]!];
  const mix = (c: 0 | 1 | 2): number => low[c] + (at - i) * (high[c] - low[c]);
  return [mix(0), mix(1), mix(2)];
}
