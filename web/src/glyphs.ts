/** What can be drawn along the thread on request: its material frame, its internal force, its internal moment. */

import * as THREE from 'three'
import type { Body, Carried } from './protocol'

/** A thread and what it carries. */
type Shape = Body & Carried

export interface GlyphOptions {
  directors: boolean
  internalForce: boolean
  internalMoment: boolean
}

/** How many places along the thread carry a glyph. */
const PLACES = 48
const AXES = [[0.8, 0.1, 0.08], [0.08, 0.5, 0.12], [0.1, 0.25, 0.85]]

export class Glyphs {
  readonly lines = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ vertexColors: true }))

  constructor() {
    this.lines.frustumCulled = false
  }

  show(shape: Shape, options: GlyphOptions, size: number): void {
    this.lines.visible = options.directors || options.internalForce || options.internalMoment
    if (!this.lines.visible) return
    const points: number[] = []
    const colours: number[] = []
    if (options.directors) this.#directors(shape, 0.035 * size, points, colours)
    if (options.internalForce) this.#stress(shape, 3, 0.14 * size, [0.7, 0.14, 0.02], points, colours)
    if (options.internalMoment) this.#stress(shape, 0, 0.14 * size, [0.2, 0.06, 0.75], points, colours)
    this.lines.geometry.dispose()
    this.lines.geometry = new THREE.BufferGeometry()
    this.lines.geometry.setAttribute('position', new THREE.Float32BufferAttribute(points, 3))
    this.lines.geometry.setAttribute('color', new THREE.Float32BufferAttribute(colours, 3))
  }

  #directors(shape: Shape, length: number, points: number[], colours: number[]): void {
    const nodes = shape.frames.length / 12
    for (let i = 0; i < nodes; i += Math.max(1, Math.floor(nodes / PLACES))) {
      const f = shape.frames.subarray(12 * i, 12 * i + 12)
      for (let d = 0; d < 3; d++) {
        points.push(f[9], f[10], f[11])
        for (let k = 0; k < 3; k++) points.push(f[9 + k] + length * f[3 * d + k])
        colours.push(...AXES[d], ...AXES[d])
      }
    }
  }

  /** The force (from = 3) or moment (from = 0) that the part beyond exerts, as hairs whose ends are joined; the longest is `length`. */
  #stress(shape: Shape, from: number, length: number, colour: number[], points: number[], colours: number[]): void {
    const elements = shape.stress.length / 6
    const size = (e: number) => Math.hypot(...shape.stress.subarray(6 * e + from, 6 * e + from + 3))
    let most = 1e-30
    for (let e = 0; e < elements; e++) most = Math.max(most, size(e))
    let before: number[] | null = null
    for (let e = 0; e < elements; e += Math.max(1, Math.floor(elements / PLACES))) {
      const f = shape.frames.subarray(12 * e, 12 * e + 12)
      const foot = [f[9], f[10], f[11]]
      const tip = [0, 1, 2].map((k) => {
        const world = [0, 1, 2].reduce((sum, d) => sum + shape.stress[6 * e + from + d] * f[3 * d + k], 0)
        return foot[k] + (length * world) / most
      })
      points.push(...foot, ...tip)
      if (before) points.push(...before, ...tip)
      for (let i = 0; i < (before ? 4 : 2); i++) colours.push(...colour)
      before = tip
    }
  }
}
