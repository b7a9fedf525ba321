/** Returns the element of index.html with this id. */
export function element<T extends HTMLElement>(id: string, type: new () => T): T {
  const found = document.getElementById(id);
  if (!(found instanceof type)) throw new Error(`index.html has no ${type.name} #${id}`);
  return found;
}

/** Adds an action. A click removes the button's focus, so that the space bar plays and pauses. */
export function onPress(button: HTMLButtonElement, action: () => void): void {
  button.addEventListener('click', ({ detail }) => {
    if (detail > 0) button.blur(); // detail is 0 for clicks by keyboard
    action();
  });
}

/** Creates an element with properties and content. */
export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  properties: Partial<HTMLElementTagNameMap[K]> = {},
  ...content: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...content);
  return made;
}

/** Creates a button with this text; see `onPress`. */
export function makeButton(text: string, action: () => void, label?: string): HTMLButtonElement {
  const made = make('button', { type: 'button', ...(label && { ariaLabel: label }) }, text);
  onPress(made, action);
  return made;
}
