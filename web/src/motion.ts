/**
 * The scene in motion: how its time runs. Each display frame asks the solver for the time that has passed, one frame at a time; where the solver cannot
 * keep up it gives time up, and never a frame.
 */

import type { HandPose, Moved, MotionReport, MovingRod, ObstacleShape, RigidBody } from './protocol'
import type { Solver } from './solver'
import type { Scenery } from './stage'

/** How long the solver may take for a frame, ms: a little less than one of 60 a second. */
const BUDGET = 14
/** A page that was hidden, or held up, does not catch up on more than this, s. */
const LONGEST = 0.1
/** What the real-time factor looks back on, ms. */
const WINDOW = 700

export const SPEEDS = [1, 1 / 4, 1 / 10, 1 / 100]

export interface MotionEvents {
  /** Something has moved, or time begins or ceases to run. */
  moved: () => void
  changed: () => void
  said: (message: string) => void
}

export class Motion {
  scenery: Scenery | null = null
  playing = false
  speed = SPEEDS[0]
  #rods: MovingRod[] = []
  #bodies: RigidBody[] = []
  #obstacles: ObstacleShape[] = []
  #busy = false
  /** When time was let pass last, ms. */
  #last = 0
  #hand: HandPose | null = null
  /** Simulated times, and when they were shown. */
  #marks: { time: number; at: number }[] = []
  /** Counts beginnings: an answer to an earlier one is late. */
  #turn = 0

  constructor(private solver: Solver, private events: MotionEvents) {}

  get report(): MotionReport | null {
    return this.scenery?.report ?? null
  }

  /** Simulated seconds a second of late; null while nothing runs. */
  get factor(): number | null {
    const [first, last] = [this.#marks[0], this.#marks[this.#marks.length - 1]]
    if (!this.playing || !first || last.at - first.at < WINDOW / 4) return null
    return (1e3 * (last.time - first.time)) / (last.at - first.at)
  }

  /**
   * Puts the scene at its start, and gives what moves, or why it cannot; null where it has begun anew meanwhile. `held` names the rod that the hand of
   * statics holds.
   */
  async begin(held: string): Promise<Scenery | string | null> {
    this.end()
    const turn = this.#turn
    const reply = await this.solver.ask({ kind: 'motion' })
    if (turn !== this.#turn) return null
    if (reply.kind !== 'moving') return reply.kind === 'error' ? reply.message : 'The solver does not answer.'
    this.#rods = reply.rods
    this.#bodies = reply.bodies
    this.#obstacles = reply.obstacles
    this.scenery = this.#scenery(reply.moved, Math.max(0, reply.rods.findIndex(({ name }) => name === held)))
    return this.scenery
  }

  /** Forgets what moves. */
  end(): void {
    this.#turn++
    this.playing = this.#busy = false
    this.scenery = null
    this.#hand = null
    this.#marks = []
  }

  setPlaying(playing: boolean): void {
    if (!this.scenery || playing === this.playing) return
    this.playing = playing
    this.#last = performance.now()
    this.#marks = []
    this.events.changed()
  }

  setSpeed(speed: number): void {
    this.speed = speed
    this.#marks = []
    this.events.changed()
  }

  /** Called once a display frame. */
  tick(): void {
    if (!this.playing || this.#busy) return
    const now = performance.now()
    const seconds = Math.min((now - this.#last) / 1e3, LONGEST) * this.speed
    this.#last = now
    this.#busy = true
    void this.#ask({ kind: 'advance', seconds, budget: BUDGET, hand: this.#hand }).then((moved) => {
      this.#busy = false
      if (!moved) return
      this.#mark(moved.time)
      // What cannot be solved now will not be by trying again and again.
      if (moved.failure) this.setPlaying(false)
    })
  }

  step(): void {
    this.setPlaying(false)
    if (this.scenery) void this.#ask({ kind: 'step', hand: this.#hand })
  }

  rewind(): void {
    this.setPlaying(false)
    this.#hand = null
    if (this.scenery) void this.#ask({ kind: 'rewind' })
  }

  setWind(velocity: [number, number, number]): void {
    if (this.scenery) void this.#ask({ kind: 'wind', velocity })
  }

  get holds(): boolean {
    return this.#hand !== null
  }

  grab(rod: number, node: number, hand: HandPose): void {
    this.#hand = hand
    void this.#ask({ kind: 'grab', rod, node })
  }

  /** Where the hand is now; the newest place wins. */
  pull(hand: HandPose): void {
    if (!this.#hand) return
    this.#hand = hand
    // Where time stands still the hand is shown where it is.
    if (this.scenery && !this.playing) this.events.moved()
  }

  release(): void {
    if (!this.#hand) return
    this.#hand = null
    if (this.scenery) void this.#ask({ kind: 'release' })
  }

  async #ask(request: Parameters<Solver['ask']>[0]): Promise<MotionReport | null> {
    const turn = this.#turn
    const reply = await this.solver.ask(request)
    if (turn !== this.#turn || !this.scenery) return null
    if (reply.kind !== 'moved') {
      this.setPlaying(false)
      if (reply.kind === 'error') this.events.said(reply.message)
      return null
    }
    this.scenery = this.#scenery(reply.moved, this.scenery.held)
    this.events.moved()
    return reply.moved.report
  }

  #mark(time: number): void {
    const at = performance.now()
    this.#marks.push({ time, at })
    // One before the window stays.
    while (this.#marks.length > 2 && this.#marks[1].at < at - WINDOW) this.#marks.shift()
  }

  /** The rods one by one, as views of what all have together. */
  #scenery(moved: Moved, held: number): Scenery {
    let [nodes, elements] = [0, 0]
    const rods = this.#rods.map((rod) => {
      const [n, e] = [nodes, elements]
      nodes += rod.nodes
      elements += rod.nodes - 1
      return {
        halfExtent: rod.halfExtent,
        frames: moved.frames.subarray(12 * n, 12 * nodes),
        strain: moved.strain.subarray(6 * e, 6 * elements),
        stress: moved.stress.subarray(6 * e, 6 * elements),
        energyDensity: moved.energyDensity.subarray(e, elements),
      }
    })
    const bodies = { shapes: this.#bodies.map(({ shape }) => shape), frames: moved.bodies }
    const { contacts, passages, report } = moved
    return { rods, bodies, obstacles: this.#obstacles, contacts, passages, held, report }
  }
}
