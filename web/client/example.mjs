/**
 * example.mjs URL: shows a body that falls for half a second, in the server's first session. Node
 * has a WebSocket since version 22. Earlier versions use the package ws.
 */
import { BodyKind, Session } from 'vat-client';

const WebSocket = globalThis.WebSocket ?? (await import('ws')).WebSocket;
const frames = [];
let newFrame = () => undefined;
let joined;
const description = new Promise((resolve) => (joined = resolve));

const session = new Session(
  { url: process.argv[2], socket: WebSocket, now: () => Date.now() / 1000 },
  {
    onDescription: (newest) => joined(newest),
    onFrame: (frame) => {
      session.acknowledge(frame.header.number);
      frames.push(frame);
      newFrame();
    },
    onFault: (message) => console.error(message),
  },
);

/** Returns the first frame of this tick. Discards earlier frames. */
async function frameOf(tick) {
  for (;;) {
    const frame = frames.shift();
    if (frame?.header.tick === tick) return frame;
    if (!frame) await new Promise((resolve) => (newFrame = resolve));
  }
}

session.open();
const { bodies } = await description;
console.log('bodies:', bodies.map(({ name }) => name).join(', '));
await session.request('control.pause', {});
await session.request('control.reset', {});
await session.request('world.set_gravity', { gravity: [0, 0, -9.81] });
const { tick } = await session.request('control.step', { ticks: 5 });

const frame = await frameOf(tick);
const [ball] = (await session.request('state.query', { bodies: ['ball'] })).bodies;
const shown = frame.blocks.find(({ kind }) => kind === BodyKind.rigid);
const difference = Math.hypot(...shown.position.map((x, i) => x - ball.center_of_mass[i]));
console.log(`tick ${tick}: the ball is at ${shown.position[2].toFixed(2)} m`);
console.log('frame and state agree to a millimetre:', difference < 0.001);
await session
  .request('world.remove_body', { body: 99 })
  .catch((error) => console.log(`${error.kind}: ${error.data.hint}`));
session.close();
