// The inspector: every control changes what it says, and what is refused is said and taken back.

import assert from 'node:assert/strict'
import { after, before, test } from 'node:test'
import { badge, changes, done, hand, openScene, openText, out, sharedPage, start, text, type, until, value } from './browser.mjs'

let context
const fresh = sharedPage(() => context)
before(async () => (context = await start()))
after(async () => context.stop())

const unfold = async (page, group) => {
  const folded = page.locator('details:not([open]) > summary', { hasText: group })
  if (await folded.count()) await folded.click()
}

test('every number of the strand changes the solution, and undo takes it back', async () => {
  const { page, complaints } = await fresh()
  const numbers = { radius: 0.09, youngs: 2, poisson: 0.3, density: 1000, kappa1: 3, kappa2: 2, tau: 5, gravity: 5, length: 310 }
  for (const [id, number] of Object.entries(numbers)) await changes(page, 'energy', () => type(page, id, number))
  await changes(page, 'energy', () => page.locator('#undo').click())
  assert.equal(await value(page, 'length'), '300')
  await changes(page, 'energy', () => page.locator('#redo').click())
  assert.equal(await value(page, 'length'), '310')
  await page.locator('#kinematics').selectOption('cosserat')
  await until(page, () => document.getElementById('undo').disabled === false)
  await badge(page, 'stable')
  assert.deepEqual(complaints, [])
})

test('a scene shows the numbers that it has: of its section, of its coil', async () => {
  const { page, complaints } = await fresh()
  const shown = async () => page.locator('#strand label:visible input').evaluateAll((all) => all.map((one) => one.id))
  await openScene(page, 'telephone_cord')
  assert.ok((await shown()).includes('helix-radius'))
  assert.ok(!(await shown()).includes('kappa1'))
  await changes(page, 'energy', () => type(page, 'helix-radius', 6.1))
  await changes(page, 'energy', () => type(page, 'helix-pitch', 6.3))
  await openScene(page, 'hair_curl')
  await changes(page, 'energy', () => type(page, 'a', 0.042))
  await changes(page, 'energy', () => type(page, 'b', 0.03))
  await openScene(page, 'cantilever')
  await changes(page, 'energy', () => type(page, 'width', 0.6))
  await changes(page, 'energy', () => type(page, 'height', 20))
  assert.deepEqual(complaints, [])
})

test('the hand is put by numbers, and its modes and its spring work', async () => {
  const { page, complaints } = await fresh()
  for (const [id, number] of [['hand-x', 160], ['hand-y', 20], ['hand-z', 70], ['turn-x', -170], ['turn-y', 50], ['turn-z', -175]]) {
    await type(page, id, number)
    await done(page)
    assert.ok(Math.abs(Number(await value(page, id)) - number) < 0.1, id)
  }
  await badge(page, 'stable')
  await page.locator('#mode').selectOption('coupling')
  for (const [i, number] of [[0, 0.01], [1, 0.0001], [2, 0.02], [3, 0.000002]]) {
    await type(page, `coupling-${i}`, number)
    await done(page)
    assert.equal(Number(await value(page, `coupling-${i}`)), number)
  }
  for (const [i, number] of [[4, 2], [5, 0.01]]) {
    await type(page, `coupling-${i}`, number)
    await done(page)
    assert.equal(Number(await value(page, `coupling-${i}`)), number)
  }
  await badge(page, 'stable', 'unstable')
  await page.locator('#mode').selectOption('scene')
  await until(page, () => document.getElementById('hand-x').value === '170.00')
  await badge(page, 'stable')
  await page.locator('#mode').selectOption('free')
  await until(page, () => document.getElementById('force').textContent === '0 N')
  await badge(page, 'stable')
  // The mode is taken back too.
  await changes(page, 'mode', () => page.locator('#undo').click())
  assert.equal(await value(page, 'mode'), 'scene')
  assert.deepEqual(complaints, [])
})

test('a spring pulls up to the device’s limit and no further', async () => {
  const { page, complaints } = await fresh()
  await openScene(page, 'cantilever')
  await page.locator('#mode').selectOption('coupling')
  await type(page, 'hand-z', -120)
  await done(page)
  assert.doesNotMatch(await text(page, 'force'), /limit/)
  await type(page, 'coupling-4', 0.05)
  await type(page, 'hand-z', -100)
  await until(page, () => document.getElementById('force').textContent === '50.0 mN (limit)')
  assert.deepEqual(complaints, [])
})

