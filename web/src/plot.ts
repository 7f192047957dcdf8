/** A small live plot of the last ten seconds. */

const SECONDS = 10

/** What is drawn: a line for each colour of the page's style, each over its own largest value, or all over one range. */
export interface Lines {
  names: string[]
  together: boolean
  label: string
}

export class Plot {
  #lines: Lines = { names: [], together: false, label: '' }
  #points: { time: number; values: number[] }[] = []

  constructor(private canvas: HTMLCanvasElement) {
    setInterval(() => this.draw(), 250)
  }

  /** Begins anew with other lines. */
  use(lines: Lines): void {
    this.#lines = lines
    this.canvas.ariaLabel = lines.label
    this.#points = []
    this.draw()
  }

  /** A value for each line, now. */
  add(...values: number[]): void {
    this.#points.push({ time: performance.now() / 1000, values })
  }

  draw(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas
    if (width === 0) return
    const sharp = Math.min(devicePixelRatio, 2)
    if (this.canvas.width !== width * sharp) Object.assign(this.canvas, { width: width * sharp, height: height * sharp })
    const context = this.canvas.getContext('2d')!
    context.setTransform(sharp, 0, 0, sharp, 0, 0)
    context.clearRect(0, 0, width, height)
    const now = performance.now() / 1000
    // One point before the window stays, so that the line begins at its edge.
    while (this.#points.length > 1 && this.#points[1].time < now - SECONDS) this.#points.shift()
    const style = getComputedStyle(document.documentElement)
    this.#lines.names.forEach((name, i) => {
      const [low, high] = this.#range(i)
      const y = (value: number) => height - 3 - (height - 6) * ((value - low) / (high - low))
      context.strokeStyle = style.getPropertyValue(`--${name}`)
      context.lineWidth = 1.6
      context.lineJoin = 'round'
      context.beginPath()
      for (const { time, values } of this.#points) context.lineTo(width * (1 - (now - time) / SECONDS), y(values[i]))
      // The last value holds until now.
      const last = this.#points[this.#points.length - 1]
      if (last) context.lineTo(width, y(last.values[i]))
      context.stroke()
    })
  }

  #range(line: number): [number, number] {
    const values = this.#points.flatMap(({ values }) => (this.#lines.together ? values : [values[line]]))
    const bounds = values.reduce(([low, high], value) => [Math.min(low, value), Math.max(high, value)], [0, 0])
    return [bounds[0], Math.max(bounds[1], bounds[0] + 1e-30)]
  }
}
