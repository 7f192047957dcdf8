/** The rail of scenes, each with its picture. `npm run pictures` makes the pictures. */

/** The scene's name for a person. */
export function spoken(name: string): string {
  const words = name.replaceAll('_', ' ')
  return words.charAt(0).toUpperCase() + words.slice(1)
}

const PICTURES = import.meta.glob<string>('./thumbnails/*.webp', { eager: true, query: '?url', import: 'default' })

export interface Bundled {
  name: string
  title: string
  text: string
}

export function buildRail(rail: HTMLElement, scenes: Bundled[], open: (scene: Bundled) => void): void {
  for (const scene of scenes) {
    const button = Object.assign(document.createElement('button'), { title: `${scene.title}.` })
    button.dataset.name = scene.name
    const url = PICTURES[`./thumbnails/${scene.name}.webp`]
    if (url) button.append(Object.assign(new Image(96, 60), { src: url, alt: '' }))
    button.append(Object.assign(document.createElement('span'), { textContent: spoken(scene.name) }))
    button.addEventListener('click', () => open(scene))
    rail.append(button)
  }
}

export function markCurrent(rail: HTMLElement, name: string): void {
  for (const button of rail.querySelectorAll('button')) button.setAttribute('aria-current', String(button.dataset.name === name))
}
