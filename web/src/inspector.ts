/** The inspector: groups of controls that read and write the scene, the hand, its motion, the solver and the view. */

import { quantities, type MapName } from './colour'
import { checkbox, choice, numberInput, refuse, slide, slider, write } from './controls'
import { couplingFields, numberFields, starts, type SceneJson } from './fields'
import type { HandMode, Shape } from './protocol'
import type { Stage, ViewOptions } from './stage'

/** What the inspector asks of the page. */
export interface Edits {
  /** `rod` is the one that the hand holds. */
  scene: (change: (scene: SceneJson, rod: SceneJson) => void) => void
  /** The hand was put somewhere by numbers. */
  hand: (change: () => void) => void
  mode: (mode: HandMode) => void
  /** One of the coupling's numbers, by its place in the solver's order. */
  coupling: (index: number, value: number) => void
  look: (change: Partial<ViewOptions>) => void
  /** How the air moves, m/s. */
  wind: (velocity: [number, number, number]) => void
}

/** A number that fits its field. */
function short(value: number): string {
  return value !== 0 && Math.abs(value) < 1e-3 ? value.toExponential(3).replace(/\.?0*e/, 'e') : String(Number(value.toPrecision(4)))
}

const group = (id: string) => document.getElementById(id)!

export class Inspector {
  #numbers = new Map<string, HTMLInputElement>()
  #choices = new Map<string, HTMLSelectElement>()
  #wind: HTMLInputElement[] = []

  constructor(private stage: Stage, private edits: Edits) {
    this.#strand()
    this.#hand()
    this.#motion()
    this.#air()
    this.#solver()
    this.#view()
  }

