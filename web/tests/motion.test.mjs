// The scene in motion: time runs, stands still, goes by steps and back to its start; what is grabbed follows the hand and flies on.

import assert from 'node:assert/strict'
import { after, before, test } from 'node:test'
import { readFile } from 'node:fs/promises'
import { fileURLToPath } from 'node:url'
import { badge, done, openPage, openScene, openText, out, resting, sharedPage, start, text, type, until } from './browser.mjs'

let context
const FLOOR = fileURLToPath(new URL('../../examples/strands_on_a_floor.toml', import.meta.url))
const fresh = sharedPage(() => context)
before(async () => (context = await start()))
after(async () => context.stop())

/** What moves, as plain numbers. */
const state = (page) =>
  page.evaluate(() => {
    const { scenery, playing, speed } = window.strands.motion
    return scenery && { report: scenery.report, playing, speed, frames: scenery.rods.map(({ frames }) => [...frames]) }
  })

/** Opens a scene of the rail that moves by itself, and stops its time at the start. */
async function openMoving(page, name) {
  await page.locator(`#rail button[data-name=${name}]`).click()
  await until(page, (name) => document.querySelector(`#rail [data-name=${name}]`).getAttribute('aria-current') === 'true', name)
  await until(page, () => window.strands.motion.scenery !== null)
  await page.locator('#rewind').click()
  await done(page)
  return state(page)
}

const place = ({ frames }, rod, node) => frames[rod].slice(12 * node + 9, 12 * node + 12)
const apart = (a, b) => Math.hypot(...a.map((x, i) => x - b[i]))
const passes = (page, seconds) => until(page, (time) => window.strands.motion.report.time >= time, seconds)

test('a rope falls, stands still while time does, goes on by one step, and comes back to its start exactly', async () => {
  const { page, complaints } = await fresh()
  const first = await openMoving(page, 'swinging_rope')
  assert.equal(first.report.time, 0)
  assert.equal(await text(page, 'badge'), 'paused')
  assert.equal(await page.locator('#motion').getAttribute('aria-pressed'), 'true')
  await page.locator('#play').click()
  await passes(page, 0.15)
  await page.locator('#stage').focus()
  await page.keyboard.press(' ')
  await badge(page, 'paused')
  await done(page)
  const stopped = await state(page)
  const fallen = place(first, 0, 60)[2] - place(stopped, 0, 60)[2]
  assert.ok(fallen > 0.05, `its end fell by ${fallen} m`)
  await page.screenshot({ path: `${out}motion.png` })
  await page.waitForTimeout(300)
  assert.deepEqual(await state(page), stopped, 'time stands still')
  await page.keyboard.press('.')
  await done(page)
  const stepped = await state(page)
  assert.equal(stepped.report.steps, stopped.report.steps + 1)
  assert.ok(Math.abs(stepped.report.time - stopped.report.time - stepped.report.time_step) < 1e-12)
  assert.ok(apart(place(stepped, 0, 60), place(stopped, 0, 60)) > 0)
  await page.locator('#step').click()
  await done(page)
  assert.equal((await state(page)).report.steps, stopped.report.steps + 2)
  await page.keyboard.press('Home')
  await done(page)
  const again = await state(page)
  assert.deepEqual([again.frames, again.report.time, again.report.steps], [first.frames, 0, 0])
  assert.deepEqual(complaints, [])
})

test('the strip shows time, energies, the cost of a step and Newton’s iterations, and the energies add up', async () => {
  const { page, complaints } = await fresh()
  await openMoving(page, 'swinging_rope')
  await page.locator('#play').click()
  await passes(page, 0.2)
  await page.locator('#play').click()
  await done(page)
  const { report } = await state(page)
  assert.equal(await text(page, 'motion-time'), `${report.time.toFixed(3)} s`)
  for (const id of ['kinetic', 'elastic', 'load', 'dissipated']) assert.match(await text(page, `motion-${id}`), /^-?\d[\d.]* [mµn]?J$/, id)
  assert.match(await text(page, 'motion-step'), /^[\d.]+ ms, p99 [\d.]+$/)
  assert.match(await text(page, 'motion-newton'), /^\d+ it\., \d\.\de-\d+$/)
  // It began at rest, where the energy of its weight was none.
  const { kinetic, elastic, load, dissipated } = report
  const lost = -(kinetic + elastic + load + dissipated)
  assert.ok(kinetic > 0.02 && Math.abs(lost) < 0.05 * kinetic, JSON.stringify(report))
  assert.ok(await page.locator('#force').isHidden())
  assert.deepEqual(complaints, [])
})

