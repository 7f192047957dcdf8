/** What stands beside the thread: the needle or a grip at its end, tissue or a clamp at its start, the ground. Made for a scene of 0.2 m. */

import * as THREE from 'three'

/**
 * Polished steel: what a sphere of it reflects of a bright sky, a dark horizon and a grey floor. A picture of a sphere costs nothing to make,
 * where surroundings for a metal of the usual kind take seconds on a machine without a graphics card.
 */
function steel(): THREE.Material {
  const size = 64
  const texels = new Uint8Array(4 * size * size)
  for (let i = 0; i < size; i++) {
    for (let j = 0; j < size; j++) {
      const [x, y] = [(2 * (j + 0.5)) / size - 1, (2 * (i + 0.5)) / size - 1]
      const z = Math.sqrt(Math.max(0, 1 - x * x - y * y))
      // The mirrored view's height and side.
      const [up, side] = [2 * z * y, 2 * z * x]
      const sky = 0.5 + 0.5 * Math.tanh(5 * (up - 0.05))
      const lamp = Math.exp(-14 * ((up - 0.75) ** 2 + (side + 0.25) ** 2))
      const shade = 0.16 + 0.2 * Math.max(0, -up) + (0.42 + 0.16 * up) * sky + 0.5 * lamp
      texels.set([shade * 247, shade * 251, shade * 255, 255].map((x) => Math.min(x, 255)), 4 * (i * size + j))
    }
  }
  const matcap = new THREE.DataTexture(texels, size, size)
  matcap.colorSpace = THREE.SRGBColorSpace
  matcap.magFilter = THREE.LinearFilter
  matcap.needsUpdate = true
  return new THREE.MeshMatcapMaterial({ matcap })
}

/** A half-circle needle, swaged onto the thread's end. */
function needle(): THREE.Group {
  const radius = 0.011
  const thickness = 0.0007
  const steps = 64
  const curve = new THREE.CatmullRomCurve3(
    Array.from({ length: 25 }, (_, i) => {
      const a = (i / 24) * Math.PI
      return new THREE.Vector3(radius * (1 - Math.cos(a)), 0, radius * Math.sin(a))
    }),
  )
  const body = new THREE.TubeGeometry(curve, steps, thickness, 12)
  // It tapers to a point along its last third.
  const at = body.attributes.position
  for (let i = 0; i <= steps; i++) {
    const part = Math.min(1, (1 - i / steps) / 0.35)
    const centre = curve.getPointAt(i / steps)
    for (let j = 0; j <= 12; j++) {
      const k = i * 13 + j
      const v = new THREE.Vector3().fromBufferAttribute(at, k).sub(centre).multiplyScalar(Math.max(part, 0.03)).add(centre)
      at.setXYZ(k, v.x, v.y, v.z)
    }
  }
  const group = new THREE.Group()
  const swage = new THREE.Mesh(new THREE.SphereGeometry(thickness * 1.35, 16, 12), steel())
  group.add(new THREE.Mesh(body, steel()), swage)
  return group
}

/** A grip: a ring around the thread's end, with a pointer along d1 that turns with it. */
function grip(): THREE.Group {
  const material = new THREE.MeshStandardMaterial({ color: 0x46525f, roughness: 0.4 })
  const ring = new THREE.Mesh(new THREE.TorusGeometry(0.0075, 0.0011, 14, 48), material)
  const pointer = new THREE.Mesh(new THREE.ConeGeometry(0.0018, 0.005, 16), new THREE.MeshStandardMaterial({ color: 0xe9edf1, roughness: 0.4 }))
  pointer.position.x = 0.0115
  pointer.rotation.z = -Math.PI / 2
  const group = new THREE.Group()
  group.add(ring, pointer)
  return group
}

/** A mound of tissue that the thread comes out of: half a unit sphere on the ground. */
function tissue(): THREE.Mesh {
  const skin = new THREE.MeshStandardMaterial({ color: 0xdd8d80, roughness: 0.62 })
  return new THREE.Mesh(new THREE.SphereGeometry(1, 64, 32, 0, 2 * Math.PI, 0, Math.PI / 2).rotateX(Math.PI / 2), skin)
}

