/** The inspector's controls: each a label, a unit and a sentence, in one row. */

function row(parent: HTMLElement, label: string, unit: string, help: string, control: HTMLElement): HTMLLabelElement {
  const line = document.createElement('label')
  line.title = help
  const text = Object.assign(document.createElement('span'), { textContent: label })
  const of = Object.assign(document.createElement('span'), { textContent: unit, className: 'unit' })
  line.append(text, control, of)
  parent.append(line)
  return line
}

/** A field for a number. `empty` is the number that an empty field stands for; without one it must not be empty. */
export function numberInput(
  parent: HTMLElement, id: string, label: string, unit: string, help: string, change: (value: number) => void, empty?: number,
): HTMLInputElement {
  const input = Object.assign(document.createElement('input'), { id, type: 'number', step: 'any', autocomplete: 'off' })
  const line = row(parent, label, unit, help, input)
  input.addEventListener('input', () => (input.dataset.typing = 'yes'))
  input.addEventListener('blur', () => delete input.dataset.typing)
  input.addEventListener('change', () => {
    delete input.dataset.typing
    // What is no number at all reads back as empty too.
    const isEmpty = input.value === '' && !input.validity.badInput
    const value = isEmpty && empty !== undefined ? empty : input.valueAsNumber
    const good = !Number.isNaN(value)
    line.classList.toggle('bad', !good)
    input.setAttribute('aria-invalid', String(!good))
    if (good) change(value)
  })
  return input
}

/** A slider; its number, as `text` says it, stands beside it. */
export function slider(
  parent: HTMLElement, id: string, label: string, help: string, [min, max, step]: [number, number, number], text: (value: number) => string, change: (value: number) => void,
): HTMLInputElement {
  const input = Object.assign(document.createElement('input'), { id, type: 'range', min: String(min), max: String(max), step: String(step) })
  const line = row(parent, label, '', help, input)
  const show = () => (line.querySelector('.unit')!.textContent = input.ariaValueText = text(input.valueAsNumber))
  input.addEventListener('input', () => {
    show()
    change(input.valueAsNumber)
  })
  input.addEventListener('shown', show)
  return input
}

/** Puts a slider where a number is. */
export function slide(input: HTMLInputElement, value: number): void {
  input.value = String(value)
  input.dispatchEvent(new Event('shown'))
}

export function choice<Value extends string>(
  parent: HTMLElement, id: string, label: string, help: string, options: [Value, string][], change: (value: Value) => void,
): HTMLSelectElement {
  const select = Object.assign(document.createElement('select'), { id })
  for (const [value, text] of options) select.append(new Option(text, value))
  select.addEventListener('change', () => change(select.value as Value))
  row(parent, label, '', help, select).classList.add('wide')
  return select
}

export function checkbox(parent: HTMLElement, id: string, label: string, help: string, checked: boolean, change: (value: boolean) => void): HTMLInputElement {
  const input = Object.assign(document.createElement('input'), { id, type: 'checkbox', checked })
  input.addEventListener('change', () => change(input.checked))
  row(parent, label, '', help, input).classList.add('tick')
  return input
}

/** Writes a number where nobody is typing, and takes back that it was bad. */
export function write(input: HTMLInputElement, text: string): void {
  if (input.dataset.typing) return
  input.value = text
  accept(input)
}

/** Says below a field why what was typed there does not hold. */
export function refuse(input: HTMLInputElement, why: string): void {
  accept(input)
  const note = Object.assign(document.createElement('p'), { id: `${input.id}-why`, className: 'why', textContent: why })
  note.setAttribute('role', 'alert')
  input.closest('label')!.after(note)
  input.setAttribute('aria-describedby', note.id)
}

function accept(input: HTMLInputElement): void {
  input.removeAttribute('aria-invalid')
  input.closest('label')?.classList.remove('bad')
  if (!input.hasAttribute('aria-describedby')) return
  input.removeAttribute('aria-describedby')
  document.getElementById(`${input.id}-why`)?.remove()
}