test('a place in the middle is grabbed, dragged, and flies on when it is let go', async () => {
  const { page, complaints } = await fresh()
  const first = await openMoving(page, 'swinging_rope')
  const [x, y] = await page.evaluate(() => window.strands.stage.nodeOnPage({ rod: 0, node: 30 }))
  await page.mouse.move(x, y)
  await page.mouse.down()
  await done(page)
  const { grabbed } = (await state(page)).report
  assert.equal(grabbed.rod, 0)
  assert.ok(Math.abs(grabbed.node - 30) <= 1, JSON.stringify(grabbed))
  await page.locator('#stage').focus()
  await page.keyboard.press(' ')
  await page.mouse.move(x - 30, y - 60, { steps: 6 })
  await passes(page, 0.25)
  const dragged = await state(page)
  const [from, to] = [first, dragged].map((one) => place(one, 0, grabbed.node))
  assert.ok(to[2] - from[2] > 0.05, `dragged up from ${from} to ${to}`)
  assert.ok(place(dragged, 0, 60)[2] < to[2], 'the rest is below the hand')
  assert.ok(await page.locator('.label.force:visible').count(), 'the force of the hand is shown')
  await page.screenshot({ path: `${out}grabbed.png` })
  await page.mouse.up()
  await done(page)
  const let_go = await state(page)
  assert.equal(let_go.report.grabbed, null)
  await passes(page, let_go.report.time + 0.15)
  const flown = await state(page)
  assert.ok(apart(place(flown, 0, grabbed.node), place(let_go, 0, grabbed.node)) > 0.02, 'it swings on')
  assert.deepEqual(complaints, [])
})

test('beside the threads a drag looks around, and a pick finds the node under the pointer', async () => {
  const { page, complaints } = await fresh()
  await openMoving(page, 'swinging_rope')
  const picked = await page.evaluate(() => {
    const { stage } = window.strands
    return [0, 17, 41, 60].map((node) => stage.pick(...stage.nodeOnPage({ rod: 0, node }), 5)?.node)
  })
  picked.forEach((node, i) => assert.ok(Math.abs(node - [0, 17, 41, 60][i]) <= 1, JSON.stringify(picked)))
  const eye = () => page.evaluate(() => window.strands.stage.camera.position.x)
  const before = await eye()
  await page.mouse.move(300, 330)
  await page.mouse.down()
  await page.mouse.move(340, 330, { steps: 3 })
  await page.mouse.up()
  await until(page, (before) => window.strands.stage.camera.position.x !== before, before)
  assert.equal((await state(page)).report.grabbed, null)
  assert.deepEqual(complaints, [])
})

test('slow motion runs at the part of real time that is asked for, by button and by key', async () => {
  const { page, complaints } = await fresh()
  await openMoving(page, 'swinging_rope')
  await page.getByRole('button', { name: 'A hundredth of real time' }).click()
  assert.equal((await state(page)).speed, 0.01)
  await page.locator('#stage').focus()
  await page.keyboard.press('3')
  assert.equal((await state(page)).speed, 0.1)
  assert.equal(await page.getByRole('button', { name: 'A tenth of real time' }).getAttribute('aria-pressed'), 'true')
  const [time, wall] = await page.evaluate(async () => {
    const { motion } = window.strands
    const began = performance.now()
    motion.setPlaying(true)
    while (performance.now() - began < 1500) await new Promise(requestAnimationFrame)
    motion.setPlaying(false)
    return [motion.report.time, (performance.now() - began) / 1e3]
  })
  assert.ok(time > 0 && time <= 0.1 * wall + 2e-3, `${time} s in ${wall} s`)
  await page.keyboard.press('1')
  assert.equal((await state(page)).speed, 1)
  assert.deepEqual(complaints, [])
})

