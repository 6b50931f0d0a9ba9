// The colours of cables, as in render/color_map.cpp: the lower three quarters of "plasma" (van der
// Walt and Smith, CC0). Its lightness increases evenly, so the map is readable without
// distinguishing hues. Slack cable has a grey that is not in the map.

export type Color = [number, number, number];

const stops: Color[] = [
  0x2b0594, 0x4f02a2, 0x7201a8, 0x920fa3, 0xb02991, 0xc8437b, 0xdb5c68, 0xeb7655, 0xf79342,
].map(fromHex);

/**
 * The map begins with lighter colours on a dark background, on which its dark end would be
 * invisible.
 */
const darkStops: Color[] = [
  0x6f4fd8, 0x8548d6, 0x9d43cf, 0xb543bf, 0xcb4aa9, 0xdd5a90, 0xeb7076, 0xf68c5c, 0xfcac48,
].map(fromHex);

export const slackColor: Color = fromHex(0x8d98a5);

export function fromHex(hex: number): Color {
  return [((hex >> 16) & 255) / 255, ((hex >> 8) & 255) / 255, (hex & 255) / 255];
}

/** "#rrggbb" as red, green, blue in [0, 1]. */
export function parseColor(text: string): Color {
  return fromHex(parseInt(text.slice(1), 16));
}

export function toCss(color: Color): string {
  const byte = (x: number): string =>
    Math.round(255 * x)
      .toString(16)
      .padStart(2, '0');
  return '#' + color.map(byte).join('');
}

export function mix(a: Color, b: Color, t: number): Color {
  return [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t];
}

/** The colour at t; t outside [0, 1] is clamped. */
export function sample(t: number, dark = false): Color {
  const map = dark ? darkStops : stops;
  const position = Math.min(Math.max(Number.isNaN(t) ? 0 : t, 0), 1) * (map.length - 1);
  const index = Math.min(Math.floor(position), map.length - 2);
  return mix(map[index], map[index + 1], position - index);
}

/** Tensions below a millionth of the scale are rounding and count as 0. */
export function tensionColor(tension: number, tensionMax: number, dark = false): Color {
  return tension > 1e-6 * tensionMax ? sample(tension / tensionMax, dark) : slackColor;
}
