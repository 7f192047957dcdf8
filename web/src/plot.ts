/** A small live plot of the last ten seconds: force and torque at the hand, each over its own largest value. */

const SECONDS = 10

export class Plot {
  #points: { time: number; force: number; torque: number }[] = []

  constructor(private canvas: HTMLCanvasElement) {
    setInterval(() => this.draw(), 250)
  }

  add(force: number, torque: number): void {
    this.#points.push({ time: performance.now() / 1000, force, torque })
  }

  clear(): void {
    this.#points = []
    this.draw()
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
    for (const name of ['torque', 'force'] as const) {
      const most = this.#points.reduce((most, point) => Math.max(most, point[name]), 1e-30)
      context.strokeStyle = style.getPropertyValue(`--${name}`)
      context.lineWidth = 1.6
      context.lineJoin = 'round'
      context.beginPath()
      for (const point of this.#points) {
        context.lineTo(width * (1 - (now - point.time) / SECONDS), height - 3 - (height - 6) * (point[name] / most))
      }
      // The last value holds until now.
      const last = this.#points[this.#points.length - 1]
      if (last) context.lineTo(width, height - 3 - (height - 6) * (last[name] / most))
      context.stroke()
    }
  }
}