  /**
   * Writes the numbers of the scene and of the rod that the hand holds. Rows for what they do not have are hidden. What someone is
   * typing stays, unless the scene is another one.
   */
  fill(scene: SceneJson, rod: SceneJson, anew = false): void {
    for (const field of numberFields) {
      const input = this.#numbers.get(field.id)!
      const value = field.get(scene, rod)
      input.closest('label')!.hidden = value === undefined
      if (anew) delete input.dataset.typing
      write(input, value === undefined ? '' : String(Number((value / field.scale).toPrecision(6))))
    }
    this.#choices.get('starts')!.value = scene.dynamics?.start ?? 'equilibrium'
    const feel = Object.values<SceneJson>(scene.rods).some((rod) => rod.drag)
    for (const input of this.#wind) input.closest('label')!.hidden = !feel
    if (anew) this.#fillWind(scene.wind?.velocity ?? [0, 0, 0])
    document.getElementById('contacts')!.closest('label')!.hidden = !scene.contact
    this.#choices.get('kinematics')!.value = rod.kinematics ?? 'cosserat'
    this.#choices.get('order')!.value = String(scene.solver?.order ?? 2)
  }

  fillCoupling(values: number[]): void {
    values.forEach((value, i) => write(this.#numbers.get(`coupling-${i}`)!, value === couplingFields[i].empty ? '' : short(value)))
  }

  /** Says beside one of the coupling's numbers why it was refused. */
  refuseCoupling(index: number, why: string): void {
    refuse(this.#numbers.get(`coupling-${index}`)!, why)
  }

  /** Writes what belongs to a shape: where the hand is, and how it holds on. */
  show(shape: Shape): void {
    this.#choices.get('mode')!.value = shape.report.mode
    ;['x', 'y', 'z'].forEach((axis, i) => write(this.#numbers.get(`hand-${axis}`)!, (shape.hand[i] * 1e3).toFixed(2)))
    const angles = this.stage.hand.angles
    ;['x', 'y', 'z'].forEach((axis, i) => write(this.#numbers.get(`turn-${axis}`)!, angles[i].toFixed(1)))
  }

  /** The view's controls as the view is. */
  fillView(): void {
    const { view } = this.stage
    write(this.#numbers.get('scale')!, String(view.displayScale))
    this.#range(null)
  }

  #number(parent: string, id: string, label: string, unit: string, help: string, change: (value: number) => void, empty?: number): void {
    this.#numbers.set(id, numberInput(group(parent), id, label, unit, help, change, empty))
  }

  #strand(): void {
    for (const field of numberFields.filter((field) => field.group === 'strand')) this.#field(field)
    const kinds: [string, string][] = [['kirchhoff', 'inextensible'], ['cosserat', 'extensible']]
    this.#choices.set('kinematics', choice(group('strand'), 'kinematics', 'Kinematics', 'Whether the thread can stretch and shear, or only bend and twist.', kinds, (value) => {
      this.edits.scene((_, rod) => (rod.kinematics = value))
    }))
  }

  #field(field: (typeof numberFields)[number]): void {
    this.#number(field.group, field.id, field.label, field.unit, field.help, (value) => {
      this.edits.scene((scene, rod) => field.set(scene, rod, value * field.scale))
    })
  }

  #hand(): void {
    const modes: [HandMode, string][] = [
      ['pose', 'holds firmly'], ['coupling', 'pulls by a spring'], ['scene', 'as in the scene'], ['free', 'lets go'],
    ]
    this.#choices.set('mode', choice(group('hand'), 'mode', 'The hand', 'How the hand holds the thread’s end.', modes, (mode) => this.edits.mode(mode)))
    ;['x', 'y', 'z'].forEach((axis, i) => {
      this.#number('hand', `hand-${axis}`, `Place ${axis}`, 'mm', `Where the hand is along ${axis}.`, (value) => {
        this.edits.hand(() => this.stage.hand.position.setComponent(i, value / 1e3))
      })
    })
    ;['x', 'y', 'z'].forEach((axis, i) => {
      this.#number('hand', `turn-${axis}`, `Turn ${axis}`, '°', `How the hand is turned about ${axis}; the turns are made in the order z, y, x.`, (value) => {
        this.edits.hand(() => (this.stage.hand.angles = this.stage.hand.angles.map((angle, k) => (k === i ? value : angle))))
      })
    })
    couplingFields.forEach(({ label, unit, help, empty }, i) => {
      this.#number('hand', `coupling-${i}`, label, unit, help, (value) => this.edits.coupling(i, value), empty)
    })
  }

  #motion(): void {
    for (const field of numberFields.filter((field) => field.group === 'motion-fields')) this.#field(field)
    this.#choices.set('starts', choice(group('motion-fields'), 'starts', 'Starts from', 'Where the scene starts to move from.', starts, (value) => {
      this.edits.scene((scene) => (scene.dynamics = { ...scene.dynamics, start: value }))
    }))
  }

  /** Wind along the ground: how fast, and where to. */
  #air(): void {
    const told = () => {
      const [speed, degrees] = this.#wind.map((input) => input.valueAsNumber)
      const angle = (degrees * Math.PI) / 180
      this.edits.wind([speed * Math.cos(angle), speed * Math.sin(angle), 0])
    }
    this.#wind = [
      slider(group('motion-fields'), 'wind-speed', 'Wind', 'How fast the air moves.', [0, 20, 0.1], (speed) => `${speed.toFixed(1)} m/s`, told),
      slider(group('motion-fields'), 'wind-to', 'Blows to', 'Where the wind blows to, about the vertical from x.', [-180, 180, 5], (angle) => `${angle}°`, told),
    ]
  }

  #fillWind([x, y]: number[]): void {
    slide(this.#wind[0], Math.hypot(x, y))
    slide(this.#wind[1], (Math.atan2(y, x) * 180) / Math.PI)
  }

  #solver(): void {
    for (const field of numberFields.filter((field) => field.group === 'solver')) this.#field(field)
    const orders: [string, string][] = [['1', '1 (Euler)'], ['2', '2'], ['4', '4']]
    this.#choices.set('order', choice(group('solver'), 'order', 'Order', 'Order of accuracy of the elements.', orders, (value) => {
      this.edits.scene((scene) => (scene.solver = { ...scene.solver, order: Number(value) }))
    }))
  }

  #view(): void {
    const by = Object.entries(quantities).map(([key, quantity]): [string, string] => [key, quantity?.label ?? 'Nothing'])
    choice(group('view'), 'colour', 'Colour by', 'What the thread’s colour shows.', by, (value) => {
      this.#range(null)
      this.edits.look({ colourBy: value })
    })
    const maps: [MapName, string][] = [['viridis', 'viridis'], ['cividis', 'cividis']]
    choice(group('view'), 'map', 'Colours', 'The scale of colours; cividis looks the same to colour-blind eyes.', maps, (map) => this.edits.look({ map }))
    checkbox(group('view'), 'fixed', 'Fixed range', 'Keeps the range of the colours as it is now.', false, (fixed) => {
      const quantity = quantities[this.stage.view.colourBy]
      this.#range(fixed && quantity ? [...this.stage.tubes.range] : null)
    })
    const ends: [string, string, string][] = [['range-low', 'From', 'The value of the first colour.'], ['range-high', 'To', 'The value of the last colour.']]
    ends.forEach(([id, label, help], i) => {
      this.#number('view', id, label, '', help, (value) => {
        const range = [...(this.stage.view.range ?? [0, 1])] as [number, number]
        range[i] = value
        this.#range(range)
      })
    })
    this.#range(null)
    this.#number('view', 'scale', 'Thickness', '×', 'How many times as thick as it is the thread is drawn.', (value) => this.edits.look({ displayScale: Math.max(value, 0.01) }))
    const glyphs: [keyof ViewOptions & string, string, string][] = [
      ['arrows', 'Forces', 'Forces (orange) and torques (violet) that hand and support exert on the thread.'],
      ['contacts', 'Contacts', 'Where surfaces touch (dots) and what threads pass through (rings), and the forces there; between two threads, what the second exerts on the first.'],
      ['directors', 'Directors', 'The material frame along the thread: d1 red, d2 green, d3 blue.'],
      ['internalForce', 'Inner force', 'The force that the thread carries, along it.'],
      ['internalMoment', 'Inner moment', 'The moment that the thread carries, along it.'],
    ]
    for (const [key, label, help] of glyphs) {
      checkbox(group('view'), key, label, help, this.stage.view[key] as boolean, (value) => this.edits.look({ [key]: value }))
    }
  }

  /** Fixes the range of the colours, or sets it free. */
  #range(range: [number, number] | null): void {
    const unit = quantities[this.stage.view.colourBy]?.unit ?? ''
    ;(document.getElementById('fixed') as HTMLInputElement).checked = range !== null
    ;['range-low', 'range-high'].forEach((id, i) => {
      const input = this.#numbers.get(id)!
      const line = input.closest('label')!
      line.hidden = range === null
      line.querySelector('.unit')!.textContent = unit
      if (range) input.value = String(Number(range[i].toPrecision(4)))
    })
    this.edits.look({ range })
  }
}
