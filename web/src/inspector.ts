/** The inspector: fields that read and write the scene, each with a label, a unit and a sentence. */

export type SceneJson = Record<string, any>

interface NumberField {
  group: string
  id: string
  label: string
  unit: string
  help: string
  /** How many of the scene's units make one of the field's. */
  scale: number
  get: (scene: SceneJson) => number | undefined
  set: (scene: SceneJson, value: number) => void
}

export function firstRod(scene: SceneJson): SceneJson {
  return scene.rods[Object.keys(scene.rods)[0]]
}

function material(scene: SceneJson): SceneJson | undefined {
  return scene.materials?.[firstRod(scene).material]
}

/** The scene's section where it is the same all along the rod and a circle. */
function circle(scene: SceneJson): SceneJson | undefined {
  const section = firstRod(scene).section
  return section && !Array.isArray(section) && section.shape === 'circle' ? section : undefined
}

function restCurvature(scene: SceneJson): number[] | undefined {
  const rest = firstRod(scene).rest
  return rest === undefined || rest === null ? [0, 0, 0] : rest.curvature
}

function restField(index: number, id: string, label: string, help: string): NumberField {
  return {
    group: 'strand', id, label, unit: '1/m', help, scale: 1,
    get: (scene) => restCurvature(scene)?.[index],
    set: (scene, value) => {
      const curvature = [...(restCurvature(scene) ?? [0, 0, 0])]
      curvature[index] = value
      firstRod(scene).rest = { curvature }
    },
  }
}

export const numberFields: NumberField[] = [
  {
    group: 'strand', id: 'length', label: 'Length', unit: 'mm', help: 'Rest length of the thread.', scale: 1e-3,
    get: (scene) => firstRod(scene).length,
    set: (scene, value) => (firstRod(scene).length = value),
  },
  {
    group: 'strand', id: 'radius', label: 'Radius', unit: 'mm', help: 'Radius of its round section.', scale: 1e-3,
    get: (scene) => circle(scene)?.radius,
    set: (scene, value) => (circle(scene)!.radius = value),
  },
  {
    group: 'strand', id: 'youngs', label: 'Young’s E', unit: 'GPa', help: 'Young’s modulus of its material.', scale: 1e9,
    get: (scene) => material(scene)?.youngs_modulus,
    set: (scene, value) => (material(scene)!.youngs_modulus = value),
  },
  {
    group: 'strand', id: 'poisson', label: 'Poisson’s ν', unit: '', help: 'Poisson’s ratio of its material.', scale: 1,
    get: (scene) => material(scene)?.poisson_ratio,
    set: (scene, value) => (material(scene)!.poisson_ratio = value),
  },
  {
    group: 'strand', id: 'density', label: 'Density', unit: 'kg/m³', help: 'Density of its material.', scale: 1,
    get: (scene) => material(scene)?.density,
    set: (scene, value) => (material(scene)!.density = value),
  },
  restField(0, 'kappa1', 'Rest κ₁', 'Curvature about d1 when nothing acts.'),
  restField(1, 'kappa2', 'Rest κ₂', 'Curvature about d2 when nothing acts.'),
  restField(2, 'tau', 'Rest twist', 'Twist when nothing acts.'),
  {
    group: 'strand', id: 'gravity', label: 'Gravity', unit: 'm/s²', help: 'Acceleration of gravity, downwards.', scale: 1,
    get: (scene) => -(scene.gravity?.[2] ?? 0),
    set: (scene, value) => (scene.gravity = [0, 0, -value]),
  },
  {
    group: 'solver', id: 'elements', label: 'Elements', unit: '', help: 'How many elements the thread is cut into.', scale: 1,
    get: (scene) => firstRod(scene).elements,
    set: (scene, value) => (firstRod(scene).elements = Math.round(value)),
  },
  {
    group: 'solver', id: 'tolerance', label: 'Tolerance', unit: '', help: 'The residual at which a solve is accepted.', scale: 1,
    get: (scene) => scene.solver?.tolerance ?? 1e-9,
    set: (scene, value) => (scene.solver = { ...scene.solver, tolerance: value }),
  },
]

function row(label: string, unit: string, help: string, control: HTMLElement): HTMLLabelElement {
  const element = document.createElement('label')
  element.title = help
  element.append(label, control, unit)
  return element
}

export function numberInput(parent: HTMLElement, id: string, label: string, unit: string, help: string, change: (value: number) => void): HTMLInputElement {
  const input = Object.assign(document.createElement('input'), { id, type: 'number', step: 'any' })
  const line = row(label, unit, help, input)
  input.addEventListener('change', () => {
    const good = input.value.trim() !== '' && Number.isFinite(input.valueAsNumber)
    line.classList.toggle('bad', !good)
    if (good) change(input.valueAsNumber)
  })
  parent.append(line)
  return input
}

export function choice(parent: HTMLElement, id: string, label: string, help: string, options: [string, string][], change: (value: string) => void): HTMLSelectElement {
  const select = Object.assign(document.createElement('select'), { id })
  for (const [value, text] of options) select.append(new Option(text, value))
  select.addEventListener('change', () => change(select.value))
  parent.append(row(label, '', help, select))
  return select
}

export function checkbox(parent: HTMLElement, id: string, label: string, help: string, checked: boolean, change: (value: boolean) => void): void {
  const input = Object.assign(document.createElement('input'), { id, type: 'checkbox', checked })
  input.addEventListener('change', () => change(input.checked))
  parent.append(row(label, '', help, input))
}
