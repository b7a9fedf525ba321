import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import type { Viewer } from './viewer';

const kAxe = readFileSync(
  fileURLToPath(new URL('../../../web/node_modules/axe-core/axe.min.js', import.meta.url)),
  'utf8',
);

/** Returns the serious faults that axe finds in the page. */
export async function faults({ page }: Viewer): Promise<string[]> {
  await page.evaluate(kAxe);
  return page.evaluate(async () => {
    interface Found {
      violations: { id: string; impact: string; nodes: { html: string }[] }[];
    }
    const { axe } = window as unknown as { axe: { run(): Promise<Found> } };
    const { violations } = await axe.run();
    return violations
      .filter(({ impact }) => impact === 'serious' || impact === 'critical')
      .flatMap(({ id, nodes }) => nodes.map(({ html }) => `${id}: ${html}`));
  });
}

/** Returns words that are truncated or extend beyond the page. */
export async function cutOff({ page }: Viewer): Promise<string[]> {
  return page.evaluate(() => {
    const isShown = (element: Element): boolean =>
      element.checkVisibility({ visibilityProperty: true }) && element.clientWidth > 0;
    return [...document.querySelectorAll('body *')]
      .filter((element) => isShown(element) && !element.closest('select, #cursors, svg'))
      .filter((element) => {
        const hasWords = [...element.childNodes].some(
          ({ nodeType, textContent }) => nodeType === Node.TEXT_NODE && textContent?.trim(),
        );
        if (!hasWords) return false;
        const range = document.createRange();
        range.selectNodeContents(element);
        const words = range.getBoundingClientRect();
        const frame = element.closest('dialog, #panel, #stage')?.getBoundingClientRect();
        return (
          frame !== undefined && (words.right > frame.right + 1 || words.left < frame.left - 1)
        );
      })
      .map((element) => element.outerHTML.slice(0, 200));
  });
}
