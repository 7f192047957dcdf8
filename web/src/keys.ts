/** The keyboard: everything that the pointer can do, in steps. */

import type { Stage } from './stage'

/** What a key asks of the page. */
export interface Commands {
  undo: () => void
  redo: () => void
  pause: () => void
  help: () => void
  escape: () => void
  /** From statics to motion and back. */
  motion: () => void
  /** While the scene moves: a step, the start, a speed by its place, and to grab the thread's end or let it go. */
  step: () => void
  rewind: () => void
  speed: (place: number) => void
  grab: () => void
  /** Whether it moves. */
  moves: () => boolean
  /** Before and after a key moves the hand. */
  grabbed: () => void
  moved: () => void
}

const STEP = 0.01
const TURN = 0.15
/** Presses of one key within this time, ms, are one change. */
const RUN = 700

export function listenToKeys(stage: Stage, commands: Commands): void {
  const moves: Record<string, Parameters<Stage['nudge']>[0]> = {
    q: { twist: -TURN },
    e: { twist: TURN },
    w: { near: -STEP },
    s: { near: STEP },
    arrowleft: { right: -STEP },
    arrowright: { right: STEP },
    arrowup: { up: STEP },
    arrowdown: { up: -STEP },
  }
  const others: Record<string, () => void> = {
    f: () => stage.frameAll(),
    m: commands.motion,
    '?': commands.help,
    escape: commands.escape,
  }
  const still: Record<string, () => void> = {
    t: () => stage.toggleGizmo('translate'),
    r: () => stage.toggleGizmo('rotate'),
  }
  const moving: Record<string, () => void> = {
    '.': commands.step,
    home: commands.rewind,
    g: commands.grab,
    ...Object.fromEntries([0, 1, 2, 3].map((place) => [String(place + 1), () => commands.speed(place)])),
  }
  let last = { key: '', time: -Infinity }
  document.addEventListener('keydown', (event) => {
    const key = event.key.toLowerCase()
    const target = event.target as HTMLElement
    if (target.closest('dialog')) return
    const typing = target.matches('input:not([type=checkbox]), select, textarea')
    if ((event.ctrlKey || event.metaKey) && !typing && (key === 'z' || key === 'y')) {
      event.preventDefault()
      return key === 'y' || event.shiftKey ? commands.redo() : commands.undo()
    }
    if (event.ctrlKey || event.metaKey || event.altKey) return
    if (typing && key !== 'escape') return
    if (key === ' ' && !target.matches('button, summary, input')) {
      event.preventDefault()
      return commands.pause()
    }
    const move = moves[key]
    if (move) {
      event.preventDefault()
      const now = performance.now()
      if (key !== last.key || now - last.time > RUN) commands.grabbed()
      last = { key, time: now }
      stage.nudge(event.shiftKey ? scaled(move, 0.1) : move)
      return commands.moved()
    }
    const more = commands.moves() ? moving : still
    ;(others[key] ?? more[key])?.()
  })
}

/** With Shift the steps are a tenth. */
function scaled(move: Parameters<Stage['nudge']>[0], by: number): Parameters<Stage['nudge']>[0] {
  return Object.fromEntries(Object.entries(move).map(([name, value]) => [name, (value ?? 0) * by]))
}
