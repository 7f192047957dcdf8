/** What the page and the solver's worker say to each other. */

/** How the hand holds the thread's end. */
export type HandMode = 'pose' | 'coupling' | 'scene' | 'free'

/** How a solve went, as the solver reports it. Reactions are in world axes, N and N·m. */
export interface Report {
  /** The name of the rod that the hand holds. */
  rod: string
  status: 'converged' | 'failed'
  reason: string | null
  /** Whether joints tie the rods: they are shown where they start to move, and what holds them is not known. */
  moves_only: boolean
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

/** What a rod's elements carry: six numbers each, in the body's frame. */
export interface Carried {
  strain: Float64Array
  stress: Float64Array
  /** Elastic energy per length, J/m, one number an element. */
  energyDensity: Float64Array
}

/** The shape of the rod in the hand after a solve, and where the others are. */
export interface Shape extends Body, Carried {
  others: (Body & { name: string })[]
  hand: Float64Array
  report: Report
  /** Hand, coupling and solution, to go back to. */
  snapshot: Float64Array
  /** Time of the solve, ms. */
  milliseconds: number
}

/** A rod that moves. */
export interface MovingRod {
  name: string
  nodes: number
  halfExtent: Float64Array
}

/** What a rigid body looks like: lengths along its third axis, edges along its axes, m. */
export type BodyShape =
  | { kind: 'ball'; radius: number }
  | { kind: 'capsule' | 'cylinder'; radius: number; length: number }
  | { kind: 'block'; size: [number, number, number] }
  | { kind: 'ring'; radius: number; wire_radius: number }

/** A rigid body that moves. */
export interface RigidBody {
  name: string
  shape: BodyShape
}

export type Triple = [number, number, number]

/** What an obstacle looks like: places and lengths, m. A tube is seen from within, a ball is a capsule whose ends are the same. */
export type ObstacleShape =
  | { kind: 'plane'; point: Triple; normal: Triple }
  | { kind: 'capsule' | 'cylinder'; ends: [Triple, Triple]; radius: number }
  | { kind: 'tube'; point: Triple; axis: Triple; radius: number }
  | { kind: 'ring'; point: Triple; axis: Triple; radius: number; wire_radius: number }
  | { kind: 'mesh'; corners: number[]; triangles: number[] }

/** How a motion goes, as the solver reports it. */
export interface MotionReport {
  /** s */
  time: number
  time_step: number
  /** Since the start. */
  steps: number
  /** How much time was to pass since the start and did not, s. */
  behind: number
  /** Energies, J. */
  kinetic: number
  elastic: number
  load: number
  dissipated: number
  /** What hands have put in. */
  worked: number
  /** Of the last step. */
  iterations: number
  residual: number | null
  /** What a step of the last answer took, ms; null where it made none. */
  step_ms: number | null
  /** Why the last step was not made. */
  failure: string | null
  /** The force of the hand, N. */
  grabbed: { rod: number; node: number; force: [number, number, number] } | null
}

/** Where all rods are at some time; every array has one rod after the other. */
export interface Moved extends Carried {
  frames: Float64Array
  /** The frames of the rigid bodies. */
  bodies: Float64Array
  /** What touches, nine numbers each: the point, the unit normal, the force, N. */
  contacts: Float64Array
  /** What rods pass through, nine numbers each: where the rod is in it, the direction of the rod, the force on it, N. */
  passages: Float64Array
  report: MotionReport
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
  /** Lets the scene move from its start, in place of solving for where it rests; and the other way round. */
  | { kind: 'motion' | 'statics' }
  /** Lets time pass (s) for at most so many ms, with the hand that has grabbed where it is now. */
  | { kind: 'advance'; seconds: number; budget: number; hand: HandPose | null }
  | { kind: 'step'; hand: HandPose | null }
  | { kind: 'rewind' }
  | { kind: 'grab'; rod: number; node: number }
  | { kind: 'release' }
  /** How the air moves, m/s. */
  | { kind: 'wind'; velocity: [number, number, number] }

export type Reply =
  | { kind: 'bundled'; scenes: { name: string; title: string; text: string }[] }
  | { kind: 'opened'; scene: string; coupling: number[]; shape: Shape }
  | { kind: 'shape'; shape: Shape; scene: string | null; coupling: number[] }
  | { kind: 'error'; message: string }
  | { kind: 'moving'; rods: MovingRod[]; bodies: RigidBody[]; obstacles: ObstacleShape[]; moved: Moved }
  | { kind: 'moved'; moved: Moved }
  | { kind: 'file'; name: string; data: string | Uint8Array }
  /** Nobody asked: the worker has come nearer to a hand that it did not reach at once. */
  | { kind: 'settled'; shape: Shape }
  /** Nobody asked: the solver has stopped on the way there. */
  | { kind: 'stopped'; message: string }
