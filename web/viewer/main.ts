import { App } from './app';
import { element } from './panel/elements';
import { showObstacle } from './panel/obstacle';

/** Starts the browser's graphics. The page's thread would wait for it up to half a second. */
async function startGraphics(): Promise<void> {
  const worker = new Worker(new URL('./view/graphics.worker.ts', import.meta.url), {
    type: 'module',
  });
  await new Promise((resolve) => {
    worker.onmessage = worker.onerror = resolve;
  });
  worker.terminate();
}

async function start(): Promise<void> {
  try {
    await startGraphics();
    new App().start();
  } catch (error) {
    showObstacle(
      'page',
      'This page needs a browser with WebGL 2. Enable it in the settings of the browser, or use another browser.',
    );
    element('connection', HTMLElement).hidden = true;
    throw error;
  }
}

void start();
