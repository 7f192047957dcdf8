/** The scene's numbers that the inspector shows: where each is in the scene, its label, its unit, and a sentence about it. */

export type SceneJson = Record<string, any>

export interface NumberField {
  group: 'strand' | 'solver'
  id: string
  label: string
  unit: string
  help: string
  /** How many of the scene's units make one of the field's. */
  scale: number
  /** The value, or undefined where the scene has no such number. */
  get: (scene: SceneJson) => number | undefined
  set: (scene: SceneJson, value: number) => void
}

export function firstRod(scene: SceneJson): SceneJson {
  return scene.rods[Object.keys(scene.rods)[0]]
}

function material(scene: SceneJson): SceneJson | undefined {
  return scene.materials?.[firstRod(scene).material]
}

/** The scene's section where it is the same all along the rod. */
function section(scene: SceneJson): SceneJson | undefined {
  const { section } = firstRod(scene)
  return section && !Array.isArray(section) ? section : undefined
}

export function isRectangle(scene: SceneJson): boolean {
  const { section } = firstRod(scene)
  return (Array.isArray(section) ? section[0] : section)?.shape === 'rectangle'
}

function sectionField(key: string, label: string, help: string): NumberField {
  return {
    group: 'strand', id: key, label, unit: 'mm', help, scale: 1e-3,
    get: (scene) => section(scene)?.[key],
    set: (scene, value) => (section(scene)![key] = value),
  }
}

function materialField(key: string, id: string, label: string, unit: string, help: string, scale: number): NumberField {
  return {
    group: 'strand', id, label, unit, help, scale,
    get: (scene) => material(scene)?.[key],
    set: (scene, value) => (material(scene)![key] = value),
  }
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

function helixField(key: string, label: string, help: string): NumberField {
  return {
    group: 'strand', id: `helix-${key}`, label, unit: 'mm', help, scale: 1e-3,
    get: (scene) => firstRod(scene).rest?.helix?.[key],
    set: (scene, value) => (firstRod(scene).rest.helix[key] = value),
  }
}

const size = (vector: number[]) => Math.hypot(...vector)

/** Which way gravity points: down, where there is none. */
function direction(gravity: number[]): number[] {
  const length = size(gravity)
  return length > 0 ? gravity.map((part) => part / length) : [0, 0, -1]
}

export const numberFields: NumberField[] = [
  {
    group: 'strand', id: 'length', label: 'Length', unit: 'mm', help: 'Length of the thread when nothing acts on it.', scale: 1e-3,
    get: (scene) => firstRod(scene).length,
    set: (scene, value) => (firstRod(scene).length = value),
  },
  sectionField('radius', 'Radius', 'Radius of its round section.'),
  sectionField('a', 'Half axis a', 'Half the width of its elliptic section along d1.'),
  sectionField('b', 'Half axis b', 'Half the width of its elliptic section along d2.'),
  sectionField('width', 'Width', 'Width of its rectangular section along d1.'),
  sectionField('height', 'Height', 'Width of its rectangular section along d2.'),
  materialField('youngs_modulus', 'youngs', 'Young’s E', 'GPa', 'Young’s modulus of its material: how hard it is to stretch and bend.', 1e9),
  materialField('poisson_ratio', 'poisson', 'Poisson’s ν', '–', 'Poisson’s ratio of its material; it decides how hard it is to twist.', 1),
  materialField('density', 'density', 'Density', 'kg/m³', 'Density of its material, and so its weight.', 1),
  restField(0, 'kappa1', 'Rest κ₁', 'Curvature about d1 when nothing acts on it.'),
  restField(1, 'kappa2', 'Rest κ₂', 'Curvature about d2 when nothing acts on it.'),
  restField(2, 'tau', 'Rest twist', 'Twist when nothing acts on it.'),
  helixField('radius', 'Coil radius', 'Radius of the helix that it forms when nothing acts on it.'),
  helixField('pitch', 'Coil pitch', 'Advance of that helix in one turn.'),
  {
    group: 'strand', id: 'gravity', label: 'Gravity', unit: 'm/s²', scale: 1,
    help: 'Acceleration of gravity in the scene’s direction, downwards where the scene has none.',
    get: (scene) => size(scene.gravity ?? []),
    set: (scene, value) => (scene.gravity = direction(scene.gravity ?? []).map((part) => part * value)),
  },
  {
    group: 'solver', id: 'elements', label: 'Elements', unit: '–', help: 'How many elements the thread is cut into.', scale: 1,
    get: (scene) => firstRod(scene).elements,
    set: (scene, value) => (firstRod(scene).elements = Math.max(1, Math.round(value))),
  },
  {
    group: 'solver', id: 'tolerance', label: 'Tolerance', unit: '–', help: 'The residual, over the rod’s own scales, at which a solve is accepted.', scale: 1,
    get: (scene) => scene.solver?.tolerance ?? 1e-9,
    set: (scene, value) => (scene.solver = { ...scene.solver, tolerance: value }),
  },
]

/** The coupling's numbers, in the solver's order. `empty` is what a field that holds nothing stands for. */
export const couplingFields: { label: string; unit: string; help: string; empty?: number }[] = [
  { label: 'Stiffness', unit: 'N/m', help: 'Stiffness of the hand’s spring against shifts.' },
  { label: 'Turn stiffness', unit: 'N·m', help: 'Stiffness of the hand’s spring against turns, per radian.' },
  { label: 'Damping', unit: 'N·s/m', help: 'Damping of the hand’s spring against shifts.' },
  { label: 'Turn damping', unit: 'N·m·s', help: 'Damping of the hand’s spring against turns, per radian.' },
  { label: 'Force limit', unit: 'N', help: 'The largest force that the device gives; empty for no limit.', empty: Infinity },
  { label: 'Torque limit', unit: 'N·m', help: 'The largest torque that the device gives; empty for no limit.', empty: Infinity },
]
