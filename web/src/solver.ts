/**
 * The page's end of the worker: requests are answered in order, and of the hand's moves only the newest waits. Moves that come while a
 * solve runs replace the one that waits.
 */

import type { HandPose, Reply, Request } from './protocol'

export class Solver {
  #worker = new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' })
  #waiting: ((reply: Reply) => void)[] = []
  #hand: HandPose | null = null
  #following = false

  constructor(private onFrame: (reply: Reply) => void) {
    this.#worker.onmessage = (event: MessageEvent<Reply>) => {
      if (event.data.kind === 'settled' || event.data.kind === 'stopped') this.onFrame(event.data)
      else this.#waiting.shift()?.(event.data)
    }
  }

  ask(request: Request): Promise<Reply> {
    return new Promise((resolve) => {
      this.#waiting.push(resolve)
      this.#worker.postMessage(request)
    })
  }

  async move(pose: HandPose): Promise<void> {
    this.#hand = pose
    if (this.#following) return
    this.#following = true
    while (this.#hand) {
      const next = this.#hand
      this.#hand = null
      this.onFrame(await this.ask({ kind: 'hand', pose: next }))
    }
    this.#following = false
  }

  /** Forgets a move that waits: the scene or the hand has been set to something else. */
  forget(): void {
    this.#hand = null
  }
}
