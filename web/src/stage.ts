/** The 3-D stage: light, camera, and what is drawn of a shape. */

import * as THREE from 'three'
import { OrbitControls } from 'three/addons/controls/OrbitControls.js'
import { TransformControls } from 'three/addons/controls/TransformControls.js'
import { Arrows, type Insets } from './arrows'
import { Glyphs, type GlyphOptions } from './glyphs'
import { Ground } from './ground'
import { Hand } from './hand'
import { Props } from './props'
import type { Shape } from './protocol'
import { Tube, type Look } from './tube'

export interface ViewOptions extends Look, GlyphOptions {
  arrows: boolean
}

/** What the stage must know of a scene beside its shape. */
export interface Setting {
  square: boolean
  /** One for each rod that the hand does not hold. */
  othersAreSquare: boolean[]
  surgical: boolean
  startIsHeld: boolean
}

/** The backdrop’s colours from the top down. */
const LIGHT = [0xf0f3f7, 0xe4e9ef, 0xcfd6de]
const DARK = [0x10151c, 0x1a212b, 0x232c38]
/** The thread is drawn at least this thick, over the size of the scene, if no other thickness is asked for. */
const LEAST_RADIUS = 0.0042
/** How far below the thread the ground is, over the size of the scene. */
const DROP = 0.07
/** Room around the thread for arrows and needle, over the size of the scene. */
const MARGIN = { x: 0.15, y: 0.2 }
const FIRST_VIEW = new THREE.Vector3(0.35, -1.45, 0.55).normalize()

export class Stage {
  readonly tube = new Tube()
  /** The threads that are not in the hand. */
  readonly others = new THREE.Group()
  readonly hand = new Hand()
  readonly camera = new THREE.PerspectiveCamera(32, 1, 0.001, 50)
  readonly orbit: OrbitControls
  readonly gizmo: TransformControls
  view: ViewOptions = {
    colourBy: 'curvature', map: 'viridis', range: null, displayScale: 1, arrows: true, directors: false, internalForce: false, internalMoment: false,
  }
  /** The size of the scene, m. */
  size = 0.2
  #others: Tube[] = []
  #renderer: THREE.WebGLRenderer
  #scene = new THREE.Scene()
  #props = new Props()
  #ground = new Ground()
  #glyphs = new Glyphs()
  #arrows: Arrows
  #key = new THREE.DirectionalLight(0xfff0dc, 2.6)
  #rim = new THREE.DirectionalLight(0xd6e6ff)
  #fill = new THREE.HemisphereLight(0xe6eeff, 0xa39a8c)
  #gap = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineDashedMaterial({ color: 0xd0242f }))
  #shape: Shape | null = null
  #floor = 0
  #insets: Insets = { left: 0, right: 0, top: 0, bottom: 0 }
  #dirty = true

