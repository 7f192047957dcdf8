// Renders the pictures of the rail and of the README from the built page: `npm run build && npm run pictures`, or of some scenes alone:
// `npm run pictures -- whip hair_tuft`.

import { mkdir, writeFile } from 'node:fs/promises'
import { fileURLToPath } from 'node:url'
import { done, openPage, start } from './browser.mjs'

const folder = fileURLToPath(new URL('../src/thumbnails/', import.meta.url))
const readme = fileURLToPath(new URL('../../docs/page.png', import.meta.url))

/** When a scene that moves has its picture taken, s: soon, but for what takes its time. */
const MOMENT = 0.32
const LATER = { twisted_cord: 6, rope_pile: 0.5, stitch: 3.2 }

async function thumbnails(context, wanted) {
  await mkdir(folder, { recursive: true })
  const { page } = await openPage(context, context.address, { width: 960, height: 600 }, 'light', { deviceScaleFactor: 1 })
  const names = await page.locator('#rail button').evaluateAll((buttons) => buttons.map((button) => button.dataset.name))
  for (const name of names.filter((name) => wanted.length === 0 || wanted.includes(name))) {
    await page.locator(`#rail button[data-name=${name}]`).click()
    await page.waitForFunction((name) => document.querySelector(`[data-name=${name}]`).getAttribute('aria-current') === 'true', name)
    await done(page)
    const data = await page.evaluate(async (moment) => {
      const { stage, motion } = window.strands
      if (motion.scenery) {
        motion.rewind()
        do {
          motion.step()
          await new Promise((resolve) => setTimeout(resolve, 5))
        } while (motion.report.time < moment)
      }
      const thicker = stage.tubes.count > 1 ? 1 : 2.2
      Object.assign(stage.view, { displayScale: thicker * stage.view.displayScale })
      stage.setInsets({ left: 0, right: 0, top: 0, bottom: 0 })
      stage.refresh()
      stage.frameAll()
      return stage.picture(224, 120)
    }, LATER[name] ?? MOMENT)
    await writeFile(`${folder}${name}.webp`, Buffer.from(data.split(',')[1], 'base64'))
  }
  await page.close()
}

/** The suture dragged nearer and up, and twisted by most of a turn. */
async function page(context) {
  const { page } = await openPage(context, context.address, { width: 1120, height: 700 }, 'light', { deviceScaleFactor: 1 })
  await page.evaluate(async () => {
    const { stage, solver } = window.strands
    const from = stage.hand.position.clone()
    for (let i = 1; i <= 60; i++) {
      stage.hand.position.set(from.x - 0.001 * i, from.y, from.z + 0.0005 * i)
      stage.hand.twist(5 / 60)
      await solver.move(stage.hand.pose())
      await new Promise(requestAnimationFrame)
    }
    const [around, above] = [0.1, 0.36]
    stage.camera.position.set(Math.sin(around) * Math.cos(above), -Math.cos(around) * Math.cos(above), Math.sin(above)).add(stage.orbit.target)
    stage.orbit.update()
    stage.frameAll()
  })
  await done(page)
  // Until the count of frames is that of a page at rest.
  await page.waitForTimeout(2500)
  await page.screenshot({ path: readme })
  await page.close()
}

const wanted = process.argv.slice(2)
const context = await start()
await thumbnails(context, wanted)
if (wanted.length === 0) await page(context)
await context.stop()
