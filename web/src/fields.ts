/** The scene's numbers that the inspector shows: where each is in the scene or in the rod that the hand holds, its label, its unit, and a sentence about it. */

export type SceneJson = Record<string, any>

export interface NumberField {
  group: 'strand' | 'solver' | 'motion-fields'
  id: string
  label: string
  unit: string
  help: string
  /** How many of the scene's units make one of the field's. */
  scale: number
  /** The value, or undefined where the scene has no such number. */
  get: (scene: SceneJson, rod: SceneJson) => number | undefined
  set: (scene: SceneJson, rod: SceneJson, value: number) => void
}

function material(scene: SceneJson, rod: SceneJson): SceneJson | undefined {
  return scene.materials?.[rod.material]
}

/** The rod's section where it is the same all along it. */
function section(rod: SceneJson): SceneJson | undefined {
  const { section } = rod
  return section && !Array.isArray(section) ? section : undefined
}

export function isRectangle(rod: SceneJson): boolean {
  const { section } = rod
  return (Array.isArray(section) ? section[0] : section)?.shape === 'rectangle'
}

function sectionField(key: string, label: string, help: string): NumberField {
  return {
    group: 'strand', id: key, label, unit: 'mm', help, scale: 1e-3,
    get: (_, rod) => section(rod)?.[key],
    set: (_, rod, value) => (section(rod)![key] = value),
  }
}

function materialField(key: string, id: string, label: string, unit: string, help: string, scale: number): NumberField {
  return {
    group: 'strand', id, label, unit, help, scale,
    get: (scene, rod) => material(scene, rod)?.[key],
    set: (scene, rod, value) => (material(scene, rod)![key] = value),
  }
}

function restCurvature({ rest }: SceneJson): number[] | undefined {
  return rest === undefined || rest === null ? [0, 0, 0] : rest.curvature
}

function restField(index: number, id: string, label: string, help: string): NumberField {
  return {
    group: 'strand', id, label, unit: '1/m', help, scale: 1,
    get: (_, rod) => restCurvature(rod)?.[index],
    set: (_, rod, value) => {
      const curvature = [...(restCurvature(rod) ?? [0, 0, 0])]
      curvature[index] = value
      rod.rest = { curvature }
    },
  }
}

function helixField(key: string, label: string, help: string): NumberField {
  return {
    group: 'strand', id: `helix-${key}`, label, unit: 'mm', help, scale: 1e-3,
    get: (_, rod) => rod.rest?.helix?.[key],
    set: (_, rod, value) => (rod.rest.helix[key] = value),
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
    get: (_, rod) => rod.length,
    set: (_, rod, value) => (rod.length = value),
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
    set: (scene, _, value) => (scene.gravity = direction(scene.gravity ?? []).map((part) => part * value)),
  },
  {
    group: 'solver', id: 'elements', label: 'Elements', unit: '–', help: 'How many elements the thread is cut into.', scale: 1,
    get: (_, rod) => rod.elements,
    set: (_, rod, value) => (rod.elements = Math.max(1, Math.round(value))),
  },
  {
    group: 'solver', id: 'tolerance', label: 'Tolerance', unit: '–', help: 'The residual, over the rod’s own scales, at which a solve is accepted.', scale: 1,
    get: (scene) => scene.solver?.tolerance ?? 1e-9,
    set: (scene, _, value) => (scene.solver = { ...scene.solver, tolerance: value }),
  },
  {
    group: 'motion-fields', id: 'time-step', label: 'Time step', unit: 'ms', help: 'How long a step in time is.', scale: 1e-3,
    get: (scene) => scene.dynamics?.time_step ?? 1e-3,
    set: (scene, _, value) => (scene.dynamics = { ...scene.dynamics, time_step: value }),
  },
  {
    group: 'motion-fields', id: 'damping', label: 'Damping', unit: 'ms', scale: 1e-3,
    help: 'Damping time of its material: its stress for a rate of strain, over its stiffness.',
    get: (scene, rod) => (material(scene, rod) ? (material(scene, rod)!.damping ?? 0) : undefined),
    set: (scene, rod, value) => (material(scene, rod)!.damping = value),
  },
]

/** Where the scene can start to move from. */
export const starts: [string, string][] = [['equilibrium', 'where it rests'], ['rest', 'its rest shape']]

/** The coupling's numbers, in the solver's order. `empty` is what a field that holds nothing stands for. */
export const couplingFields: { label: string; unit: string; help: string; empty?: number }[] = [
  { label: 'Stiffness', unit: 'N/m', help: 'Stiffness of the hand’s spring against shifts.' },
  { label: 'Turn stiffness', unit: 'N·m', help: 'Stiffness of the hand’s spring against turns, per radian.' },
  { label: 'Damping', unit: 'N·s/m', help: 'Damping of the hand’s spring against shifts.' },
  { label: 'Turn damping', unit: 'N·m·s', help: 'Damping of the hand’s spring against turns, per radian.' },
  { label: 'Force limit', unit: 'N', help: 'The largest force that the device gives; empty for no limit.', empty: Infinity },
  { label: 'Torque limit', unit: 'N·m', help: 'The largest torque that the device gives; empty for no limit.', empty: Infinity },
]
