/** A storage of texts: localStorage, sessionStorage or a substitute. */
export type Shelf = Pick<Storage, 'getItem' | 'setItem'>;

/** A storage that is always empty. */
export const kNoShelf: Shelf = { getItem: () => null, setItem: () => undefined };

/**
 * Returns a storage of the page, or kNoShelf if the browser denies access, for example in a frame of
 * another page.
 */
export function shelfOf(
  page: { readonly localStorage: Shelf; readonly sessionStorage: Shelf },
  name: 'localStorage' | 'sessionStorage',
): Shelf {
  try {
    return page[name];
  } catch {
    return kNoShelf;
  }
}