/** A block that clamps the thread's start. */
function clamp(material: THREE.Material): THREE.Mesh {
  return new THREE.Mesh(new THREE.CylinderGeometry(0.0085, 0.0085, 0.012, 48).rotateX(Math.PI / 2).translate(0, 0, -0.0058), material)
}

/** A stand of unit height for the clamp, its foot at the origin. */
function stand(material: THREE.Material): THREE.Group {
  const group = new THREE.Group()
  const foot = new THREE.Mesh(new THREE.CylinderGeometry(0.013, 0.0135, 0.02, 48).rotateX(Math.PI / 2).translate(0, 0, 0.01), material)
  group.add(new THREE.Mesh(new THREE.CylinderGeometry(0.0022, 0.0022, 1, 24).rotateX(Math.PI / 2).translate(0, 0, 0.5), material), foot)
  return group
}

/** A clip that holds the thread between its ends: a ring around it. */
function clip(material: THREE.Material): THREE.Mesh {
  const ring = new THREE.Mesh(new THREE.TorusGeometry(0.0045, 0.0013, 12, 36), material)
  ring.castShadow = ring.receiveShadow = true
  return ring
}

/** The least height of a stand, in parts of the scene's size: a thread that hangs deeper hangs from above. */
const HANGS = 0.55

export class Props {
  /** Follows the thread's end. */
  readonly end = new THREE.Group()
  /** Follows the thread's start. */
  readonly start = new THREE.Group()
  /** Stands on the ground below the start. */
  readonly below = new THREE.Group()
  /** Hold the thread between its ends. */
  readonly clips = new THREE.Group()
  /** Hold the starts of the other threads. */
  readonly roots = new THREE.Group()
  /** Marks what a hand has grabbed. */
  readonly hold = new THREE.Mesh(new THREE.SphereGeometry(1, 24, 16), new THREE.MeshStandardMaterial({ color: 0xd9480f, roughness: 0.4, transparent: true, opacity: 0.75 }))
  #root = new THREE.SphereGeometry(1, 12, 8)
  #planted: THREE.InstancedMesh | null = null
  #rootSize = 1
  #radius = 1
  #dark = new THREE.MeshStandardMaterial({ color: 0x5a6675, roughness: 0.45 })
  #parts = { needle: needle(), grip: grip(), tissue: tissue(), scalp: tissue(), clamp: clamp(this.#dark), stand: stand(this.#dark) }

