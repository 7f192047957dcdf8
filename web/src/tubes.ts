/**
 * Threads as solids of their own sections, with a stripe along d1 that shows how they twist: all of them one mesh, so that a tuft of hair is drawn as
 * fast as a thread. A ring of points is laid at every node, and the buffers are written in place.
 */

import * as THREE from 'three'
import { atNodes, colourAt, quantities, type MapName } from './colour'
import type { Body, Carried } from './protocol'

/** A thread to draw: coloured by what its elements carry, or quiet where that is not given. */
export type Strand = Body & Partial<Carried>

/** The colour of a thread that shows nothing: that of a blue suture, in linear light. */
const PLAIN = [0.03, 0.13, 0.42]
/** And that of one that is not in the hand. */
const QUIET = [0.2, 0.22, 0.25]
const STRIPE = [0.82, 0.84, 0.86]
/** From so many threads on they are a bundle: each has half as many sides. */
export const MANY = 12
/** How much of the way to a narrower range of colours is gone in a frame, where the range must not flicker. */
const EASE = 0.03

/** A point of a ring, over the half extents along d1 and d2; its normal is `(p, q)` over those. */
interface Point { u: number; v: number; p: number; q: number; stripe: boolean }

/** Rings are made of arcs, each with its own points, so that colours and normals may break between them. */
function arcs(square: boolean, fine: boolean): Point[][] {
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
  return [arc(-w, w, fine ? 3 : 1, true), arc(w, 2 * Math.PI - w, fine ? 20 : 11, false)]
}

export interface Look {
  colourBy: string
  map: MapName
  /** The range of the colours; null where it follows the values. */
  range: [number, number] | null
  displayScale: number
}

/** Where a thread is in the buffers. */
interface Place { first: number; nodes: number; arcs: Point[][]; ring: Point[] }

export class Tubes {
  readonly mesh: THREE.Mesh
  #geometry = new THREE.BufferGeometry()
  #square: boolean[] = []
  #places: Place[] = []
  /** The least and greatest value of the quantity that colours the threads. */
  range: [number, number] = [0, 0]

  constructor() {
    const material = new THREE.MeshStandardMaterial({ vertexColors: true, roughness: 0.36 })
    this.mesh = new THREE.Mesh(this.#geometry, material)
    this.mesh.castShadow = true
    this.mesh.receiveShadow = true
    this.mesh.frustumCulled = false
  }

  /** How many threads are drawn. */
  get count(): number {
    return this.#places.length
  }

  /** Which threads are rectangles; the others are round or elliptic. */
  setSections(square: boolean[]): void {
    this.#square = square
    this.#places = []
  }

  /** Shows the threads. Where they move, the range of the colours grows at once and shrinks slowly. */
  update(strands: Strand[], look: Look, moving = false): void {
    const fits = strands.length === this.#places.length && strands.every(({ frames }, i) => frames.length === 12 * this.#places[i].nodes)
    if (!fits) this.#allocate(strands.map(({ frames }) => frames.length / 12))
    const quantity = quantities[look.colourBy]
    const shown = strands.map((strand) => (quantity && hasFields(strand) ? atNodes(quantity, strand) : null))
    const ranges = shown.flatMap((one) => (one ? [one.range] : []))
    if (ranges.length) this.#span([Math.min(...ranges.map(([low]) => low)), Math.max(...ranges.map(([, high]) => high))], moving && fits)
    const [low, high] = look.range ?? this.range
    const part = (value: number) => (high > low ? (value - low) / (high - low) : 0.5)
    strands.forEach((strand, i) => {
      const values = shown[i]?.values
      const colourOf = values && ((node: number, into: number[]) => colourAt(look.map, part(values[node]), into))
      this.#lay(this.#places[i], strand, look.displayScale, hasFields(strand) ? PLAIN : QUIET, colourOf)
    })
    for (const name of ['position', 'normal', 'color']) this.#geometry.attributes[name].needsUpdate = true
  }

  #span([low, high]: [number, number], eased: boolean): void {
    const [before, after] = this.range
    this.range = eased ? [Math.min(low, before + EASE * (low - before)), Math.max(high, after + EASE * (high - after))] : [low, high]
  }

  #lay(place: Place, body: Body, displayScale: number, plain: number[], colourOf?: (node: number, into: number[]) => void): void {
    const { first, nodes, ring } = place
    const { frames, halfExtent } = body
    const position = this.#geometry.attributes.position.array as Float32Array
    const normal = this.#geometry.attributes.normal.array as Float32Array
    const colour = this.#geometry.attributes.color.array as Float32Array
    const base = [...plain]
    const points = ring.length
    let [a, b] = [0, 0]
    const put = (at: number, f: number, { u, v, p, q, stripe }: Point, cap: number) => {
      const size = Math.hypot(b * p, a * q)
      const [along, across] = [(b * p) / size, (a * q) / size]
      for (let k = 0; k < 3; k++) {
        const [d1, d2] = [frames[f + k], frames[f + 3 + k]]
        position[at + k] = frames[f + 9 + k] + a * u * d1 + b * v * d2
        normal[at + k] = cap ? cap * frames[f + 6 + k] : along * d1 + across * d2
        colour[at + k] = stripe && !cap ? STRIPE[k] : base[k]
      }
    }
    for (let i = 0; i < nodes; i++) {
      a = halfExtent[2 * i] * displayScale
      b = halfExtent[2 * i + 1] * displayScale
      colourOf?.(i, base)
      for (let j = 0; j < points; j++) put(3 * (first + i * points + j), 12 * i, ring[j], 0)
      if (i > 0 && i < nodes - 1) continue
      const lid = first + nodes * points + (i ? points + 1 : 0)
      for (let j = 0; j < points; j++) put(3 * (lid + j), 12 * i, ring[j], i ? 1 : -1)
      put(3 * (lid + points), 12 * i, MIDDLE, i ? 1 : -1)
    }
  }

  #allocate(nodes: number[]): void {
    let first = 0
    this.#places = nodes.map((count, i) => {
      const parts = arcs(this.#square[i] ?? false, nodes.length < MANY)
      const place = { first, nodes: count, arcs: parts, ring: parts.flat() }
      first += count * place.ring.length + 2 * (place.ring.length + 1)
      return place
    })
    this.#geometry.dispose()
    for (const name of ['position', 'normal', 'color']) {
      const attribute = new THREE.BufferAttribute(new Float32Array(3 * first), 3)
      attribute.setUsage(THREE.DynamicDrawUsage)
      this.#geometry.setAttribute(name, attribute)
    }
    this.#geometry.setIndex(this.#places.flatMap(triangles))
  }
}

const MIDDLE: Point = { u: 0, v: 0, p: 1, q: 0, stripe: false }

function hasFields(strand: Strand): strand is Body & Carried {
  return strand.strain !== undefined
}

/** The triangles between the rings of a thread, and those of its two lids. */
function triangles({ first, nodes, arcs, ring: { length: points } }: Place): number[] {
  const index: number[] = []
  let start = 0
  for (const arc of arcs) {
    for (let j = start; j + 1 < start + arc.length; j++) {
      for (let i = 0; i + 1 < nodes; i++) {
        const [a, b] = [first + i * points + j, first + (i + 1) * points + j]
        index.push(a, a + 1, b, b, a + 1, b + 1)
      }
      const [front, back] = [first + nodes * points, first + nodes * points + points + 1]
      index.push(front + points, front + j + 1, front + j, back + points, back + j, back + j + 1)
    }
    start += arc.length
  }
  return index
}
