/** The legend: what the colours say, and how much thicker than it is the thread is drawn. */

import { gradient, quantities } from './colour'
import { engineering } from './engineering'
import type { ViewOptions } from './stage'

export function showLegend(box: HTMLElement, view: ViewOptions, range: [number, number]): void {
  const quantity = quantities[view.colourBy]
  const part = (tag: string, text: string) => Object.assign(document.createElement(tag), { textContent: text })
  const lines: HTMLElement[] = []
  if (quantity) {
    const [low, high] = view.range ?? range
    const bar = document.createElement('i')
    bar.style.background = gradient(view.map)
    const ends = document.createElement('div')
    ends.append(part('span', engineering(low, quantity.unit)), part('span', engineering(high, quantity.unit)))
    lines.push(part('b', quantity.label + (view.range ? ' (fixed range)' : '')), bar, ends)
  }
  if (view.displayScale !== 1) lines.push(part('small', `drawn ${Number(view.displayScale.toPrecision(3))}× as thick`))
  box.hidden = lines.length === 0
  box.replaceChildren(...lines)
}
