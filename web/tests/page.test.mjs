// The page around the stage: scenes, files, theme, help, small windows, and whether everybody can use it.

import assert from 'node:assert/strict'
import { readFile, writeFile } from 'node:fs/promises'
import { after, before, test } from 'node:test'
import { badge, changes, needle, openPage, openScene, out, resting, start, text, type, until, value } from './browser.mjs'

let context
before(async () => (context = await start()))
after(async () => context.stop())

test('every scene has a picture, and every one that rests opens stable, and its end can be dragged', async () => {
  const { page, complaints } = await openPage(context, context.address)
  const pictures = await page.locator('#rail img').evaluateAll((all) => all.map((image) => image.naturalWidth > 0))
  assert.deepEqual(pictures, Array(20).fill(true))
  for (const name of await resting(page)) {
    await openScene(page, name)
    const [x, y] = await needle(page)
    await page.mouse.move(x, y)
    await page.mouse.down()
    await changes(page, 'hand-z', () => page.mouse.move(x - 6, y - 6, { steps: 3 }))
    await page.mouse.up()
    assert.equal(await value(page, 'mode'), 'pose', name)
    await badge(page, 'stable')
    await page.screenshot({ path: `${out}scene_${name}.png` })
  }
  assert.deepEqual(complaints, [])
  await page.close()
})

test('scene, shape and picture are saved, a scene file is opened, a broken one explained, and the address shared', async () => {
  const { page, complaints } = await openPage(context, context.address)
  await type(page, 'hand-z', 66)
  await badge(page, 'stable')
  const saved = {}
  for (const [id, ending] of [['save-scene', '.toml'], ['save-csv', '.csv'], ['save-glb', '.glb'], ['save-png', '.png']]) {
    const download = page.waitForEvent('download')
    await page.locator(`#${id}`).click()
    saved[ending] = await (await download).path()
    assert.equal((await download).suggestedFilename(), `suture${ending}`)
  }
  await openScene(page, 'ribbon')
  const chooser = page.waitForEvent('filechooser')
  await page.locator('#load').click()
  await (await chooser).setFiles({ name: 'mine.toml', mimeType: 'text/plain', buffer: await readFile(saved['.toml']) })
  await until(page, () => document.getElementById('scene-name').textContent === 'Suture')
  assert.equal(await value(page, 'hand-z'), '66.00')
  await writeFile(`${out}broken.toml`, 'format = 1\nnmae = "x"\n')
  await page.locator('#file').setInputFiles(`${out}broken.toml`)
  await until(page, () => document.getElementById('message').textContent.includes('nmae'))
  // What was open stays open, and so does what reset goes back to.
  await page.locator('#reset').click()
  await until(page, () => document.getElementById('message').hidden)
  assert.equal(await value(page, 'hand-z'), '66.00')
  await page.locator('#share').click()
  await until(page, () => location.hash.startsWith('#scene='))
  const shared = await openPage(context, page.url())
  await badge(shared.page, 'stable')
  assert.equal(await value(shared.page, 'hand-z'), '66.00')
  await openScene(shared.page, 'ribbon')
  assert.equal(await shared.page.evaluate(() => location.hash), '')
  await page.evaluate(() => {
    const data = new DataTransfer()
    data.items.add(new File(['format = 1\n[rods]\n'], 'dropped.toml'))
    document.dispatchEvent(new DragEvent('drop', { dataTransfer: data, cancelable: true }))
  })
  await until(page, () => !document.getElementById('message').hidden)
  assert.deepEqual([...complaints, ...shared.complaints], [])
  await shared.page.close()
  await page.close()
})

test('a solver that cannot be loaded, and a browser without WebGL, are explained', async () => {
  const page = await context.browser.newPage()
  await page.route('**/*.wasm', (route) => route.abort())
  await page.goto(context.address)
  await badge(page, 'failed')
  assert.match(await text(page, 'message'), /could not be loaded.*Reload/s)
  await page.close()
  const flat = await context.browser.newPage()
  await flat.addInitScript(() => (HTMLCanvasElement.prototype.getContext = () => null))
  await flat.goto(context.address)
  await until(flat, () => document.getElementById('message').textContent.includes('WebGL'))
  await flat.close()
})

