/** The page's end of the worker: requests are answered in order, and of the hand's moves only the newest waits. */

import type { HandPose, Reply, Request } from './protocol'

export class Solver {
  #worker = new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' })
  #waiting: ((reply: Reply) => void)[] = []
  #hand: HandPose | null = null
  #following = false

  constructor(private onFrame: (reply: Reply) => void) {
    this.#worker.onmessage = (event: MessageEvent<Reply>) => this.#waiting.shift()?.(event.data)
  }

  ask(request: Request): Promise<Reply> {
    return new Promise((resolve) => {
      this.#waiting.push(resolve)
      this.#worker.postMessage(request)
    })
  }

  /** Moves the hand. While a solve runs, later moves replace the one that waits. */
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
}
