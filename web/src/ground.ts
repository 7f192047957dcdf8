/** The ground: a grid that fades into the backdrop, and the shadows that fall on it. */

import * as THREE from 'three'

const VERTEX = `
varying vec2 at;
void main() {
  at = position.xy;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`

// Lines of constant width on the screen, every tenth of them stronger.
const FRAGMENT = `
uniform vec3 colour;
uniform float cell;
uniform float reach;
uniform float strength;
varying vec2 at;
float lines(float width) {
  vec2 place = at / width;
  vec2 blur = fwidth(place);
  vec2 edge = abs(fract(place - 0.5) - 0.5) / max(blur, vec2(1e-6));
  float line = 1.0 - min(min(edge.x, edge.y), 1.0);
  return line * (1.0 - smoothstep(0.15, 0.6, max(blur.x, blur.y)));
}
void main() {
  float fade = 1.0 - smoothstep(0.1, 1.0, length(at) / reach);
  float line = max(0.45 * lines(cell), lines(10.0 * cell));
  gl_FragColor = vec4(colour, strength * line * fade * fade);
}`

export class Ground {
  readonly group = new THREE.Group()
  #grid: THREE.ShaderMaterial
  #shadow = new THREE.ShadowMaterial({ transparent: true })

  constructor() {
    this.#grid = new THREE.ShaderMaterial({
      vertexShader: VERTEX, fragmentShader: FRAGMENT, transparent: true, depthWrite: false,
      uniforms: { colour: { value: new THREE.Color() }, cell: { value: 0.01 }, reach: { value: 1 }, strength: { value: 0.6 } },
    })
    const plane = new THREE.PlaneGeometry(1, 1)
    const grid = new THREE.Mesh(new THREE.PlaneGeometry(8, 8), this.#grid)
    const shadow = new THREE.Mesh(plane, this.#shadow)
    shadow.scale.setScalar(8)
    shadow.receiveShadow = true
    shadow.position.z = -0.0002
    this.group.add(grid, shadow)
  }

  setTheme(dark: boolean): void {
    this.#grid.uniforms.colour.value.set(dark ? 0x8fa3ba : 0x5d6f84)
    this.#grid.uniforms.strength.value = dark ? 0.32 : 0.42
    this.#shadow.opacity = dark ? 0.5 : 0.2
  }

  /** Puts it below a scene. Its squares are a power of ten wide, about a twentieth of the scene. */
  fit(centre: THREE.Vector3, floor: number, size: number): void {
    this.group.position.set(centre.x, centre.y, floor)
    this.#grid.uniforms.cell.value = 10 ** Math.round(Math.log10(size / 20))
    this.#grid.uniforms.reach.value = 2.4 * size
  }
}