test('every scene that rests moves and rests again, and what it was at rest comes back', async () => {
  const { page, complaints } = await fresh()
  for (const name of await resting(page)) {
    await openScene(page, name)
    const csv = () => page.evaluate(() => window.strands.solver.ask({ kind: 'csv' }).then((reply) => reply.data))
    const before = await csv()
    await page.locator('#stage').focus()
    await page.keyboard.press('m')
    await until(page, () => window.strands.motion.playing)
    await passes(page, 0.01)
    assert.equal(await page.locator('#message').isHidden(), true, `${name}: ${await text(page, 'message')}`)
    await page.keyboard.press('m')
    await badge(page, 'stable', 'converged')
    assert.ok(await page.locator('#time-bar').isHidden())
    assert.equal(await csv(), before, name)
  }
  assert.deepEqual(complaints, [])
})

test('fifty hairs are drawn as one mesh; how long that takes is printed', async () => {
  const { page, complaints } = await fresh()
  const first = await openMoving(page, 'hair_tuft')
  assert.equal(first.frames.length, 50)
  assert.equal(await page.evaluate(() => window.strands.stage.tubes.count), 50)
  const times = await page.evaluate(() => {
    const { stage, motion } = window.strands
    return Array.from({ length: 60 }, () => {
      const began = performance.now()
      stage.showMoving(motion.scenery)
      return performance.now() - began
    }).sort((a, b) => a - b)
  })
  console.log(`50 hairs of 20 elements are laid in ${times[30].toFixed(2)} ms (median), ${times[58].toFixed(2)} ms (p97)`)
  await page.locator('#play').click()
  await passes(page, 0.04)
  await page.screenshot({ path: `${out}tuft.png` })
  const fallen = await state(page)
  assert.ok(place(fallen, 7, 20)[2] < place(first, 7, 20)[2])
  assert.deepEqual(complaints, [])
})

test('rods that are tied open in motion, move, and have nothing else', async () => {
  const { page, complaints } = await fresh()
  const first = await openMoving(page, 'willow')
  assert.equal(first.frames.length, 21)
  assert.ok(await page.locator('#motion').isDisabled())
  assert.equal(await page.locator('#motion').getAttribute('title'), 'Rods that are tied or touch move; they come to rest by themselves.')
  await page.locator('#stage').focus()
  await page.keyboard.press('m')
  await done(page)
  assert.ok(await page.locator('#time-bar').isVisible())
  await page.locator('#play').click()
  await passes(page, 0.4)
  await page.locator('#play').click()
  await done(page)
  const blown = await state(page)
  const top = (one) => place(one, 0, 22)
  assert.ok(top(blown)[0] > top(first)[0] + 0.01, `the wind blows its top from ${top(first)} to ${top(blown)}`)
  await page.screenshot({ path: `${out}willow.png` })
  console.log(`willow: ${blown.report.step_ms.toFixed(2)} ms for a step of ${1e3 * blown.report.time_step} ms`)
  assert.deepEqual(complaints, [])
})

test('a net hangs, and what is pulled of it comes along', async () => {
  const { page, complaints } = await fresh()
  const first = await openMoving(page, 'hanging_net')
  assert.equal(first.frames.length, 8)
  assert.ok(place(first, 1, 6)[2] < -0.01, 'its middle hangs below its corners')
  const [x, y] = await page.evaluate(() => window.strands.stage.nodeOnPage({ rod: 1, node: 6 }))
  await page.mouse.move(x, y)
  await page.mouse.down()
  await done(page)
  const { grabbed } = (await state(page)).report
  assert.ok(grabbed)
  await page.locator('#stage').focus()
  await page.keyboard.press(' ')
  await page.mouse.move(x, y - 25, { steps: 5 })
  await passes(page, 0.3)
  const lifted = await state(page)
  await page.screenshot({ path: `${out}net.png` })
  await page.mouse.up()
  const rise = (rod, node) => place(lifted, rod, node)[2] - place(first, rod, node)[2]
  assert.ok(rise(grabbed.rod, grabbed.node) > 0.01, JSON.stringify(grabbed))
  assert.ok(apart(place(lifted, 1, 4), place(lifted, 5, 4)) < 1e-6, 'the knots hold')
  assert.deepEqual(complaints, [])
})

