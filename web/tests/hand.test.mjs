// The hand: grabbed by mouse, fingers and keys; what it cannot reach; what is taken back.

import assert from 'node:assert/strict'
import { readFileSync } from 'node:fs'
import { after, before, test } from 'node:test'
import { badge, changes, done, hand, needle, openPage, openScene, openText, out, sharedPage, start, text, type, until, value } from './browser.mjs'

let context
const fresh = sharedPage(() => context)
before(async () => (context = await start()))
after(async () => context.stop())

test('the suture opens ready to drag, follows the pointer, and undo and redo bring the hand back', async () => {
  const { page, complaints } = await fresh()
  await badge(page, 'stable')
  assert.match(await text(page, 'method'), /(equilibrium|shooting), 200 el\./)
  const first = await hand(page)
  assert.ok(await page.locator('#undo').isDisabled())
  const [x, y] = await needle(page)
  await page.mouse.move(x, y)
  await page.mouse.down()
  await changes(page, 'hand-x', () => page.mouse.move(x - 30, y - 25, { steps: 5 }))
  await changes(page, 'hand-y', () => page.mouse.wheel(0, 60))
  await page.keyboard.down('Shift')
  await changes(page, 'turn-z', () => page.mouse.move(x - 5, y - 25, { steps: 5 }))
  await page.keyboard.up('Shift')
  await page.keyboard.down('Alt')
  await changes(page, 'turn-y', () => page.mouse.move(x - 5, y - 15, { steps: 3 }))
  await page.keyboard.up('Alt')
  await page.mouse.up()
  await badge(page, 'stable')
  await page.screenshot({ path: `${out}dragged.png` })
  const dragged = await hand(page)
  await page.locator('#undo').click()
  await until(page, (x) => document.getElementById('hand-x').value === x, first[0])
  assert.deepEqual(await hand(page), first)
  assert.ok(await page.locator('#undo').isDisabled())
  await page.keyboard.press('Control+Shift+Z')
  await until(page, (x) => document.getElementById('hand-x').value === x, dragged[0])
  assert.deepEqual(await hand(page), dragged)
  await page.keyboard.press('Control+z')
  await until(page, (x) => document.getElementById('hand-x').value === x, first[0])
  await page.locator('#redo').click()
  await until(page, (x) => document.getElementById('hand-x').value === x, dragged[0])
  await page.locator('#reset').click()
  await until(page, (x) => document.getElementById('hand-x').value === x, first[0])
  assert.deepEqual(await hand(page), first)
  await page.locator('#undo').click()
  await until(page, (x) => document.getElementById('hand-x').value === x, dragged[0])
  assert.deepEqual(complaints, [])
})

test('300 poses on a closed path are solved; how long that takes is printed', async () => {
  const { page } = await fresh()
  const times = await page.evaluate(async () => {
    const { stage, readout, solver } = window.strands
    readout.times.length = 0
    const start = stage.hand.pose()
    for (let i = 1; i <= 300; i++) {
      const a = (2 * Math.PI * i) / 300
      const pose = [...start]
      pose[0] -= 0.02 * (1 - Math.cos(a))
      pose[1] += 0.015 * Math.sin(2 * a)
      pose[2] += 0.02 * Math.sin(a)
      await solver.move(pose)
    }
    return [...readout.times].sort((a, b) => a - b)
  })
  assert.equal(times.length, 300)
  const at = (part) => times[Math.floor(part * (times.length - 1))].toFixed(2)
  console.log(`${times.length} solves of 200 elements: median ${at(0.5)} ms, p99 ${at(0.99)} ms`)
  await badge(page, 'stable')
})

