/** Returns the page's address with another session; undefined: the server's first. */
export function addressOf(page: string, session: string | undefined): string {
  const url = new URL(page);
  url.searchParams.delete('recording');
  if (session === undefined) url.searchParams.delete('session');
  else url.searchParams.set('session', session);
  return url.href;
}

/** Returns the position `#at=` in a replay or a recording; undefined without a valid one. */
export function linkedMoment(page: string): number | undefined {
  const text = new URLSearchParams(new URL(page).hash.slice(1)).get('at') ?? '';
  return /^\d{1,15}$/.test(text) ? Number(text) : undefined;
}
