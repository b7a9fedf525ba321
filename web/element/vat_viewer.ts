import colours from '../viewer/colours.css?inline';
import { make } from '../viewer/panel/elements';
import { poseFromText } from '../viewer/view/base/pose';
import theme from '../viewer/view/base/theme.css?inline';
import style from './element.css?inline';
import { LiveView } from './live_view';
import { sourceOf } from './source';

/** Returns a style sheet of the page for a shadow tree. */
function forHost(css: string): string {
  return css.replace(/:root(\[[^\]]*\])?/g, (_, attribute?: string) =>
    attribute === undefined ? ':host' : `:host(${attribute})`,
  );
}

/**
 * `<vat-viewer src="…">` shows a live session or a recording. The attributes:
 *
 * - `src`: see sourceOf();
 * - `controls`: the user can pull bodies, play, pause, and reset or seek;
 * - `view`, `camera`: settings of the view and the pose of the camera, as in links of the page;
 * - `label`: the name of the picture for screen readers;
 * - `data-theme`: `light` or `dark`; by default, that of the system.
 *
 * While the element is outside the window, it receives no frames.
 */
export class VatViewer extends HTMLElement {
  static readonly observedAttributes = ['src', 'controls', 'view', 'camera', 'label'];

  private readonly root = this.attachShadow({ mode: 'open' });
  private readonly words = make('p', { role: 'status', hidden: true });
  private live: LiveView | undefined;
  private isVisible = false;
  private isScheduled = false;
  private readonly visibility = new IntersectionObserver((entries) => {
    this.isVisible = entries.at(-1)!.isIntersecting;
    this.watch();
  });
  private readonly watch = (): void => this.live?.watch(this.isVisible && !document.hidden);

  constructor() {
    super();
    this.root.adoptedStyleSheets = [colours, theme, style].map((css) => {
      const sheet = new CSSStyleSheet();
      sheet.replaceSync(forHost(css));
      return sheet;
    });
  }

  /** The session or the recording. */
  get src(): string {
    return this.getAttribute('src') ?? '';
  }

  set src(src: string) {
    this.setAttribute('src', src);
  }

  connectedCallback(): void {
    this.visibility.observe(this);
    document.addEventListener('visibilitychange', this.watch);
    this.schedule();
  }

  disconnectedCallback(): void {
    this.visibility.disconnect();
    document.removeEventListener('visibilitychange', this.watch);
    this.stop();
  }

  attributeChangedCallback(): void {
    this.schedule();
  }

  /** Starts anew after all changes of attributes by the present script. */
  private schedule(): void {
    if (this.isScheduled) return;
    this.isScheduled = true;
    queueMicrotask(() => {
      this.isScheduled = false;
      this.stop();
      if (this.isConnected && this.src !== '') this.start();
    });
  }

  private start(): void {
    const canvas = make('canvas', { tabIndex: 0, role: 'img' });
    canvas.ariaLabel = this.getAttribute('label') ?? 'A particle simulation';
    const stage = make('div', { className: 'stage' }, canvas);
    this.root.replaceChildren(stage, this.words);
    this.say('Waiting for the first frame …');
    try {
      this.live = new LiveView(
        canvas,
        sourceOf(this.src, document.baseURI),
        {
          view: this.getAttribute('view') ?? '',
          pose: poseFromText(this.getAttribute('camera') ?? ''),
          hasControls: this.hasAttribute('controls'),
        },
        (words) => this.say(words),
      );
      this.root.append(this.live.controlElement);
      this.watch();
    } catch (error) {
      this.say(error instanceof Error ? error.message : String(error));
    }
  }

  private stop(): void {
    this.live?.dispose();
    this.live = undefined;
    this.root.replaceChildren();
  }

  private say(words: string | undefined): void {
    this.words.hidden = words === undefined;
    if (this.words.textContent !== (words ?? '')) this.words.textContent = words ?? '';
  }
}

customElements.define('vat-viewer', VatViewer);