test('a knot is pulled tight by one of its ends', async () => {
  const { page, complaints } = await fresh()
  const first = await openMoving(page, 'overhand_knot')
  const [x, y] = await page.evaluate(() => window.strands.stage.nodeOnPage({ rod: 0, node: 100 }))
  await page.mouse.move(x, y)
  await page.mouse.down()
  await done(page)
  assert.ok((await state(page)).report.grabbed)
  await page.locator('#stage').focus()
  await page.keyboard.press(' ')
  await page.mouse.move(x + 120, y, { steps: 5 })
  await passes(page, 0.4)
  const pulled = await state(page)
  await page.screenshot({ path: `${out}knot.png` })
  await page.mouse.up()
  assert.ok(place(pulled, 0, 100)[0] > place(first, 0, 100)[0] + 0.01, 'the end comes along')
  assert.ok(await page.evaluate(() => window.strands.stage.contacts.count.dots) > 2)
  assert.equal(pulled.report.failure, null)
  assert.deepEqual(complaints, [])
})

test('bodies are drawn where they are, in their shapes', async () => {
  const { page, complaints } = await fresh()
  const bodies = () =>
    page.evaluate(() => window.strands.stage.solids.group.children.map(({ geometry, position }) => ({ kind: geometry.type, radius: geometry.parameters.radius, at: position.toArray() })))
  await openMoving(page, 'spiders_ring')
  const [before] = await bodies()
  assert.deepEqual([before.kind, before.radius], ['SphereGeometry', 6e-3])
  await page.locator('#play').click()
  await passes(page, 0.1)
  await page.locator('#play').click()
  await done(page)
  const [after] = await bodies()
  assert.ok(after.at[2] < before.at[2] - 1e-4, `${before.at} ${after.at}`)
  // A spoke ends at the spider.
  const moved = await state(page)
  assert.ok(apart(moved.frames[1].slice(-3), after.at) < 0.01)
  await page.screenshot({ path: `${out}spider.png` })
  await openMoving(page, 'needle_and_thread')
  assert.equal((await bodies()).length, 1)
  await page.locator('#play').click()
  await passes(page, 0.5)
  await page.screenshot({ path: `${out}needle.png` })
  await openScene(page, 'suture')
  assert.equal((await bodies()).length, 0)
  assert.ok(await page.locator('#motion').isEnabled())
  assert.deepEqual(complaints, [])
})

test('what falls on a floor touches it: the floor and the contacts are drawn, and a box switches these off', async () => {
  const { page, complaints } = await fresh()
  const drawn = () =>
    page.evaluate(() => {
      const { contacts, obstacles } = window.strands.stage
      return { ...contacts.count, obstacles: obstacles.group.children.map(({ geometry }) => geometry.type) }
    })
  await openText(page, 'strands on a floor', await readFile(FLOOR, 'utf8'))
  await page.locator('#rewind').click()
  await done(page)
  assert.deepEqual(await drawn(), { dots: 0, rings: 0, arrows: 0, obstacles: ['PlaneGeometry'] })
  await page.locator('#play').click()
  await until(page, () => window.strands.stage.contacts.count.dots > 40)
  await page.locator('#play').click()
  await done(page)
  const touching = await drawn()
  const { contacts, count } = await page.evaluate(() => ({ contacts: [...window.strands.motion.scenery.contacts], count: window.strands.motion.scenery.contacts.length / 9 }))
  assert.equal(touching.dots, count)
  assert.ok(touching.arrows > 0 && touching.arrows <= count, JSON.stringify(touching))
  for (let i = 0; i < count; i++) assert.ok(Math.abs(Math.hypot(...contacts.slice(9 * i + 3, 9 * i + 6)) - 1) < 1e-9)
  await page.screenshot({ path: `${out}contacts.png` })
  await page.locator('summary', { hasText: 'View' }).click()
  assert.ok(await page.locator('#contacts').isChecked())
  await page.locator('#contacts').uncheck()
  assert.deepEqual(await drawn(), { dots: 0, rings: 0, arrows: 0, obstacles: ['PlaneGeometry'] })
  await page.locator('#contacts').check()
  assert.deepEqual(await drawn(), touching)
  await openScene(page, 'suture')
  assert.deepEqual(await drawn(), { dots: 0, rings: 0, arrows: 0, obstacles: [] })
  assert.ok(await page.locator('#contacts').isHidden())
  await page.locator('summary', { hasText: 'View' }).click()
  assert.deepEqual(complaints, [])
})

