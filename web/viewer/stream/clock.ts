/** Seconds since 1970, finer than Date.now() and never stepping back; equal in page and worker. */
export function now(): number {
  return (performance.timeOrigin + performance.now()) / 1000;
}
