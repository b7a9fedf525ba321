import type { Page } from 'playwright-core';

declare global {
  interface Window {
    /** Sets the page's clock forward by `time` [ms]. */
    skip(time: number): void;
  }
}

/** Makes the page's clock advance by `skip`. */
export async function controlClock(page: Page): Promise<void> {
  await page.addInitScript(() => {
    const now = performance.now.bind(performance);
    let ahead = 0;
    performance.now = () => now() + ahead;
    window.skip = (time) => (ahead += time);
  });
}