test('a hand that cannot be followed does not hold up a newer one; how long that waits is printed', async () => {
  const { page, complaints } = await fresh()
  const waits = await page.evaluate(async () => {
    const { stage, solver } = window.strands
    const start = stage.hand.pose()
    const waits = []
    // Drawing in software would take longer than what is measured.
    const { draw } = stage
    stage.draw = () => undefined
    for (let i = 1; i <= 40; i++) {
      const far = [...start]
      far[0] += 0.003 * i
      far[2] += 0.01 * i
      await solver.move(far)
      // Some time into the way there, a newer hand.
      await new Promise((resolve) => setTimeout(resolve, i % 7))
      const asked = performance.now()
      await solver.move(start)
      waits.push(performance.now() - asked)
    }
    stage.draw = draw
    return waits.sort((a, b) => a - b)
  })
  console.log(`a newer hand waited ${waits[waits.length >> 1].toFixed(1)} ms (median), ${waits[waits.length - 1].toFixed(1)} ms (most)`)
  await done(page)
  assert.equal(await value(page, 'hand-z'), '60.00')
  assert.deepEqual(complaints, [])
})

test('of many moves at once the newest wins, also after one that cannot be reached', async () => {
  const { page, complaints } = await fresh()
  const solved = await page.evaluate(async () => {
    const { stage, solver, readout, moveHand } = window.strands
    const start = stage.hand.pose()
    const before = readout.times.length
    for (let i = 1; i <= 200; i++) {
      const pose = [...start]
      pose[2] += 0.0001 * i
      stage.hand.set(pose)
      moveHand()
    }
    // Answered in order: one move is under way, and one waits.
    for (let i = 0; i < 3; i++) await solver.ask({ kind: 'csv' })
    return readout.times.length - before
  })
  await until(page, () => document.getElementById('hand-z').value === '80.00')
  assert.ok(solved < 200, `${solved} solves for 200 moves`)
  await type(page, 'hand-z', 900)
  await type(page, 'hand-z', 70)
  await done(page)
  await badge(page, 'stable')
  assert.equal(await value(page, 'hand-z'), '70.00')
  assert.equal(await page.evaluate(() => window.strands.stage.gapIsShown), false)
  assert.deepEqual(complaints, [])
})

test('out of reach the hand goes on, a line shows the gap, and the badge says how far', async () => {
  const { page, complaints } = await fresh()
  await type(page, 'hand-x', 900)
  await until(page, () => /out of reach by \d+\.\d mm/.test(document.getElementById('badge').textContent))
  assert.ok(await page.evaluate(() => window.strands.stage.gapIsShown))
  assert.match(await text(page, 'live'), /out of reach/)
  assert.equal(await value(page, 'hand-x'), '900.00')
  await page.locator('#reset').click()
  await badge(page, 'stable')
  assert.equal(await page.evaluate(() => window.strands.stage.gapIsShown), false)
  assert.deepEqual(complaints, [])
})

test('where no equilibrium is found out of reach, the failure is what the badge says', async () => {
  const { page } = await fresh()
  const judged = (status, settling) => page.evaluate(async (change) => {
    const { solver, readout, stage } = window.strands
    const { shape } = await solver.ask({ kind: 'hand', pose: stage.hand.pose() })
    Object.assign(shape.report, { beyond: 0.2, ...change })
    readout.show(shape, false)
    return ['className', 'textContent'].map((key) => document.getElementById('badge')[key])
  }, { status, settling })
  assert.deepEqual(await judged('converged', false), ['away', 'out of reach by 200.0 mm'])
  assert.deepEqual(await judged('failed', false), ['failed', 'failed, out of reach by 200.0 mm'])
  // While the thread is on its way it is known how far, and not how it ends.
  assert.deepEqual(await judged('failed', true), ['away', 'out of reach by 200.0 mm'])
})

const ARCH = readFileSync(new URL('../../crates/strands-wasm/src/session/arch.toml', import.meta.url), 'utf8')

