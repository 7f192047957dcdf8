// Renders the pictures of the rail from the built page: `npm run build && npm run thumbnails`.

import { mkdir, writeFile } from 'node:fs/promises'
import { fileURLToPath } from 'node:url'
import { openPage, start } from './browser.mjs'

const folder = fileURLToPath(new URL('../src/thumbnails/', import.meta.url))
await mkdir(folder, { recursive: true })
const context = await start()
const { page } = await openPage(context, context.address, { width: 960, height: 600 })
for (const name of await page.locator('#rail button').evaluateAll((buttons) => buttons.map((button) => button.dataset.name))) {
  await page.locator(`#rail button[data-name=${name}]`).click()
  await page.waitForFunction((name) => document.querySelector(`[data-name=${name}]`).getAttribute('aria-current') === 'true', name)
  const data = await page.evaluate(() => {
    const { stage } = window.strands
    Object.assign(stage.view, { displayScale: 2.2 * stage.view.displayScale })
    stage.setInsets({ left: 0, right: 0, top: 0, bottom: 0 })
    stage.refresh()
    stage.frameAll()
    return stage.picture(224, 120)
  })
  await writeFile(`${folder}${name}.webp`, Buffer.from(data.split(',')[1], 'base64'))
}
await context.stop()
