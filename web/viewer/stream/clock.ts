/** Returns the time since 1970 [s]: finer than Date.now(), monotonic, equal in page and worker. */
export function now(): number {
  return (performance.timeOrigin + performance.now()) / 1000;
}
