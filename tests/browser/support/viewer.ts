import type {
  Browser,
  BrowserContextOptions,
  ConsoleMessage,
  Page,
  Request,
} from 'playwright-core';
import { kDeadlineMs, kTestFlags, launchChromium } from './chromium';
import { recordPage } from './transcript';

/** Smaller differences of a colour channel may result from rounding. */
const kSeenStep = 12;

/** Display settings of the browser. */
export type Look = Pick<
  BrowserContextOptions,
  'viewport' | 'colorScheme' | 'hasTouch' | 'isMobile' | 'deviceScaleFactor'
> & {
  /** Runs before the page is loaded. */
  before?: (page: Page) => Promise<unknown>;
  /** Shows the panel as a bar, as at the first visit. By default, the panel is beside the picture. */
  hasBar?: boolean;
  /** Omits the transcript, because not all messages are the server's. */
  isUnrecorded?: boolean;
};

/** A blank page per browser, outside the viewer's content policy. */
const blankPages = new WeakMap<Browser, Promise<Page>>();

/** The viewer's page with a separate profile, as a user sees and operates it. */
export class Viewer {
  /** Faults of the page: console errors, failed requests, and requests to other hosts. */
  readonly problems: string[] = [];
  /** Permits failed connections while a test has stopped the server. */
  serverIsAway = false;

