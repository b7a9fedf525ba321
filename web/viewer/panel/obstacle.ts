import { element } from './elements';

/** Says in the middle of the scene why nothing can be drawn there; `undefined`: it can. */
export function showObstacle(text: string | undefined): void {
  const obstacle = element('obstacle', HTMLElement);
  obstacle.textContent = text ?? '';
  obstacle.hidden = text === undefined;
}
