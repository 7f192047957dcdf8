import assert from 'node:assert/strict'
import { writeFile } from 'node:fs/promises'
import { after, before, test } from 'node:test'
import { openPage, out, start } from './browser.mjs'

let context
before(async () => (context = await start()))
after(async () => context.stop())

const text = (page, id) => page.locator(`#${id}`).textContent()
const badge = (page, wanted) =>
  page.waitForFunction((wanted) => wanted.includes(document.getElementById('badge').textContent), wanted, { timeout: 20000 })
const until = (page, work, argument) => page.waitForFunction(work, argument, { timeout: 20000 })

test('the suture opens ready to drag, follows the pointer at every frame, and is drawn', async () => {
  const { page, complaints } = await openPage(context, context.address, { width: 900, height: 600 })
  await badge(page, ['stable'])
  assert.match(await text(page, 'method'), /shooting, 200 el\./)
  await page.evaluate(() => (window.strands.times.length = 0))
  const [x, y] = await page.evaluate(() => window.strands.stage.needleOnPage())
  await page.mouse.move(x, y)
  await page.mouse.down()
  const before = await page.locator('#hand-z').inputValue()
  await page.mouse.move(x - 30, y - 25, { steps: 15 })
  await page.mouse.wheel(0, 60)
  await page.keyboard.down('Shift')
  await page.mouse.move(x - 5, y - 25, { steps: 5 })
  await page.keyboard.up('Shift')
  await page.mouse.up()
  await until(page, (before) => document.getElementById('hand-z').value !== before, before)
  // 300 frames on a closed path, one pose a display frame.
  await page.evaluate(async () => {
    const { stage, moveHand } = window.strands
    const start = stage.handPose()
    for (let i = 1; i <= 300; i++) {
      const a = (2 * Math.PI * i) / 300
      const pose = [...start]
      pose[0] -= 0.02 * (1 - Math.cos(a))
      pose[1] += 0.015 * Math.sin(2 * a)
      pose[2] += 0.02 * Math.sin(a)
      moveHand(pose)
      await new Promise(requestAnimationFrame)
    }
  })
  const times = await page.evaluate(() => [...window.strands.times].sort((a, b) => a - b))
  const p99 = times[Math.floor(0.99 * times.length)]
  console.log(`${times.length} solves of 200 elements: median ${times[times.length >> 1].toFixed(2)} ms, p99 ${p99.toFixed(2)} ms`)
  await page.screenshot({ path: `${out}suture.png` })
  assert.deepEqual(complaints, [])
  await page.close()
})

test('keys twist, move, pause and show the gizmo and the gestures', async () => {
  const { page, complaints } = await openPage(context, context.address)
  const torque = await text(page, 'torque')
  await page.locator('#stage').focus()
  for (let i = 0; i < 6; i++) await page.keyboard.press('e')
  await until(page, (torque) => document.getElementById('torque').textContent !== torque, torque)
  const z = await page.locator('#hand-z').inputValue()
  await page.keyboard.press('ArrowUp')
  await until(page, (z) => document.getElementById('hand-z').value !== z, z)
  await page.keyboard.press('w')
  await page.keyboard.press('t')
  await page.keyboard.press('r')
  await page.keyboard.press('r')
  await page.keyboard.press(' ')
  assert.equal(await page.locator('#pause').getAttribute('aria-pressed'), 'true')
  await page.waitForTimeout(300) // what was under way before the pause
  const held = await page.locator('#hand-x').inputValue()
  await page.keyboard.press('ArrowLeft')
  await page.waitForTimeout(200)
  assert.equal(await page.locator('#hand-x').inputValue(), held, 'a paused page follows the hand')
  await page.locator('#pause').click()
  await page.locator('#help').click()
  assert.ok(await page.locator('#gestures').isVisible())
  await page.getByRole('button', { name: 'Close' }).click()
  assert.deepEqual(complaints, [])
  await page.close()
})

test('every number of the inspector changes the solution, and undo takes it back', async () => {
  const { page, complaints } = await openPage(context, context.address)
  const changes = { radius: '0.09', youngs: '2', poisson: '0.3', density: '1000', kappa1: '3', kappa2: '2', tau: '5', gravity: '5', length: '310' }
  for (const [id, value] of Object.entries(changes)) {
    const before = await text(page, 'energy')
    await page.locator(`#${id}`).fill(value)
    await page.locator(`#${id}`).press('Enter')
    await until(page, (before) => document.getElementById('energy').textContent !== before, before)
  }
  const energy = await text(page, 'energy')
  await page.locator('#undo').click()
  await until(page, (energy) => document.getElementById('energy').textContent !== energy, energy)
  await page.locator('summary', { hasText: 'Solver' }).click()
  await page.locator('#elements').fill('80')
  await page.locator('#elements').press('Enter')
  await until(page, () => document.getElementById('method').textContent.includes('80 el.'))
  await page.locator('#order').selectOption('4')
  await page.locator('#kinematics').selectOption('cosserat')
  await page.locator('#tolerance').fill('1e-8')
  await page.locator('#tolerance').press('Enter')
  await page.locator('#radius').fill('-1')
  await page.locator('#radius').press('Enter')
  await until(page, () => document.getElementById('message').textContent.includes('radius'))
  await page.locator('#reset').click()
  await until(page, () => document.getElementById('method').textContent.includes('200 el.'))
  assert.deepEqual(complaints, [])
  await page.close()
})

