import type { Place } from '../viewer/stream/stream';

/** The subject of a viewer: a live session, or the address of a recording. */
export type Source = { place: Place; recording: string | undefined };

/**
 * Reads the attribute `src`: a WebSocket address such as `wss://host/ws?session=s1#invite=TOKEN`, or
 * the address of a recording, relative to `page`.
 * @throws Error with a message for the author of the page.
 */
export function sourceOf(src: string, page: string): Source {
  let url: URL;
  try {
    url = new URL(src, page);
  } catch {
    throw new Error(`src: “${src}” is not an address`);
  }
  if (url.protocol === 'ws:' || url.protocol === 'wss:')
    return { place: live(url), recording: undefined };
  if (url.protocol !== 'http:' && url.protocol !== 'https:') {
    throw new Error('src: must begin with ws:, wss:, http: or https:, or be a relative address');
  }
  const place = { url: '', session: undefined, token: undefined, base: url.href };
  return { place, recording: url.href };
}

function live(url: URL): Place {
  const session = url.searchParams.get('session') ?? undefined;
  const token = new URLSearchParams(url.hash.slice(1)).get('invite') ?? undefined;
  const server = new URL(url);
  server.search = server.hash = '';
  return { url: server.href, session, token, base: server.href };
}
