/**
 * untrusted.mjs URL: prints the reason why the client waits, at a server with an untrusted
 * certificate.
 */
import { createRequire } from 'node:module';
import { Connection } from '../../web/client/dist/index.js';

const { WebSocket } = createRequire(new URL('../../web/package.json', import.meta.url))('ws');
const connection = new Connection(
  { url: process.argv[2], socket: WebSocket },
  {
    onState: ({ name, reason }) => {
      console.log(name, reason ?? '-');
      if (name === 'waiting') setImmediate(() => connection.close());
    },
  },
);
connection.open();