  constructor() {
    this.end.add(this.#parts.needle, this.#parts.grip)
    this.start.add(this.#parts.clamp)
    this.below.add(this.#parts.tissue, this.#parts.stand)
    for (const group of [this.end, this.start, this.below]) {
      group.traverse((part) => (part.castShadow = part.receiveShadow = true))
    }
  }

  /** `endIsFree` where nothing holds the end and no hand is to take it there. */
  choose(surgical: boolean, startIsHeld: boolean, endIsFree: boolean): void {
    this.#parts.needle.visible = this.#parts.tissue.visible = surgical
    this.#parts.grip.visible = !surgical && !endIsFree
    this.#parts.clamp.visible = this.#parts.stand.visible = !surgical
    this.start.visible = this.below.visible = startIsHeld
  }

  /** Fits them to a scene of a size, to its start and floor, and the clamp and the grip to a thread that is drawn `radius` thick. */
  fit(size: number, radius: number, start: THREE.Vector3, floor: number): void {
    const scale = size / 0.2
    this.#radius = radius
    this.hold.scale.setScalar(Math.max(2 * radius, 0.012 * size))
    const wide = Math.min(Math.max(1, (1.5 * radius) / (0.0065 * scale)), 1.7)
    this.end.scale.setScalar(scale)
    this.start.scale.setScalar(scale)
    this.#parts.grip.scale.setScalar(wide)
    this.#parts.clamp.scale.setScalar(wide)
    this.below.position.set(start.x, start.y, floor)
    const height = start.z - floor
    this.#parts.tissue.scale.set(0.03 * scale, 0.025 * scale, height + 0.0006 * scale)
    this.#parts.stand.scale.set(scale, scale, height)
    this.#parts.stand.visible &&= height < HANGS * size
    const [, foot] = this.#parts.stand.children
    foot.scale.z = (0.16 * scale) / height
  }

  /** Puts a root where each of these threads is held, by its frame, and skin under all of them where they grow out of it. */
  plant(starts: Float64Array[], skin: boolean): void {
    for (const old of this.roots.children) if (old instanceof THREE.InstancedMesh) old.dispose()
    this.roots.clear()
    this.#planted = null
    if (starts.length === 0) return
    this.#planted = new THREE.InstancedMesh(this.#root, this.#dark, starts.length)
    this.#planted.frustumCulled = false
    this.#rootSize = (skin ? 1.2 : 2) * this.#radius
    this.roots.add(this.#planted)
    this.putRoots(starts)
    if (skin) this.roots.add(this.#under(starts))
    for (const part of this.roots.children) part.castShadow = part.receiveShadow = true
  }

  /** Puts the roots where what they hold has been led. */
  putRoots(starts: Float64Array[]): void {
    const [size, matrix] = [this.#rootSize, new THREE.Matrix4()]
    starts.forEach((frames, i) => this.#planted?.setMatrixAt(i, matrix.makeScale(size, size, size).setPosition(frames[9], frames[10], frames[11])))
    if (this.#planted) this.#planted.instanceMatrix.needsUpdate = true
  }

  /** Where they are. */
  get rootsAt(): [number, number, number][] {
    const matrix = new THREE.Matrix4()
    return Array.from({ length: this.#planted?.count ?? 0 }, (_, i) => {
      this.#planted!.getMatrixAt(i, matrix)
      return new THREE.Vector3().setFromMatrixPosition(matrix).toArray()
    })
  }

  /** A flat mound whose surface goes through the roots of threads and faces as they do. */
  #under(starts: Float64Array[]): THREE.Mesh {
    const [centre, up] = [new THREE.Vector3(), new THREE.Vector3()]
    for (const frames of starts) {
      centre.add(new THREE.Vector3().fromArray(frames, 9).divideScalar(starts.length))
      up.add(new THREE.Vector3().fromArray(frames, 6))
    }
    up.normalize()
    const arms = starts.map((frames) => new THREE.Vector3().fromArray(frames, 9).sub(centre))
    const wide = 1.8 * Math.max(...arms.map((arm) => arm.length()))
    const top = Math.max(...arms.map((arm) => arm.dot(up))) + 0.03 * wide
    const mound = this.#parts.scalp
    mound.scale.set(wide, wide, 0.45 * wide)
    mound.position.copy(centre).addScaledVector(up, top - 0.45 * wide)
    mound.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), up)
    return mound
  }

  /** Makes as many clips as there are supports between the ends, of the clamp's size. */
  countClips(count: number): void {
    while (this.clips.children.length > count) {
      const last = this.clips.children[this.clips.children.length - 1] as THREE.Mesh
      last.geometry.dispose()
      this.clips.remove(last)
    }
    while (this.clips.children.length < count) this.clips.add(clip(this.#dark))
    for (const one of this.clips.children) one.scale.copy(this.start.scale).multiply(this.#parts.clamp.scale)
  }

  /** Where the end can be grabbed, in the end's frame, m. */
  get handles(): THREE.Vector3[] {
    const bow = [0, 0.25, 0.5, 0.75, 1].map((part) => {
      const a = part * Math.PI
      return new THREE.Vector3(0.011 * (1 - Math.cos(a)), 0, 0.011 * Math.sin(a))
    })
    return this.#parts.needle.visible ? bow : [new THREE.Vector3()]
  }
}
