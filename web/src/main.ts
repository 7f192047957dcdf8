/** The page: scenes, stage, inspector and the strip of numbers, around one solver. */

import './style.css'
import { engineering, gradient, quantities } from './colour'
import { checkbox, choice, firstRod, numberFields, numberInput, type SceneJson } from './inspector'
import { Plot } from './plot'
import type { HandMode, HandPose, Reply, Shape } from './protocol'
import { Solver } from './solver'
import { Stage } from './stage'

const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T
const stage = new Stage(element<HTMLCanvasElement>('stage'), moveHand)
const solver = new Solver(receive)
const plot = new Plot(element<HTMLCanvasElement>('plot'))
const times: number[] = []
const inputs = new Map<string, HTMLInputElement | HTMLSelectElement>()
const undone: string[] = []
let scene: SceneJson = {}
let opened = { text: '', name: '' }
let paused = false
let frames = 0

function moveHand(pose: HandPose): void {
  if (paused) return
  if (inputs.get('mode')!.value === 'scene') void setMode('pose')
  void solver.move(pose)
}

function receive(reply: Reply): void {
  if (reply.kind === 'error') return say(reply.message)
  if (reply.kind === 'opened') {
    scene = JSON.parse(reply.scene)
    stage.setHand(reply.shape.hand)
    stage.fit(reply.shape)
    fill(reply.coupling)
  }
  if (reply.kind === 'shape' && reply.scene) {
    scene = JSON.parse(reply.scene)
    fill()
  }
  if (reply.kind === 'opened' || reply.kind === 'shape' || reply.kind === 'settled') show(reply.shape, reply.kind === 'settled')
}

function show(shape: Shape, settled = false): void {
  stage.show(shape)
  const { report } = shape
  const { force, moment } = report.end
  // The way to a hand that was not reached at once is no solve.
  if (!settled) times.push(shape.milliseconds)
  if (times.length > 300) times.shift()
  const sorted = [...times].sort((a, b) => a - b)
  const at = (part: number) => sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))].toFixed(2)
  const text: Record<string, string> = {
    force: engineering(Math.hypot(...force), 'N') + (report.saturated ? ' (limit)' : ''),
    torque: engineering(Math.hypot(...moment), 'N·m'),
    energy: engineering(report.energy, 'J'),
    method: `${report.method}, ${report.elements} el.`,
    newton: `${report.iterations} it., ${report.residual?.toExponential(1) ?? '–'}`,
    time: `${at(0.5)} ms, p99 ${at(0.99)}`,
  }
  for (const [id, value] of Object.entries(text)) element(id).textContent = value
  if (report.settling) return
  const away = report.beyond > 0 ? `out of reach by ${(1e3 * report.beyond).toFixed(1)} mm` : null
  const state = away ?? (report.status === 'failed' ? 'failed' : report.morse_index === null ? 'converged' : report.morse_index === 0 ? 'stable' : 'unstable')
  const badge = element('badge')
  if (badge.textContent !== state) badge.textContent = state
  badge.className = away ? 'unstable' : state
  say(away ? null : report.reason)
  plot.add(Math.hypot(...force))
  legend()
  for (const [i, id] of ['hand-x', 'hand-y', 'hand-z'].entries()) {
    const input = inputs.get(id) as HTMLInputElement
    if (document.activeElement !== input) input.value = (shape.hand[i] * 1e3).toFixed(2)
  }
}

function say(message: string | null): void {
  const box = element('message')
  box.hidden = !message
  box.textContent = message
  if (message && element('badge').textContent === 'opening') element('badge').textContent = 'failed'
}

function legend(): void {
  const quantity = quantities[stage.view.colourBy]
  element('legend').hidden = !quantity
  if (!quantity) return
  const [low, high] = stage.tube.range
  element('legend').innerHTML = `${quantity.label}<i style="background:${gradient}"></i><div><span>${engineering(low, quantity.unit)}</span><span>${engineering(high, quantity.unit)}</span></div>`
}

async function open(text: string, name: string): Promise<void> {
  opened = { text, name }
  undone.length = 0
  times.length = 0
  solver.forget()
  const reply = await solver.ask({ kind: 'open', text, name })
  receive(reply)
  if (reply.kind === 'opened') {
    element('scene-name').textContent = `– ${scene.name ?? name}`
    document.querySelectorAll('#rail button').forEach((button) => {
      button.setAttribute('aria-current', String((button as HTMLElement).dataset.name === scene.name))
    })
    const held = firstRod(scene).supports?.some((s: SceneJson) => s.at === 'end' && s.fix.includes('position'))
    inputs.get('mode')!.value = held ? 'pose' : 'scene'
    // The first solve starts from rest, and says nothing of the frames to come.
    times.length = 0
  }
}

