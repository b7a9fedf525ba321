/** The page's element with this id, which index.html must have. */
export function element<T extends HTMLElement>(id: string, type: new () => T): T {
  const found = document.getElementById(id);
  if (!(found instanceof type)) throw new Error(`index.html has no ${type.name} #${id}`);
  return found;
}

/** A button that keeps no focus after a click, so that the space bar still plays and pauses. */
export function onPress(button: HTMLButtonElement, action: () => void): void {
  button.addEventListener('click', ({ detail }) => {
    if (detail > 0) button.blur(); // detail is 0 for a click made by the keyboard
    action();
  });
}
