/** What stands still and is touched: quiet shapes, of which those that hide what moves are seen through. */

import * as THREE from 'three'
import type { ObstacleShape, Triple } from './protocol'

/** Colours of what is solid, of planes, on which the ground's grid is seen, and of edges. */
const LIGHT = { solid: 0xc6d0db, plane: 0xc6d0db, edge: 0x45525f }
const DARK = { solid: 0x6b7a8d, plane: 0x2e3947, edge: 0xb8c5d4 }
/** How wide a plane is drawn, and how long a tube, over the size of the scene. */
const WIDE = 1.7
const LONG = 1.15
/** How much is seen of what is seen through. */
const OPACITY = { plane: 0.55, hollow: 0.22, edge: 0.4 }
/** Faces that meet at less than this have no line between them, degrees. */
const FLAT = 25
/** What has no end, and what is larger than the scene, is of this size over that of the scene where a view shows all. */
const SEEN = 0.6

const vector = (numbers: Triple) => new THREE.Vector3(...numbers)

/** Puts what lies along z along a direction instead. */
function turn(mesh: THREE.Object3D, along: THREE.Vector3): void {
  mesh.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), along)
}

export class Obstacles {
  readonly group = new THREE.Group()
  #solid = new THREE.MeshStandardMaterial({ roughness: 0.75 })
  /** The ground's grid and shadows, which are as high as a level plane, are seen on it. */
  #level = new THREE.MeshStandardMaterial({ roughness: 0.9, side: THREE.DoubleSide, transparent: true, opacity: OPACITY.plane, depthWrite: false })
  /** And they are not seen through another one. */
  #slope = new THREE.MeshStandardMaterial({ roughness: 0.9, side: THREE.DoubleSide, transparent: true, opacity: OPACITY.plane })
  #hollow = new THREE.MeshStandardMaterial({ roughness: 0.6, side: THREE.DoubleSide, transparent: true, opacity: OPACITY.hollow, depthWrite: false })
  #edge = new THREE.LineBasicMaterial({ transparent: true, opacity: OPACITY.edge, depthWrite: false })

  setTheme(dark: boolean): void {
    const { solid, plane, edge } = dark ? DARK : LIGHT
    for (const material of [this.#solid, this.#hollow]) material.color.set(solid)
    for (const material of [this.#level, this.#slope]) material.color.set(plane)
    this.#edge.color.set(edge)
  }

  /** Makes the obstacles of a scene, whose middle and size are given, in place of those that there are. */
  choose(shapes: ObstacleShape[], centre: THREE.Vector3, size: number): void {
    this.group.traverse((old) => {
      if (old instanceof THREE.Mesh || old instanceof THREE.LineSegments) old.geometry.dispose()
    })
    this.group.clear()
    for (const shape of shapes) this.group.add(this.#made(shape, centre, size))
    this.group.updateMatrixWorld()
  }

  #made(shape: ObstacleShape, centre: THREE.Vector3, size: number): THREE.Object3D {
    switch (shape.kind) {
      case 'plane': {
        const normal = vector(shape.normal)
        const mesh = new THREE.Mesh(new THREE.PlaneGeometry(WIDE * size, WIDE * size), isLevel(shape.normal) ? this.#level : this.#slope)
        mesh.position.copy(new THREE.Plane().setFromNormalAndCoplanarPoint(normal, vector(shape.point)).projectPoint(centre, mesh.position))
        turn(mesh, normal)
        // Before the ground, and before what else is seen through.
        mesh.renderOrder = -1
        mesh.receiveShadow = true
        return mesh
      }
      case 'capsule':
      case 'cylinder': {
        const [from, to] = shape.ends.map(vector)
        const along = to.clone().sub(from)
        const length = along.length()
        const mesh = new THREE.Mesh(round(shape.kind, shape.radius, length).rotateX(Math.PI / 2), this.#solid)
        mesh.position.copy(from).add(to).multiplyScalar(0.5)
        if (length > 0) turn(mesh, along.divideScalar(length))
        mesh.castShadow = mesh.receiveShadow = true
        return mesh
      }
      case 'tube': {
        const [point, axis] = [vector(shape.point), vector(shape.axis)]
        const geometry = new THREE.CylinderGeometry(shape.radius, shape.radius, LONG * size, 64, 1, true).rotateX(Math.PI / 2)
        const mesh = this.#seenThrough(geometry)
        mesh.position.copy(point).addScaledVector(axis, centre.clone().sub(point).dot(axis))
        turn(mesh, axis)
        return mesh
      }
      case 'ring': {
        const mesh = new THREE.Mesh(new THREE.TorusGeometry(shape.radius, shape.wire_radius, 24, 96), this.#solid)
        mesh.position.copy(vector(shape.point))
        turn(mesh, vector(shape.axis))
        mesh.castShadow = mesh.receiveShadow = true
        return mesh
      }
      case 'mesh': {
        const geometry = new THREE.BufferGeometry()
        geometry.setAttribute('position', new THREE.Float32BufferAttribute(shape.corners, 3))
        geometry.setIndex(shape.triangles)
        // Without an index corners belong to one face each, which is then flat.
        const flat = geometry.toNonIndexed()
        flat.computeVertexNormals()
        return this.#seenThrough(flat)
      }
    }
  }

  /** A surface that is seen through, with lines where it bends or ends. */
  #seenThrough(geometry: THREE.BufferGeometry): THREE.Mesh {
    const mesh = new THREE.Mesh(geometry, this.#hollow)
    mesh.add(new THREE.LineSegments(new THREE.EdgesGeometry(geometry, FLAT), this.#edge))
    mesh.receiveShadow = true
    return mesh
  }
}

/** What is long of it lies along y. */
function round(kind: 'capsule' | 'cylinder', radius: number, length: number): THREE.BufferGeometry {
  if (kind === 'cylinder') return new THREE.CylinderGeometry(radius, radius, length, 64)
  return length > 0 ? new THREE.CapsuleGeometry(radius, length, 24, 64) : new THREE.SphereGeometry(radius, 64, 48)
}

/** The corners of what a view of the scene is to show of its obstacles: what has ends, as far as it is near what moves. */
export function outlines(shapes: ObstacleShape[], near: THREE.Box3, size: number): THREE.Vector3[] {
  const room = near.clone().expandByScalar(SEEN * size)
  return shapes.flatMap((shape) => {
    const box = bounds(shape)
    if (!box?.intersectsBox(room)) return []
    box.intersect(room)
    return [box.min, box.max]
  })
}

function bounds(shape: ObstacleShape): THREE.Box3 | null {
  switch (shape.kind) {
    case 'capsule':
    case 'cylinder':
      return new THREE.Box3().setFromPoints(shape.ends.map(vector)).expandByScalar(shape.radius)
    case 'ring':
      return new THREE.Box3().setFromPoints([vector(shape.point)]).expandByScalar(shape.radius + shape.wire_radius)
    case 'mesh':
      return new THREE.Box3().setFromArray(shape.corners)
    case 'plane':
    case 'tube':
      return null
  }
}

/** Whether a plane has its free side up. */
function isLevel(normal: Triple): boolean {
  return normal[2] > 1 - 1e-6
}

/** How high the highest level plane is whose free side is up; null where there is none. */
export function levelFloor(shapes: ObstacleShape[]): number | null {
  const levels = shapes.flatMap((shape) => (shape.kind === 'plane' && isLevel(shape.normal) ? [shape.point[2]] : []))
  return levels.length ? Math.max(...levels) : null
}
