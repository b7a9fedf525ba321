import type {
  Browser,
  BrowserContextOptions,
  ConsoleMessage,
  Page,
  Request,
} from 'playwright-core';
import { kDeadlineMs, launchChromium } from './chromium';
import { recordPage } from './transcript';

/** A step of one colour channel below this may come from rounding. */
const kSeenStep = 12;

/** How the browser shows the page, where that is not as usual. */
export type Look = Pick<
  BrowserContextOptions,
  'viewport' | 'colorScheme' | 'hasTouch' | 'isMobile' | 'deviceScaleFactor'
> & {
  /** Runs in the page before its own scripts. */
  prepare?: () => void;
  /** What the page hears is not all the server's own, and no transcript of it. */
  isUnrecorded?: boolean;
};

/** The page in a browser with a profile of its own, as a user sees and works it. */
export class Viewer {
  /** What the page did wrong: errors on its console, requests that failed or left its server. */
  readonly problems: string[] = [];
  /** While the server is away on purpose, connections may fail. */
  serverIsAway = false;

  private constructor(
    private readonly browser: Browser,
    readonly page: Page,
    private readonly url: string,
  ) {
    page.on('console', (message) => this.noteConsole(message));
    page.on('pageerror', (error) => this.problems.push(`uncaught ${error.message}`));
    page.on('request', (request) => this.noteRequest(request));
    page.on('requestfailed', (request) => {
      if (!this.serverIsAway) this.problems.push(`no answer for ${request.url()}`);
    });
    page.on('response', (response) => {
      if (!response.ok()) this.problems.push(`${response.status()} for ${response.url()}`);
    });
  }

  static async open(url: string, { prepare, isUnrecorded, ...look }: Look = {}): Promise<Viewer> {
    const browser = await launchChromium();
    const page = await browser.newPage({ viewport: { width: 1000, height: 640 }, ...look });
    page.setDefaultTimeout(kDeadlineMs);
    await page.addInitScript(addBrake);
    if (prepare) await page.addInitScript(prepare);
    const viewer = new Viewer(browser, page, url);
    if (!isUnrecorded) recordPage(page);
    await page.goto(url);
    return viewer;
  }

  async close(): Promise<void> {
    await this.browser.close();
  }

  /** Keeps the page from drawing, as browsers do with a tab in the background, or lets it again. */
  async brake(on: boolean): Promise<void> {
    await this.page.evaluate((value) => window.brake(value), on);
  }

  /** Waits for an element that matches; the page says its state in data attributes. */
  async until(selector: string): Promise<void> {
    await this.page.waitForSelector(selector, { state: 'attached' });
  }

  /** Waits until the picture shows a tick in this range. */
  async untilTick(least: number, most = Infinity): Promise<void> {
    await this.page.waitForFunction(
      ([low, high]) => {
        const tick = document.getElementById('view')?.dataset.tick;
        return tick !== undefined && Number(tick) >= low && Number(tick) <= high;
      },
      [least, most] as const,
    );
  }

  /** Waits for the picture of this scene. */
  async untilScene(scene: string): Promise<void> {
    await this.until(`#view[data-joined="true"][data-scene="${scene}"]`);
  }

  /** A value that the canvas says about itself. */
  async said(name: string): Promise<string | undefined> {
    return this.page.locator('#view').evaluate((view, key) => view.dataset[key], name);
  }

  /** The tick that the picture shows; waits for the first picture of a scene. */
  async tick(): Promise<number> {
    await this.until('#view[data-tick]');
    return Number(await this.said('tick'));
  }

  /** A picture of the canvas, as a data address; without the hint, which fades after a while. */
  async picture(): Promise<string> {
    await this.page.evaluate(() => {
      const hint = document.getElementById('hint');
      if (hint) hint.style.display = 'none';
    });
    const png = await this.page.locator('#view').screenshot({ timeout: kDeadlineMs });
    return `data:image/png;base64,${png.toString('base64')}`;
  }

  /** A page of no server, outside of the viewer's content policy. */
  async blankPage(): Promise<Page> {
    return this.browser.newPage();
  }

  /** How many pixels of two pictures can be told apart. */
  async difference(first: string, second: string): Promise<number> {
    const page = await this.blankPage();
    try {
      return await page.evaluate(countDifferences, [first, second, kSeenStep] as const);
    } finally {
      await page.close();
    }
  }

  /**
   * Looks for a point of the canvas under which there is a particle, from the top down, and leaves
   * the pointer there.
   */
  async findParticle(): Promise<{ x: number; y: number }> {
    const box = await this.page.locator('#view').boundingBox();
    if (!box) throw new Error('the canvas is not shown');
    for (let row = 2; row < 18; ++row) {
      for (let column = 2; column < 18; ++column) {
        const point = { x: box.x + (column * box.width) / 20, y: box.y + (row * box.height) / 20 };
        await this.page.mouse.move(point.x, point.y);
        if ((await this.said('pointer')) === 'particle') return point;
      }
    }
    throw new Error('no particle is seen');
  }

  private noteConsole(message: ConsoleMessage): void {
    if (message.type() !== 'error') return;
    if (!this.serverIsAway) this.problems.push(`console: ${message.text()}`);
  }

  private noteRequest(request: Request): void {
    const { protocol, origin } = new URL(request.url());
    const isLocal = protocol === 'blob:' || protocol === 'data:';
    if (!isLocal && origin !== new URL(this.url).origin)
      this.problems.push(`asked for ${request.url()}`);
  }
}

declare global {
  interface Window {
    brake(on: boolean): void;
  }
}

/** Runs in the browser, before the page's own scripts. */
function addBrake(): void {
  const draw = window.requestAnimationFrame.bind(window);
  const held: FrameRequestCallback[] = [];
  let isOn = false;
  window.requestAnimationFrame = (callback) => (isOn ? -held.push(callback) : draw(callback));
  window.brake = (on) => {
    isOn = on;
    if (!on) held.splice(0).forEach((callback) => draw(callback));
  };
}

/** Runs in the browser. */
async function countDifferences([first, second, step]: readonly [
  string,
  string,
  number,
]): Promise<number> {
  const pixels = await Promise.all(
    [first, second].map(async (address) => {
      const image = new Image();
      image.src = address;
      await image.decode();
      const canvas = new OffscreenCanvas(image.width, image.height);
      const context = canvas.getContext('2d');
      if (!context) throw new Error('the browser cannot draw');
      context.drawImage(image, 0, 0);
      return context.getImageData(0, 0, image.width, image.height).data;
    }),
  );
  const [a, b] = pixels;
  if (!a || !b || a.length !== b.length) throw new Error('the pictures differ in size');
  let count = 0;
  for (let i = 0; i < a.length; i += 4) {
    const isSeen = [0, 1, 2].some((channel) => Math.abs(a[i + channel]! - b[i + channel]!) >= step);
    if (isSeen) ++count;
  }
  return count;
}
