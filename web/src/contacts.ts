/**
 * Contacts: a dot where surfaces touch, a ring around a rod where it passes through an eyelet or a hole, and an arrow along the force there. All of them are four
 * instanced meshes, whose buffers are written in place and grow where there is more to show than ever before.
 */

import * as THREE from 'three'
import { head, HEAD, LONGEST, marked, shaft, THICK } from './arrows'

/** How many numbers a contact has: its point, its normal, its force; and a passage: its point, the rod's direction, its force. */
const NUMBERS = 9
/** The radii of a ring and of its wire, over that of a dot. */
const RING = [1.6, 0.45] as const
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
  #rings!: THREE.InstancedMesh
  #shafts!: THREE.InstancedMesh
  #heads!: THREE.InstancedMesh
  #material = marked('force')
  #geometries = [new THREE.SphereGeometry(1, 14, 10), new THREE.TorusGeometry(...RING, 10, 32), shaft(), head()]
  /** The force that the longest arrow stands for, N, and the contacts that it was found with. */
  #most = 0
  #shown: Float64Array | null = null
  // Scratch.
  #matrix = new THREE.Matrix4()
  #point = new THREE.Vector3()
  #along = new THREE.Vector3()
  #axis = new THREE.Vector3()
  #at = new THREE.Vector3()
  #turn = new THREE.Quaternion()
  #across = new THREE.Quaternion()
  #scale = new THREE.Vector3()

  constructor() {
    this.#makeRoom(ROOM)
  }

  /** How many contacts and passages are drawn, and how many of them with an arrow. */
  get count(): { dots: number; rings: number; arrows: number } {
    return this.group.visible ? { dots: this.#dots.count, rings: this.#rings.count, arrows: this.#heads.count } : { dots: 0, rings: 0, arrows: 0 }
  }

  /** Forgets how great forces were. */
  forget(): void {
    this.#most = 0
    this.#shown = null
    this.group.visible = false
  }

  /** Shows contacts and passages in a scene of a size, nine numbers each, as dots of a radius and rings around it. */
  show(contacts: Float64Array, passages: Float64Array, visible: boolean, size: number, radius: number): void {
    const [dots, rings] = [contacts.length / NUMBERS, passages.length / NUMBERS]
    this.group.visible = visible && dots + rings > 0
    if (!this.group.visible) return
    if (dots + rings > this.#dots.instanceMatrix.count) this.#makeRoom(2 * (dots + rings))
    if (contacts !== this.#shown) this.#span(contacts, passages)
    this.#shown = contacts
    let arrows = 0
    for (let i = 0; i < dots + rings; i++) {
      const touches = i < dots
      const part = (touches ? this.#read(contacts, i) : this.#read(passages, i - dots)) / this.#most
      if (touches) this.#put(this.#dots, i, 0, radius, radius)
      else this.#ring(i - dots, passages, radius)
      if (part > LEAST) this.#arrow(arrows++, LONGEST * part * size, THINNER * THICK * size)
    }
    this.#dots.count = dots
    this.#rings.count = rings
    this.#shafts.count = this.#heads.count = arrows
    for (const mesh of [this.#dots, this.#rings, this.#shafts, this.#heads]) mesh.instanceMatrix.needsUpdate = true
  }

  /** The scale of the arrows follows greater forces at once, and smaller ones slowly. */
  #span(...all: Float64Array[]): void {
    let most = 0
    for (const of of all) for (let i = 0; i < of.length / NUMBERS; i++) most = Math.max(most, this.#read(of, i))
    this.#most = Math.max(most, this.#most + EASE * (most - this.#most))
  }

  /** Puts a ring where the rod is that goes through it. */
  #ring(i: number, passages: Float64Array, radius: number): void {
    this.#axis.fromArray(passages, NUMBERS * i + 3)
    this.#across.setFromUnitVectors(UP, this.#axis)
    this.#rings.setMatrixAt(i, this.#matrix.compose(this.#point, this.#across, this.#scale.setScalar(radius)))
  }

  /** Reads where one of many contacts or passages is and where its force points to, and gives how great it is, N. */
  #read(all: Float64Array, one: number): number {
    this.#point.fromArray(all, NUMBERS * one)
    this.#along.fromArray(all, NUMBERS * one + 6)
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
    ;[this.#dots, this.#rings, this.#shafts, this.#heads] = made
    this.group.add(...made)
  }
}

const UP = new THREE.Vector3(0, 0, 1)
