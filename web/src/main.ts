/** The page: scenes, stage, inspector and the strip of numbers, around one solver. */

import './style.css'
import { isRectangle, type SceneJson } from './fields'
import { download, forgetShared, givenScene, listenToFiles, share } from './files'
import { Gestures } from './gestures'
import { dismissHints, listenToHelp, showGestures, showHints } from './help'
import { History } from './history'
import { Inspector } from './inspector'
import { listenToKeys } from './keys'
import { showLegend } from './legend'
import { SPEEDS } from './motion'
import { MotionMode } from './motion-mode'
import { Plot } from './plot'
import type { HandMode, Reply, Shape } from './protocol'
import { buildRail, markCurrent, spoken } from './rail'
import { judge, Readout } from './readout'
import { listenToTabs, showSheet } from './sheets'
import { Solver } from './solver'
import { Stage, type ViewOptions } from './stage'
import { MANY } from './tubes'

/** A state to go back to. */
interface Moment {
  scene: string
  mode: HandMode
  numbers: Float64Array
}

const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T
const stage = makeStage()
const solver = new Solver(receive)
const plot = new Plot(element<HTMLCanvasElement>('plot'))
const readout = new Readout(plot)
const mode = new MotionMode(stage, solver, readout, plot, { say, shown: showColours, covered: measure })
const { motion } = mode
const gestures = new Gestures(stage, {
  near: (x, y, reach) => (motion.scenery ? stage.pick(x, y, reach) !== null : stage.nearHandle(x, y, reach)),
  grabbed: (x, y, reach) => (motion.scenery ? mode.grab(stage.pick(x, y, reach)) : remember()),
  held: remember,
  moved: moveHand,
  released: () => motion.release(),
})
const inspector = new Inspector(stage, { scene: edit, hand: placeHand, mode: setMode, coupling: setCoupling, look, wind: (velocity) => motion.setWind(velocity) })
const history = new History<Moment>((undo, redo) => {
  element<HTMLButtonElement>('undo').disabled = !undo
  element<HTMLButtonElement>('redo').disabled = !redo
})
let scene: SceneJson = {}
let coupling: number[] = []
let shape: Shape | null = null
let opened = { text: '', name: '' }
let paused = false
/** Whether the hand has been moved while the page was paused. */
let ahead = false
let frames = 0

function makeStage(): Stage {
  try {
    return new Stage(element<HTMLCanvasElement>('stage'), element('labels'), moveHand)
  } catch (error) {
    say('This browser draws no 3-D pictures (WebGL 2). Allow hardware acceleration in its settings, or open the page in another one.')
    throw error
  }
}

function moveHand(): void {
  if (!shape) return
  dismissHints()
  if (motion.scenery) return motion.pull(stage.hand.pose())
  // A paused page remembers where the hand would be, and solves when it goes on.
  ahead = paused
  if (paused) return
  if (shape.report.mode === 'scene' || shape.report.mode === 'free') void solver.ask({ kind: 'mode', mode: 'pose' })
  shape.report.mode = shape.report.mode === 'coupling' ? 'coupling' : 'pose'
  void solver.move(stage.hand.pose())
}

function placeHand(change: () => void): void {
  remember()
  change()
  moveHand()
}

function receive(reply: Reply): void {
  switch (reply.kind) {
    case 'error':
    case 'stopped':
      return say(reply.message)
    case 'opened':
      scene = JSON.parse(reply.scene)
      stage.hand.set(reply.shape.hand)
      setUp(reply.shape)
      inspector.fill(scene, scene.rods[reply.shape.report.rod], true)
      coupling = reply.coupling
      inspector.fillCoupling(coupling)
      // The first solve starts from rest, and says nothing of the frames to come.
      return show(reply.shape, false)
    case 'shape':
      if (reply.scene) {
        scene = JSON.parse(reply.scene)
        // Edits that wait are not in it yet, and their fields must not go back.
        if (waiting === 0) inspector.fill(scene, scene.rods[reply.shape.report.rod])
        inspector.fillCoupling(reply.coupling)
      }
      coupling = reply.coupling
      shape = reply.shape
      // What moves begins anew with the scene as it is now.
      if (motion.scenery) return void setMotion(true, motion.playing)
      return show(reply.shape)
    case 'settled':
      return show(reply.shape, false)
  }
}

/** Prepares stage and names for a scene that has just been opened. */
function setUp(first: Shape): void {
  const rods = [first.report.rod, ...first.others.map(({ name }) => name)].map((name) => scene.rods[name])
  const isHeld = (rod: SceneJson, ...places: unknown[]) => rod.supports?.some(({ at }: SceneJson) => places.includes(at)) ?? false
  stage.setScene(first, {
    square: rods.map(isRectangle),
    startIsHeld: rods.map((rod) => isHeld(rod, 'start', 0)),
    endIsHeld: rods.map((rod) => isHeld(rod, 'end', rod.length)),
    tied: first.report.moves_only && !(scene.contact && !scene.joints?.length),
    touches: Boolean(scene.contact),
    surgical: String(scene.name ?? '').includes('suture'),
    skin: rods.length >= MANY && String(scene.name ?? '').includes('hair'),
  })
  inspector.fillView()
  mode.allowRest(!first.report.moves_only)
  element('scene-name').textContent = spoken(scene.name ?? opened.name)
  markCurrent(element('rail'), scene.name)
}

