/** Creates a graphics context, which starts the browser's graphics outside the page's thread. */
const context = new OffscreenCanvas(1, 1).getContext('webgl2');
context?.getExtension('WEBGL_lose_context')?.loseContext();
self.postMessage(null);
