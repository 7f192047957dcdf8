/** The 3-D stage: light, ground, thread, needle, tissue, arrows, and the hand's gestures. */

import * as THREE from 'three'
import { OrbitControls } from 'three/addons/controls/OrbitControls.js'
import { TransformControls } from 'three/addons/controls/TransformControls.js'
import type { HandPose, Shape } from './protocol'
import { Tube } from './tube'

export interface ViewOptions {
  colourBy: string
  displayScale: number
  arrows: boolean
  directors: boolean
}

const LIGHT = { sky: 0xf3f6f9, ground: 0xd9dee4, grid: 0xb9c2cc }
const DARK = { sky: 0x161c24, ground: 0x1d252f, grid: 0x39434f }

export class Stage {
  readonly tube = new Tube()
  view: ViewOptions = { colourBy: 'curvature', displayScale: 4, arrows: true, directors: false }
  #renderer: THREE.WebGLRenderer
  #scene = new THREE.Scene()
  #camera = new THREE.PerspectiveCamera(38, 1, 0.001, 50)
  #orbit: OrbitControls
  #gizmo: TransformControls
  #needle = new THREE.Group()
  #handle: THREE.Mesh
  #tissue: THREE.Mesh
  #grid: THREE.GridHelper
  #ground: THREE.Mesh
  #arrows = [0, 1, 2, 3].map((i) => new THREE.ArrowHelper(new THREE.Vector3(0, 0, 1), new THREE.Vector3(), 0.01, i % 2 ? 0x8a3ffc : 0xd9480f))
  #gap = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineDashedMaterial({ color: 0xd0242f, dashSize: 0.004, gapSize: 0.003 }))
  #directors = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ vertexColors: true }))
  #size = 0.2
  #hand = { position: new THREE.Vector3(), quaternion: new THREE.Quaternion() }
  #drag: { id: number; x: number; y: number } | null = null
  #shape: Shape | null = null
  #dirty = true