test('a thread is led through tissue: a ring is drawn around it at every hole, and what leads it goes along', async () => {
  const { page, complaints } = await fresh()
  await openMoving(page, 'stitch')
  const come = (time) =>
    page.evaluate(async (time) => {
      const { motion, stage } = window.strands
      while (motion.report.time < time) {
        motion.step()
        await new Promise((resolve) => setTimeout(resolve, 2))
      }
      return { ...stage.contacts.count, passages: [...motion.scenery.passages], root: [...stage.roots[0]] }
    }, time)
  assert.equal((await come(0)).rings, 0)
  // It has gone in at the top of the left edge, out at its side, and into the right edge.
  const sewn = await come(0.45)
  assert.equal(sewn.rings, 3)
  assert.equal(sewn.passages.length, 27)
  assert.ok(sewn.arrows > 0)
  const { frames } = await state(page)
  for (let i = 0; i < 3; i++) {
    const [ring, direction] = [0, 3].map((from) => sewn.passages.slice(9 * i + from, 9 * i + from + 3))
    const nearest = Math.min(...Array.from({ length: frames[0].length / 12 }, (_, node) => apart(place({ frames }, 0, node), ring)))
    assert.ok(nearest < 1.1e-3, `a ring is ${nearest} m from the nearest node`)
    assert.ok(Math.abs(Math.hypot(...direction) - 1) < 1e-9)
  }
  assert.ok(apart(sewn.root, place({ frames }, 0, 0)) < 1e-6, 'what holds the start is where that is')
  await page.screenshot({ path: `${out}stitch.png` })
  await openScene(page, 'suture')
  assert.equal(await page.evaluate(() => window.strands.stage.contacts.count.rings), 0)
  assert.deepEqual(complaints, [])
})

const SHAPES = `format = 1
name = "shapes"
[materials.soft]
youngs_modulus = 1e7
poisson_ratio = 0.4
density = 1000.0
[rods.thread]
material = "soft"
length = 0.2
elements = 20
section = { shape = "circle", radius = 1e-3 }
supports = [{ at = "start", fix = ["position", "orientation"] }]
[contact]
${[
  'shape = "sphere"\nradius = 0.01\nposition = [0.1, 0.0, 0.0]',
  'shape = "capsule"\nradius = 0.01\nlength = 0.05\nposition = [0.1, 0.1, 0.0]',
  'shape = "cylinder"\nradius = 0.01\nlength = 0.05\nposition = [-0.1, 0.0, 0.0]',
  'shape = "box"\nsize = [0.02, 0.04, 0.06]\nposition = [0.0, 0.1, 0.0]',
  'shape = "ring"\nradius = 0.02\nwire_radius = 0.005\nposition = [-0.1, 0.1, 0.0]',
  'shape = "tube"\nradius = 0.3',
].map((lines) => `[[obstacles]]\n${lines}\n`).join('')}
[dynamics]
start = "rest"
`

