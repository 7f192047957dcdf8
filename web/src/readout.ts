/** The strip of numbers, and the badge that says whether the shape can be trusted. */

import { engineering, threeDigits } from './engineering'
import type { Plot } from './plot'
import type { Report, Shape } from './protocol'

/** How many solves the spread of the solve time looks back on. */
const SOLVES = 300
/** How long a snap is told of, ms, and how long the words then fade. */
const TOLD = 2000
const FADES = 300

export interface Verdict {
  kind: 'stable' | 'converged' | 'unstable' | 'failed' | 'away' | 'following' | 'moving' | 'slow' | 'still'
  badge: string
  /** What to do where something went wrong. */
  advice: string | null
}

/** What a report comes to. */
export function judge(report: Report): Verdict {
  const away = report.beyond > 0 ? `out of reach by ${(1e3 * report.beyond).toFixed(1)} mm` : null
  // How the way to it ends is not known yet, but how far the hand is away is.
  if (report.settling) return away ? { kind: 'away', badge: away, advice: null } : { kind: 'following', badge: 'following …', advice: null }
  if (report.status === 'failed') {
    const advice = 'No equilibrium was found here, and the last good shape stays. Bring the hand back a little, or turn it another way.'
    return { kind: 'failed', badge: away ? `failed, ${away}` : 'failed', advice }
  }
  if (away) return { kind: 'away', badge: away, advice: null }
  if (report.morse_index === null) return { kind: 'converged', badge: 'converged', advice: null }
  if (report.morse_index === 0) return { kind: 'stable', badge: 'stable', advice: null }
  return { kind: 'unstable', badge: 'unstable', advice: null }
}

export class Readout {
  readonly times: number[] = []
  #badge = document.getElementById('badge')!
  #live = document.getElementById('live')!
  #snap = document.getElementById('snap')!
  #fading = 0
  #said = ''

  constructor(private plot: Plot) {}

  clear(): void {
    this.times.length = 0
    this.plot.use({ names: ['torque', 'force'], together: false, label: 'Force and torque at the hand over the last ten seconds' })
    this.#forgetSnap()
  }

  /** Says for a while that the thread has snapped over. */
  #tellSnap(): void {
    clearTimeout(this.#fading)
    this.#snap.textContent = 'The strand snapped to another equilibrium'
    this.#snap.classList.add('shown')
    this.#fading = window.setTimeout(() => {
      this.#snap.classList.remove('shown')
      this.#fading = window.setTimeout(() => this.#forgetSnap(), FADES)
    }, TOLD)
  }

  #forgetSnap(): void {
    clearTimeout(this.#fading)
    this.#snap.classList.remove('shown')
    this.#snap.textContent = ''
  }

  /** `solved` says whether the shape comes from a solve of its own, and not from the way to an earlier hand. */
  show(shape: Shape, solved: boolean): void {
    const { report } = shape
    if (solved) this.times.push(shape.milliseconds)
    if (this.times.length > SOLVES) this.times.shift()
    const sorted = [...this.times].sort((a, b) => a - b)
    const at = (part: number) => sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))]
    const [force, torque] = [report.end.force, report.end.moment].map((v) => Math.hypot(...v))
    const texts: Record<string, string> = {
      force: engineering(force, 'N') + (report.saturated ? ' (limit)' : ''),
      torque: engineering(torque, 'N·m'),
      energy: engineering(report.elastic_energy, 'J'),
      method: `${report.method}, ${report.elements} el.`,
      newton: `${report.iterations} it., ${report.residual?.toExponential(1) ?? '–'}`,
      time: sorted.length ? `${threeDigits(at(0.5))} ms, p99 ${threeDigits(at(0.99))}` : '–',
    }
    for (const [id, text] of Object.entries(texts)) document.getElementById(id)!.textContent = text
    this.plot.add(torque, force)
    if (report.snapped) this.#tellSnap()
    const verdict = judge(report)
    // Most ways are too short to be seen.
    if (verdict.kind !== 'following' || !solved) this.say(verdict)
  }

  say(verdict: Pick<Verdict, 'kind' | 'badge'>): void {
    this.#badge.textContent = verdict.badge
    this.#badge.className = verdict.kind
    if (this.#said === verdict.kind || verdict.kind === 'following') return
    // Only a change is read out, and not every millimetre.
    this.#said = verdict.kind
    this.#live.textContent = verdict.badge
  }
}
