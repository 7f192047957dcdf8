/**
 * The solver in its own thread: one request, one reply. A hand that one search does not reach is gone after in small bits while nothing
 * else is asked for, so that a newer hand never waits for an older one.
 */

import init, { Session, bundled } from './wasm/strands_wasm.js'
import wasm from './wasm/strands_wasm_bg.wasm?url'
import { Mover } from './mover'
import type { Reply, Request, Shape } from './protocol'

/** How long the worker goes on, ms, before it looks for messages and shows how far it is. */
const BIT = 8

const ready = init({ module_or_path: wasm })
let session: Session | null = null
/** The scene in motion, while it is. */
let mover: Mover | null = null
let lastSolve = performance.now()
/** Counts the requests: whoever settles stops at a newer one. */
let requests = 0
let settling = false

function shape(open: Session, milliseconds: number): Shape {
  const report = JSON.parse(open.report())
  settling = report.settling
  return {
    frames: open.frames(),
    others: open.other_names().map((name, i) => ({ name, frames: open.other_frames(i), halfExtent: open.other_half_extent(i) })),
    strain: open.strain(),
    stress: open.stress(),
    energyDensity: open.energy_density(),
    halfExtent: open.half_extent(),
    hand: open.hand(),
    report,
    snapshot: open.snapshot(),
    milliseconds,
  }
}

function timed(work: () => void): number {
  const start = performance.now()
  work()
  return performance.now() - start
}

function answer(request: Request): Reply {
  if (request.kind === 'bundled') return { kind: 'bundled', scenes: JSON.parse(bundled()) }
  if (request.kind === 'open') {
    let opened: Session | null = null
    const milliseconds = timed(() => (opened = new Session(request.text, request.name)))
    session?.free()
    stand()
    session = opened as unknown as Session
    return { kind: 'opened', scene: session.scene_json(), coupling: Array.from(session.coupling()), shape: shape(session, milliseconds) }
  }
  if (!session) return { kind: 'error', message: 'No scene is open.' }
  const open = session
  const changed = (milliseconds: number, scene: string | null): Reply => {
    return { kind: 'shape', shape: shape(open, milliseconds), scene, coupling: Array.from(open.coupling()) }
  }
  const moved = mover?.answer(request)
  if (moved) return moved
  switch (request.kind) {
    case 'motion': {
      const next = new Mover(open.scene_toml())
      stand()
      mover = next
      return next.start()
    }
    case 'statics':
      stand()
      return changed(0, null)
    case 'replace': {
      const milliseconds = timed(() => open.replace(request.text, 'scene.json'))
      return changed(milliseconds, open.scene_json())
    }
    case 'restore': {
      const milliseconds = timed(() => open.restore(request.text, request.mode, request.numbers))
      return changed(milliseconds, open.scene_json())
    }
    case 'hand':
    case 'mode':
    case 'coupling': {
      if (request.kind === 'hand') {
        const [x, y, z, w, i, j, k] = request.pose
        open.set_hand(x, y, z, w, i, j, k)
      } else if (request.kind === 'mode') open.set_mode(request.mode)
      else {
        const [kx, kr, dx, dr, force, torque] = request.values
        open.set_coupling(kx, kr, dx, dr, force, torque)
      }
      const now = performance.now()
      const step = Math.min((now - lastSolve) / 1000, 0.1)
      lastSolve = now
      // A coupling is written into the scene.
      return changed(timed(() => open.solve(step)), request.kind === 'coupling' ? open.scene_json() : null)
    }
    case 'toml':
      return { kind: 'file', name: 'scene.toml', data: open.scene_toml() }
    case 'csv':
      return { kind: 'file', name: 'shape.csv', data: open.shape_csv() }
    case 'glb':
      return { kind: 'file', name: 'shape.glb', data: open.shape_glb() }
    default:
      return { kind: 'error', message: 'Nothing moves: let the scene move first.' }
  }
}

/** Ends a motion. */
function stand(): void {
  mover?.free()
  mover = null
}

const say = (reply: Reply) => self.postMessage(reply)

/** Lets messages in. A message to oneself waits for no timer. */
function breathe(): Promise<void> {
  return new Promise((resolve) => {
    const { port1, port2 } = new MessageChannel()
    port1.onmessage = () => {
      port1.close()
      resolve()
    }
    port2.postMessage(null)
  })
}

/** Goes on towards the hand until it is reached, nothing is left to try, or something else is asked for. */
async function settle(turn: number): Promise<void> {
  await breathe()
  while (settling && !mover && turn === requests && session) {
    const open = session
    const start = performance.now()
    let more = true
    // A snap is told before anything else happens.
    do more = open.settle()
    while (more && !open.snapped() && performance.now() - start < BIT)
    say({ kind: 'settled', shape: shape(open, performance.now() - start) })
    await breathe()
  }
}

/** What to tell a person of an error. */
function explained(error: unknown): string {
  if (!(error instanceof WebAssembly.RuntimeError)) return String(error)
  // What has stopped in the middle of its work cannot be used again.
  session = null
  mover = null
  settling = false
  return `The solver stopped unexpectedly (${error.message}). Reset opens the scene anew.`
}

self.onmessage = async (event: MessageEvent<Request>) => {
  const turn = ++requests
  try {
    await ready.catch((error) => {
      throw `The solver could not be loaded (${error}). Reload the page; an up-to-date browser is needed.`
    })
    say(answer(event.data))
  } catch (error) {
    say({ kind: 'error', message: explained(error) })
  }
  if (settling) void settle(turn).catch((error) => say({ kind: 'stopped', message: explained(error) }))
}
