import { defineConfig } from 'vite'

// Relative paths: the page works from any folder of any static server.
export default defineConfig({
  base: './',
  worker: { format: 'es' },
  build: { target: 'es2022', chunkSizeWarningLimit: 900 },
})
