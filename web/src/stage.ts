/** The 3-D stage: light, camera, and what is drawn of a shape. */

import * as THREE from 'three'
import { OrbitControls } from 'three/addons/controls/OrbitControls.js'
import { TransformControls } from 'three/addons/controls/TransformControls.js'
import { Arrows, type Insets } from './arrows'
import { Solids, type Bodies } from './bodies'
import { Contacts } from './contacts'
import { Glyphs, type GlyphOptions } from './glyphs'
import { Ground } from './ground'
import { Hand } from './hand'
import { levelFloor, Obstacles, outlines } from './obstacles'
import { onPage, pick, type Picked } from './pick'
import { length, measured, place, places } from './places'
import { Props } from './props'
import type { Body, Carried, MotionReport, ObstacleShape, Shape } from './protocol'
import { MANY, Tubes, type Look, type Strand } from './tubes'

export interface ViewOptions extends Look, GlyphOptions {
  arrows: boolean
  contacts: boolean
}

/** What the stage must know of a scene beside its shape. */
export interface Setting {
  /** Which rods are rectangles, that in the hand first. */
  square: boolean[]
  /** Which of them have their start held. */
  startIsHeld: boolean[]
  /** And which their end. */
  endIsHeld: boolean[]
  /** Whether joints tie them together. */
  tied: boolean
  /** Whether they touch themselves, each other and obstacles. */
  touches: boolean
  surgical: boolean
  /** Whether they grow out of skin. */
  skin: boolean
}

/** All rods of a scene in motion, and which of them is the one in the hand of statics. */
export interface Scenery {
  rods: (Body & Carried)[]
  bodies: Bodies
  obstacles: ObstacleShape[]
  /** Nine numbers each: the point, the unit normal, the force, N. */
  contacts: Float64Array
  /** Eyelets and holes, nine numbers each: where the rod is in it, the direction of the rod, the force on it, N. */
  passages: Float64Array
  held: number
  report: MotionReport
}

/** The backdrop’s colours from the top down. */
const LIGHT = [0xf0f3f7, 0xe4e9ef, 0xcfd6de]
const DARK = [0x10151c, 0x1a212b, 0x232c38]
/** The thread is drawn at least this thick, over the size of the scene, if no other thickness is asked for. */
const LEAST_RADIUS = 0.0042
/** And this, where it touches something: surfaces that are drawn where they are not pass through each other. */
const LEAST_TOUCHING = 0.0021
/** A dot where something touches is at least this large, over the size of the scene. */
const LEAST_DOT = 0.004
/** How far below the thread the ground is, over the size of the scene. */
const DROP = 0.07
/** Room around the thread for arrows and needle, over the size of the scene. */
const MARGIN = { x: 0.15, y: 0.2 }
const FIRST_VIEW = new THREE.Vector3(0.35, -1.45, 0.55).normalize()

