// What a sweep and a warm search of 100 elements cost in the browser, and how many times as much as without one: `npm run bench`.

import { execFileSync } from 'node:child_process'
import { readFile } from 'node:fs/promises'
import { fileURLToPath } from 'node:url'
import { launch } from './browser.mjs'

const module = (name) => readFile(fileURLToPath(new URL(`../src/wasm/${name}`, import.meta.url)))

const browser = await launch()
const page = await browser.newPage()
await page.route('**/*', async (route) => {
  const name = new URL(route.request().url()).pathname.slice(1)
  const contentType = name.endsWith('.js') ? 'text/javascript' : name.endsWith('.wasm') ? 'application/wasm' : 'text/html'
  await route.fulfill({ contentType, body: name ? await module(name) : '<title>bench</title>' })
})
await page.goto('http://bench.localhost/')
const here = await page.evaluate(async () => {
  const strands = await import('/strands_wasm.js')
  await strands.default('/strands_wasm_bg.wasm')
  const time = (sweeps, solves) => {
    const start = performance.now()
    const converged = strands.bench(100, sweeps, solves)
    if (converged !== solves) throw new Error(`${converged} of ${solves} searches converged`)
    return performance.now() - start
  }
  const [sweeps, solves] = [1000, 200]
  const best = { sweep: Infinity, search: Infinity }
  for (let round = 0; round < 30; round++) {
    const none = time(0, 0)
    best.sweep = Math.min(best.sweep, (1000 * (time(sweeps, 0) - none)) / sweeps)
    best.search = Math.min(best.search, (1000 * (time(0, solves) - none)) / solves)
  }
  return best
})
await browser.close()

const command = ['run', '--quiet', '--release', '--package', 'strands-wasm', '--example', 'native']
const native = JSON.parse(execFileSync('cargo', command, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'inherit'] }))
for (const name of ['sweep', 'search']) {
  const ratio = here[name] / native[name]
  console.log(`${name}: ${here[name].toFixed(2)} µs in the browser, ${native[name].toFixed(2)} µs without, ${ratio.toFixed(2)} times`)
}
