import { element } from './elements';

/** Reasons why the scene cannot be shown, the most severe first. */
const kCauses = ['page', 'graphics', 'server'] as const;

export type Cause = (typeof kCauses)[number];

const told = new Map<Cause, string>();

/** Shows the reason in the middle of the scene; `undefined` removes the reason. */
export function showObstacle(cause: Cause, text: string | undefined): void {
  if (text === undefined) told.delete(cause);
  else told.set(cause, text);
  const words = kCauses.map((one) => told.get(one)).find((one) => one !== undefined);
  const obstacle = element('obstacle', HTMLElement);
  if (obstacle.textContent !== (words ?? '')) obstacle.textContent = words ?? '';
  obstacle.hidden = words === undefined;
}

/** Handles the loss of the graphics context, for example when the machine sleeps. */
export function watchGraphics(canvas: HTMLCanvasElement, redraw: () => void): void {
  canvas.addEventListener('webglcontextlost', () =>
    showObstacle(
      'graphics',
      'The browser has stopped the graphics. They continue when the browser allows it. Otherwise reload the page.',
    ),
  );
  canvas.addEventListener('webglcontextrestored', () => {
    showObstacle('graphics', undefined);
    redraw();
  });
}