test('hints come once, the list of gestures keeps the focus and closes by Escape, and the theme changes', async () => {
  const { page, complaints } = await openPage(context, context.address, undefined, 'light', { hints: true })
  await until(page, () => !document.getElementById('hints').hidden)
  assert.equal(await page.locator('#hints li').count(), 3)
  await page.locator('#hints-close').click()
  assert.ok(await page.locator('#hints').isHidden())
  await page.reload()
  await badge(page, 'stable')
  assert.ok(await page.locator('#hints').isHidden())
  await page.keyboard.press('?')
  assert.ok(await page.locator('#gestures').isVisible())
  for (let i = 0; i < 5; i++) {
    await page.keyboard.press('Tab')
    assert.ok(await page.evaluate(() => document.activeElement === document.body || document.activeElement.closest('dialog') !== null))
  }
  await page.keyboard.press('Escape')
  assert.ok(await page.locator('#gestures').isHidden())
  await page.locator('#help').click()
  await page.getByRole('button', { name: 'Close' }).click()
  assert.ok(await page.locator('#gestures').isHidden())
  await page.locator('#theme').click()
  assert.equal(await page.locator('html').getAttribute('data-theme'), 'dark')
  await page.screenshot({ path: `${out}dark.png` })
  await page.locator('#theme').click()
  assert.equal(await page.locator('html').getAttribute('data-theme'), 'light')
  assert.deepEqual(complaints, [])
  await page.close()
})

test('on a phone every panel is a sheet, nothing covers another, and nothing is lost', async () => {
  const { page, complaints } = await openPage(context, context.address, { width: 390, height: 844 }, 'dark', { hasTouch: true })
  assert.equal(await page.locator('html').getAttribute('data-theme'), 'dark')
  const boxes = await Promise.all(['top', 'legend', 'strip', 'tabs'].map((id) => page.locator(`#${id}`).boundingBox()))
  boxes.forEach((a, i) => boxes.slice(i + 1).forEach((b) => assert.ok(a.y + a.height <= b.y || b.y + b.height <= a.y, `${JSON.stringify(a)} ${JSON.stringify(b)}`)))
  for (const box of boxes) assert.ok(box.x >= 0 && box.x + box.width <= 390)
  const sheets = { rail: '#rail button', inspector: '#inspector summary', numbers: '#newton', more: '#save-scene' }
  for (const [name, inside] of Object.entries(sheets)) {
    assert.ok(await page.locator(inside).first().isHidden(), name)
    await page.locator(`[data-sheet=${name}]`).last().tap()
    assert.ok(await page.locator(inside).first().isVisible(), name)
    assert.equal(await page.locator(`#tabs [data-sheet=${name}]`).getAttribute('aria-expanded'), 'true')
    await page.screenshot({ path: `${out}phone_${name}.png` })
  }
  await page.keyboard.press('Escape')
  assert.ok(await page.locator('#save-scene').isHidden())
  await page.locator('[data-sheet=rail]').last().tap()
  await page.locator('#rail [data-name=ribbon]').tap()
  await until(page, () => document.getElementById('scene-name').textContent === 'Ribbon')
  assert.ok(await page.locator('#rail').isHidden(), 'the sheet stays open')
  assert.deepEqual(complaints, [])
  await page.close()
})

test('every control has a name, a tooltip of one sentence and a visible focus; colours are AA in both themes', async () => {
  const { page, complaints } = await openPage(context, context.address)
  await page.locator('details').evaluateAll((all) => all.forEach((one) => (one.open = true)))
  const bad = await page.locator('button, input:not([hidden]), select').evaluateAll((all) =>
    all
      .filter((one) => {
        const label = one.closest('label')
        const name = one.textContent.trim() || label?.textContent.trim() || one.getAttribute('aria-label')
        return !name || !/\.$/.test(label?.title || one.title || '')
      })
      .map((one) => `${one.tagName} ${one.id} ${one.title}`),
  )
  assert.deepEqual(bad, [])
  assert.equal(await page.locator('#live').getAttribute('aria-live'), 'polite')
  assert.equal(await text(page, 'live'), 'stable')
  await page.locator('#undo').evaluate(() => document.body.focus())
  for (let i = 0; i < 4; i++) {
    await page.keyboard.press('Tab')
    assert.equal(await page.evaluate(() => getComputedStyle(document.activeElement).outlineStyle), 'solid')
  }
  for (const theme of ['light', 'dark']) {
    const poor = await page.evaluate((theme) => {
      document.documentElement.dataset.theme = theme
      const style = getComputedStyle(document.documentElement)
      const light = (name) => {
        const hex = style.getPropertyValue(name).trim().slice(1)
        const [r, g, b] = [0, 2, 4].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255).map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4))
        return 0.2126 * r + 0.7152 * g + 0.0722 * b
      }
      const ratio = (a, b) => (Math.max(light(a), light(b)) + 0.05) / (Math.min(light(a), light(b)) + 0.05)
      const texts = ['--ink', '--soft', '--accent', '--good', '--warn', '--bad', '--force', '--torque'].map((name) => [name, ratio(name, '--solid'), 4.5])
      return [...texts, ['--on-accent', ratio('--on-accent', '--accent'), 4.5], ['--control', ratio('--control', '--solid'), 3]].filter(([, is, least]) => is < least)
    }, theme)
    assert.deepEqual(poor, [], theme)
  }
  assert.deepEqual(complaints, [])
  await page.close()
})
