/** Where rods are: their nodes as places, how far they reach, and things put where a node is. */

import * as THREE from 'three'
import type { Body } from './protocol'

/** The places of the nodes of some rods. */
export function places(rods: Body[]): THREE.Vector3[] {
  return rods.flatMap(({ frames }) => Array.from({ length: frames.length / 12 }, (_, i) => new THREE.Vector3().fromArray(frames, 12 * i + 9)))
}

/** How long a rod is, m. */
export function length(frames: Float64Array): number {
  const all = places([{ frames, halfExtent: frames }])
  return all.reduce((sum, at, i) => (i ? sum + at.distanceTo(all[i - 1]) : 0), 0)
}

export function measured(rods: Body[]): { box: THREE.Box3; size: number; radius: number } {
  const box = new THREE.Box3().setFromPoints(places(rods))
  const radius = rods[0].halfExtent.reduce((most, a) => Math.max(most, a), 1e-9)
  return { box, size: Math.max(box.getSize(new THREE.Vector3()).length(), 0.02), radius }
}

/** Puts a thing where a node is, keeping its scale. */
export function place(thing: { position: THREE.Vector3; quaternion: THREE.Quaternion }, frames: Float64Array, node: number): void {
  const f = frames.subarray(12 * node, 12 * node + 12)
  const turn = new THREE.Matrix4().set(f[0], f[3], f[6], 0, f[1], f[4], f[7], 0, f[2], f[5], f[8], 0, 0, 0, 0, 1)
  thing.position.set(f[9], f[10], f[11])
  thing.quaternion.setFromRotationMatrix(turn)
}