function show(next: Shape, solved = true): void {
  shape = next
  // A hand that does not lead is where the thread's end is; one that leads is ahead of the solver.
  const follows = next.report.mode === 'scene' || next.report.mode === 'free'
  if (follows && !gestures.holding && !ahead) stage.hand.set(next.hand)
  stage.show(next)
  readout.show(next, solved)
  inspector.show(next)
  const { advice } = judge(next.report)
  if (!next.report.settling) say(advice, advice && next.report.reason)
  showColours()
}

/** Says what went wrong and what to do; what only an expert wants to know is folded away. */
function say(message: string | null, details: string | null = null): void {
  element('message').hidden = !message
  // Written anew it would be read out anew.
  if (element('message-text').textContent !== message) element('message-text').textContent = message
  element('message-details').hidden = !details
  element('message-more').textContent = details
}

/** Opens a scene in place of this one, and gives whether that worked. Whether it then moves is what the scene says, unless it is given. */
async function open(text: string, name: string, moves?: boolean): Promise<boolean> {
  solver.forget()
  const reply = await solver.ask({ kind: 'open', text, name })
  if (reply.kind !== 'opened') {
    if (!shape) readout.say({ kind: 'failed', badge: 'failed' })
    receive(reply)
    return false
  }
  opened = { text, name }
  history.clear()
  // Where the hand was in the other scene means nothing in this one.
  ahead = false
  setPaused(false)
  mode.show(false)
  readout.clear()
  receive(reply)
  // A scene that says how it moves is there to move, and rods that are tied or touch can do nothing else.
  if (reply.shape.report.moves_only || (moves ?? scene.dynamics)) await setMotion(true, !matchMedia('(prefers-reduced-motion: reduce)').matches)
  return true
}

async function reset(): Promise<void> {
  const before = shape && now()
  if ((await open(opened.text, opened.name, motion.scenery !== null)) && before) history.push(before)
}

/** Edits are made one after the other: each starts from what the last has left. */
let lastEdit = Promise.resolve()
/** How many have not begun. */
let waiting = 0

function inTurn(work: () => Promise<void>): void {
  waiting++
  const begin = () => {
    waiting--
    return work()
  }
  // One that breaks off must not hold up those after it.
  lastEdit = lastEdit.then(begin).catch((error) => {
    refill()
    say(`This change could not be made (${error}).`)
  })
}

/** Writes what holds into the inspector's fields. */
function refill(): void {
  inspector.fill(scene, scene.rods[shape!.report.rod])
}

function edit(change: (scene: SceneJson, rod: SceneJson) => void): void {
  inTurn(async () => {
    const edited = structuredClone(scene)
    change(edited, edited.rods[shape!.report.rod])
    const before = now()
    const reply = await solver.ask({ kind: 'replace', text: JSON.stringify(edited) })
    if (reply.kind === 'shape') history.push(before)
    receive(reply)
    // What was refused is not what holds.
    if (reply.kind === 'error') refill()
  })
}

function now(): Moment {
  return { scene: JSON.stringify(scene), mode: shape!.report.mode, numbers: shape!.snapshot }
}

function remember(): void {
  if (shape) history.push(now())
}

async function goBack(moment: Moment | undefined): Promise<void> {
  if (!moment) return
  solver.forget()
  ahead = false
  const reply = await solver.ask({ kind: 'restore', text: moment.scene, mode: moment.mode, numbers: moment.numbers })
  if (reply.kind === 'shape') stage.hand.set(reply.shape.hand)
  receive(reply)
}

const undo = () => shape && void goBack(history.undo(now()))
const redo = () => shape && void goBack(history.redo(now()))

async function setMode(mode: HandMode): Promise<void> {
  const before = now()
  solver.forget()
  const reply = await solver.ask({ kind: 'mode', mode })
  if (reply.kind !== 'shape') {
    receive(reply)
    return inspector.show(shape!)
  }
  history.push(before)
  ahead = false
  // A spring takes hold a little beside the thread's end.
  stage.hand.set(reply.shape.hand)
  receive(reply)
  // What is let go may fall out of sight.
  if (mode === 'free' || mode === 'scene') stage.frameAll()
}

function setCoupling(index: number, value: number): void {
  inTurn(async () => {
    const before = now()
    // The others as they are, and not as their fields round them.
    const reply = await solver.ask({ kind: 'coupling', values: coupling.map((old, i) => (i === index ? value : old)) })
    if (reply.kind === 'shape') {
      history.push(before)
      receive(reply)
    }
    inspector.fillCoupling(coupling)
    // What was refused is not what holds.
    if (reply.kind === 'error') inspector.refuseCoupling(index, reply.message)
  })
}

