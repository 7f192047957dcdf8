/**
 * The thread as a solid of its own section, with a stripe along d1 that shows how it twists. A ring of points is laid at every node, and
 * the buffers are written in place.
 */

import * as THREE from 'three'
import { atNodes, colourAt, quantities, type MapName } from './colour'
import type { Body, Shape } from './protocol'

/** The colour of a thread that shows nothing: that of a blue suture, in linear light. */
const PLAIN = [0.03, 0.13, 0.42]
/** And that of one that is not in the hand. */
const QUIET = [0.2, 0.22, 0.25]
const STRIPE = [0.82, 0.84, 0.86]

/** A point of a ring, over the half extents along d1 and d2; its normal is `(p, q)` over those. */
interface Point { u: number; v: number; p: number; q: number; stripe: boolean }

/** Rings are made of arcs, each with its own points, so that colours and normals may break between them. */
function arcs(square: boolean): Point[][] {
  if (square) {
    const side = (from: [number, number], to: [number, number], p: number, q: number, stripe = false): Point[] =>
      [from, to].map(([u, v]) => ({ u, v, p, q, stripe }))
    const w = 0.14
    return [
      side([1, -1], [1, -w], 1, 0), side([1, -w], [1, w], 1, 0, true), side([1, w], [1, 1], 1, 0),
      side([1, 1], [-1, 1], 0, 1), side([-1, 1], [-1, -1], -1, 0), side([-1, -1], [1, -1], 0, -1),
    ]
  }
  const arc = (from: number, to: number, steps: number, stripe: boolean): Point[] =>
    Array.from({ length: steps + 1 }, (_, i) => {
      const angle = from + ((to - from) * i) / steps
      const [u, v] = [Math.cos(angle), Math.sin(angle)]
      return { u, v, p: u, q: v, stripe }
    })
  const w = 0.3
  return [arc(-w, w, 3, true), arc(w, 2 * Math.PI - w, 20, false)]
}

export interface Look {
  colourBy: string
  map: MapName
  /** The range of the colours; null where it follows the values. */
  range: [number, number] | null
  displayScale: number
}

export class Tube {
  readonly mesh: THREE.Mesh
  #geometry = new THREE.BufferGeometry()
  #nodes = 0
  #square = false
  #arcs = arcs(false)
  #ring: Point[] = this.#arcs.flat()
  /** The least and greatest value of the quantity that colours the thread. */
  range: [number, number] = [0, 0]

  constructor() {
    const material = new THREE.MeshStandardMaterial({ vertexColors: true, roughness: 0.36 })
    this.mesh = new THREE.Mesh(this.#geometry, material)
    this.mesh.castShadow = true
    this.mesh.receiveShadow = true
    this.mesh.frustumCulled = false
  }

  dispose(): void {
    this.#geometry.dispose()
    ;(this.mesh.material as THREE.Material).dispose()
  }

  /** Round or elliptic, or a rectangle. */
  setSection(square: boolean): void {
    if (square === this.#square) return
    this.#square = square
    this.#arcs = arcs(square)
    this.#ring = this.#arcs.flat()
    this.#nodes = 0
  }

  /** The thread in the hand, coloured by a quantity. */
  update(shape: Shape, look: Look): void {
    const quantity = quantities[look.colourBy]
    const shown = quantity && atNodes(quantity, shape)
    if (shown) this.range = shown.range
    const [low, high] = look.range ?? this.range
    this.#lay(shape, look.displayScale, PLAIN, shown && ((i, into) => colourAt(look.map, high > low ? (shown.values[i] - low) / (high - low) : 0.5, into)))
  }

  /** A thread that nobody holds. */
  updateQuiet(body: Body, displayScale: number): void {
    this.#lay(body, displayScale, QUIET, null)
  }

  #lay(body: Body, displayScale: number, plain: number[], colourOf: ((node: number, into: number[]) => void) | null): void {
    const nodes = body.frames.length / 12
    if (nodes !== this.#nodes) this.#allocate(nodes)
    const position = this.#geometry.attributes.position.array as Float32Array
    const normal = this.#geometry.attributes.normal.array as Float32Array
    const colour = this.#geometry.attributes.color.array as Float32Array
    const base = [...plain]
    const points = this.#ring.length
    const put = (at: number, i: number, point: Point, cap: number) => {
      const f = 12 * i
      const a = body.halfExtent[2 * i] * displayScale
      const b = body.halfExtent[2 * i + 1] * displayScale
      const size = Math.hypot(b * point.p, a * point.q)
      for (let k = 0; k < 3; k++) {
        const [d1, d2, d3] = [body.frames[f + k], body.frames[f + 3 + k], body.frames[f + 6 + k]]
        position[at + k] = body.frames[f + 9 + k] + a * point.u * d1 + b * point.v * d2
        normal[at + k] = cap ? cap * d3 : (b * point.p * d1 + a * point.q * d2) / size
        colour[at + k] = point.stripe && !cap ? STRIPE[k] : base[k]
      }
    }
    for (let i = 0; i < nodes; i++) {
      colourOf?.(i, base)
      for (let j = 0; j < points; j++) put(3 * (i * points + j), i, this.#ring[j], 0)
      if (i > 0 && i < nodes - 1) continue
      const first = nodes * points + (i ? points + 1 : 0)
      for (let j = 0; j < points; j++) put(3 * (first + j), i, this.#ring[j], i ? 1 : -1)
      put(3 * (first + points), i, { u: 0, v: 0, p: 1, q: 0, stripe: false }, i ? 1 : -1)
    }
    for (const name of ['position', 'normal', 'color']) this.#geometry.attributes[name].needsUpdate = true
  }

  #allocate(nodes: number): void {
    this.#nodes = nodes
    const points = this.#ring.length
    this.#geometry.dispose()
    for (const name of ['position', 'normal', 'color']) {
      const attribute = new THREE.BufferAttribute(new Float32Array(3 * (nodes * points + 2 * (points + 1))), 3)
      attribute.setUsage(THREE.DynamicDrawUsage)
      this.#geometry.setAttribute(name, attribute)
    }
    const index: number[] = []
    let start = 0
    for (const arc of this.#arcs) {
      for (let j = start; j + 1 < start + arc.length; j++) {
        for (let i = 0; i + 1 < nodes; i++) {
          const [a, b] = [i * points + j, (i + 1) * points + j]
          index.push(a, a + 1, b, b, a + 1, b + 1)
        }
        const [front, back] = [nodes * points, nodes * points + points + 1]
        index.push(front + points, front + j + 1, front + j, back + points, back + j, back + j + 1)
      }
      start += arc.length
    }
    this.#geometry.setIndex(index)
  }
}