  private constructor(
    readonly page: Page,
    private readonly url: string,
    private readonly browser: Browser,
    private readonly ownsBrowser: boolean,
  ) {
    page.setDefaultTimeout(kDeadlineMs);
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

  /** Opens the page in `shared`, or in a new browser that ends with the page. */
  static async open(
    url: string,
    { before, isUnrecorded, hasBar, ...look }: Look = {},
    shared?: Browser,
  ): Promise<Viewer> {
    const browser = shared ?? (await launchChromium(kTestFlags));
    const page = await browser.newPage({ viewport: { width: 1000, height: 640 }, ...look });
    const viewer = new Viewer(page, url, browser, shared === undefined);
    await page.addInitScript(addBrake);
    if (!hasBar) await page.addInitScript(extendPanel);
    await before?.(page);
    if (!isUnrecorded) recordPage(page);
    await page.goto(url);
    return viewer;
  }

  async close(): Promise<void> {
    if (this.ownsBrowser) await this.browser.close();
    else await this.page.context().close();
  }

  /** Stops the page from drawing, as browsers do with background tabs, or resumes it. */
  async brake(on: boolean): Promise<void> {
    await this.page.evaluate((value) => window.brake(value), on);
  }

  /** Sets these view settings, in the form of links, and resets the others to their defaults. */
  async setView(view: string): Promise<void> {
    await this.page.evaluate(changeView, view);
  }

  /** Waits for a matching element. The page publishes its state in data attributes. */
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

  /** Waits for the picture of this scene, and for the part of the page that draws solids. */
  async untilScene(scene: string): Promise<void> {
    await this.until(`#view[data-joined="true"][data-solids][data-scene="${scene}"]`);
  }

  /** Returns a data attribute of the canvas. */
  async said(name: string): Promise<string | undefined> {
    return this.page.locator('#view').evaluate((view, key) => view.dataset[key], name);
  }

  /** Returns the tick of the picture. Waits for the first picture of a scene. */
  async tick(): Promise<number> {
    await this.until('#view[data-tick]');
    return Number(await this.said('tick'));
  }

  /**
   * Returns a picture of the canvas as a data URL, without the hint and other participants'
   * pointers.
   */
  async picture(): Promise<string> {
    await this.page.evaluate(() => {
      for (const id of ['hint', 'cursors']) document.getElementById(id)!.style.display = 'none';
    });
    // It waits for a frame of the page. Screenshots by the browser's own protocol are faster, but
    // can contain an earlier frame.
    const png = await this.page.locator('#view').screenshot({ timeout: kDeadlineMs });
    await this.page.evaluate(() =>
      document.getElementById('cursors')!.style.removeProperty('display'),
    );
    return `data:image/png;base64,${png.toString('base64')}`;
  }

  /** Returns a picture of the canvas after two successive pictures are equal. */
  async stillPicture(): Promise<string> {
    for (let last = ''; ;) {
      // A moving picture can have a lower resolution.
      await this.page.waitForFunction(
        () => !(Number(document.querySelector('canvas')?.dataset.scale) < 1),
      );
      const picture = await this.picture();
      // A picture that waits for shaders is not drawn, and the previous one remains.
      await this.until('#view[data-warm="true"]');
      if (picture === last) return picture;
      last = picture;
    }
  }

  /** Returns a page without a server. It stays open for later uses. */
  blankPage(): Promise<Page> {
    const { browser } = this;
    const page = blankPages.get(browser) ?? browser.newPage();
    blankPages.set(browser, page);
    return page;
  }

  /** Returns the number of pixels that differ visibly between two pictures. */
  async difference(first: string, second: string): Promise<number> {
    const page = await this.blankPage();
    return page.evaluate(countDifferences, [first, second, kSeenStep] as const);
  }

  /** Moves the pointer to a particle, the first in a search from the top. */
  async findParticle(): Promise<{ x: number; y: number }> {
    await this.until('#view[data-tick]');
    const point = await this.page.evaluate(searchParticle);
    if (!point) throw new Error('no particle is seen');
    await this.page.mouse.move(point.x, point.y);
    return point;
  }

  /** Clicks a particle until its values are shown. A slow click would be a pull. */
  async clickParticle(): Promise<string> {
    const { x, y } = await this.findParticle();
    const card = this.page.locator('#inspector');
    do await this.page.mouse.click(x, y);
    while (!(await card.isVisible()));
    return (await card.textContent()) ?? '';
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

/** Runs in the browser: the panel is extended, unless the page has stored another choice. */
function extendPanel(): void {
  if (!localStorage.getItem('vat.panel')) localStorage.setItem('vat.panel', 'open');
}

/**
 * Runs in the browser, before the page's own scripts. The page draws at most 15 times per second.
 * Otherwise, pages whose picture is not the subject would use the processors' time.
 */
function addBrake(): void {
  const kPeriodMs = 60;
  const next = window.requestAnimationFrame.bind(window);
  let last = 0;
  const draw = (callback: FrameRequestCallback): number =>
    next((time) => {
      if (time !== last && time - last < kPeriodMs) return void draw(callback);
      last = time;
      callback(time);
    });
  const held: FrameRequestCallback[] = [];
  let isOn = false;
  window.requestAnimationFrame = (callback) => (isOn ? -held.push(callback) : draw(callback));
  window.brake = (on) => {
    isOn = on;
    if (!on) held.splice(0).forEach((callback) => draw(callback));
  };
}

/** Runs in the browser. */
function searchParticle(): { x: number; y: number } | undefined {
  const view = document.getElementById('view') as HTMLCanvasElement;
  const box = view.getBoundingClientRect();
  for (let row = 2; row < 18; ++row) {
    for (let column = 2; column < 18; ++column) {
      const clientX = box.x + (column * box.width) / 20;
      const clientY = box.y + (row * box.height) / 20;
      view.dispatchEvent(
        new PointerEvent('pointermove', { clientX, clientY, pointerType: 'mouse' }),
      );
      if (view.dataset.pointer === 'particle') return { x: clientX, y: clientY };
    }
  }
  return undefined;
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

/** Runs in the browser. */
function changeView(view: string): void {
  // The slow orbit of an idle page would change pictures on a slow machine.
  const given = new Map(
    `orbit:off,${view}`.split(',').map((part) => part.split(':') as [string, string]),
  );
  const options = document.getElementById('view-options')!;
  for (const control of options.querySelectorAll<HTMLInputElement | HTMLSelectElement>(
    'input, select',
  )) {
    const value = given.get(control.id.replace('view-', ''));
    if (control instanceof HTMLSelectElement) control.value = value ?? control.options[0]!.value;
    else if (control.type === 'checkbox') control.checked = value === 'true';
    else control.value = value ?? (control.type === 'range' ? '0.5' : '');
    control.dispatchEvent(new Event(control.type === 'range' ? 'input' : 'change'));
  }
}