function look(change: Partial<ViewOptions>): void {
  Object.assign(stage.view, change)
  stage.refresh()
  showColours()
}

function showColours(): void {
  showLegend(element('legend'), stage.view, stage.tubes.range)
}

/** Lets the scene move from its start, or solves for where it rests. */
async function setMotion(moves: boolean, plays = true): Promise<void> {
  if (!shape || (!moves && shape.report.moves_only)) return
  solver.forget()
  const why = moves ? await mode.begin(shape, plays) : null
  if (moves && !why) return
  await mode.end()
  stage.hand.set(shape.hand)
  stage.setStill(shape)
  readout.clear()
  show(shape, false)
  if (why) say(why)
}

async function save(kind: 'toml' | 'csv' | 'glb'): Promise<void> {
  const reply = await solver.ask({ kind })
  if (reply.kind === 'file') download(reply.name.replace(/^(scene|shape)/, scene.name ?? '$1'), reply.data)
}

function savePicture(): void {
  stage.canvas.toBlob((picture) => picture && download(`${scene.name ?? 'strands'}.png`, picture))
}

async function shareScene(): Promise<void> {
  const reply = await solver.ask({ kind: 'toml' })
  if (reply.kind !== 'file') return
  await share(reply.data as string)
  element('share').textContent = 'Address ready'
  setTimeout(() => (element('share').textContent = 'Share'), 1500)
}

function setPaused(value: boolean): void {
  paused = value
  if (!paused && ahead) moveHand()
  element('pause').setAttribute('aria-pressed', String(value))
  element('pause').textContent = value ? 'Go on' : 'Pause'
}

function setTheme(dark: boolean): void {
  document.documentElement.dataset.theme = dark ? 'dark' : 'light'
  element('theme').textContent = dark ? 'Light' : 'Dark'
  stage.setTheme(dark)
}

/** Tells the stage what the panels cover. */
function measure(): void {
  const size = (id: string) => element(id).getBoundingClientRect()
  const narrow = innerWidth <= 720
  stage.setInsets({
    left: narrow ? 0 : size('rail').right,
    right: narrow ? 0 : innerWidth - size('inspector').left,
    top: size('top').bottom,
    bottom: innerHeight - size('strip').top,
  })
}

function listen(): void {
  const on = (id: string, work: () => void) => element(id).addEventListener('click', work)
  on('undo', undo)
  on('redo', redo)
  on('reset', () => void reset())
  on('pause', () => setPaused(!paused))
  on('motion', () => void setMotion(!motion.scenery))
  on('save-scene', () => void save('toml'))
  on('save-csv', () => void save('csv'))
  on('save-glb', () => void save('glb'))
  on('save-png', savePicture)
  on('load', () => element('file').click())
  on('share', () => void shareScene())
  on('theme', () => setTheme(document.documentElement.dataset.theme !== 'dark'))
  on('help', showGestures)
  on('hints-close', dismissHints)
  on('message-close', () => say(null))
  listenToHelp()
  listenToTabs()
  listenToFiles(element<HTMLInputElement>('file'), (text, name) => {
    forgetShared()
    void open(text, name)
  })
  const escape = () => {
    say(null)
    showSheet(null)
    dismissHints()
  }
  listenToKeys(stage, {
    undo, redo, help: showGestures, escape, moved: moveHand,
    pause: () => (motion.scenery ? motion.setPlaying(!motion.playing) : setPaused(!paused)),
    motion: () => void setMotion(!motion.scenery),
    step: () => motion.step(),
    rewind: () => motion.rewind(),
    speed: (place) => motion.setSpeed(SPEEDS[place]),
    grab: () => mode.grabEnd(),
    moves: () => motion.scenery !== null,
    grabbed: () => motion.scenery ?? remember(),
  })
  addEventListener('resize', measure)
}

async function start(): Promise<void> {
  listen()
  setTheme(matchMedia('(prefers-color-scheme: dark)').matches)
  const reply = await solver.ask({ kind: 'bundled' })
  if (reply.kind !== 'bundled') {
    readout.say({ kind: 'failed', badge: 'failed' })
    return receive(reply)
  }
  buildRail(element('rail'), reply.scenes, ({ text, name }) => {
    forgetShared()
    showSheet(null)
    void open(text, `${name}.toml`)
  })
  measure()
  const given = await givenScene()
  const suture = reply.scenes.find((scene) => scene.name === 'suture') ?? reply.scenes[0]
  await open(given?.text ?? suture.text, given?.name ?? `${suture.name}.toml`)
  showHints()
}

function tick(): void {
  frames++
  motion.tick()
  stage.draw()
  requestAnimationFrame(tick)
}

setInterval(() => {
  for (const id of ['fps', 'motion-fps']) element(id).textContent = `${frames} /s`
  frames = 0
}, 1000)
// What the page's tests look at.
Object.assign(window, { strands: { stage, readout, solver, motion, moveHand } })
void start()
tick()