async function edit(change: (scene: SceneJson) => void): Promise<void> {
  const before = JSON.stringify(scene)
  const edited = JSON.parse(before)
  change(edited)
  const reply = await solver.ask({ kind: 'replace', text: JSON.stringify(edited) })
  if (reply.kind === 'shape') undone.push(before)
  receive(reply)
  if (reply.kind === 'error') fill()
}

async function undo(): Promise<void> {
  const before = undone.pop()
  if (before) receive(await solver.ask({ kind: 'replace', text: before }))
}

async function setMode(mode: string): Promise<void> {
  inputs.get('mode')!.value = mode
  receive(await solver.ask({ kind: 'mode', mode: mode as HandMode }))
}

/** Writes the scene's numbers into the inspector. */
function fill(coupling?: number[]): void {
  for (const field of numberFields) {
    const input = inputs.get(field.id) as HTMLInputElement
    const value = field.get(scene)
    input.disabled = value === undefined
    input.value = value === undefined ? '' : String(Number((value / field.scale).toPrecision(6)))
  }
  inputs.get('kinematics')!.value = firstRod(scene).kinematics ?? 'cosserat'
  inputs.get('order')!.value = String(scene.solver?.order ?? 2)
  coupling?.forEach((value, i) => (inputs.get(`coupling-${i}`)!.value = String(Number(value.toPrecision(4)))))
}

function buildInspector(): void {
  for (const field of numberFields) {
    const input = numberInput(element(field.group), field.id, field.label, field.unit, field.help, (value) => {
      void edit((scene) => field.set(scene, value * field.scale))
    })
    inputs.set(field.id, input)
  }
  const kinds: [string, string][] = [['kirchhoff', 'inextensible'], ['cosserat', 'extensible']]
  inputs.set('kinematics', choice(element('strand'), 'kinematics', 'Kinematics', 'Whether the thread can stretch and shear.', kinds, (value) => {
    void edit((scene) => (firstRod(scene).kinematics = value))
  }))
  const orders: [string, string][] = [['1', '1 (Euler)'], ['2', '2'], ['4', '4']]
  inputs.set('order', choice(element('solver'), 'order', 'Order', 'Order of accuracy of the elements.', orders, (value) => {
    void edit((scene) => (scene.solver = { ...scene.solver, order: Number(value) }))
  }))
  const modes: [string, string][] = [['pose', 'imposes a pose'], ['coupling', 'pulls a spring'], ['scene', 'is not there'], ['free', 'lets go']]
  inputs.set('mode', choice(element('hand'), 'mode', 'The hand', 'How the hand holds the thread’s end.', modes, (value) => void setMode(value)))
  for (const [i, axis] of ['x', 'y', 'z'].entries()) {
    inputs.set(`hand-${axis}`, numberInput(element('hand'), `hand-${axis}`, `Hand ${axis}`, 'mm', `Where the hand is along ${axis}.`, (value) => {
      const pose = stage.handPose()
      pose[i] = value / 1e3
      stage.setHand(pose)
      moveHand(pose)
    }))
  }
  const coupling: [string, string, string][] = [
    ['Stiffness', 'N/m', 'Stiffness of the spring against shifts.'],
    ['Turning', 'N·m', 'Stiffness of the spring against turns, per radian.'],
    ['Damping', 'N·s/m', 'Damping of shifts.'],
    ['Turn damp.', 'N·m·s', 'Damping of turns.'],
    ['Force limit', 'N', 'The largest force that the device gives.'],
    ['Torque limit', 'N·m', 'The largest torque that the device gives.'],
  ]
  coupling.forEach(([label, unit, help], i) => {
    inputs.set(`coupling-${i}`, numberInput(element('hand'), `coupling-${i}`, label, unit, help, () => {
      const values = coupling.map((_, k) => Number(inputs.get(`coupling-${k}`)!.value))
      void solver.ask({ kind: 'coupling', values }).then(receive)
    }))
  })
  const by = Object.entries(quantities).map(([key, quantity]): [string, string] => [key, quantity?.label ?? 'Nothing'])
  choice(element('view'), 'colour', 'Colour by', 'What the thread’s colour shows.', by, (value) => look({ colourBy: value }))
  const scale = numberInput(element('view'), 'scale', 'Radius ×', '', 'How much thicker than it is the thread is drawn.', (value) => look({ displayScale: value }))
  scale.value = String(stage.view.displayScale)
  checkbox(element('view'), 'arrows', 'Arrows', 'Forces (orange) and torques (violet) at both ends.', true, (value) => look({ arrows: value }))
  checkbox(element('view'), 'directors', 'Directors', 'The material frame along the thread.', false, (value) => look({ directors: value }))
}

function look(change: Partial<typeof stage.view>): void {
  Object.assign(stage.view, change)
  stage.refresh()
  legend()
}

