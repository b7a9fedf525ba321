import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { afterAll, beforeAll, expect, it } from 'vitest';
import { Session } from '../../web/client/index';
import { Observer } from './support/observer';
import { Server } from './support/server';
import { RecordedSocket } from './support/transcript';
import { kInTime } from './support/visits';

/** The JavaScript examples of the documents, as programs of Node. */
const server = new Server();
const sessions: Session[] = [];

beforeAll(() => server.start());

afterAll(async () => {
  for (const session of sessions) session.close();
  await server.kill();
});

/** Runs the only JavaScript example of a document. Returns the values that it logs. */
function runExample(document: string): unknown[][] {
  const path = fileURLToPath(new URL(`../../${document}`, import.meta.url));
  const [example, ...others] =
    readFileSync(path, 'utf8').match(/(?<=^```js\n).*?(?=^```)/gms) ?? [];
  expect(others).toEqual([]);
  const imported = "import { Session } from 'vat-client';";
  expect(example).toContain(imported);
  const address = new URL('/ws', server.url.replace('http', 'ws')).href;
  const program = String(example).replace(imported, '').replace('ws://127.0.0.1:8080/ws', address);
  const logged: unknown[][] = [];
  const log = (...values: unknown[]): number => logged.push(values);
  const run = new Function('Session', 'WebSocket', 'console', `${program}\nreturn session;`);
  sessions.push(run(Session, RecordedSocket, { log }) as Session);
  return logged;
}

it('the example of README.md pauses the session and sets its speed', async () => {
  const observer = await Observer.join(server.url);
  expect(await observer.nextStatus()).toMatchObject({ playing: true, speed: 1 });
  runExample('README.md');
  await expect
    .poll(() => observer.nextStatus(), kInTime)
    .toMatchObject({ playing: false, speed: 0.5 });
  await observer.request('control.play', {});
  observer.leave();
});

it('the example of the client receives frames', async () => {
  const logged = runExample('web/client/README.md');
  await expect.poll(() => logged.length, kInTime).toBeGreaterThan(10);
  const ticks = logged.map(([tick]) => tick).filter((tick) => typeof tick === 'number');
  expect(ticks.length).toBeGreaterThan(5); // the server waits for acknowledgements
  expect(ticks).toEqual([...ticks].sort((a, b) => a - b));
  expect(logged).toContainEqual([expect.arrayContaining(['pool'])]);
});
