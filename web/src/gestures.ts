/** Pointer, wheel and touch on the stage: what grabs moves and turns the hand, everything else looks around. */

import type { Stage } from './stage'

/** How near to what can be grabbed a pointer grabs it, px. */
const REACH = { mouse: 22, pen: 26, touch: 40 }

interface Finger { x: number; y: number }

export interface HandEvents {
  /** Whether there is something to grab within so many px of a place of the page. */
  near: (x: number, y: number, reach: number) => boolean
  /** It is grabbed: what follows is one change. */
  grabbed: (x: number, y: number, reach: number) => void
  /** The gizmo is. */
  held: () => void
  moved: () => void
  released: () => void
}

export class Gestures {
  #fingers = new Map<number, Finger>()
  /** The finger that holds the hand. */
  #holder: number | null = null

  constructor(private stage: Stage, private events: HandEvents) {
    const { canvas } = stage
    // Before the orbit's own listeners, so that it can be switched off in time.
    canvas.addEventListener('pointerdown', (event) => this.#down(event), { capture: true })
    canvas.addEventListener('pointermove', (event) => this.#move(event), { capture: true })
    for (const name of ['pointerup', 'pointercancel', 'lostpointercapture'] as const) {
      canvas.addEventListener(name, (event) => this.#up(event))
    }
    canvas.addEventListener('wheel', (event) => this.#wheel(event), { capture: true, passive: false })
    canvas.addEventListener('dblclick', () => stage.frameAll())
    stage.gizmo.addEventListener('mouseDown', () => events.held())
  }

  get holding(): boolean {
    return this.#holder !== null || this.stage.gizmo.dragging
  }

  #down(event: PointerEvent): void {
    if (this.#holder === null) {
      if (event.button !== 0 || this.stage.gizmo.axis || !this.#near(event)) return
      this.#holder = event.pointerId
      this.stage.orbit.enabled = false
      this.stage.canvas.style.cursor = 'grabbing'
      this.events.grabbed(event.clientX, event.clientY, reachOf(event))
    }
    // A finger that joins belongs to the hand.
    this.#fingers.set(event.pointerId, { x: event.clientX, y: event.clientY })
    this.stage.canvas.setPointerCapture(event.pointerId)
  }

  #move(event: PointerEvent): void {
    const before = this.#fingers.get(event.pointerId)
    if (!before) {
      if (this.#holder === null) this.stage.canvas.style.cursor = this.#near(event) ? 'grab' : ''
      return
    }
    const now = { x: event.clientX, y: event.clientY }
    const other = [...this.#fingers].find(([id]) => id !== event.pointerId)?.[1]
    this.#fingers.set(event.pointerId, now)
    if (other) this.#two(other, before, now)
    else this.#one(event, now.x - before.x, now.y - before.y)
    this.events.moved()
  }

  /** One finger, or the mouse: in the plane that faces the eye; with Shift twist, with Alt turns. */
  #one(event: PointerEvent, dx: number, dy: number): void {
    const { stage } = this
    if (event.shiftKey) return stage.nudge({ twist: dx * 0.02 })
    if (event.altKey) {
      const [right, up] = stage.axes()
      stage.hand.turn(up, dx * 0.01)
      return stage.hand.turn(right, dy * 0.01)
    }
    this.#shift(dx, dy)
  }

  #shift(dx: number, dy: number): void {
    const { camera, hand, canvas, size } = this.stage
    const depth = camera.position.clone().sub(hand.position).dot(this.stage.axes()[2])
    const metre = (2 * depth * Math.tan((camera.fov * Math.PI) / 360)) / canvas.clientHeight / size
    this.stage.nudge({ right: dx * metre, up: -dy * metre })
  }

  /** Two fingers: turning them twists, spreading them brings the hand nearer, moving both moves it. */
  #two(other: Finger, before: Finger, now: Finger): void {
    const arm = (finger: Finger) => ({ length: Math.hypot(finger.x - other.x, finger.y - other.y), angle: Math.atan2(finger.y - other.y, finger.x - other.x) })
    const [old, fresh] = [arm(before), arm(now)]
    const turn = fresh.angle - old.angle
    this.stage.nudge({ twist: Math.atan2(Math.sin(turn), Math.cos(turn)), near: (fresh.length - old.length) * 0.002 })
    this.#shift((now.x - before.x) / 2, (now.y - before.y) / 2)
  }

  #up(event: PointerEvent): void {
    this.#fingers.delete(event.pointerId)
    if (this.#fingers.size > 0 || this.#holder === null) return
    this.#holder = null
    this.stage.orbit.enabled = true
    this.stage.canvas.style.cursor = ''
    this.events.released()
  }

  #wheel(event: WheelEvent): void {
    if (this.#holder === null) return
    event.preventDefault()
    event.stopImmediatePropagation()
    this.stage.nudge({ near: event.deltaY * 0.0004 })
    this.events.moved()
  }

  #near(event: PointerEvent): boolean {
    return this.events.near(event.clientX, event.clientY, reachOf(event))
  }
}

function reachOf(event: PointerEvent): number {
  return REACH[event.pointerType as keyof typeof REACH] ?? REACH.mouse
}
