// Prefixes of units, as in scenes/unit_scale.cpp, so that a page, a still and a table show the same
// numbers.

export interface UnitScale {
  factor: number;
  prefix: string;
}

const usual = ['N', 'J', 'W', 'Pa', 'Hz', 'm', 's'];

/** The prefix for values about as large as `reference`, in a unit that usually takes one. */
export function unitScale(reference: number, unit: string): UnitScale {
  const plain = { factor: 1, prefix: '' };
  if (unit.includes(',') || !usual.includes(unit.split(/[ /]/)[0])) return plain;
  const size = Math.abs(reference);
  const large = unit === 's' ? plain : null;
  if (size >= 1e10) return large ?? { factor: 1e9, prefix: 'G' };
  if (size >= 1e7) return large ?? { factor: 1e6, prefix: 'M' };
  if (size >= 1e4) return large ?? { factor: 1e3, prefix: 'k' };
  if (size >= 0.1 || !(size > 0)) return plain;
  return size >= 1e-4 ? { factor: 1e-3, prefix: 'm' } : { factor: 1e-6, prefix: 'µ' };
}
