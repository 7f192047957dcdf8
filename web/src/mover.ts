/** The worker's side of motion: the scene that moves, and what is asked of it. */

import { Motion } from './wasm/strands_wasm.js'
import type { HandPose, Moved, MovingRod, Reply, Request } from './protocol'

export class Mover {
  #motion: Motion

  constructor(toml: string) {
    this.#motion = new Motion(toml, 'scene.toml')
  }

  free(): void {
    this.#motion.free()
  }

  start(): Reply {
    const [bodies, obstacles] = [this.#motion.body_shapes(), this.#motion.obstacles()].map((text) => JSON.parse(text))
    return { kind: 'moving', rods: this.#rods(), bodies, obstacles, moved: this.#moved() }
  }

  /** Answers what only a scene in motion can; null where it is something else. */
  answer(request: Request): Reply | null {
    switch (request.kind) {
      case 'advance':
        this.#pull(request.hand)
        this.#motion.advance(request.seconds, request.budget)
        break
      case 'step':
        this.#pull(request.hand)
        this.#motion.step()
        break
      case 'rewind':
        this.#motion.rewind()
        break
      case 'grab':
        this.#motion.grab(request.rod, request.node)
        break
      case 'release':
        this.#motion.release()
        break
      case 'wind':
        this.#motion.set_wind(...request.velocity)
        break
      default:
        return null
    }
    return { kind: 'moved', moved: this.#moved() }
  }

  #pull(hand: HandPose | null): void {
    if (!hand) return
    const [x, y, z, w, i, j, k] = hand
    this.#motion.pull(x, y, z, w, i, j, k)
  }

  #moved(): Moved {
    const borne = this.#motion.borne()
    const elements = borne.length / 13
    return {
      frames: this.#motion.frames(),
      bodies: this.#motion.bodies(),
      contacts: this.#motion.contacts(),
      passages: this.#motion.passages(),
      strain: borne.subarray(0, 6 * elements),
      stress: borne.subarray(6 * elements, 12 * elements),
      energyDensity: borne.subarray(12 * elements),
      report: JSON.parse(this.#motion.report()),
    }
  }

  #rods(): MovingRod[] {
    const halfExtent = this.#motion.half_extent()
    let first = 0
    return JSON.parse(this.#motion.rods()).map((rod: { name: string; nodes: number }) => {
      const from = first
      first += rod.nodes
      return { ...rod, halfExtent: halfExtent.slice(2 * from, 2 * first) }
    })
  }
}
