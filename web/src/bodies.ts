/** The rigid bodies of a scene in motion. */

import * as THREE from 'three'
import { place } from './places'
import type { BodyShape } from './protocol'

/** Bodies to draw: what they look like, and twelve numbers each of where they are. */
export interface Bodies {
  shapes: BodyShape[]
  frames: Float64Array
}

/** The solid of a shape, its centre at the origin and what is long of it along z. */
function solid(shape: BodyShape): THREE.BufferGeometry {
  switch (shape.kind) {
    case 'ball':
      return new THREE.SphereGeometry(shape.radius, 48, 32)
    case 'capsule':
      return new THREE.CapsuleGeometry(shape.radius, shape.length, 16, 48).rotateX(Math.PI / 2)
    case 'cylinder':
      return new THREE.CylinderGeometry(shape.radius, shape.radius, shape.length, 48).rotateX(Math.PI / 2)
    case 'ring':
      return new THREE.TorusGeometry(shape.radius, shape.wire_radius, 24, 96)
    case 'block':
      return new THREE.BoxGeometry(...shape.size)
  }
}

export class Solids {
  readonly group = new THREE.Group()
  #material = new THREE.MeshStandardMaterial({ color: 0xa8452c, roughness: 0.42 })

  /** Makes the solids of some shapes in place of those that there are. */
  choose(shapes: BodyShape[]): void {
    for (const old of this.group.children) (old as THREE.Mesh).geometry.dispose()
    this.group.clear()
    for (const shape of shapes) {
      const mesh = new THREE.Mesh(solid(shape), this.#material)
      mesh.castShadow = mesh.receiveShadow = true
      this.group.add(mesh)
    }
  }

  /** Puts them where they are. */
  put(frames: Float64Array): void {
    this.group.children.forEach((mesh, i) => place(mesh, frames, i))
  }
}
