/** The strip of numbers while the scene moves. */

import { engineering, threeDigits } from './engineering'
import type { Motion } from './motion'
import type { Plot } from './plot'
import type { Readout } from './readout'

/** How many answers the spread of a step's time looks back on. */
const ANSWERS = 300
/** Slower than this part of the speed that is asked for, it is called slow. */
const KEEPS_UP = 0.9

export class MotionReadout {
  #times: number[] = []

  constructor(private readout: Readout, private plot: Plot) {}

  clear(): void {
    this.#times.length = 0
    this.plot.use({ names: ['bad', 'good', 'accent'], together: true, label: 'Kinetic (red), elastic (green) and potential energy (blue) over the last ten seconds' })
  }

  show(motion: Motion): void {
    const { report, factor } = motion
    if (!report) return
    if (report.step_ms !== null) this.#times.push(report.step_ms)
    if (this.#times.length > ANSWERS) this.#times.shift()
    const sorted = [...this.#times].sort((a, b) => a - b)
    const at = (part: number) => threeDigits(sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))])
    const slow = factor !== null && factor < KEEPS_UP * motion.speed
    const texts: Record<string, string> = {
      'motion-time': `${report.time.toFixed(3)} s`,
      'motion-factor': factor === null ? '–' : `${threeDigits(factor)} ×`,
      'motion-kinetic': engineering(report.kinetic, 'J'),
      'motion-elastic': engineering(report.elastic, 'J'),
      'motion-load': engineering(report.load, 'J'),
      'motion-dissipated': engineering(report.dissipated, 'J'),
      'motion-step': sorted.length ? `${at(0.5)} ms, p99 ${at(0.99)}` : '–',
      'motion-newton': `${report.iterations} it., ${report.residual?.toExponential(1) ?? '–'}`,
    }
    for (const [id, text] of Object.entries(texts)) document.getElementById(id)!.textContent = text
    document.getElementById('motion-factor')!.classList.toggle('slow', slow)
    this.plot.add(report.kinetic, report.elastic, report.load)
    if (report.failure) this.readout.say({ kind: 'failed', badge: 'failed' })
    else if (!motion.playing) this.readout.say({ kind: 'still', badge: 'paused' })
    else this.readout.say({ kind: slow ? 'slow' : 'moving', badge: slow ? 'slow' : 'moving' })
  }
}
