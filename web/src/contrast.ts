// Contrast of two colours by WCAG 2: (L + 0.05) / (l + 0.05) of their relative luminances.

/** Smallest contrast of text and of curves with their background. */
export const leastContrast = 4.5;
/** Smallest contrast of bodies with the background, that of graphical objects by WCAG 2. */
export const leastBodyContrast = 3;

type Rgb = [number, number, number];

const parse = (hex: string): Rgb =>
  [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16)) as Rgb;

function luminance(color: Rgb): number {
  const [r, g, b] = color.map((byte) => {
    const share = byte / 255;
    return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

function contrastOf(a: Rgb, b: Rgb): number {
  const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y);
  return (high + 0.05) / (low + 0.05);
}

/** Contrast of two colours "#rrggbb": 1 for equal ones, 21 for black and white. */
export const contrast = (a: string, b: string): number => contrastOf(parse(a), parse(b));

/**
 * The colour, mixed with as much white as it needs on a dark background "#rrggbb", or black on a
 * light one.
 */
export function readable(color: string, background: string, least = leastContrast): string {
  const from = parse(color);
  const ground = parse(background);
  const to = luminance(ground) < 0.18 ? 255 : 0;
  for (let share = 0; share <= 1; share += 0.02) {
    const mixed = from.map((byte) => Math.round(byte + share * (to - byte))) as Rgb;
    if (contrastOf(mixed, ground) < least) continue;
    return `#${mixed.map((byte) => byte.toString(16).padStart(2, '0')).join('')}`;
  }
  return to > 0 ? '#ffffff' : '#000000';
}
