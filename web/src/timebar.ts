/** The bar of time: start, play, step and speed. It is there while the scene moves. */

import type { Motion } from './motion'
import { SPEEDS } from './motion'

const NAMES = ['1', '¼', '⅒', '1⁄100']
const SPOKEN = ['Real time', 'A quarter of real time', 'A tenth of real time', 'A hundredth of real time']

const button = (id: string) => document.getElementById(id) as HTMLButtonElement

export class TimeBar {
  #speeds: HTMLButtonElement[]

  constructor(private motion: Motion) {
    button('rewind').addEventListener('click', () => motion.rewind())
    button('play').addEventListener('click', () => motion.setPlaying(!motion.playing))
    button('step').addEventListener('click', () => motion.step())
    this.#speeds = SPEEDS.map((speed, i) => {
      const one = Object.assign(document.createElement('button'), { textContent: NAMES[i], title: `${SPOKEN[i]} (${i + 1}).`, ariaLabel: SPOKEN[i] })
      one.dataset.speed = String(speed)
      one.addEventListener('click', () => motion.setSpeed(speed))
      return one
    })
    document.getElementById('speeds')!.append(...this.#speeds)
    this.show()
  }

  /** Shows how time runs. */
  show(): void {
    const { motion } = this
    const play = button('play')
    play.textContent = motion.playing ? 'Pause' : 'Play'
    play.title = motion.playing ? 'Stops time (Space).' : 'Lets time run (Space).'
    this.#speeds.forEach((one, i) => one.setAttribute('aria-pressed', String(SPEEDS[i] === motion.speed)))
  }
}