  constructor(
    private canvas: HTMLCanvasElement,
    private onHand: (pose: HandPose) => void,
  ) {
    this.#renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true })
    this.#renderer.shadowMap.enabled = true
    this.#renderer.shadowMap.type = THREE.PCFShadowMap
    this.#renderer.toneMapping = THREE.ACESFilmicToneMapping
    this.#camera.up.set(0, 0, 1)
    this.#orbit = new OrbitControls(this.#camera, canvas)
    this.#orbit.addEventListener('change', () => (this.#dirty = true))
    this.#handle = this.#buildNeedle()
    this.#tissue = new THREE.Mesh(
      new THREE.CapsuleGeometry(0.012, 0.022, 8, 24),
      new THREE.MeshStandardMaterial({ color: 0xd98f87, roughness: 0.75 }),
    )
    this.#tissue.castShadow = this.#tissue.receiveShadow = true
    this.#ground = new THREE.Mesh(new THREE.CircleGeometry(4, 64), new THREE.MeshStandardMaterial({ roughness: 1 }))
    this.#ground.receiveShadow = true
    this.#grid = new THREE.GridHelper(2, 100)
    this.#grid.rotation.x = Math.PI / 2
    const key = new THREE.DirectionalLight(0xfff1de, 2.6)
    key.position.set(0.25, -0.35, 0.7)
    key.castShadow = true
    key.shadow.mapSize.set(1024, 1024)
    key.shadow.radius = 4
    Object.assign(key.shadow.camera, { left: -0.4, right: 0.4, top: 0.4, bottom: -0.4, near: 0.01, far: 3 })
    key.shadow.bias = -0.0005
    this.#scene.add(new THREE.HemisphereLight(0xdfeaff, 0x8d8577, 1.5), key, this.tube.mesh, this.#needle)
    this.#scene.add(this.#tissue, this.#ground, this.#grid, this.#gap, this.#directors, ...this.#arrows)
    this.#gap.visible = this.#directors.visible = false
    this.#gizmo = new TransformControls(this.#camera, canvas)
    this.#gizmo.setSize(0.7)
    this.#gizmo.addEventListener('dragging-changed', (event) => (this.#orbit.enabled = !event.value))
    this.#gizmo.addEventListener('objectChange', () => {
      this.#hand.position.copy(this.#needle.position)
      this.#hand.quaternion.copy(this.#needle.quaternion)
      this.#moved()
    })
    this.#scene.add(this.#gizmo.getHelper())
    this.setTheme(false)
    this.#listen()
    new ResizeObserver(() => this.#resize()).observe(canvas)
    this.#resize()
  }

  /** Draws when something changed; called once a display frame. */
  draw(): void {
    this.#orbit.update()
    if (!this.#dirty) return
    this.#dirty = false
    this.#renderer.render(this.#scene, this.#camera)
  }

  setTheme(dark: boolean): void {
    const colours = dark ? DARK : LIGHT
    this.#scene.background = new THREE.Color(colours.sky)
    this.#scene.fog = new THREE.Fog(colours.sky, 0.8, 2.6)
    ;(this.#ground.material as THREE.MeshStandardMaterial).color.set(colours.ground)
    const grid = this.#grid.material as THREE.LineBasicMaterial
    grid.vertexColors = false
    grid.color.set(colours.grid)
    grid.transparent = true
    grid.opacity = 0.5
    grid.needsUpdate = true
    this.#dirty = true
  }

  /** Shows a shape. The needle goes where the thread's end is; a dashed line leads to a hand that it cannot reach. */
  show(shape: Shape): void {
    this.#shape = shape
    this.tube.update(shape, this.view.displayScale, this.view.colourBy)
    const last = shape.frames.length - 12
    const tip = this.#frame(shape.frames, last)
    if (!this.#gizmo.dragging) tip.decompose(this.#needle.position, this.#needle.quaternion, new THREE.Vector3())
    const base = this.#frame(shape.frames, 0)
    base.decompose(this.#tissue.position, this.#tissue.quaternion, new THREE.Vector3())
    this.#tissue.position.addScaledVector(new THREE.Vector3().setFromMatrixColumn(base, 2), -0.06 * this.#size)
    const hand = new THREE.Vector3(shape.hand[0], shape.hand[1], shape.hand[2])
    const end = new THREE.Vector3().setFromMatrixPosition(tip)
    this.#gap.visible = hand.distanceTo(end) > 1e-4
    this.#gap.geometry.setFromPoints([end, hand])
    this.#gap.computeLineDistances()
    this.#showArrows(shape, base, end)
    this.#showDirectors(shape)
    this.#dirty = true
  }

  refresh(): void {
    if (this.#shape) this.show(this.#shape)
  }

  /** Puts the hand somewhere without telling anyone. */
  setHand(pose: HandPose): void {
    const [x, y, z, w, i, j, k] = pose
    this.#hand.position.set(x, y, z)
    this.#hand.quaternion.set(i, j, k, w)
  }

  handPose(): number[] {
    const { position: p, quaternion: q } = this.#hand
    return [p.x, p.y, p.z, q.w, q.x, q.y, q.z]
  }

  /** Looks at all of a shape, and fits needle, tissue and ground to its size. */
  fit(shape: Shape): void {
    const box = new THREE.Box3()
    for (let i = 9; i < shape.frames.length; i += 12) {
      box.expandByPoint(new THREE.Vector3(shape.frames[i], shape.frames[i + 1], shape.frames[i + 2]))
    }
    this.#size = Math.max(box.getSize(new THREE.Vector3()).length(), 0.02)
    const centre = box.getCenter(new THREE.Vector3())
    const scale = this.#size / 0.2
    this.#needle.scale.setScalar(scale)
    this.#tissue.scale.setScalar(scale)
    const floor = box.min.z - 0.12 * this.#size
    this.#ground.position.z = floor - 0.0005 * scale
    this.#grid.position.z = floor
    this.#orbit.target.copy(centre)
    const narrow = Math.max(1, 1.1 / this.#camera.aspect)
    this.#camera.position.copy(centre).add(new THREE.Vector3(0.35, -1.45, 0.5).multiplyScalar(1.45 * this.#size * narrow))
    this.#camera.near = 0.01 * this.#size
    this.#camera.updateProjectionMatrix()
    this.#dirty = true
  }

  /** Moves or turns the hand in its own and the camera's axes: metres and radians. */
  nudge(move: { right?: number; up?: number; near?: number; twist?: number }): void {
    const [right, up, near] = [0, 1, 2].map((i) => new THREE.Vector3().setFromMatrixColumn(this.#camera.matrixWorld, i))
    this.#hand.position.addScaledVector(right, (move.right ?? 0) * this.#size)
    this.#hand.position.addScaledVector(up, (move.up ?? 0) * this.#size)
    this.#hand.position.addScaledVector(near, (move.near ?? 0) * this.#size)
    if (move.twist) this.#hand.quaternion.multiply(new THREE.Quaternion().setFromAxisAngle(new THREE.Vector3(0, 0, 1), move.twist))
    this.#moved()
  }

  /** Shows or hides the gizmo. */
  toggleGizmo(mode: 'translate' | 'rotate'): void {
    if (this.#gizmo.object && this.#gizmo.mode === mode) this.#gizmo.detach()
    else {
      this.#gizmo.setMode(mode)
      this.#gizmo.attach(this.#needle)
    }
    this.#dirty = true
  }

  /** Where the needle is on the page, px. */
  needleOnPage(): [number, number] {
    const at = this.#needle.position.clone().project(this.#camera)
    const box = this.canvas.getBoundingClientRect()
    return [box.left + ((at.x + 1) / 2) * box.width, box.top + ((1 - at.y) / 2) * box.height]
  }

  #frame(frames: Float64Array, i: number): THREE.Matrix4 {
    const f = frames.subarray(i, i + 12)
    return new THREE.Matrix4().set(f[0], f[3], f[6], f[9], f[1], f[4], f[7], f[10], f[2], f[5], f[8], f[11], 0, 0, 0, 1)
  }

  #buildNeedle(): THREE.Mesh {
    const steel = new THREE.MeshStandardMaterial({ color: 0xc3cad2, metalness: 0.9, roughness: 0.25 })
    const radius = 0.011
    const curve = new THREE.CatmullRomCurve3(
      Array.from({ length: 25 }, (_, i) => {
        const a = (i / 24) * Math.PI
        return new THREE.Vector3(radius * (1 - Math.cos(a)), 0, radius * Math.sin(a))
      }),
    )
    const arc = new THREE.Mesh(new THREE.TubeGeometry(curve, 48, 0.00055, 10), steel)
    const point = new THREE.Mesh(new THREE.ConeGeometry(0.00055, 0.003, 12), steel)
    point.position.set(2 * radius, 0, -0.0015)
    point.rotation.x = -Math.PI / 2
    const handle = new THREE.Mesh(new THREE.SphereGeometry(0.02, 12, 8), new THREE.MeshBasicMaterial({ visible: false }))
    handle.position.set(radius, 0, radius / 2)
    for (const part of [arc, point]) part.castShadow = true
    this.#needle.add(arc, point, handle)
    return handle
  }

  #showArrows(shape: Shape, base: THREE.Matrix4, end: THREE.Vector3): void {
    const start = new THREE.Vector3().setFromMatrixPosition(base)
    const { start: atStart, end: atEnd } = shape.report
    const vectors = [atStart.force, atStart.moment, atEnd.force, atEnd.moment].map((v) => new THREE.Vector3(...v))
    const largest = [0, 1].map((i) => Math.max(vectors[i].length(), vectors[i + 2].length(), 1e-30))
    this.#arrows.forEach((arrow, i) => {
      const size = vectors[i].length()
      arrow.visible = this.view.arrows && size > 1e-12
      if (!arrow.visible) return
      arrow.position.copy(i < 2 ? start : end)
      arrow.setDirection(vectors[i].clone().normalize())
      const length = Math.max(0.18 * this.#size * (size / largest[i % 2]), 0.03 * this.#size)
      arrow.setLength(length, 0.025 * this.#size, 0.012 * this.#size)
    })
  }

  #showDirectors(shape: Shape): void {
    this.#directors.visible = this.view.directors
    if (!this.view.directors) return
    const nodes = shape.frames.length / 12
    const every = Math.max(1, Math.floor(nodes / 40))
    const [points, colours]: [number[], number[]] = [[], []]
    for (let i = 0; i < nodes; i += every) {
      for (let d = 0; d < 3; d++) {
        for (let far = 0; far < 2; far++) {
          for (let k = 0; k < 3; k++) {
            points.push(shape.frames[12 * i + 9 + k] + far * 0.04 * this.#size * shape.frames[12 * i + 3 * d + k])
            colours.push(k === d ? 0.9 : 0.15)
          }
        }
      }
    }
    this.#directors.geometry.setAttribute('position', new THREE.Float32BufferAttribute(points, 3))
    this.#directors.geometry.setAttribute('color', new THREE.Float32BufferAttribute(colours, 3))
  }

  #listen(): void {
    const pointers = new Map<number, { x: number; y: number }>()
    this.canvas.addEventListener('pointerdown', (event) => {
      pointers.set(event.pointerId, { x: event.clientX, y: event.clientY })
      if (this.#drag || this.#gizmo.axis || !this.#hits(event)) return
      this.#drag = { id: event.pointerId, x: event.clientX, y: event.clientY }
      this.#orbit.enabled = false
      this.canvas.setPointerCapture(event.pointerId)
    })
    this.canvas.addEventListener('pointermove', (event) => {
      const before = pointers.get(event.pointerId)
      if (before) pointers.set(event.pointerId, { x: event.clientX, y: event.clientY })
      if (!this.#drag) {
        this.canvas.style.cursor = this.#hits(event) ? 'grab' : ''
        return
      }
      if (event.pointerId !== this.#drag.id) {
        // A second finger: up and down is depth, sideways is twist.
        if (before) this.nudge({ near: (event.clientY - before.y) * 0.002, twist: (event.clientX - before.x) * 0.02 })
        return
      }
      const [dx, dy] = [event.clientX - this.#drag.x, event.clientY - this.#drag.y]
      this.#drag.x = event.clientX
      this.#drag.y = event.clientY
      if (event.shiftKey) this.nudge({ twist: dx * 0.02 })
      else if (event.altKey) this.#turn(dx, dy)
      else {
        const distance = this.#camera.position.distanceTo(this.#hand.position)
        const metre = (2 * distance * Math.tan((this.#camera.fov * Math.PI) / 360)) / this.canvas.clientHeight / this.#size
        this.nudge({ right: dx * metre, up: -dy * metre })
      }
    })
    const release = (event: PointerEvent) => {
      pointers.delete(event.pointerId)
      if (this.#drag?.id !== event.pointerId) return
      this.#drag = null
      this.#orbit.enabled = true
    }
    this.canvas.addEventListener('pointerup', release)
    this.canvas.addEventListener('pointercancel', release)
    this.canvas.addEventListener('wheel', (event) => this.#drag && this.nudge({ near: event.deltaY * 0.0004 }))
    this.canvas.addEventListener('dblclick', () => this.#shape && this.fit(this.#shape))
  }

  #turn(dx: number, dy: number): void {
    const [right, up] = [0, 1].map((i) => new THREE.Vector3().setFromMatrixColumn(this.#camera.matrixWorld, i))
    const turn = new THREE.Quaternion().setFromAxisAngle(up, dx * 0.01)
    turn.multiply(new THREE.Quaternion().setFromAxisAngle(right, dy * 0.01))
    this.#hand.quaternion.premultiply(turn)
    this.#moved()
  }

  #hits(event: PointerEvent): boolean {
    const box = this.canvas.getBoundingClientRect()
    const at = new THREE.Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2)
    const ray = new THREE.Raycaster()
    ray.setFromCamera(at, this.#camera)
    return ray.intersectObject(this.#handle, false).length > 0
  }

  #moved(): void {
    this.onHand(this.handPose())
  }

  #resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas
    this.#renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2))
    this.#renderer.setSize(width, height, false)
    this.#camera.aspect = width / height
    // The middle of what the panels leave free.
    if (width > 720) this.#camera.setViewOffset(width, height, 45, 10, width, height)
    else this.#camera.clearViewOffset()
    this.#camera.updateProjectionMatrix()
    this.#dirty = true
  }
}
