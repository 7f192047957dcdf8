/** A small live plot of the last ten seconds. */

const SECONDS = 10

export class Plot {
  #points: [number, number][] = []

  constructor(private canvas: HTMLCanvasElement) {}

  add(value: number): void {
    const now = performance.now() / 1000
    this.#points.push([now, value])
    while (this.#points[0][0] < now - SECONDS) this.#points.shift()
    this.draw()
  }

  draw(): void {
    const context = this.canvas.getContext('2d')!
    const { width, height } = this.canvas
    context.clearRect(0, 0, width, height)
    const style = getComputedStyle(document.documentElement)
    const now = performance.now() / 1000
    const most = Math.max(...this.#points.map(([, value]) => value), 1e-30)
    context.strokeStyle = style.getPropertyValue('--accent')
    context.lineWidth = 1.5
    context.beginPath()
    this.#points.forEach(([time, value], i) => {
      const x = width * (1 - (now - time) / SECONDS)
      const y = height - 3 - (height - 6) * (value / most)
      if (i) context.lineTo(x, y)
      else context.moveTo(x, y)
    })
    context.stroke()
  }
}
