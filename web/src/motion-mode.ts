/** From rest to motion and back: what moves in place of the shape at rest, and the controls of that in place of the others. */

import { dismissHints } from './help'
import { Motion } from './motion'
import { MotionReadout } from './motion-readout'
import type { Picked } from './pick'
import type { Plot } from './plot'
import type { Shape } from './protocol'
import type { Readout } from './readout'
import type { Solver } from './solver'
import type { Stage } from './stage'
import { TimeBar } from './timebar'

const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T

const TOGGLES = element('motion').title

/** What it asks of the page. */
export interface PageEvents {
  say: (message: string | null, details?: string | null) => void
  /** Something else is on the stage. */
  shown: () => void
  /** The controls cover other parts of it. */
  covered: () => void
}

export class MotionMode {
  readonly motion: Motion
  #readout: MotionReadout
  #bar: TimeBar

  constructor(private stage: Stage, private solver: Solver, readout: Readout, plot: Plot, private page: PageEvents) {
    this.motion = new Motion(solver, { moved: () => this.#moved(), changed: () => this.#changed(), said: page.say })
    this.#readout = new MotionReadout(readout, plot)
    this.#bar = new TimeBar(this.motion)
  }

  /** Lets a scene, whose shape at rest is given, move from its start. Gives why it cannot. */
  async begin(rest: Shape, plays: boolean): Promise<string | null> {
    const scenery = await this.motion.begin(rest.report.rod)
    if (typeof scenery === 'string') return scenery
    // It has begun anew meanwhile.
    if (!scenery) return null
    this.show(true)
    this.#readout.clear()
    this.stage.setMoving(scenery, rest)
    this.motion.setPlaying(plays)
    this.#moved()
    this.#changed()
    return null
  }

  /** Ends the motion. */
  async end(): Promise<void> {
    this.show(false)
    await this.solver.ask({ kind: 'statics' })
  }

  /** Shows the controls of motion, or ends it and shows those of rest. */
  show(moves: boolean): void {
    if (!moves) this.motion.end()
    this.page.say(null)
    document.body.classList.toggle('moves', moves)
    element('motion').setAttribute('aria-pressed', String(moves))
    for (const id of ['time-bar', 'motion-numbers']) element(id).hidden = !moves
    for (const id of ['pause', 'hand-group', 'still-numbers']) element(id).hidden = moves
    // They are of the shape at rest.
    for (const id of ['save-csv', 'save-glb']) element<HTMLButtonElement>(id).disabled = moves
    this.stage.canvas.ariaLabel = moves
      ? 'The scene in motion. Take hold of a thread with the pointer anywhere, or of its end with G; ? lists all gestures.'
      : 'The strand. Drag its end with the pointer, or use the arrow keys; ? lists all gestures.'
    this.page.covered()
  }

  /** Lets a person end the motion, or not: where rods are tied or touch there is nothing else. */
  allowRest(allowed: boolean): void {
    const button = element<HTMLButtonElement>('motion')
    button.disabled = !allowed
    button.title = allowed ? TOGGLES : 'Rods that are tied or touch move; they come to rest by themselves.'
  }

  /** Takes hold of a place of what moves. */
  grab(place: Picked | null): void {
    if (!place) return
    dismissHints()
    this.stage.handTo(place)
    this.motion.grab(place.rod, place.node, this.stage.hand.pose())
  }

  /** Takes hold of the end of the thread, or lets it go: for the keyboard. */
  grabEnd(): void {
    const { scenery, holds } = this.motion
    if (holds) this.motion.release()
    else if (scenery) this.grab({ rod: scenery.held, node: scenery.rods[scenery.held].frames.length / 12 - 1 })
  }

  #moved(): void {
    const { scenery } = this.motion
    if (!scenery) return
    this.stage.showMoving(scenery)
    this.#readout.show(this.motion)
    const { failure } = scenery.report
    this.page.say(failure && 'This step could not be made, and all stays as it was before it. Let go, go back to the start, or choose a shorter time step.', failure)
    this.page.shown()
  }

  #changed(): void {
    this.#bar.show()
    this.#readout.show(this.motion)
  }
}