test('an arch whose end is turned by typed angles snaps over, which a notice says for a while, and stays stable', async () => {
  const { page, complaints } = await fresh()
  await openText(page, 'arch', ARCH)
  await page.locator('#mode').selectOption('pose')
  await badge(page, 'stable')
  const shown = () => page.locator('#snap').evaluate((notice) => notice.classList.contains('shown'))
  const turns = async (sign) => {
    for (let angle = 0; angle <= 112; angle += 4) {
      await type(page, 'turn-x', sign * angle)
      await done(page)
      await badge(page, 'stable')
      if (await shown()) return angle
    }
    return null
  }
  assert.equal(await text(page, 'snap'), '')
  // Which way it is to be turned depends on the side that it has buckled to.
  const angle = (await turns(1)) ?? (await turns(-1))
  assert.ok(angle > 20, `snapped at ${angle}°`)
  assert.equal(await text(page, 'snap'), 'The strand snapped to another equilibrium')
  assert.equal(await text(page, 'badge'), 'stable')
  await page.screenshot({ path: `${out}snapped.png` })
  await until(page, () => document.getElementById('snap').textContent === '')
  await badge(page, 'stable')
  assert.deepEqual(complaints, [])
})

test('keys twist, move and turn the hand, show the gizmo, pause and frame', async () => {
  const { page, complaints } = await fresh()
  await page.locator('#stage').focus()
  await changes(page, 'torque', () => page.keyboard.press('e'))
  await changes(page, 'turn-z', () => page.keyboard.press('q'))
  await changes(page, 'hand-y', () => page.keyboard.press('w'))
  await changes(page, 'hand-y', () => page.keyboard.press('s'))
  for (const [key, id] of [['ArrowUp', 'hand-z'], ['ArrowDown', 'hand-z'], ['ArrowLeft', 'hand-x'], ['ArrowRight', 'hand-x']]) {
    await changes(page, id, () => page.keyboard.press(key))
  }
  const z = Number(await value(page, 'hand-z'))
  const fine = Number(await changes(page, 'hand-z', () => page.keyboard.press('Shift+ArrowUp')))
  assert.ok(fine - z < 0.6, `a fine step of ${fine - z} mm`)
  const gizmo = () => page.evaluate(() => window.strands.stage.gizmo.object && window.strands.stage.gizmo.mode)
  await page.keyboard.press('t')
  assert.equal(await gizmo(), 'translate')
  await page.keyboard.press('r')
  assert.equal(await gizmo(), 'rotate')
  await page.keyboard.press('r')
  assert.equal(await gizmo(), undefined)
  await page.keyboard.press(' ')
  assert.equal(await page.locator('#pause').getAttribute('aria-pressed'), 'true')
  const held = await hand(page)
  await page.keyboard.press('ArrowLeft')
  await page.evaluate(() => window.strands.solver.ask({ kind: 'csv' }))
  assert.deepEqual(await hand(page), held, 'a paused page follows the hand')
  await changes(page, 'hand-x', () => page.locator('#pause').click())
  const far = await page.evaluate(() => {
    const { camera } = window.strands.stage
    camera.position.multiplyScalar(3)
    return camera.position.length()
  })
  await page.keyboard.press('f')
  assert.ok((await page.evaluate(() => window.strands.stage.camera.position.length())) < far)
  assert.deepEqual(complaints, [])
})

test('a hand that is moved while the page is paused is followed when it goes on, also where it did not hold the end', async () => {
  const { page, complaints } = await fresh()
  for (const mode of ['scene', 'free', 'coupling']) {
    await page.locator('#mode').selectOption(mode)
    await badge(page, 'stable', 'unstable')
    await done(page)
    await page.locator('#stage').focus()
    await page.keyboard.press(' ')
    const before = await hand(page)
    for (let i = 0; i < 3; i++) await page.keyboard.press('Shift+ArrowUp')
    await done(page)
    assert.deepEqual(await hand(page), before, mode)
    const aim = await page.evaluate(() => (1e3 * window.strands.stage.hand.position.z).toFixed(2))
    await page.keyboard.press(' ')
    await until(page, (aim) => document.getElementById('hand-z').value === aim, aim)
    assert.equal(await value(page, 'mode'), mode === 'coupling' ? 'coupling' : 'pose')
  }
  // Nothing of it is left for a scene that is opened meanwhile.
  await page.keyboard.press(' ')
  await page.keyboard.press('ArrowUp')
  await openScene(page, 'ribbon')
  const opened = await hand(page)
  await done(page)
  assert.equal(await page.locator('#pause').getAttribute('aria-pressed'), 'false')
  assert.deepEqual(await hand(page), opened)
  assert.deepEqual(complaints, [])
})


