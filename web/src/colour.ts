/**
 * Perceptually uniform colours, sampled: viridis (van der Walt & Smith 2015) and cividis, which a colour-blind eye reads in the same way
 * (Nuñez, Anderton & Renslow 2018); and what the thread can be coloured by.
 */

import type { Carried } from './protocol'

const STOPS: Record<string, string[]> = {
  viridis: ['440154', '482878', '3e4989', '31688e', '26828e', '1f9e89', '35b779', '6ece58', 'b5de2b', 'fde725'],
  cividis: ['00224e', '123570', '3b496c', '575d6d', '707173', '8a8678', 'a59c74', 'c3b369', 'e1cc55', 'fee838'],
}

function linear(part: number): number {
  return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4
}

const LINEAR = Object.fromEntries(
  Object.entries(STOPS).map(([name, stops]) => [
    name,
    stops.map((hex) => [0, 2, 4].map((i) => linear(parseInt(hex.slice(i, i + 2), 16) / 255))),
  ]),
)

export type MapName = 'viridis' | 'cividis'

/** Writes a colour in linear light for `x` in [0, 1]. */
export function colourAt(map: MapName, x: number, into: number[]): void {
  const stops = LINEAR[map]
  const place = Math.min(Math.max(x, 0), 1) * (stops.length - 1)
  const i = Math.min(Math.floor(place), stops.length - 2)
  for (let k = 0; k < 3; k++) into[k] = stops[i][k] + (stops[i + 1][k] - stops[i][k]) * (place - i)
}

export function gradient(map: MapName): string {
  return `linear-gradient(90deg, ${STOPS[map].map((hex) => `#${hex}`).join(', ')})`
}

export interface Quantity {
  label: string
  unit: string
  value: (of: Carried, element: number) => number
}

export const quantities: Record<string, Quantity | null> = {
  curvature: { label: 'Curvature', unit: '1/m', value: (s, e) => Math.hypot(s.strain[6 * e], s.strain[6 * e + 1]) },
  twist: { label: 'Twist', unit: '1/m', value: (s, e) => s.strain[6 * e + 2] },
  tension: { label: 'Tension', unit: 'N', value: (s, e) => s.stress[6 * e + 5] },
  moment: { label: 'Bending moment', unit: 'N·m', value: (s, e) => Math.hypot(s.stress[6 * e], s.stress[6 * e + 1]) },
  energy: { label: 'Elastic energy', unit: 'J/m', value: (s, e) => s.energyDensity[e] },
  nothing: null,
}

/** A quantity at the nodes, and its least and greatest value. */
export function atNodes(quantity: Quantity, of: Carried): { values: Float64Array; range: [number, number] } {
  const elements = of.strain.length / 6
  const values = new Float64Array(elements + 1)
  const range: [number, number] = [Infinity, -Infinity]
  for (let i = 0; i <= elements; i++) {
    const value = 0.5 * (quantity.value(of, Math.max(i - 1, 0)) + quantity.value(of, Math.min(i, elements - 1)))
    values[i] = value
    range[0] = Math.min(range[0], value)
    range[1] = Math.max(range[1], value)
  }
  return { values, range }
}