const HELD = `format = 1
name = "held"
[rods.beam]
length = 0.3
elements = 40
stiffness = { bending = [1e-4, 1e-4], torsion = 1e-4 }
kinematics = "kirchhoff"
supports = [{ at = "start", fix = ["position", "orientation"] }]
[coupling.hand]
rod = "beam"
linear_stiffness = 2.34567
angular_stiffness = 0.1
`

test('a limit’s empty field is no limit, both ways, and an edit leaves the other numbers as they are', async () => {
  const { page, complaints } = await fresh()
  await openText(page, 'held', HELD)
  const snapshot = () => page.evaluate(() => window.strands.solver.ask({ kind: 'mode', mode: 'coupling' }).then((reply) => reply.coupling.map(String)))
  assert.equal(await value(page, 'coupling-4'), '')
  await type(page, 'coupling-1', 0.2)
  await done(page)
  assert.deepEqual(await snapshot(), ['2.34567', '0.2', '0', '0', 'Infinity', 'Infinity'])
  await type(page, 'coupling-4', 0.5)
  await done(page)
  assert.deepEqual(await snapshot(), ['2.34567', '0.2', '0', '0', '0.5', 'Infinity'])
  const saved = () => page.evaluate(() => window.strands.solver.ask({ kind: 'toml' }).then((reply) => reply.data))
  assert.match(await saved(), /\[coupling\.hand\][^[]*angular_stiffness = 0\.2\s[^[]*max_force = 0\.5/)
  // An edit of the scene does not take it back.
  await type(page, 'length', 310)
  await done(page)
  assert.match(await saved(), /length = 0\.31\s[^]*max_force = 0\.5/)
  await type(page, 'coupling-4', '')
  await done(page)
  assert.deepEqual(await snapshot(), ['2.34567', '0.2', '0', '0', 'Infinity', 'Infinity'])
  assert.notEqual(await page.locator('#coupling-4').getAttribute('aria-invalid'), 'true')
  await type(page, 'coupling-0', '')
  assert.equal(await page.locator('#coupling-0').getAttribute('aria-invalid'), 'true')
  await page.locator('#undo').click()
  await until(page, () => document.getElementById('coupling-4').value === '0.5')
  assert.deepEqual(complaints, [])
})

test('a number that no spring can have is refused beside its field, and the last good one holds', async () => {
  const { page, complaints } = await fresh()
  await openText(page, 'held', HELD)
  await page.locator('#mode').selectOption('coupling')
  await badge(page, 'stable', 'converged')
  await type(page, 'coupling-0', 0)
  await until(page, () => document.getElementById('coupling-0-why') !== null)
  assert.match(await text(page, 'coupling-0-why'), /must be greater than zero, but is 0/)
  assert.equal(await page.locator('#coupling-0').getAttribute('aria-describedby'), 'coupling-0-why')
  assert.equal(await value(page, 'coupling-0'), '2.346')
  const end = () => page.evaluate(() => window.strands.solver.ask({ kind: 'mode', mode: 'coupling' }).then((reply) => [...reply.shape.hand, reply.coupling[0]]))
  assert.ok((await end()).every(Number.isFinite))
  assert.equal((await end()).at(-1), 2.34567)
  await type(page, 'coupling-0', 3)
  await until(page, () => document.getElementById('coupling-0-why') === null)
  assert.equal((await end()).at(-1), 3)
  // A spring too soft to hold the thread does not take hold, and the page goes on as it was.
  await page.locator('#mode').selectOption('pose')
  await type(page, 'hand-x', 100)
  await type(page, 'hand-z', 250)
  await badge(page, 'stable', 'converged')
  await type(page, 'coupling-0', '1e-320')
  await done(page)
  await page.locator('#mode').selectOption('coupling')
  await until(page, () => document.getElementById('message').textContent.includes('too soft'))
  assert.equal(await value(page, 'mode'), 'pose')
  await page.locator('#message-close').click()
  assert.deepEqual(complaints, [])
})

test('of several rods all are drawn, and the fields are of the one in the hand', async () => {
  const { page, complaints } = await fresh()
  const still = `[rods.still]
length = 0.2
elements = 10
stiffness = { bending = [1e-4, 1e-4], torsion = 1e-4 }
kinematics = "kirchhoff"
position = [0.1, 0.0, 0.0]
supports = [{ at = "start", fix = ["position", "orientation"] }]
`
  await openText(page, 'held', HELD.replace('[rods.beam]', `${still}[rods.beam]`))
  assert.equal(await value(page, 'length'), '300')
  assert.equal(await value(page, 'elements'), '40')
  const drawn = await page.evaluate(() => {
    const { count, mesh } = window.strands.stage.tubes
    const { array } = mesh.geometry.attributes.position
    const heights = array.filter((_, i) => i % 3 === 2 && array[i - 2] > 0.08)
    return { count, low: Math.min(...heights), high: Math.max(...heights), right: Math.max(...array.filter((_, i) => i % 3 === 0)) }
  })
  assert.equal(drawn.count, 2)
  assert.ok(drawn.right < 0.12 && Math.abs(drawn.low) < 1e-6 && Math.abs(drawn.high - 0.2) < 1e-6, JSON.stringify(drawn))
  await type(page, 'length', 310)
  await done(page)
  const toml = await page.evaluate(() => window.strands.solver.ask({ kind: 'toml' }).then((reply) => reply.data))
  assert.match(toml, /\[rods\.still\]\s+length = 0\.2\s[^]*\[rods\.beam\]\s+length = 0\.31\s/)
  await page.screenshot({ path: `${out}rods.png` })
  // The other one cannot be grabbed: a drag at its end looks around.
  const [x, y] = await page.evaluate(() => {
    const { stage } = window.strands
    const at = stage.hand.position.clone().set(0.1, 0, 0.2).project(stage.camera)
    const box = stage.canvas.getBoundingClientRect()
    return [box.left + ((at.x + 1) / 2) * box.width, box.top + ((1 - at.y) / 2) * box.height]
  })
  const [before, eye] = [await hand(page), await page.evaluate(() => window.strands.stage.camera.position.x)]
  await page.mouse.move(x, y)
  await page.mouse.down()
  await page.mouse.move(x + 30, y, { steps: 3 })
  await page.mouse.up()
  await until(page, (eye) => window.strands.stage.camera.position.x !== eye, eye)
  assert.deepEqual(await hand(page), before)
  await openScene(page, 'ribbon')
  assert.equal(await page.evaluate(() => window.strands.stage.tubes.count), 1)
  assert.deepEqual(complaints, [])
})

test('gravity keeps its direction, and points down where there was none', async () => {
  const { page, complaints } = await fresh()
  const beam = HELD.replace('name = "held"', 'name = "held"\ngravity = [3.0, 0.0, -4.0]').replace('kinematics', 'mass_per_length = 1e-3\nkinematics')
  await openText(page, 'held', beam)
  assert.equal(await value(page, 'gravity'), '5')
  const gravity = async (number) => {
    await type(page, 'gravity', number)
    await done(page)
    const toml = await page.evaluate(() => window.strands.solver.ask({ kind: 'toml' }).then((reply) => reply.data))
    return toml.match(/gravity = \[([^\]]*)\]/)[1].split(',').map(Number).slice(0, 3)
  }
  assert.deepEqual((await gravity(10)).map((part) => part.toFixed(9)), ['6.000000000', '0.000000000', '-8.000000000'])
  assert.deepEqual((await gravity(0)).map(Math.abs), [0, 0, 0])
  assert.deepEqual(await gravity(2), [0, 0, -2])
  assert.deepEqual(complaints, [])
})


test('an edit that breaks off is said, and those after it are made', async () => {
  const { page, complaints } = await fresh()
  // A field of what the suture does not have: it is hidden.
  await page.evaluate(() => {
    const field = document.getElementById('helix-radius')
    field.value = '3'
    field.dispatchEvent(new Event('change'))
  })
  await until(page, () => document.getElementById('message').textContent.includes('could not be made'))
  await changes(page, 'energy', () => type(page, 'radius', 0.09))
  assert.deepEqual(complaints, [])
})


test('the solver’s controls hold, and a number that is refused is explained and goes back', async () => {
  const { page, complaints } = await fresh()
  await unfold(page, 'Solver')
  await type(page, 'elements', 80)
  await until(page, () => document.getElementById('method').textContent.includes('80 el.'))
  await page.locator('#order').selectOption('4')
  await type(page, 'tolerance', '1e-8')
  await done(page)
  await badge(page, 'stable')
  assert.equal(await value(page, 'order'), '4')
  assert.equal(Number(await value(page, 'tolerance')), 1e-8)
  await type(page, 'radius', -1)
  await until(page, () => document.getElementById('message').textContent.includes('radius'))
  assert.equal(await value(page, 'radius'), '0.085')
  await page.locator('#message-close').click()
  assert.ok(await page.locator('#message').isHidden())
  await page.locator('#radius').fill('')
  await page.locator('#radius').press('Enter')
  assert.equal(await page.locator('#radius').getAttribute('aria-invalid'), 'true')
  await page.locator('#reset').click()
  await until(page, () => document.getElementById('method').textContent.includes('200 el.'))
  assert.equal(await page.locator('#radius').getAttribute('aria-invalid'), null)
  assert.equal(await value(page, 'radius'), '0.085')
  assert.deepEqual(complaints, [])
})

test('what is being typed is not overwritten by an answer that arrives meanwhile', async () => {
  const { page, complaints } = await fresh()
  await unfold(page, 'Solver')
  await page.locator('#order').selectOption('4')
  await page.locator('#tolerance').fill('1e-8')
  await done(page)
  assert.equal(Number(await value(page, 'tolerance')), 1e-8)
  await page.locator('#tolerance').press('Enter')
  await done(page)
  const saved = await page.evaluate(() => window.strands.solver.ask({ kind: 'toml' }).then((reply) => reply.data))
  assert.match(saved, /\[solver\][^[]*order = 4/)
  assert.match(saved, /\[solver\][^[]*tolerance = (1e-8|0\.00000001)/)
  // Of two edits at once the first one's answer does not take back what the second has changed.
  const shown = await page.evaluate(async () => {
    const change = (id, text) => {
      const field = document.getElementById(id)
      field.value = text
      field.dispatchEvent(new Event('change'))
    }
    const seen = new Set()
    change('radius', '0.09')
    change('density', '1000')
    for (let i = 0; i < 3; i++) {
      await window.strands.solver.ask({ kind: 'csv' })
      seen.add(document.getElementById('density').value)
    }
    return [...seen]
  })
  assert.deepEqual(shown, ['1000'])
  assert.deepEqual(complaints, [])
})

test('where no equilibrium is found the last good shape stays, and the page says what to do', async () => {
  const { page, complaints } = await fresh()
  const shape = () => page.evaluate(() => window.strands.solver.ask({ kind: 'csv' }).then((reply) => reply.data))
  const before = await shape()
  // No number is a place that cannot be held.
  await page.evaluate(() => {
    const { stage, moveHand } = window.strands
    stage.hand.position.x = NaN
    moveHand()
  })
  await badge(page, 'failed')
  assert.match(await text(page, 'message'), /last good shape stays.*Bring the hand back.*Details.*overflowed/s)
  assert.equal(await text(page, 'live'), 'failed')
  assert.equal(await shape(), before)
  await type(page, 'hand-x', 168)
  await badge(page, 'stable')
  assert.ok(await page.locator('#message').isHidden())
  // And one that is refused.
  await unfold(page, 'Solver')
  await type(page, 'tolerance', '1e-300')
  await until(page, () => document.getElementById('message').textContent.includes('tolerance'))
  await page.keyboard.press('Escape')
  assert.ok(await page.locator('#message').isHidden())
  assert.deepEqual(complaints, [])
})

test('the view: colours, their map, range and legend, thickness, arrows and glyphs', async () => {
  const { page, complaints } = await fresh()
  await unfold(page, 'View')
  const legends = { twist: /Twist.*1\/m/, tension: /Tension.*[µn]N/, moment: /Bending moment.*N·m/, energy: /Elastic energy.*J\/m/, curvature: /Curvature.*1\/m/ }
  for (const [by, pattern] of Object.entries(legends)) {
    await page.locator('#colour').selectOption(by)
    assert.match(await text(page, 'legend'), pattern)
  }
  const bar = () => page.locator('#legend i').getAttribute('style')
  const viridis = await bar()
  await page.locator('#map').selectOption('cividis')
  assert.notEqual(await bar(), viridis)
  await page.locator('#fixed').check()
  await type(page, 'range-low', 1.5)
  await type(page, 'range-high', 50)
  assert.match(await text(page, 'legend'), /fixed range.*1\.50 1\/m.*50\.0 1\/m/)
  await page.locator('#fixed').uncheck()
  assert.doesNotMatch(await text(page, 'legend'), /fixed/)
  await type(page, 'scale', 8)
  assert.match(await text(page, 'legend'), /8× as thick/)
  assert.ok((await page.locator('.label:visible').count()) >= 3)
  assert.match((await page.locator('.label.force').first().textContent()) ?? '', /^\d[\d.]{2,3} µN$/)
  await page.locator('#arrows').uncheck()
  await until(page, () => [...document.querySelectorAll('.label')].every((label) => label.hidden))
  const picture = () => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(window.strands.stage.canvas.toDataURL())))))
  for (const id of ['directors', 'internalForce', 'internalMoment']) {
    const before = await picture()
    await page.locator(`#${id}`).check()
    assert.notEqual(await picture(), before, id)
    await page.locator(`#${id}`).uncheck()
  }
  await page.locator('#colour').selectOption('nothing')
  assert.doesNotMatch(await text(page, 'legend'), /Curvature/)
  assert.deepEqual(complaints, [])
})