test('the gizmo moves the hand, a drag elsewhere looks around, a double-click frames', async () => {
  const { page, complaints } = await fresh()
  await page.locator('#stage').focus()
  await page.keyboard.press('t')
  // The gizmo's vertical arrow stands above the thread's end.
  const [x, y] = await needle(page)
  await until(page, () => window.strands.stage.gizmo.object !== undefined)
  for (let up = 20; up < 120; up += 8) {
    await page.mouse.move(x, y - up)
    await page.evaluate(() => new Promise(requestAnimationFrame))
    if ((await page.evaluate(() => window.strands.stage.gizmo.axis)) === 'Z') break
  }
  assert.equal(await page.evaluate(() => window.strands.stage.gizmo.axis), 'Z')
  await page.mouse.down()
  await changes(page, 'hand-z', () => page.mouse.move(x, y - 110, { steps: 4 }))
  await page.mouse.up()
  await page.keyboard.press('t')
  const eye = () => page.evaluate(() => window.strands.stage.camera.position.toArray())
  const first = await eye()
  const moved = await hand(page)
  await page.mouse.move(400, 340)
  await page.mouse.down()
  await page.mouse.move(460, 330, { steps: 4 })
  await page.mouse.up()
  await until(page, (first) => window.strands.stage.camera.position.x !== first[0], first)
  await page.mouse.wheel(0, 400)
  await until(page, (first) => window.strands.stage.camera.position.length() > 1.01 * Math.hypot(...first), first)
  const away = await eye()
  await page.mouse.dblclick(400, 340)
  await until(page, (away) => window.strands.stage.camera.position.length() < Math.hypot(...away), away)
  assert.deepEqual(await hand(page), moved)
  assert.deepEqual(complaints, [])
})

test('one finger drags the hand or looks around, two fingers on the hand twist and bring nearer', async () => {
  const { page, complaints } = await openPage(context, context.address, { width: 390, height: 844 }, 'light', { hasTouch: true })
  const session = await page.context().newCDPSession(page)
  const touch = (type, ...points) =>
    session.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) })
  const [x, y] = await needle(page)
  const before = await hand(page)
  await touch('touchStart', [x, y])
  await changes(page, 'hand-z', async () => {
    for (let i = 1; i <= 4; i++) await touch('touchMove', [x - 2 * i, y - 4 * i])
  })
  const [a, b] = [x - 8, y - 16]
  await touch('touchStart', [a, b], [a - 80, b])
  // The second finger goes round the first: a twist.
  await changes(page, 'turn-z', async () => {
    for (let i = 1; i <= 5; i++) await touch('touchMove', [a, b], [a - 80 * Math.cos(0.1 * i), b - 80 * Math.sin(0.1 * i)])
  })
  // And away from it: nearer.
  await changes(page, 'hand-y', async () => {
    for (let i = 1; i <= 4; i++) await touch('touchMove', [a, b], [a - (80 + 10 * i) * Math.cos(0.5), b - (80 + 10 * i) * Math.sin(0.5)])
  })
  await touch('touchEnd')
  await page.locator('#undo').tap()
  await until(page, (x) => document.getElementById('hand-x').value === x, before[0])
  assert.deepEqual(await hand(page), before)
  const eye = await page.evaluate(() => window.strands.stage.camera.position.x)
  await touch('touchStart', [100, 600])
  for (let i = 1; i <= 4; i++) await touch('touchMove', [100 + 10 * i, 600])
  await touch('touchEnd')
  await until(page, (eye) => window.strands.stage.camera.position.x !== eye, eye)
  assert.deepEqual(await hand(page), before)
  assert.deepEqual(complaints, [])
  await page.close()
})
