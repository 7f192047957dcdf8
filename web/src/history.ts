/** What can be taken back and done again. */

export class History<State> {
  #past: State[] = []
  #future: State[] = []

  /** `changed` is told whether there is something to take back, and to do again. */
  constructor(private changed: (undo: boolean, redo: boolean) => void) {}

  /** Remembers a state that is about to change. */
  push(state: State): void {
    this.#past.push(state)
    if (this.#past.length > 200) this.#past.shift()
    this.#future = []
    this.#tell()
  }

  undo(now: State): State | undefined {
    return this.#step(this.#past, this.#future, now)
  }

  redo(now: State): State | undefined {
    return this.#step(this.#future, this.#past, now)
  }

  clear(): void {
    this.#past = []
    this.#future = []
    this.#tell()
  }

  #step(from: State[], to: State[], now: State): State | undefined {
    const state = from.pop()
    if (state !== undefined) to.push(now)
    this.#tell()
    return state
  }

  #tell(): void {
    this.changed(this.#past.length > 0, this.#future.length > 0)
  }
}
