/** On a phone, scenes, inspector, numbers and the rest of the actions are sheets that a bar of tabs opens, one at a time. */

const tabs = () => [...document.querySelectorAll<HTMLButtonElement>('#tabs button')]

export function showSheet(name: string | null): void {
  if (name) document.body.dataset.sheet = name
  else delete document.body.dataset.sheet
  for (const tab of tabs()) tab.setAttribute('aria-expanded', String(tab.dataset.sheet === name))
}

export function listenToTabs(): void {
  for (const tab of tabs()) {
    tab.addEventListener('click', () => showSheet(document.body.dataset.sheet === tab.dataset.sheet ? null : tab.dataset.sheet!))
  }
  showSheet(null)
  // A sheet is low: there the groups begin folded.
  if (innerWidth <= 720) for (const group of document.querySelectorAll('details')) group.open = false
}