test('obstacles of all shapes are drawn where they are, and tubes and surfaces are seen through', async () => {
  const { page, complaints } = await fresh()
  await openText(page, 'shapes', SHAPES)
  await until(page, () => window.strands.motion.scenery !== null)
  const drawn = await page.evaluate(() =>
    window.strands.stage.obstacles.group.children.map(({ geometry, material, position }) => {
      geometry.computeBoundingBox()
      const { min, max } = geometry.boundingBox
      return { kind: geometry.type, through: material.transparent, at: position.toArray(), size: max.sub(min).toArray() }
    }),
  )
  const near = (a, b) => assert.ok(a.every((x, i) => Math.abs(x - b[i]) < 1e-4), `${a} is not ${b}`)
  assert.deepEqual(drawn.map(({ kind }) => kind), ['SphereGeometry', 'CapsuleGeometry', 'CylinderGeometry', 'BufferGeometry', 'TorusGeometry', 'CylinderGeometry'])
  assert.deepEqual(drawn.map(({ through }) => through), [false, false, false, true, false, true])
  near(drawn[1].at, [0.1, 0.1, 0])
  near(drawn[1].size, [0.02, 0.02, 0.07])
  near(drawn[2].size, [0.02, 0.02, 0.05])
  near(drawn[3].size, [0.02, 0.04, 0.06])
  near(drawn[4].at, [-0.1, 0.1, 0])
  near(drawn[4].size, [0.05, 0.05, 0.01])
  near(drawn[5].size, [0.6, 0.6, 0.23])
  await page.screenshot({ path: `${out}obstacles.png` })
  assert.deepEqual(complaints, [])
})

test('the end is grabbed and pulled by keys alone', async () => {
  const { page, complaints } = await fresh()
  const first = await openMoving(page, 'swinging_rope')
  await page.locator('#stage').focus()
  await page.keyboard.press('g')
  await done(page)
  assert.deepEqual((await state(page)).report.grabbed.node, 60)
  for (let i = 0; i < 8; i++) await page.keyboard.press('ArrowUp')
  await page.keyboard.press(' ')
  await passes(page, 0.2)
  assert.ok(place(await state(page), 0, 60)[2] > place(first, 0, 60)[2] + 0.02)
  await page.keyboard.press('g')
  await done(page)
  assert.equal((await state(page)).report.grabbed, null)
  assert.deepEqual(complaints, [])
})

test('a needle that is held stays where it is brought', async () => {
  const { page, complaints } = await fresh()
  await page.locator('#motion').click()
  await until(page, () => window.strands.motion.playing)
  const before = place(await state(page), 0, 200)
  await page.locator('#stage').focus()
  await page.keyboard.press('g')
  for (let i = 0; i < 5; i++) await page.keyboard.press('ArrowUp')
  await until(page, (z) => window.strands.motion.scenery.rods[0].frames.at(-1) > z + 0.008, before[2])
  await page.keyboard.press('g')
  await done(page)
  const let_go = await state(page)
  await passes(page, let_go.report.time + 0.02)
  const held = await state(page)
  assert.ok(apart(place(held, 0, 200), place(let_go, 0, 200)) < 1e-4)
  await passes(page, held.report.time + 0.02)
  assert.deepEqual(place(await state(page), 0, 200), place(held, 0, 200))
  assert.deepEqual(complaints, [])
})

const ROPE = `format = 1
name = "rope"
gravity = [0.0, 0.0, -9.81]
[materials.soft]
youngs_modulus = 1e7
poisson_ratio = 0.4
density = 1000.0
[rods.rope]
material = "soft"
length = 0.5
elements = 20
section = { shape = "circle", radius = 2e-3 }
kinematics = "kirchhoff"
orientation = [0.70710678118654752, 0.0, 0.70710678118654752, 0.0]
supports = [{ at = "start", fix = ["position", "orientation"] }]
`

