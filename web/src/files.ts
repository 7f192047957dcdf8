/** Files that come and go: scenes that are opened, dropped or shared by an address, and what is saved. */

export function download(name: string, data: string | Uint8Array | Blob): void {
  const link = document.createElement('a')
  link.href = URL.createObjectURL(data instanceof Blob ? data : new Blob([data as BlobPart]))
  link.download = name
  link.click()
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000)
}

/** Puts a scene into the page's address, and the address into the clipboard where that is allowed. */
export async function share(text: string): Promise<void> {
  location.hash = `scene=${encodeURIComponent(text)}`
  await navigator.clipboard?.writeText(location.href).catch(() => undefined)
}

/** Takes a shared scene out of the address, so that a reload does not bring it back after another one has been opened. */
export function forgetShared(): void {
  if (location.hash) window.history.replaceState(null, '', location.pathname + location.search)
}

/** A scene from the address, else from the server; nothing where there is neither. */
export async function givenScene(): Promise<{ text: string; name: string } | null> {
  const shared = new URLSearchParams(location.hash.slice(1).replaceAll('+', '%2B')).get('scene')
  if (shared) return { text: shared, name: 'shared.toml' }
  for (const name of ['scene.toml', 'scene.json']) {
    const served = await fetch(name).catch(() => null)
    const type = served?.headers.get('content-type') ?? ''
    if (served?.ok && !type.includes('html')) return { text: await served.text(), name }
  }
  return null
}

/** Opens what is chosen with the file dialog or dropped on the page. */
export function listenToFiles(input: HTMLInputElement, open: (text: string, name: string) => void): void {
  const take = async (file?: File) => file && open(await file.text(), file.name)
  input.addEventListener('change', async () => {
    await take(input.files?.[0])
    // The same file may be chosen again after it was edited.
    input.value = ''
  })
  document.addEventListener('dragover', (event) => event.preventDefault())
  document.addEventListener('drop', (event) => {
    event.preventDefault()
    void take(event.dataTransfer?.files[0])
  })
}
