import { App } from './app';
import { element } from './panel/elements';
import { showObstacle } from './panel/obstacle';

try {
  new App().start();
} catch (error) {
  showObstacle(
    'page',
    'This page needs a browser with WebGL 2. Enable it in the settings of the browser, or use another browser.',
  );
  element('connection', HTMLElement).hidden = true;
  throw error;
}
