/**
 * Contacts: a dot where surfaces touch, and an arrow along the force there. All of them are three instanced meshes, whose buffers are written in place and
 * grow where there are more contacts than ever before.
 */

import * as THREE from 'three'
import { head, HEAD, LONGEST, marked, shaft, THICK } from './arrows'

/** How many numbers a contact has: its point, its normal, its force. */
const NUMBERS = 9
/** Room for so many at first. */
const ROOM = 64
/** An arrow is drawn from this part of the greatest force on. */
const LEAST = 1e-3
/** An arrow among many is this much thinner than one that stands alone. */
const THINNER = 0.5
/** How much of the way to a smaller greatest force is gone in a frame: an impact must not make all arrows flicker. */
const EASE = 0.08

export class Contacts {
  readonly group = new THREE.Group()
  #dots!: THREE.InstancedMesh
  #shafts!: THREE.InstancedMesh
  #heads!: THREE.InstancedMesh
  #material = marked('force')
  #geometries = [new THREE.SphereGeometry(1, 14, 10), shaft(), head()]
  /** The force that the longest arrow stands for, N, and the contacts that it was found from. */
  #most = 0
  #shown: Float64Array | null = null
  // Scratch.
  #matrix = new THREE.Matrix4()
  #point = new THREE.Vector3()
  #along = new THREE.Vector3()
  #at = new THREE.Vector3()
  #turn = new THREE.Quaternion()
  #scale = new THREE.Vector3()

  constructor() {
    this.#makeRoom(ROOM)
  }

  /** How many contacts are drawn, and how many of them with an arrow. */
  get count(): { dots: number; arrows: number } {
    return this.group.visible ? { dots: this.#dots.count, arrows: this.#heads.count } : { dots: 0, arrows: 0 }
  }

  /** Forgets how great forces were. */
  forget(): void {
    this.#most = 0
    this.#shown = null
    this.group.visible = false
  }

  /** Shows contacts in a scene of a size, nine numbers each, as dots of a radius. */
  show(contacts: Float64Array, visible: boolean, size: number, radius: number): void {
    const count = contacts.length / NUMBERS
    this.group.visible = visible && count > 0
    if (!this.group.visible) return
    if (count > this.#dots.instanceMatrix.count) this.#makeRoom(2 * count)
    if (contacts !== this.#shown) this.#span(contacts, count)
    this.#shown = contacts
    let arrows = 0
    for (let i = 0; i < count; i++) {
      const part = this.#read(contacts, i) / this.#most
      this.#put(this.#dots, i, 0, radius, radius)
      if (part > LEAST) this.#arrow(arrows++, LONGEST * part * size, THINNER * THICK * size)
    }
    this.#dots.count = count
    this.#shafts.count = this.#heads.count = arrows
    for (const mesh of [this.#dots, this.#shafts, this.#heads]) mesh.instanceMatrix.needsUpdate = true
  }

  /** The scale of the arrows follows greater forces at once, and smaller ones slowly. */
  #span(contacts: Float64Array, count: number): void {
    let most = 0
    for (let i = 0; i < count; i++) most = Math.max(most, this.#read(contacts, i))
    this.#most = Math.max(most, this.#most + EASE * (most - this.#most))
  }

  /** Reads where a contact is and where its force points to, and gives how great it is, N. */
  #read(contacts: Float64Array, contact: number): number {
    this.#point.fromArray(contacts, NUMBERS * contact)
    this.#along.fromArray(contacts, NUMBERS * contact + 6)
    const force = this.#along.length()
    if (force > 0) this.#turn.setFromUnitVectors(UP, this.#along.divideScalar(force))
    return force
  }

  /** An arrow that is too short for its head is smaller as a whole. */
  #arrow(i: number, length: number, thick: number): void {
    const slender = Math.min(1, length / (2 * HEAD * thick))
    const [wide, tip] = [thick * slender, HEAD * thick * slender]
    this.#put(this.#shafts, i, 0, wide, length - tip)
    this.#put(this.#heads, i, length - tip / 2, 3 * wide, 3 * wide)
  }

  /** Puts an instance so far along the force from the contact. */
  #put(mesh: THREE.InstancedMesh, i: number, ahead: number, wide: number, long: number): void {
    this.#at.copy(this.#point).addScaledVector(this.#along, ahead)
    mesh.setMatrixAt(i, this.#matrix.compose(this.#at, this.#turn, this.#scale.set(wide, wide, long)))
  }

  #makeRoom(count: number): void {
    for (const old of this.group.children) (old as THREE.InstancedMesh).dispose()
    this.group.clear()
    const made = this.#geometries.map((geometry) => {
      const mesh = new THREE.InstancedMesh(geometry, this.#material, count)
      mesh.instanceMatrix.setUsage(THREE.DynamicDrawUsage)
      mesh.frustumCulled = false
      return mesh
    })
    ;[this.#dots, this.#shafts, this.#heads] = made
    this.group.add(...made)
  }
}

const UP = new THREE.Vector3(0, 0, 1)
