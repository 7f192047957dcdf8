// A browser on the built page, served from 127.0.0.1, and how the tests speak to it.

import { createServer } from 'node:http'
import { readFile, mkdir } from 'node:fs/promises'
import { existsSync } from 'node:fs'
import { extname, join } from 'node:path'
import { fileURLToPath } from 'node:url'
import { chromium } from 'playwright-core'

const folder = fileURLToPath(new URL('../dist/', import.meta.url))
export const out = fileURLToPath(new URL('./out/', import.meta.url))
const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm', '.webp': 'image/webp' }
const KNOWN = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome']

/** A Chromium that draws WebGL in software. */
export function launch() {
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? KNOWN.find(existsSync),
    args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-background-networking', '--no-first-run'],
  })
}

export async function start() {
  await mkdir(out, { recursive: true })
  const server = createServer(async (request, response) => {
    const path = new URL(request.url, 'http://x').pathname
    const file = join(folder, path === '/' ? 'index.html' : path)
    try {
      const body = await readFile(file)
      response.writeHead(200, { 'content-type': TYPES[extname(file)] ?? 'application/octet-stream' }).end(body)
    } catch {
      response.writeHead(404).end()
    }
  })
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve))
  const browser = await launch()
  const address = `http://127.0.0.1:${server.address().port}/`
  return { browser, address, stop: async () => (await browser.close(), server.close()) }
}

/**
 * A page with the suture open, its hints put away; collects what the console complains about. Drawn in software, so with half as many pixels
 * each way.
 */
export async function openPage(context, address, size = { width: 800, height: 500 }, scheme = 'light', options = {}) {
  const page = await context.browser.newPage({ viewport: size, colorScheme: scheme, acceptDownloads: true, deviceScaleFactor: 0.5, ...options })
  const complaints = []
  page.on('pageerror', (error) => complaints.push(String(error)))
  page.on('console', (message) => {
    if (message.type() === 'error' && !message.text().includes('404')) complaints.push(message.text())
  })
  if (!options.hints) await page.addInitScript(() => localStorage.setItem('strands.hints-seen', 'yes'))
  await page.goto(address)
  await until(page, () => document.getElementById('badge').textContent !== 'opening')
  return { page, complaints }
}

/** One page for several tests: opening one in software takes seconds. Each begins with the suture opened anew. */
export function sharedPage(context, size) {
  let opened
  return async () => {
    if (!opened) return (opened = await openPage(context(), context().address, size))
    const { page } = opened
    await page.keyboard.press('Escape')
    await openScene(page, 'suture')
    return opened
  }
}

export const text = (page, id) => page.locator(`#${id}`).textContent()
export const value = (page, id) => page.locator(`#${id}`).inputValue()
export const until = (page, work, argument) => page.waitForFunction(work, argument, { timeout: 20000, polling: 30 })
export const badge = (page, ...wanted) => until(page, (wanted) => wanted.includes(document.getElementById('badge').textContent), wanted)

/** What the badge says in motion. */
const MOVES = ['moving', 'paused', 'slow']

/** Types a number into a field. */
export async function type(page, id, number) {
  await page.locator(`#${id}`).fill(String(number))
  await page.locator(`#${id}`).press('Enter')
}

/** Does something and waits until an element's text or value is another. */
export async function changes(page, id, work) {
  const read = () => page.locator(`#${id}`).evaluate((one) => one.value ?? one.textContent)
  const before = await read()
  await work()
  await until(page, ([id, before]) => {
    const one = document.getElementById(id)
    return (one.value ?? one.textContent) !== before
  }, [id, before])
  return read()
}

/** Waits until the solver has done what it was asked to. Of moves one may be under way and one wait. */
export async function done(page) {
  for (let i = 0; i < 3; i++) await page.evaluate(() => window.strands.solver.ask({ kind: 'csv' }))
}

/** The names of the scenes of the rail that rest by themselves: those whose rods no joints tie, and that touch nothing. */
export async function resting(page) {
  const { scenes } = await page.evaluate(() => window.strands.solver.ask({ kind: 'bundled' }))
  return scenes.filter(({ text }) => !/^(joints\b|\[\[joints\]\]|\[contact\])/m.test(text)).map(({ name }) => name)
}

/** Opens a scene of the rail, and stops it where it moves by itself. */
export async function openScene(page, name) {
  await page.locator(`#rail button[data-name=${name}]`).click()
  await done(page)
  await until(page, (name) => document.querySelector(`#rail [data-name=${name}]`).getAttribute('aria-current') === 'true', name)
  await badge(page, 'stable', 'converged', ...MOVES)
  if (await page.locator('#time-bar').isVisible()) await page.locator('#motion').click()
  await badge(page, 'stable', 'converged')
}

/** Opens a scene from its text, as a file that is chosen. */
export async function openText(page, name, text) {
  await page.locator('#file').setInputFiles({ name: `${name}.toml`, mimeType: 'text/plain', buffer: Buffer.from(text) })
  await until(page, (name) => document.getElementById('scene-name').textContent.toLowerCase() === name, name)
  await badge(page, 'stable', 'converged', ...MOVES)
}

/** Where the thread's end is on the page. */
export const needle = (page) => page.evaluate(() => window.strands.stage.handlesOnPage()[0])

/** Where the hand is: its three places and three turns as the inspector shows them. */
export const hand = (page) => page.evaluate(() => ['hand-x', 'hand-y', 'hand-z', 'turn-x', 'turn-y', 'turn-z'].map((id) => document.getElementById(id).value))