export class Stage {
  readonly tubes = new Tubes()
  readonly hand = new Hand()
  readonly solids = new Solids()
  readonly obstacles = new Obstacles()
  readonly contacts = new Contacts()
  readonly camera = new THREE.PerspectiveCamera(32, 1, 0.001, 50)
  readonly orbit: OrbitControls
  readonly gizmo: TransformControls
  view: ViewOptions = {
    colourBy: 'curvature', map: 'viridis', range: null, displayScale: 1, arrows: true, contacts: true, directors: false, internalForce: false, internalMoment: false,
  }
  /** The size of the scene, m. */
  size = 0.2
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
  #setting: Setting = { square: [], startIsHeld: [], endIsHeld: [], tied: false, touches: false, surgical: false, skin: false }
  /** What moves, in place of the shape. */
  #moving: Scenery | null = null
  /** What else a view of all of the scene shows. */
  #reach: THREE.Vector3[] = []
  #clips: number[] = []
  #radius = 1
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
    this.#scene.add(this.#fill, this.#rim, this.#key, this.#key.target, this.#ground.group, this.tubes.mesh, this.#glyphs.lines)
    this.#scene.add(this.#props.end, this.#props.start, this.#props.below, this.#props.clips, this.#props.roots, this.#props.hold, this.solids.group, this.obstacles.group, this.contacts.group, this.#gap, this.#arrows.group, this.gizmo.getHelper())
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
    this.obstacles.setTheme(dark)
    this.#dirty = true
  }

  /** Prepares for a new scene: its things, the size of them, and a view of all of it. */
  setScene(shape: Shape, setting: Setting): void {
    this.#shape = shape
    this.#setting = setting
    this.#moving = null
    const all = [shape, ...shape.others]
    const { box, size, radius } = measured(all)
    this.size = size
    this.#radius = radius
    this.#floor = box.min.z - DROP * size
    this.#reach = []
    this.#clips = shape.report.between.map(({ node }) => node)
    this.solids.choose([])
    this.obstacles.choose([], box.min, size)
    this.contacts.forget()
    // Of many threads each is drawn thinner, so that they stay apart.
    const thin = ((setting.touches ? LEAST_TOUCHING : LEAST_RADIUS) * size) / radius / Math.max(1, all.length / 4) ** 0.25
    this.view.displayScale = thin <= 1 ? 1 : thin < 3 ? Math.ceil(thin * 2) / 2 : Math.ceil(thin)
    this.#furnish(all)
    this.#lookAt(places(all), FIRST_VIEW)
  }

  /** Chooses and fits the things beside the threads, that in the hand first. */
  #furnish(all: Strand[]): void {
    const { square, startIsHeld, endIsHeld, surgical, skin } = this.#setting
    const [held] = all
    this.tubes.setSections(square)
    const { roots, bundle } = this.#rooted(all)
    this.#props.choose(surgical, startIsHeld[0] && !bundle, this.#moving !== null && !endIsHeld[0])
    this.#props.fit(this.size, this.#radius * this.view.displayScale, new THREE.Vector3().fromArray(held.frames, 9), this.#floor)
    this.#props.plant(roots, skin)
    this.#props.countClips(this.#clips.length)
    this.gizmo.detach()
  }

  /** The frames where threads are held that get roots, and whether no clamp stands for the first. */
  #rooted(all: Body[]): { roots: Float64Array[]; bundle: boolean } {
    const { square, startIsHeld, endIsHeld, tied } = this.#setting
    const starts = all.filter((_, i) => startIsHeld[i]).map(({ frames }) => frames)
    const ends = all.filter((_, i) => tied && endIsHeld[i]).map(({ frames }) => frames.subarray(-12))
    // Where many things are held alike none of them gets a clamp.
    const bundle = tied ? starts.length + ends.length > 1 : square.length >= MANY
    return { roots: [...(bundle || !startIsHeld[0] ? starts : starts.slice(1)), ...ends], bundle }
  }

  /** Prepares for the scene, whose shape at rest is given, to move: there is room for what swings. */
  setMoving(moving: Scenery, rest: Shape): void {
    this.#moving = moving
    this.#shape = rest
    const rests = places([this.#shape!, ...this.#shape!.others])
    const starts = places(this.#ordered(moving))
    const farthest = starts.reduce((most, at, i) => Math.max(most, at.distanceTo(rests[i] ?? at)), 0)
    const held = moving.rods[moving.held].frames
    const root = new THREE.Vector3().fromArray(held, 9)
    // What swings comes up again on the other side.
    const swings = moving.rods.length < MANY && farthest > 0.2 * this.size && this.#setting.startIsHeld[0] && !this.#setting.endIsHeld[0]
    const others = swings ? starts.map((at) => new THREE.Vector3(2 * root.x - at.x, 2 * root.y - at.y, Math.min(at.z, root.z))) : []
    this.#reach = [...rests, ...starts, ...others, ...places([{ frames: moving.bodies.frames, halfExtent: moving.bodies.frames }])]
    const box = new THREE.Box3().setFromPoints(this.#reach)
    this.obstacles.choose(moving.obstacles, box.getCenter(new THREE.Vector3()), this.size)
    this.contacts.forget()
    this.#reach.push(...outlines(moving.obstacles, box, this.size))
    box.setFromPoints(this.#reach)
    const least = this.#setting.endIsHeld[0] || this.#setting.tied ? box.min.z : Math.min(box.min.z, root.z - length(held))
    // What falls on a level plane has it for a floor.
    this.#floor = levelFloor(moving.obstacles) ?? least - DROP * this.size
    this.#furnish(this.#ordered(moving))
    this.solids.choose(moving.bodies.shapes)
    this.#lookAt(this.#reach, FIRST_VIEW)
  }

  /** Ends the motion: the scene rests again. */
  setStill(shape: Shape): void {
    this.setScene(shape, this.#setting)
    this.show(shape)
  }

  /** The rods in the order of statics: that in the hand first. */
  #ordered({ rods, held }: Scenery): (Body & Carried)[] {
    return [rods[held], ...rods.filter((_, i) => i !== held)]
  }

  /** Shows a shape. The needle goes where the thread's end is; a dashed line leads to a hand that it cannot reach. */
  show(shape: Shape): void {
    this.#shape = shape
    this.tubes.update([shape, ...shape.others], this.view)
    const tip = this.#place(shape)
    const hand = new THREE.Vector3().fromArray(shape.hand, 0)
    this.#props.hold.visible = false
    this.#connect(tip, hand, hand.distanceTo(tip) > 2e-3 * this.size && shape.report.mode === 'pose')
    const { start, end } = shape.report
    this.#arrows.show([start, end], this.view.arrows, this.size, [this.#props.start.position, tip])
    this.#glyphs.show(shape, this.view, this.size)
    this.#dirty = true
  }

  /** Shows where all that moves is. What is grabbed is marked, and a dashed line leads to a hand that is elsewhere. */
  showMoving(moving: Scenery): void {
    this.#moving = moving
    const held = moving.rods[moving.held]
    const all = this.#ordered(moving)
    this.tubes.update(all, this.view, true)
    this.#place(held)
    this.#props.putRoots(this.#rooted(all).roots)
    this.solids.put(moving.bodies.frames)
    const { grabbed } = moving.report
    const at = new THREE.Vector3()
    if (grabbed) at.fromArray(moving.rods[grabbed.rod].frames, 12 * grabbed.node + 9)
    this.#props.hold.visible = grabbed !== null
    this.#props.hold.position.copy(at)
    this.#connect(at, this.hand.position, grabbed !== null && at.distanceTo(this.hand.position) > 0.01 * this.size)
    const pull = grabbed ? [{ force: grabbed.force, moment: NOTHING }] : []
    this.#arrows.show(pull, this.view.arrows, this.size, [at])
    this.contacts.show(moving.contacts, moving.passages, this.view.contacts, this.size, Math.max(this.#radius * this.view.displayScale, LEAST_DOT * this.size))
    this.#glyphs.show(held, this.view, this.size)
    this.#dirty = true
  }

  /** Puts the things at both ends of a thread and between, and gives where its end is. */
  #place({ frames }: Body): THREE.Vector3 {
    const last = frames.length / 12 - 1
    const { start, end, clips } = this.#props
    if (!this.gizmo.dragging) place(end, frames, last)
    place(start, frames, 0)
    clips.children.forEach((clip, i) => place(clip, frames, this.#clips[i]))
    return new THREE.Vector3().fromArray(frames, 12 * last + 9)
  }

  #connect(from: THREE.Vector3, to: THREE.Vector3, visible: boolean): void {
    this.#gap.visible = visible
    if (!visible) return
    this.#gap.geometry.setFromPoints([from, to])
    this.#gap.computeLineDistances()
  }

  /** Where the roots are that hold threads. */
  get roots(): [number, number, number][] {
    return this.#props.rootsAt
  }

  /** Whether a line leads from the thread's end to a hand that is elsewhere. */
  get gapIsShown(): boolean {
    return this.#gap.visible
  }

  refresh(): void {
    if (this.#moving) this.showMoving(this.#moving)
    else if (this.#shape) this.show(this.#shape)
  }

  /** Turns to see all of the scene, from where the eye is. */
  frameAll(): void {
    if (!this.#shape) return
    const all = [...places(this.#drawn()), ...this.#reach]
    this.#lookAt(all, this.camera.position.clone().sub(this.orbit.target).normalize())
  }

  /** The threads on the stage, that in the hand first. */
  #drawn(): Strand[] {
    return this.#moving ? this.#ordered(this.#moving) : [this.#shape!, ...this.#shape!.others]
  }

  /** The place of a moving rod that a pointer at a place of the page takes hold of, within a reach, px. */
  pick(x: number, y: number, reach: number): Picked | null {
    if (!this.#moving) return null
    const box = this.canvas.getBoundingClientRect()
    return pick(this.#moving.rods, this.camera, box, new THREE.Vector2(x - box.left, y - box.top), reach, this.view.displayScale)
  }

  /** Where a node of a moving rod is on the page, px. */
  nodeOnPage({ rod, node }: Picked): [number, number] {
    const box = this.canvas.getBoundingClientRect()
    this.camera.updateMatrixWorld()
    const { x, y } = onPage(new THREE.Vector3().fromArray(this.#moving!.rods[rod].frames, 12 * node + 9), this.camera, box)
    return [box.left + x, box.top + y]
  }

  /** Puts the hand where a node of a moving rod is. */
  handTo({ rod, node }: Picked): void {
    place(this.hand, this.#moving!.rods[rod].frames, node)
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

  /** Whether a place of the page is within so many px of a handle of the hand. */
  nearHandle(x: number, y: number, reach: number): boolean {
    return this.handlesOnPage().some((at) => Math.hypot(x - at[0], y - at[1]) < reach)
  }

  /** Where the hand's handles are on the page, px; the first is the thread's end. */
  handlesOnPage(): [number, number][] {
    const box = this.canvas.getBoundingClientRect()
    this.camera.updateMatrixWorld()
    this.#props.end.updateMatrixWorld()
    return this.#props.handles.map((handle) => {
      const { x, y } = onPage(handle.applyMatrix4(this.#props.end.matrixWorld), this.camera, box)
      return [box.left + x, box.top + y]
    })
  }

  /** A picture of thread and things alone, on nothing: WebP as an address of data. */
  picture(width: number, height: number): string {
    const { background } = this.#scene
    const aside = [this.#ground.group, this.#arrows.group, this.contacts.group].filter(({ visible }) => visible)
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
    for (const at of places(this.#drawn())) {
      const { x, y } = at.project(this.camera)
      most = Math.max(most, Math.abs(x), Math.abs(y))
    }
    return most
  }

  /** Turns to see some places, from a direction. */
  #lookAt(all: THREE.Vector3[], direction: THREE.Vector3): void {
    const centre = new THREE.Box3().setFromPoints(all).getCenter(new THREE.Vector3())
    const { size } = this
    // So near that thread and arrows fill the free part of the window.
    const { clientWidth: width, clientHeight: height } = this.canvas
    const { left, right, top, bottom } = this.#insets
    const tan = Math.tan((this.camera.fov * Math.PI) / 360)
    const [wide, high] = [width - left - right, height - top - bottom].map((free) => (tan * Math.max(free, 120)) / height)
    const sideways = new THREE.Vector3().crossVectors(this.camera.up, direction).normalize()
    const upwards = new THREE.Vector3().crossVectors(direction, sideways)
    let distance = 0
    for (const place of all) {
      const at = place.clone().sub(centre)
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

const NOTHING: [number, number, number] = [0, 0, 0]

/** A picture of two rows or more of colours, blended from the top down. */
function backdrop(colours: number[]): THREE.Texture {
  const rows = [...colours].reverse().flatMap((hex) => [hex >> 16, (hex >> 8) & 255, hex & 255, 255])
  const texture = new THREE.DataTexture(new Uint8Array(rows), 1, colours.length)
  texture.colorSpace = THREE.SRGBColorSpace
  texture.minFilter = texture.magFilter = THREE.LinearFilter
  texture.needsUpdate = true
  return texture
}