  constructor(
    readonly canvas: HTMLCanvasElement,
    labels: HTMLElement,
    /** Called when the gizmo has moved the hand. */
    onGizmo: () => void,
  ) {
    this.#renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true })
    this.#renderer.shadowMap.enabled = true
    this.#renderer.shadowMap.type = THREE.PCFShadowMap
    // Keeps the colours of the maps, which the legend shows, and rolls the highlights off as film does.
    this.#renderer.toneMapping = THREE.NeutralToneMapping
    this.camera.up.set(0, 0, 1)
    this.orbit = new OrbitControls(this.camera, canvas)
    this.orbit.addEventListener('change', () => (this.#dirty = true))
    this.#key.castShadow = true
    this.#key.shadow.mapSize.set(2048, 2048)
    this.#key.shadow.radius = 5
    this.#arrows = new Arrows(labels)
    this.gizmo = new TransformControls(this.camera, canvas)
    this.gizmo.setSize(0.75)
    this.gizmo.addEventListener('change', () => (this.#dirty = true))
    this.gizmo.addEventListener('dragging-changed', (event) => (this.orbit.enabled = !event.value))
    this.gizmo.addEventListener('objectChange', () => {
      this.hand.position.copy(this.#props.end.position)
      this.hand.quaternion.copy(this.#props.end.quaternion)
      onGizmo()
    })
    this.#rim.position.set(0.6, 1, 0.5)
    this.#scene.add(this.#fill, this.#rim, this.#key, this.#key.target, this.#ground.group, this.tube.mesh, this.others, this.#glyphs.lines)
    this.#scene.add(this.#props.end, this.#props.start, this.#props.below, this.#props.clips, this.#gap, this.#arrows.group, this.gizmo.getHelper())
    this.#gap.visible = this.#glyphs.lines.visible = false
    this.#gap.frustumCulled = false
    // The ring of the focus is for the keyboard.
    canvas.addEventListener('pointerdown', () => canvas.classList.add('by-pointer'))
    canvas.addEventListener('blur', () => canvas.classList.remove('by-pointer'))
    this.setTheme(false)
    new ResizeObserver(() => this.#resize()).observe(canvas)
    this.#resize()
  }

  /** Draws when something changed; called once a display frame. */
  draw(): void {
    this.orbit.update()
    if (!this.#dirty) return
    this.#dirty = false
    this.#renderer.render(this.#scene, this.camera)
    this.#arrows.place(this.camera, this.canvas.clientWidth, this.canvas.clientHeight, this.#insets)
  }

  setTheme(dark: boolean): void {
    this.#scene.background = backdrop(dark ? DARK : LIGHT)
    // Dark colours need an edge of light to stand out from a dark backdrop.
    this.#rim.intensity = dark ? 3.2 : 0.9
    this.#fill.intensity = dark ? 1.9 : 1.35
    this.#ground.setTheme(dark)
    this.#dirty = true
  }

  /** Prepares for a new scene: its things, the size of them, and a view of all of it. */
  setScene(shape: Shape, setting: Setting): void {
    this.#shape = shape
    const { box, size, radius } = this.#measure(shape)
    this.size = size
    this.#floor = box.min.z - DROP * size
    this.tube.setSection(setting.square)
    for (const tube of this.#others) tube.dispose()
    this.#others = setting.othersAreSquare.map((square) => {
      const tube = new Tube()
      tube.setSection(square)
      return tube
    })
    this.others.clear()
    for (const tube of this.#others) this.others.add(tube.mesh)
    this.#props.choose(setting.surgical, setting.startIsHeld)
    const thin = (LEAST_RADIUS * size) / radius
    this.view.displayScale = thin <= 1 ? 1 : thin < 3 ? Math.ceil(thin * 2) / 2 : Math.ceil(thin)
    this.#props.fit(size, radius * this.view.displayScale, new THREE.Vector3().fromArray(shape.frames, 9), this.#floor)
    this.gizmo.detach()
    this.#lookAt(shape, FIRST_VIEW)
  }

  /** Shows a shape. The needle goes where the thread's end is; a dashed line leads to a hand that it cannot reach. */
  show(shape: Shape): void {
    this.#shape = shape
    this.tube.update(shape, this.view)
    this.#others.forEach((tube, i) => tube.updateQuiet(shape.others[i], this.view.displayScale))
    const nodes = shape.frames.length / 12
    const { start, end } = this.#props
    if (!this.gizmo.dragging) place(end, shape.frames, nodes - 1)
    place(start, shape.frames, 0)
    this.#props.countClips(shape.report.between.length)
    this.#props.clips.children.forEach((clip, i) => place(clip, shape.frames, shape.report.between[i].node))
    const tip = new THREE.Vector3().fromArray(shape.frames, 12 * nodes - 3)
    const hand = new THREE.Vector3().fromArray(shape.hand, 0)
    this.#gap.visible = hand.distanceTo(tip) > 2e-3 * this.size && shape.report.mode === 'pose'
    this.#gap.geometry.setFromPoints([tip, hand])
    this.#gap.computeLineDistances()
    this.#arrows.show(shape, this.view.arrows, this.size, [start.position, tip])
    this.#glyphs.show(shape, this.view, this.size)
    this.#dirty = true
  }

  /** Whether a line leads from the thread's end to a hand that is elsewhere. */
  get gapIsShown(): boolean {
    return this.#gap.visible
  }

  refresh(): void {
    if (this.#shape) this.show(this.#shape)
  }

  /** Turns to see all of the shape, from where the eye is. */
  frameAll(): void {
    if (this.#shape) this.#lookAt(this.#shape, this.camera.position.clone().sub(this.orbit.target).normalize())
  }

  /** Says what panels cover: the scene is shown in the middle of the rest. */
  setInsets(insets: Insets): void {
    this.#insets = insets
    this.#resize()
  }

  /** Moves or turns the hand in the camera's and the thread's axes: parts of the scene's size, and rad. */
  nudge(move: { right?: number; up?: number; near?: number; twist?: number }): void {
    const [right, up, near] = this.axes()
    this.hand.position.addScaledVector(right, (move.right ?? 0) * this.size)
    this.hand.position.addScaledVector(up, (move.up ?? 0) * this.size)
    this.hand.position.addScaledVector(near, (move.near ?? 0) * this.size)
    if (move.twist) this.hand.twist(move.twist)
  }

  /** The camera's axes: right, up, and towards the eye. */
  axes(): THREE.Vector3[] {
    this.camera.updateMatrixWorld()
    return [0, 1, 2].map((i) => new THREE.Vector3().setFromMatrixColumn(this.camera.matrixWorld, i))
  }

  toggleGizmo(mode: 'translate' | 'rotate'): void {
    if (this.gizmo.object && this.gizmo.mode === mode) this.gizmo.detach()
    else {
      this.gizmo.setMode(mode)
      this.gizmo.attach(this.#props.end)
    }
    this.#dirty = true
  }

  /** Where the hand's handles are on the page, px; the first is the thread's end. */
  handlesOnPage(): [number, number][] {
    const box = this.canvas.getBoundingClientRect()
    this.camera.updateMatrixWorld()
    this.#props.end.updateMatrixWorld()
    return this.#props.handles.map((handle) => {
      const at = handle.applyMatrix4(this.#props.end.matrixWorld).project(this.camera)
      return [box.left + ((at.x + 1) / 2) * box.width, box.top + ((1 - at.y) / 2) * box.height]
    })
  }

  /** A picture of thread and things alone, on nothing: WebP as an address of data. */
  picture(width: number, height: number): string {
    const { background } = this.#scene
    const aside = [this.#ground.group, this.#arrows.group]
    this.#scene.background = null
    for (const thing of aside) thing.visible = false
    this.#renderer.setPixelRatio(1)
    this.#renderer.setSize(width, height, false)
    this.camera.aspect = width / height
    this.camera.clearViewOffset()
    this.camera.zoom = 0.84 / this.#extent()
    this.camera.updateProjectionMatrix()
    this.#renderer.render(this.#scene, this.camera)
    const data = this.canvas.toDataURL('image/webp', 0.86)
    this.#scene.background = background
    for (const thing of aside) thing.visible = true
    this.camera.zoom = 1
    this.#resize()
    return data
  }

  /** How far the thread reaches from the middle of the picture: one is its edge. */
  #extent(): number {
    this.camera.updateProjectionMatrix()
    let most = 0.1
    for (const at of places(this.#shape!)) {
      const { x, y } = at.project(this.camera)
      most = Math.max(most, Math.abs(x), Math.abs(y))
    }
    return most
  }

  #measure(shape: Shape): { box: THREE.Box3; size: number; radius: number } {
    const box = new THREE.Box3()
    for (const at of places(shape)) box.expandByPoint(at)
    const radius = shape.halfExtent.reduce((most, a) => Math.max(most, a), 1e-9)
    return { box, size: Math.max(box.getSize(new THREE.Vector3()).length(), 0.02), radius }
  }

  #lookAt(shape: Shape, direction: THREE.Vector3): void {
    const { box, size } = this.#measure(shape)
    const centre = box.getCenter(new THREE.Vector3())
    // So near that thread and arrows fill the free part of the window.
    const { clientWidth: width, clientHeight: height } = this.canvas
    const { left, right, top, bottom } = this.#insets
    const tan = Math.tan((this.camera.fov * Math.PI) / 360)
    const [wide, high] = [width - left - right, height - top - bottom].map((free) => (tan * Math.max(free, 120)) / height)
    const sideways = new THREE.Vector3().crossVectors(this.camera.up, direction).normalize()
    const upwards = new THREE.Vector3().crossVectors(direction, sideways)
    let distance = 0
    for (const at of places(shape)) {
      at.sub(centre)
      const x = Math.abs(at.dot(sideways)) + MARGIN.x * size
      const y = Math.abs(at.dot(upwards)) + MARGIN.y * size
      distance = Math.max(distance, at.dot(direction) + Math.max(x / wide, y / high))
    }
    this.orbit.target.copy(centre)
    this.camera.position.copy(centre).addScaledVector(direction, distance)
    this.camera.near = 0.02 * this.size
    this.camera.far = 60 * this.size
    this.#ground.fit(centre, this.#floor, this.size)
    this.#light(centre, this.size)
    this.orbit.update()
    this.#resize()
  }

  #light(centre: THREE.Vector3, size: number): void {
    this.#key.position.copy(centre).add(new THREE.Vector3(-0.55, -0.6, 1.5).multiplyScalar(1.6 * size))
    this.#key.target.position.copy(centre)
    const { shadow } = this.#key
    const reach = 1.5 * size
    Object.assign(shadow.camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: 0.01 * size, far: 8 * size })
    shadow.camera.updateProjectionMatrix()
    shadow.bias = -0.0004
    shadow.normalBias = 0.002 * size
    const gap = this.#gap.material as THREE.LineDashedMaterial
    Object.assign(gap, { dashSize: 0.02 * size, gapSize: 0.014 * size })
  }

  #resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas
    this.#renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2))
    this.#renderer.setSize(width, height, false)
    this.camera.aspect = width / height
    const { left, right, top, bottom } = this.#insets
    this.camera.setViewOffset(width, height, (right - left) / 2, (bottom - top) / 2, width, height)
    this.camera.updateProjectionMatrix()
    this.#dirty = true
  }
}

/** The places of the nodes of all rods. */
function places(shape: Shape): THREE.Vector3[] {
  return [shape, ...shape.others].flatMap(({ frames }) =>
    Array.from({ length: frames.length / 12 }, (_, i) => new THREE.Vector3().fromArray(frames, 12 * i + 9)),
  )
}

/** Puts a thing where a node is, keeping its scale. */
function place(thing: THREE.Object3D, frames: Float64Array, node: number): void {
  const f = frames.subarray(12 * node, 12 * node + 12)
  const turn = new THREE.Matrix4().set(f[0], f[3], f[6], 0, f[1], f[4], f[7], 0, f[2], f[5], f[8], 0, 0, 0, 0, 1)
  thing.position.set(f[9], f[10], f[11])
  thing.quaternion.setFromRotationMatrix(turn)
}

/** A picture of two rows or more of colours, blended from the top down. */
function backdrop(colours: number[]): THREE.Texture {
  const rows = [...colours].reverse().flatMap((hex) => [hex >> 16, (hex >> 8) & 255, hex & 255, 255])
  const texture = new THREE.DataTexture(new Uint8Array(rows), 1, colours.length)
  texture.colorSpace = THREE.SRGBColorSpace
  texture.minFilter = texture.magFilter = THREE.LinearFilter
  texture.needsUpdate = true
  return texture
}
