const kShelf = 'vat.scene_keys';

/** The keys with which this browser can replace or delete its saved scenes. */
export class SceneKeys {
  private keys = read();

  of(scene: string): string | undefined {
    return this.keys[scene];
  }

  put(scene: string, key: string): void {
    this.write({ ...this.keys, [scene]: key });
  }

  forget(scene: string): void {
    this.write(Object.fromEntries(Object.entries(this.keys).filter(([name]) => name !== scene)));
  }

  private write(keys: Readonly<Record<string, string>>): void {
    this.keys = keys;
    try {
      localStorage.setItem(kShelf, JSON.stringify(keys));
    } catch {
      // Without storage, the keys are lost with the page.
    }
  }
}

function read(): Readonly<Record<string, string>> {
  try {
    const found: unknown = JSON.parse(localStorage.getItem(kShelf) ?? '{}');
    if (typeof found !== 'object' || found === null) return {};
    return Object.fromEntries(
      Object.entries(found).filter((pair): pair is [string, string] => typeof pair[1] === 'string'),
    );
  } catch {
    return {}; // not written by this page
  }
}
