import { settingsFromText, settingsToText } from './settings';
import type { ViewSettings } from './settings';

const kKey = 'vat.view';

/** Where settings are kept between visits: localStorage, or what stands in for it. */
export type Shelf = Pick<Storage, 'getItem' | 'setItem'>;

/** The settings of this page's view; who subscribes is told of each change. */
export class SettingsStore {
  private current: ViewSettings;
  private readonly listeners: ((settings: ViewSettings) => void)[] = [];

  /** A link to this page may carry settings, as text; else they are those of the last visit. */
  constructor(
    private readonly shelf: Shelf,
    linked?: string,
  ) {
    this.current = settingsFromText(linked ?? readShelf(shelf));
  }

  get settings(): Readonly<ViewSettings> {
    return this.current;
  }

  /** For links: what differs from the defaults; empty where nothing does. */
  get text(): string {
    return settingsToText(this.current);
  }

  change(changes: Partial<ViewSettings>): void {
    this.current = { ...this.current, ...changes };
    try {
      this.shelf.setItem(kKey, this.text);
    } catch {
      // A browser that stores nothing forgets the settings with the page, as it is meant to.
    }
    for (const tell of this.listeners) tell(this.current);
  }

  /** Tells the settings now and after each change. */
  subscribe(listener: (settings: Readonly<ViewSettings>) => void): void {
    this.listeners.push(listener);
    listener(this.current);
  }
}

/** The settings that the fragment of a page's address carries as `#view=`. */
export function linkedSettings(page: string): string | undefined {
  return new URLSearchParams(new URL(page).hash.slice(1)).get('view') ?? undefined;
}

function readShelf(shelf: Shelf): string {
  try {
    return shelf.getItem(kKey) ?? '';
  } catch {
    return ''; // browsers may forbid it
  }
}
