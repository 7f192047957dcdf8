/**
 * Force and torque at the hand and at the support, or at a hand that has grabbed: a straight arrow for a force, an arc around its axis for a torque, each with its number.
 * Both forces have one scale, and both torques.
 */

import * as THREE from 'three'
import { engineering } from './engineering'
import type { Reaction } from './protocol'

const COLOURS = { force: 0xd9480f, torque: 0x7c3aed }
/** An arrow, its length or its radius, m; then where its number stands. */
interface Arrow {
  kind: 'force' | 'torque'
  group: THREE.Group
  shaft: THREE.Mesh
  head: THREE.Mesh
  label: HTMLElement
  tip: THREE.Vector3
}

/** What panels cover at each side of the window, px. */
export interface Insets { left: number; right: number; top: number; bottom: number }

const ARC = 1.5 * Math.PI
/** How long the arrow of the greatest force is, and how thick a shaft, over the size of the scene. */
export const LONGEST = 0.19
export const THICK = 0.0026
/** How long a head is, over the thickness of its shaft. */
export const HEAD = 2.6 * 3

/** What shows forces, or torques, is made of. */
export function marked(kind: 'force' | 'torque'): THREE.MeshStandardMaterial {
  return new THREE.MeshStandardMaterial({ color: COLOURS[kind], roughness: 0.5, emissive: COLOURS[kind], emissiveIntensity: 0.35 })
}

/** A shaft of unit length and radius, its foot at the origin and its axis z. */
export function shaft(): THREE.BufferGeometry {
  return new THREE.CylinderGeometry(1, 1, 1, 14).translate(0, 0.5, 0).rotateX(Math.PI / 2)
}

/** A head of unit radius about the origin, its axis z. */
export function head(): THREE.BufferGeometry {
  return new THREE.ConeGeometry(1, 2.6, 18).rotateX(Math.PI / 2)
}

function build(kind: 'force' | 'torque', labels: HTMLElement): Arrow {
  const material = marked(kind)
  const body = new THREE.Mesh(kind === 'force' ? shaft() : new THREE.TorusGeometry(1, 0.05, 10, 48, ARC), material)
  const tip = new THREE.Mesh(head(), material)
  const group = new THREE.Group()
  group.add(body, tip)
  const label = document.createElement('span')
  label.className = `label ${kind}`
  labels.append(label)
  return { kind, group, shaft: body, head: tip, label, tip: new THREE.Vector3() }
}

export class Arrows {
  readonly group = new THREE.Group()
  #arrows: Arrow[]

  constructor(labels: HTMLElement) {
    this.#arrows = (['force', 'torque', 'force', 'torque'] as const).map((kind) => build(kind, labels))
    this.group.add(...this.#arrows.map((arrow) => arrow.group))
  }

  /** `size` is that of the scene, `places` where the reactions act. There are at most two. */
  show(reactions: Reaction[], visible: boolean, size: number, places: THREE.Vector3[]): void {
    const vectors = reactions.flatMap(({ force, moment }) => [new THREE.Vector3(...force), new THREE.Vector3(...moment)])
    const largest = [0, 1].map((i) => Math.max(...vectors.filter((_, k) => k % 2 === i).map((vector) => vector.length())))
    this.#arrows.forEach((arrow, i) => {
      const amount = vectors[i]?.length() ?? 0
      const part = amount / largest[i % 2]
      arrow.group.visible = visible && amount > 1e-12 && part > 1e-3
      if (!arrow.group.visible) return
      const direction = vectors[i].clone().normalize()
      arrow.group.position.copy(places[i < 2 ? 0 : 1])
      arrow.group.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), direction)
      if (arrow.kind === 'force') this.#straight(arrow, Math.max(LONGEST * part, 0.05) * size, THICK * size)
      else this.#arc(arrow, (0.035 + 0.03 * part) * size)
      arrow.label.textContent = engineering(amount, arrow.kind === 'force' ? 'N' : 'N·m')
      arrow.group.updateMatrixWorld()
      arrow.tip.applyMatrix4(arrow.group.matrixWorld)
    })
  }

  #straight(arrow: Arrow, length: number, thick: number): void {
    const head = HEAD * thick
    arrow.shaft.scale.set(thick, thick, length - head)
    arrow.head.scale.setScalar(3 * thick)
    arrow.head.position.set(0, 0, length - head / 2)
    arrow.tip.set(0, 0, length)
  }

  #arc(arrow: Arrow, radius: number): void {
    arrow.shaft.scale.setScalar(radius)
    arrow.head.scale.setScalar(0.16 * radius)
    arrow.head.position.set(radius * Math.cos(ARC), radius * Math.sin(ARC), 0)
    // The cone's axis, z, along the arc's tangent at its end.
    arrow.head.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), new THREE.Vector3(-Math.sin(ARC), Math.cos(ARC), 0))
    arrow.tip.set(radius * 1.1, 0, 0)
  }

  /** Puts the numbers beside their arrows, within what panels leave free, and apart from each other. */
  place(camera: THREE.Camera, width: number, height: number, insets: Insets): void {
    const taken: { x: number; y: number }[] = []
    for (const arrow of this.#arrows) {
      arrow.label.hidden = !arrow.group.visible
      if (arrow.label.hidden) continue
      const at = arrow.tip.clone().project(camera)
      let [x, y] = [((at.x + 1) / 2) * width, ((1 - at.y) / 2) * height]
      const foot = arrow.group.position.clone().project(camera)
      // Away from the arrow's foot.
      x += at.x >= foot.x ? 8 : -8 - arrow.label.offsetWidth
      y -= 10
      while (taken.some((other) => Math.abs(other.x - x) < 80 && Math.abs(other.y - y) < 20)) y += 21
      x = Math.min(Math.max(x, insets.left + 4), width - insets.right - arrow.label.offsetWidth - 4)
      y = Math.min(Math.max(y, insets.top + 4), height - insets.bottom - 24)
      taken.push({ x, y })
      arrow.label.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`
    }
  }
}
