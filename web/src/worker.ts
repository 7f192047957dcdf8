/** The solver in its own thread: one request, one reply. */

import init, { Session, bundled } from './wasm/strands_wasm.js'
import wasm from './wasm/strands_wasm_bg.wasm?url'
import type { Reply, Request, Shape } from './protocol'

const ready = init({ module_or_path: wasm })
let session: Session | null = null
let lastSolve = performance.now()

function shape(open: Session, milliseconds: number): Shape {
  return {
    frames: open.frames(),
    otherFrames: open.other_frames(),
    strain: open.strain(),
    stress: open.stress(),
    halfExtent: open.half_extent(),
    hand: open.hand(),
    report: JSON.parse(open.report()),
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
    session = opened as unknown as Session
    return { kind: 'opened', scene: session.scene_json(), coupling: Array.from(session.coupling()), shape: shape(session, milliseconds) }
  }
  if (!session) return { kind: 'error', message: 'No scene is open.' }
  const open = session
  switch (request.kind) {
    case 'replace': {
      const milliseconds = timed(() => open.replace(request.text, 'scene.json'))
      return { kind: 'shape', shape: shape(open, milliseconds), scene: open.scene_json() }
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
      const milliseconds = timed(() => open.solve(step))
      return { kind: 'shape', shape: shape(open, milliseconds), scene: null }
    }
    case 'toml':
      return { kind: 'file', name: 'scene.toml', data: open.scene_toml() }
    case 'csv':
      return { kind: 'file', name: 'shape.csv', data: open.shape_csv() }
    case 'glb':
      return { kind: 'file', name: 'shape.glb', data: open.shape_glb() }
  }
}

self.onmessage = async (event: MessageEvent<Request>) => {
  await ready
  let reply: Reply
  try {
    reply = answer(event.data)
  } catch (error) {
    reply = { kind: 'error', message: String(error) }
  }
  self.postMessage(reply)
}
