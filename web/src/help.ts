/** The list of gestures, and the three hints of the first visit. */

const SEEN = 'strands.hints-seen'

const dialog = () => document.getElementById('gestures') as HTMLDialogElement

/** A modal dialog keeps the focus inside and closes by Escape. */
export function showGestures(): void {
  if (!dialog().open) dialog().showModal()
}

export function listenToHelp(): void {
  // A click beside the list closes it too.
  dialog().addEventListener('click', (event) => {
    if (event.target === dialog()) dialog().close()
  })
}

/** Shows the hints if they have never been seen, until they are dismissed. Where nothing can be remembered they come each time. */
export function showHints(): void {
  const hints = document.getElementById('hints')!
  const remembered = () => {
    try {
      return localStorage.getItem(SEEN) !== null
    } catch {
      return false
    }
  }
  hints.hidden = remembered()
}

export function dismissHints(): void {
  const hints = document.getElementById('hints')!
  if (hints.hidden) return
  hints.hidden = true
  try {
    localStorage.setItem(SEEN, 'yes')
  } catch {
    // Private windows may refuse: then the hints come again.
  }
}
