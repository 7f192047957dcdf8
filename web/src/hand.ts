/** The hand: where it is, and how it is moved and turned. */

import * as THREE from 'three'
import type { HandPose } from './protocol'

const THREAD_AXIS = new THREE.Vector3(0, 0, 1)

export class Hand {
  readonly position = new THREE.Vector3()
  readonly quaternion = new THREE.Quaternion()

  set(pose: HandPose): void {
    const [x, y, z, w, i, j, k] = pose
    this.position.set(x, y, z)
    this.quaternion.set(i, j, k, w)
  }

  pose(): number[] {
    const { position: p, quaternion: q } = this
    return [p.x, p.y, p.z, q.w, q.x, q.y, q.z]
  }

  /** Turns about the thread's axis. */
  twist(angle: number): void {
    this.quaternion.multiply(new THREE.Quaternion().setFromAxisAngle(THREAD_AXIS, angle)).normalize()
  }

  /** Turns about an axis of the world. */
  turn(axis: THREE.Vector3, angle: number): void {
    this.quaternion.premultiply(new THREE.Quaternion().setFromAxisAngle(axis, angle)).normalize()
  }

  /** Its turns about x, y and z, in this order, in degrees. */
  get angles(): number[] {
    const { x, y, z } = new THREE.Euler().setFromQuaternion(this.quaternion, 'XYZ')
    return [x, y, z].map((angle) => (angle * 180) / Math.PI)
  }

  set angles(degrees: number[]) {
    const [x, y, z] = degrees.map((angle) => (angle * Math.PI) / 180)
    this.quaternion.setFromEuler(new THREE.Euler(x, y, z, 'XYZ'))
  }
}