test('a hand out of reach is told how far, and through the coupling pulls to its limit', async () => {
  const { page, complaints } = await openPage(context, context.address)
  await page.locator('#hand-x').fill('900')
  await page.locator('#hand-x').press('Enter')
  await until(page, () => document.getElementById('badge').textContent.includes('out of reach by'))
  await page.locator('#reset').click()
  await badge(page, ['stable'])
  await page.locator('#mode').selectOption('coupling')
  for (const x of [200, 230, 260, 290, 320, 400]) {
    await page.locator('#hand-x').fill(String(x))
    await page.locator('#hand-x').press('Enter')
    await page.waitForTimeout(60)
  }
  await page.locator('#coupling-4').fill('0.00001')
  await page.locator('#coupling-4').press('Enter')
  await until(page, () => document.getElementById('force').textContent.includes('limit'))
  for (const mode of ['scene', 'free']) {
    await page.locator('#mode').selectOption(mode)
    await badge(page, ['stable'])
  }
  assert.deepEqual(complaints, [])
  await page.close()
})

test('the view, the theme and every bundled scene', async () => {
  const { page, complaints } = await openPage(context, context.address)
  await page.locator('summary', { hasText: 'View' }).click()
  for (const by of ['twist', 'tension', 'moment', 'nothing', 'curvature']) await page.locator('#colour').selectOption(by)
  assert.match(await text(page, 'legend'), /Curvature.*1\/m/)
  await page.locator('#scale').fill('8')
  await page.locator('#scale').press('Enter')
  await page.locator('#arrows').uncheck()
  await page.locator('#directors').check()
  await page.locator('#theme').click()
  assert.equal(await page.locator('html').getAttribute('data-theme'), 'dark')
  for (const button of await page.locator('#rail button').all()) {
    const name = await button.textContent()
    await button.click()
    await until(page, (name) => document.getElementById('scene-name').textContent.includes(name.replaceAll(' ', '_')), name)
    await badge(page, ['stable', 'converged'])
    await page.screenshot({ path: `${out}scene_${name.replaceAll(' ', '_')}.png` })
  }
  assert.deepEqual(complaints, [])
  await page.close()
})

test('scene and shape are saved, a scene file is opened, a broken one explained, and the address shared', async () => {
  const { page, complaints } = await openPage(context, context.address)
  const saved = {}
  for (const [id, ending] of [['save-scene', '.toml'], ['save-csv', '.csv'], ['save-glb', '.glb']]) {
    const download = page.waitForEvent('download')
    await page.locator(`#${id}`).click()
    saved[ending] = await (await download).path()
    assert.ok((await download).suggestedFilename().endsWith(ending))
  }
  await page.locator('#file').setInputFiles({ name: 'mine.toml', mimeType: 'text/plain', buffer: await (await import('node:fs/promises')).readFile(saved['.toml']) })
  await badge(page, ['stable'])
  await writeFile(`${out}broken.toml`, 'format = 1\nnmae = "x"\n')
  await page.locator('#file').setInputFiles(`${out}broken.toml`)
  await until(page, () => document.getElementById('message').textContent.includes('nmae'))
  await page.locator('#share').click()
  await until(page, () => location.hash.startsWith('#scene='))
  const address = page.url()
  const shared = await openPage(context, address)
  await badge(shared.page, ['stable'])
  assert.deepEqual([...complaints, ...shared.complaints], [])
  await shared.page.close()
  await page.close()
})

test('at phone width and in the dark nothing is lost', async () => {
  const { page, complaints } = await openPage(context, context.address, { width: 390, height: 800 }, 'dark')
  assert.equal(await page.locator('html').getAttribute('data-theme'), 'dark')
  for (const id of ['rail', 'inspector', 'badge', 'force', 'help']) assert.ok(await page.locator(`#${id}`).isVisible(), id)
  const unnamed = await page.locator('button, input:not([hidden]), select').evaluateAll((all) =>
    all.filter((one) => !(one.textContent.trim() || one.labels?.length || one.getAttribute('aria-label'))).map((one) => one.outerHTML),
  )
  assert.deepEqual(unnamed, [])
  await page.screenshot({ path: `${out}phone.png` })
  assert.deepEqual(complaints, [])
  await page.close()
})
