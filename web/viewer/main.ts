import { App } from './app';
import { element } from './panel/elements';

try {
  new App().start();
} catch (error) {
  element('hint', HTMLElement).textContent =
    'This page cannot draw: it needs a browser with WebGL 2 switched on.';
  throw error;
}
