import { App } from './app';
import { element } from './panel/elements';
import { showObstacle } from './panel/obstacle';

try {
  new App().start();
} catch (error) {
  showObstacle(
    'page',
    'This page cannot draw: it needs a browser with WebGL 2 switched on. Switch it on in the browser’s settings, or open the page in another browser.',
  );
  element('connection', HTMLElement).hidden = true;
  throw error;
}
