import { readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { constants, gzipSync } from 'node:zlib';
import { build } from 'vite';
import type { Plugin } from 'vite';

/** Includes workers in the program, because a page on a disk cannot load other files. */
export function inlineWorkers(): Plugin {
  const creation = /new Worker\(\s*new URL\('([^']+)', import\.meta\.url\),\s*\{[^}]*\}\s*\)/g;
  return {
    name: 'inline-workers',
    enforce: 'pre',
    transform(code, id) {
      if (!id.endsWith('.ts') || !creation.test(code)) return undefined;
      const imports: string[] = [];
      const replaced = code.replace(creation, (_, path: string) => {
        imports.push(`import InlineWorker${imports.length} from '${path}?worker&inline';`);
        return `new InlineWorker${imports.length - 1}()`;
      });
      return { code: `${imports.join('\n')}\n${replaced}`, map: null };
    },
  };
}

/** Writes the page into which `vat export` inserts a program and a recording. */
export function exportPage(folder: string, loader: string): Plugin {
  return {
    name: 'export-page',
    apply: 'build',
    async closeBundle() {
      const names = readdirSync(folder);
      const read = (extension: string): string =>
        names
          .filter((name) => name.endsWith(extension))
          .map((name) => readFileSync(join(folder, name), 'utf8'))
          .join('\n');
      const program = `${styleScript(read('.css'))}\n${read('.js')}`;
      for (const name of names) rmSync(join(folder, name), { recursive: true });
      const level = constants.Z_BEST_COMPRESSION;
      writeFileSync(join(folder, 'player.js.gz'), gzipSync(program, { level }));
      writeFileSync(join(folder, 'page.html'), pageWith(await builtLoader(loader)));
    },
  };
}

function styleScript(css: string): string {
  const text = JSON.stringify(css);
  return `document.head.append(Object.assign(document.createElement('style'),{textContent:${text}}));`;
}

async function builtLoader(entry: string): Promise<string> {
  const built = await build({
    configFile: false,
    logLevel: 'error',
    build: {
      target: 'es2022',
      write: false,
      lib: { entry, formats: ['iife'], name: 'vatLoader', fileName: 'loader' },
    },
  });
  const [output] = [built].flat();
  if (!output || !('output' in output)) throw new Error('the loader was not built');
  return output.output[0].code;
}

/**
 * Returns the page. Its encoding maps each byte to one character. Everything after `<plaintext>` is
 * text, up to the end of the file. `vat export` replaces the names between `@`.
 */
export function pageWith(loader: string): string {
  const isPlain = [...loader].every((character) => character < '\x80');
  if (!isPlain || loader.includes('</script')) throw new Error('the loader cannot be included');
  return [
    '<!doctype html>',
    '<html lang="en">',
    '<head>',
    '<meta charset="windows-1252">',
    '<meta name="viewport" content="width=device-width, initial-scale=1">',
    '<meta name="color-scheme" content="light dark">',
    '<link rel="icon" href="data:,">',
    '<title>@TITLE@</title>',
    '<style>html,body{height:100%;margin:0}[hidden]{display:none}</style>',
    '<script type="application/json" id="vat-parts">@PARTS@</script>',
    `<script>${loader.trim()}</script>`,
    '</head>',
    '<body>',
    '<main>',
    '<div id="stage">',
    '<canvas id="view" tabindex="0" role="img" aria-label="The recorded bodies. Arrow keys turn the view, plus and minus zoom"></canvas>',
    '<div id="cursors" aria-hidden="true"></div>',
    '<p id="obstacle" class="obstacle" role="alert" hidden></p>',
    '<noscript><p class="obstacle">This page needs JavaScript.</p></noscript>',
    '</div>',
    '<section id="replay" aria-label="Recording" hidden></section>',
    '</main>',
    '<plaintext id="vat-data" hidden>',
  ].join('\n');
}
