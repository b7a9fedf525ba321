/** Returns the page's address with another session; undefined: the server's first. */
export function addressOf(page: string, session: string | undefined): string {
  const url = new URL(page);
  url.searchParams.delete('recording');
  if (session === undefined) url.searchParams.delete('session');
  else url.searchParams.set('session', session);
  return url.href;
}
