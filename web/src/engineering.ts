/** Numbers in engineering units: three digits and a prefix. */

const PREFIXES: [number, string][] = [[1e9, 'G'], [1e6, 'M'], [1e3, 'k'], [1, ''], [1e-3, 'm'], [1e-6, 'µ'], [1e-9, 'n'], [1e-12, 'p']]

/** Three digits without an exponent: 0.0123, 1.23, 12.3, 123, 1230. */
export function threeDigits(value: number): string {
  const rounded = Number(value.toPrecision(3))
  if (rounded === 0) return '0'
  const size = Math.floor(Math.log10(Math.abs(rounded)))
  return size > 5 || size < -5 ? rounded.toExponential(2) : rounded.toFixed(Math.max(0, 2 - size))
}

export function engineering(value: number, unit: string): string {
  // Milli per metre reads like millimetres: a unit that is an inverse takes no prefix.
  if (unit.startsWith('1/')) return `${Math.abs(value) < 1e-6 ? '0' : threeDigits(value)} ${unit}`
  const rounded = Number(value.toPrecision(3))
  const size = Math.abs(rounded)
  if (!(size >= 1e-13)) return `0 ${unit}`
  const [scale, prefix] = PREFIXES.find(([scale]) => size >= scale) ?? PREFIXES[PREFIXES.length - 1]
  return `${threeDigits(rounded / scale)} ${prefix}${unit}`
}
