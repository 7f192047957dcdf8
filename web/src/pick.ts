/**
 * Which place of a rod a pointer takes hold of: the nearest on the page, within a reach beyond what is drawn of the rod; of several that are under the
 * pointer the one in front. Threads are thinner than fingers, so the distance is measured on the page, and not by a ray.
 */

import * as THREE from 'three'
import type { Body } from './protocol'

export interface Picked { rod: number; node: number }

/** `pointer` and `reach` in px of a canvas whose size is `box`'s. */
export function pick(
  rods: Body[], camera: THREE.PerspectiveCamera, box: { width: number; height: number }, pointer: THREE.Vector2, reach: number, displayScale: number,
): Picked | null {
  camera.updateMatrixWorld()
  const pixels = box.height / (2 * Math.tan((camera.fov * Math.PI) / 360))
  let best: (Picked & { away: number; depth: number }) | null = null
  rods.forEach(({ frames, halfExtent }, rod) => {
    let before: THREE.Vector2 | null = null
    for (let node = 0; node < frames.length / 12; node++) {
      const at = new THREE.Vector3().fromArray(frames, 12 * node + 9)
      const depth = -at.clone().applyMatrix4(camera.matrixWorldInverse).z
      const on = onPage(at, camera, box)
      const thick = (pixels * displayScale * Math.max(halfExtent[2 * node], halfExtent[2 * node + 1])) / depth
      const { distance, part } = before ? toSegment(pointer, before, on) : { distance: pointer.distanceTo(on), part: 1 }
      const away = Math.max(0, distance - thick)
      const nearer = !best || away < best.away || (away === best.away && depth < best.depth)
      if (depth > 0 && away <= reach && nearer) best = { rod, node: part < 0.5 ? node - 1 : node, away, depth }
      before = on
    }
  })
  return best
}

/** Where a place of the world is on the canvas, px. The camera's matrices must be those of now. */
export function onPage(at: THREE.Vector3, camera: THREE.Camera, { width, height }: { width: number; height: number }): THREE.Vector2 {
  const { x, y } = at.clone().project(camera)
  return new THREE.Vector2(((x + 1) / 2) * width, ((1 - y) / 2) * height)
}

/** How far a point is from the straight line between two others, and what part of the way its nearest place on it is. */
function toSegment(point: THREE.Vector2, from: THREE.Vector2, to: THREE.Vector2): { distance: number; part: number } {
  const way = to.clone().sub(from)
  const part = Math.min(Math.max(point.clone().sub(from).dot(way) / Math.max(way.lengthSq(), 1e-12), 0), 1)
  return { distance: point.distanceTo(way.multiplyScalar(part).add(from)), part }
}
