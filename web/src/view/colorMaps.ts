// Color maps from a few stops, interpolated in sRGB. Viridis and cividis (Nuñez, Anderton, Renslow 2018) have uniform
// lightness; they and blue-orange are distinguishable with any kind of color vision.
const kStops = {
  viridis: ["440154", "482475", "414487", "355f8d", "2a788e", "21918c", "22a884", "44bf70", "7ad151", "bddf26", "fde725"],
  cividis: ["00224e", "123570", "3b496c", "575d6d", "707173", "8a8678", "a59c74", "c3b369", "e1cc55", "fee838"],
  blue_orange: ["0b3c78", "1f6db5", "67a3d9", "b7d3ea", "f5f5f2", "fbcf9d", "f29e4c", "d3670f", "873800"],
};

export type MapName = keyof typeof kStops;
export const kMapNames = Object.keys(kStops) as MapName[];
export type Rgb = [number, number, number]; // 0 to 255, sRGB

export function colorAt(map: MapName, t: number): Rgb {
  const stops = kStops[map];
  const at = Math.min(1, Math.max(0, t)) * (stops.length - 1);
  const k = Math.min(stops.length - 2, Math.floor(at));
  const channel = (stop: string, c: number): number => parseInt(stop.slice(2 * c, 2 * c + 2), 16);
  const mixed = [0, 1, 2].map((c) => channel(stops[k], c) + (at - k) * (channel(stops[k + 1], c) - channel(stops[k], c)));
  return mixed as Rgb;
}

// Texels of the map, RGBA.
export function mapTexels(map: MapName, count: number): Uint8Array {
  const texels = new Uint8Array(4 * count);
  for (let i = 0; i < count; ++i) texels.set([...colorAt(map, i / (count - 1)).map(Math.round), 255], 4 * i);
  return texels;
}
