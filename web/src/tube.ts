/** The thread as a tube of its true section, with a stripe along d1 that shows how it twists. Buffers are written in place. */

import * as THREE from 'three'
import { quantities, viridis } from './colour'
import type { Shape } from './protocol'

const SIDES = 20
const STRIPE = 2
const PLAIN = [0.1, 0.24, 0.5]

export class Tube {
  readonly mesh: THREE.Mesh
  #geometry = new THREE.BufferGeometry()
  #nodes = 0
  /** The least and greatest value of the quantity that colours the thread. */
  range: [number, number] = [0, 0]

  constructor() {
    const material = new THREE.MeshStandardMaterial({ vertexColors: true, roughness: 0.38, metalness: 0.05 })
    this.mesh = new THREE.Mesh(this.#geometry, material)
    this.mesh.castShadow = true
    this.mesh.receiveShadow = true
    this.mesh.frustumCulled = false
  }

  update(shape: Shape, scale: number, by: string): void {
    const nodes = shape.frames.length / 12
    if (nodes !== this.#nodes) this.#allocate(nodes)
    const position = this.#geometry.attributes.position.array as Float32Array
    const normal = this.#geometry.attributes.normal.array as Float32Array
    const colour = this.#geometry.attributes.color.array as Float32Array
    const values = this.#values(shape, by, nodes)
    for (let i = 0; i < nodes; i++) {
      const f = 12 * i
      const [a, b] = [shape.halfExtent[2 * i] * scale, shape.halfExtent[2 * i + 1] * scale]
      const [low, high] = this.range
      const base = values ? viridis(high > low ? (values[i] - low) / (high - low) : 0.5) : PLAIN
      for (let j = 0; j <= SIDES; j++) {
        const angle = (2 * Math.PI * j) / SIDES
        const [cos, sin] = [Math.cos(angle), Math.sin(angle)]
        const at = 3 * (i * (SIDES + 1) + j)
        const stripe = j < STRIPE || j === SIDES ? 1 : 0
        for (let k = 0; k < 3; k++) {
          const [d1, d2] = [shape.frames[f + k], shape.frames[f + 3 + k]]
          position[at + k] = shape.frames[f + 9 + k] + a * cos * d1 + b * sin * d2
          normal[at + k] = (b * cos * d1 + a * sin * d2) / Math.hypot(b * cos, a * sin)
          colour[at + k] = stripe ? 0.85 : base[k]
        }
      }
    }
    for (const name of ['position', 'normal', 'color']) this.#geometry.attributes[name].needsUpdate = true
    this.#geometry.computeBoundingSphere()
  }

  #values(shape: Shape, by: string, nodes: number): Float64Array | null {
    const quantity = quantities[by]
    if (!quantity) return null
    const values = new Float64Array(nodes)
    this.range = [Infinity, -Infinity]
    for (let i = 0; i < nodes; i++) {
      const [before, after] = [Math.max(i - 1, 0), Math.min(i, nodes - 2)]
      values[i] = 0.5 * (quantity.value(shape, before) + quantity.value(shape, after))
      this.range = [Math.min(this.range[0], values[i]), Math.max(this.range[1], values[i])]
    }
    return values
  }

  #allocate(nodes: number): void {
    this.#nodes = nodes
    const points = nodes * (SIDES + 1)
    this.#geometry.dispose()
    for (const name of ['position', 'normal', 'color']) {
      const attribute = new THREE.BufferAttribute(new Float32Array(3 * points), 3)
      attribute.setUsage(THREE.DynamicDrawUsage)
      this.#geometry.setAttribute(name, attribute)
    }
    const index = new Uint32Array(6 * SIDES * (nodes - 1))
    let at = 0
    for (let i = 0; i + 1 < nodes; i++) {
      for (let j = 0; j < SIDES; j++) {
        const [a, b] = [i * (SIDES + 1) + j, (i + 1) * (SIDES + 1) + j]
        index.set([a, a + 1, b, b, a + 1, b + 1], at)
        at += 6
      }
    }
    this.#geometry.setIndex(new THREE.BufferAttribute(index, 1))
  }
}
