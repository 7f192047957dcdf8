/** Perceptually uniform colours (viridis, sampled; van der Walt & Smith 2015) and what the thread can be coloured by. */

import type { Shape } from './protocol'

const VIRIDIS = ['440154', '482878', '3e4989', '31688e', '26828e', '1f9e89', '35b779', '6ece58', 'b5de2b', 'fde725']
const STOPS = VIRIDIS.map((hex) => [0, 2, 4].map((i) => (parseInt(hex.slice(i, i + 2), 16) / 255) ** 2.2))

/** A colour in linear light for `x` in [0, 1]. */
export function viridis(x: number): number[] {
  const place = Math.min(Math.max(x, 0), 1) * (STOPS.length - 1)
  const i = Math.min(Math.floor(place), STOPS.length - 2)
  return STOPS[i].map((a, k) => a + (STOPS[i + 1][k] - a) * (place - i))
}

export const gradient = `linear-gradient(90deg, ${VIRIDIS.map((hex) => '#' + hex).join(', ')})`

export interface Quantity {
  label: string
  unit: string
  value: (shape: Shape, element: number) => number
}

export const quantities: Record<string, Quantity | null> = {
  curvature: { label: 'Curvature', unit: '1/m', value: (s, e) => Math.hypot(s.strain[6 * e], s.strain[6 * e + 1]) },
  twist: { label: 'Twist', unit: '1/m', value: (s, e) => s.strain[6 * e + 2] },
  tension: { label: 'Tension', unit: 'N', value: (s, e) => s.stress[6 * e + 5] },
  moment: { label: 'Bending moment', unit: 'N·m', value: (s, e) => Math.hypot(s.stress[6 * e], s.stress[6 * e + 1]) },
  nothing: null,
}

const PREFIXES: [number, string][] = [[1e3, 'k'], [1, ''], [1e-3, 'm'], [1e-6, 'µ'], [1e-9, 'n']]

/** A number in engineering units, three digits. */
export function engineering(value: number, unit: string): string {
  const size = Math.abs(value)
  if (size < 1e-15) return `0 ${unit}`
  const [scale, prefix] = PREFIXES.find(([scale]) => size >= scale) ?? PREFIXES[PREFIXES.length - 1]
  return `${(value / scale).toPrecision(3)} ${prefix}${unit}`
}
