/** What the page and the solver's worker say to each other. */

/** How the hand holds the thread's end. */
export type HandMode = 'pose' | 'coupling' | 'scene' | 'free'

/** How a solve went, as the solver reports it. Reactions are in world axes, N and N·m. */
export interface Report {
  /** The name of the rod that the hand holds. */
  rod: string
  status: 'converged' | 'failed'
  reason: string | null
  /** Whether the worker is still on its way to the hand. */
  settling: boolean
  /** Whether the thread has just snapped over to another equilibrium. */
  snapped: boolean
  mode: HandMode
  /** How far the hand is out of reach, m. */
  beyond: number
  method: string
  iterations: number
  /** Null where it is not finite. */
  residual: number | null
  path_steps: number
  morse_index: number | null
  elements: number
  energy: number
  elastic_energy: number
  saturated: boolean
  start: Reaction
  end: Reaction
  /** Of the supports between the ends, in order. */
  between: (Reaction & { node: number })[]
}

export interface Reaction {
  force: [number, number, number]
  moment: [number, number, number]
}

/** Where a rod is: twelve numbers a node (d1, d2, d3, position), two half extents a node. */
export interface Body {
  frames: Float64Array
  halfExtent: Float64Array
}

/** The shape of the rod in the hand after a solve, and where the others are; what is of elements has six numbers each. */
export interface Shape extends Body {
  others: (Body & { name: string })[]
  strain: Float64Array
  stress: Float64Array
  /** Elastic energy per length, J/m, one number an element. */
  energyDensity: Float64Array
  hand: Float64Array
  report: Report
  /** Hand, coupling and solution, to go back to. */
  snapshot: Float64Array
  /** Time of the solve, ms. */
  milliseconds: number
}

/** Position and quaternion `[x, y, z, qw, qx, qy, qz]`. */
export type HandPose = Float64Array | number[]

export type Request =
  | { kind: 'bundled' }
  | { kind: 'open'; text: string; name: string }
  | { kind: 'replace'; text: string }
  | { kind: 'restore'; text: string; mode: HandMode; numbers: Float64Array }
  | { kind: 'hand'; pose: HandPose }
  | { kind: 'mode'; mode: HandMode }
  | { kind: 'coupling'; values: number[] }
  | { kind: 'toml' | 'csv' | 'glb' }

export type Reply =
  | { kind: 'bundled'; scenes: { name: string; title: string; text: string }[] }
  | { kind: 'opened'; scene: string; coupling: number[]; shape: Shape }
  | { kind: 'shape'; shape: Shape; scene: string | null; coupling: number[] }
  | { kind: 'error'; message: string }
  | { kind: 'file'; name: string; data: string | Uint8Array }
  /** Nobody asked: the worker has come nearer to a hand that it did not reach at once. */
  | { kind: 'settled'; shape: Shape }
  /** Nobody asked: the solver has stopped on the way there. */
  | { kind: 'stopped'; message: string }