test('an edit lets it begin anew with what was changed, and undo takes it back', async () => {
  const { page, complaints } = await fresh()
  await openText(page, 'rope', ROPE)
  await page.locator('#motion').click()
  await until(page, () => window.strands.motion.scenery !== null)
  await page.locator('#motion-group > summary').click()
  await page.locator('#starts').selectOption('rest')
  await type(page, 'time-step', 2)
  await until(page, () => window.strands.motion.report?.time_step === 2e-3)
  await type(page, 'damping', 30)
  await done(page)
  await until(page, () => window.strands.motion.report?.dissipated > 0)
  const toml = await page.evaluate(() => window.strands.solver.ask({ kind: 'toml' }).then((reply) => reply.data))
  assert.match(toml, /damping = 0\.03/)
  assert.match(toml, /\[dynamics\]\s+time_step = 0\.002\s+start = "rest"/)
  for (let i = 0; i < 2; i++) await page.locator('#undo').click()
  await until(page, () => window.strands.motion.report?.time_step === 1e-3)
  assert.deepEqual(complaints, [])
})

test('what cannot move is said, and the scene rests as before', async () => {
  const { page, complaints } = await fresh()
  await openText(page, 'rope', ROPE.replace('material = "soft"', 'stiffness = { bending = [1e-4, 1e-4], torsion = 1e-4 }').replace(/section.*\n/, '').replace(/gravity.*\n/, ''))
  await page.locator('#motion').click()
  await until(page, () => document.getElementById('message').textContent.includes('mass'))
  assert.ok(await page.locator('#time-bar').isHidden())
  await badge(page, 'stable', 'converged')
  await page.locator('#message-close').click()
  assert.deepEqual(complaints, [])
})

test('a step that cannot be made is said, time stands still, and all stays as it was', async () => {
  const { page, complaints } = await fresh()
  // A rope that does not stretch is pulled to twice its length.
  const pulled = '{ at = "end", fix = ["position"], motion = [{ t = 0.0, position = [0.5, 0.0, 0.0] }, { t = 0.01, position = [1.0, 0.0, 0.0] }] }]'
  await openText(page, 'rope', `${ROPE.replace(/\}\]\n$/, `}, ${pulled}\n`)}[dynamics]\nstart = "rest"\n`)
  await page.locator('#rewind').click()
  await done(page)
  const before = await state(page)
  await page.locator('#step').click()
  await badge(page, 'failed')
  assert.match(await text(page, 'message'), /stays as it was.*Details.*(was not solved|led nowhere)/s)
  assert.equal((await state(page)).playing, false)
  assert.deepEqual((await state(page)).frames, before.frames)
  await page.locator('#rewind').click()
  await badge(page, 'paused')
  assert.ok(await page.locator('#message').isHidden())
  assert.deepEqual((await state(page)).frames, before.frames)
  assert.deepEqual(complaints, [])
})

test('on a phone the bar of time covers nothing, and a finger grabs', async () => {
  const { page, complaints } = await openPage(context, context.address, { width: 390, height: 844 }, 'light', { hasTouch: true })
  await page.locator('[data-sheet=rail]').last().tap()
  await page.locator('#rail [data-name=swinging_rope]').tap()
  await until(page, () => window.strands.motion.scenery !== null)
  await page.locator('#rewind').tap()
  await done(page)
  const boxes = await Promise.all(['top', 'legend', 'time-bar', 'strip', 'tabs'].map((id) => page.locator(`#${id}`).boundingBox()))
  boxes.forEach((a, i) => boxes.slice(i + 1).forEach((b) => assert.ok(a.y + a.height <= b.y || b.y + b.height <= a.y, `${JSON.stringify(a)} ${JSON.stringify(b)}`)))
  for (const box of boxes) assert.ok(box.x >= 0 && box.x + box.width <= 390, JSON.stringify(box))
  const session = await page.context().newCDPSession(page)
  const touch = (type, ...points) => session.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) })
  const [x, y] = await page.evaluate(() => window.strands.stage.nodeOnPage({ rod: 0, node: 40 }))
  await touch('touchStart', [x, y])
  await done(page)
  assert.ok((await state(page)).report.grabbed)
  await touch('touchEnd')
  await done(page)
  assert.equal((await state(page)).report.grabbed, null)
  await page.screenshot({ path: `${out}phone_motion.png` })
  assert.deepEqual(complaints, [])
  await page.close()
})