function download(name: string, data: string | Uint8Array): void {
  const link = document.createElement('a')
  link.href = URL.createObjectURL(new Blob([data as BlobPart]))
  link.download = name
  link.click()
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000)
}

async function save(kind: 'toml' | 'csv' | 'glb'): Promise<void> {
  const reply = await solver.ask({ kind })
  if (reply.kind === 'file') download(reply.name, reply.data)
}

async function share(): Promise<void> {
  const reply = await solver.ask({ kind: 'toml' })
  if (reply.kind !== 'file') return
  location.hash = `scene=${encodeURIComponent(reply.data as string)}`
  await navigator.clipboard?.writeText(location.href).catch(() => undefined)
  element('share').textContent = 'Address ready'
  setTimeout(() => (element('share').textContent = 'Share'), 1500)
}

function setPaused(value: boolean): void {
  paused = value
  element('pause').setAttribute('aria-pressed', String(value))
}

function setTheme(dark: boolean): void {
  document.documentElement.dataset.theme = dark ? 'dark' : 'light'
  stage.setTheme(dark)
  plot.draw()
}

function listen(): void {
  const on = (id: string, work: () => void) => element(id).addEventListener('click', work)
  on('undo', () => void undo())
  on('reset', () => void open(opened.text, opened.name))
  on('pause', () => setPaused(!paused))
  on('save-scene', () => void save('toml'))
  on('save-csv', () => void save('csv'))
  on('save-glb', () => void save('glb'))
  on('load', () => element('file').click())
  on('share', () => void share())
  on('theme', () => setTheme(document.documentElement.dataset.theme !== 'dark'))
  on('help', () => element<HTMLDialogElement>('gestures').showModal())
  const take = async (file?: File) => file && open(await file.text(), file.name)
  const file = element<HTMLInputElement>('file')
  file.addEventListener('change', () => void take(file.files?.[0]))
  document.addEventListener('dragover', (event) => event.preventDefault())
  document.addEventListener('drop', (event) => {
    event.preventDefault()
    void take(event.dataTransfer?.files[0])
  })
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey && event.key === 'z') return void undo()
    if ((event.target as HTMLElement).matches('input, select, summary, dialog *')) return
    const step = 0.01
    const keys: Record<string, () => void> = {
      q: () => stage.nudge({ twist: -0.15 }),
      e: () => stage.nudge({ twist: 0.15 }),
      w: () => stage.nudge({ near: -step }),
      s: () => stage.nudge({ near: step }),
      arrowleft: () => stage.nudge({ right: -step }),
      arrowright: () => stage.nudge({ right: step }),
      arrowup: () => stage.nudge({ up: step }),
      arrowdown: () => stage.nudge({ up: -step }),
      t: () => stage.toggleGizmo('translate'),
      r: () => stage.toggleGizmo('rotate'),
      '?': () => element<HTMLDialogElement>('gestures').showModal(),
    }
    if (event.key === ' ' && !(event.target as HTMLElement).matches('button')) {
      event.preventDefault()
      return setPaused(!paused)
    }
    keys[event.key.toLowerCase()]?.()
  })
}

/** A scene from the server, else from the address, else the suture. */
async function first(scenes: { name: string; text: string }[]): Promise<[string, string]> {
  for (const name of ['scene.toml', 'scene.json']) {
    const served = await fetch(name).catch(() => null)
    const type = served?.headers.get('content-type') ?? ''
    if (served?.ok && !type.includes('html')) return [await served.text(), name]
  }
  const shared = new URLSearchParams(location.hash.slice(1)).get('scene')
  if (shared) return [shared, 'shared.toml']
  const suture = scenes.find((scene) => scene.name === 'suture') ?? scenes[0]
  return [suture.text, `${suture.name}.toml`]
}

async function start(): Promise<void> {
  buildInspector()
  if (innerWidth <= 720) document.querySelectorAll('details').forEach((group) => (group.open = false))
  listen()
  setTheme(matchMedia('(prefers-color-scheme: dark)').matches)
  const reply = await solver.ask({ kind: 'bundled' })
  if (reply.kind !== 'bundled') return receive(reply)
  for (const { name, title, text } of reply.scenes) {
    const button = Object.assign(document.createElement('button'), { textContent: name.replaceAll('_', ' '), title })
    button.dataset.name = name
    button.addEventListener('click', () => void open(text, `${name}.toml`))
    element('rail').append(button)
  }
  await open(...(await first(reply.scenes)))
}

function tick(): void {
  frames++
  stage.draw()
  requestAnimationFrame(tick)
}

setInterval(() => {
  element('fps').textContent = `${frames} /s`
  frames = 0
}, 1000)
// What the page's tests look at.
Object.assign(window, { strands: { stage, times, moveHand } })
void start()
tick()
