import { App } from './app';
import { element } from './panel/elements';
import { showObstacle } from './panel/obstacle';

try {
  new App().start();
} catch (error) {
  showObstacle('This page cannot draw: it needs a browser with WebGL 2 switched on.');
  element('hint', HTMLElement).hidden = true;
  element('connection', HTMLElement).hidden = true;
  throw error;
}
