// Number formats for people.

import { unitScale } from './units';

/** About `digits` significant digits, without trailing rounding noise. */
export function numberText(value: number, digits = 5): string {
  if (!Number.isFinite(value)) return '–';
  if (value === 0 || Math.abs(value) < 1e-12) return '0';
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-3) return value.toExponential(digits - 1).replace(/\.?0+e/, 'e');
  return String(Number(value.toPrecision(digits)));
}

/** The value with its unit, prefixed: "76.4 kN". */
export function quantityText(value: number, unit: string, digits = 5): string {
  if (!Number.isFinite(value) || !unit) return numberText(value, digits);
  const scale = unitScale(Math.abs(value) < 1e-12 ? 0 : value, unit);
  return `${numberText(value / scale.factor, digits)} ${scale.prefix}${unit}`;
}

/** Time [s] with enough decimals to distinguish steps of `dt`. */
export function timeText(time: number, dt: number): string {
  const decimals = Math.min(Math.max(Math.ceil(-Math.log10(dt)), 2), 6);
  return time.toFixed(decimals);
}
