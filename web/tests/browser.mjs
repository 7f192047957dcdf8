// A browser on the built page, served from 127.0.0.1.

import { createServer } from 'node:http'
import { readFile, mkdir } from 'node:fs/promises'
import { existsSync } from 'node:fs'
import { extname, join } from 'node:path'
import { fileURLToPath } from 'node:url'
import { chromium } from 'playwright-core'

const folder = fileURLToPath(new URL('../dist/', import.meta.url))
export const out = fileURLToPath(new URL('./out/', import.meta.url))
const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm' }
const KNOWN = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome']

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
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? KNOWN.find(existsSync),
    args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-background-networking', '--no-first-run'],
  })
  const address = `http://127.0.0.1:${server.address().port}/`
  return { browser, address, stop: async () => (await browser.close(), server.close()) }
}

/** A page with the suture open; collects what the console complains about. */
export async function openPage(context, address, size = { width: 1000, height: 640 }, scheme = 'light') {
  const page = await context.browser.newPage({ viewport: size, colorScheme: scheme, acceptDownloads: true })
  const complaints = []
  page.on('pageerror', (error) => complaints.push(String(error)))
  page.on('console', (message) => {
    if (message.type() === 'error' && !message.text().includes('404')) complaints.push(message.text())
  })
  await page.goto(address)
  await page.waitForFunction(() => !['opening'].includes(document.getElementById('badge').textContent), null, { timeout: 30000 })
  return { page, complaints }
}
