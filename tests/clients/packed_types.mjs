// Compiles a TypeScript program that uses the package of `npm pack`, with each module resolution of
// TypeScript.
import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

const web = fileURLToPath(new URL('../../web/', import.meta.url));
const kProgram = `
import { RequestError, Session } from 'vat-client';
import type { BodyState, Event, Frame, Result } from 'vat-client';

declare const socket: ConstructorParameters<typeof Session>[0]['socket'];
const session = new Session(
  { url: 'ws://127.0.0.1:8080/ws', socket, now: () => 0 },
  {
    onFrame: (frame: Frame) => session.acknowledge(frame.header.number),
    onEvent: (event: Event) => event.event === 'session.status' && event.params.tick,
  },
);
export async function first(): Promise<BodyState | undefined> {
  const result: Result<'state.query'> = await session.request('state.query', { bodies: [1] });
  return result.bodies[0];
}
// @ts-expect-error there is no such method
void session.request('no.method', {}).catch((error: unknown) => error instanceof RequestError);
`;

const folder = mkdtempSync(join(tmpdir(), 'vat-client-'));
try {
  const installed = join(folder, 'node_modules', 'vat-client');
  mkdirSync(installed, { recursive: true });
  execFileSync('npm', ['pack', '--silent', '--pack-destination', folder], { cwd: join(web, 'client') });
  const [archive] = readdirSync(folder).filter((name) => name.endsWith('.tgz'));
  execFileSync('tar', ['-xzf', join(folder, archive), '-C', installed, '--strip-components', '1']);
  writeFileSync(join(folder, 'package.json'), '{"type": "module"}');
  writeFileSync(join(folder, 'program.ts'), kProgram);
  for (const [module, resolution] of [
    ['nodenext', 'nodenext'], // also that of node16
    ['esnext', 'bundler'],
  ]) {
    const flags = ['--strict', '--noEmit', '--target', 'es2022', '--lib', 'es2022,dom'];
    flags.push('--skipDefaultLibCheck'); // only the types of the package are checked
    const found = ['--module', module, '--moduleResolution', resolution];
    const tsc = join(web, 'node_modules', 'typescript', 'bin', 'tsc');
    execFileSync('node', [tsc, ...flags, ...found, 'program.ts'], { cwd: folder, stdio: 'inherit' });
    console.log(`${resolution}: its types are found`);
  }
} finally {
  rmSync(folder, { recursive: true });
}
