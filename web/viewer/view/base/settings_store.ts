import { settingsFromText, settingsToText } from './settings';
import type { ViewSettings } from './settings';
import type { Shelf } from './shelf';

const kKey = 'vat.view';

/** The settings of the view. Subscribers are notified of each change. */
export class SettingsStore {
  private current: ViewSettings;
  private readonly listeners: ((settings: ViewSettings) => void)[] = [];

  /** Uses the settings of the page's link, otherwise the settings of the last visit. */
  constructor(
    private readonly shelf: Shelf,
    linked?: string,
  ) {
    this.current = settingsFromText(linked ?? readShelf(shelf));
  }

  get settings(): Readonly<ViewSettings> {
    return this.current;
  }

  /** The settings that differ from the defaults, for links. */
  get text(): string {
    return settingsToText(this.current);
  }

  change(changes: Partial<ViewSettings>): void {
    this.current = { ...this.current, ...changes };
    try {
      this.shelf.setItem(kKey, this.text);
    } catch {
      // Without storage, the settings are lost with the page.
    }
    for (const tell of this.listeners) tell(this.current);
  }

  /** Notifies a listener now and after each change. */
  subscribe(listener: (settings: Readonly<ViewSettings>) => void): void {
    this.listeners.push(listener);
    listener(this.current);
  }
}

/** Returns the settings in the fragment of the page's address, `#view=`. */
export function linkedSettings(page: string): string | undefined {
  return new URLSearchParams(new URL(page).hash.slice(1)).get('view') ?? undefined;
}

function readShelf(shelf: Shelf): string {
  try {
    return shelf.getItem(kKey) ?? '';
  } catch {
    return ''; // browsers can deny access
  }
}
