import { Connection, RequestError } from '../client/index';
import './vat_viewer';
import type { VatViewer } from './vat_viewer';

/** The server: `?server=` of the page's address, or the default of `./vat serve`. */
const server = new URLSearchParams(location.search).get('server') ?? 'ws://127.0.0.1:8080/ws';

/** Returns the id of the article's session with this scene, which it creates if necessary. */
async function sessionOf(connection: Connection, scene: string): Promise<string> {
  const name = `article: ${scene}`;
  const { sessions } = await connection.request('session.list', {});
  const known = sessions.find((session) => session.name === name && session.state === 'running');
  return known?.session ?? (await connection.request('session.create', { name, scene })).session;
}

async function start(connection: Connection): Promise<void> {
  for (const viewer of document.querySelectorAll<VatViewer>('vat-viewer[data-scene]')) {
    viewer.src = `${server}?session=${await sessionOf(connection, viewer.dataset.scene!)}`;
  }
  connection.close();
}

function tell(words: string): void {
  const problem = document.getElementById('problem')!;
  problem.hidden = false;
  problem.textContent = words;
}

const connection: Connection = new Connection(
  { url: server, socket: WebSocket },
  {
    onState: (state) => {
      if (state.name === 'open') {
        start(connection).catch((error: unknown) => {
          if (!(error instanceof RequestError)) throw error;
          tell(`The server rejects the sessions of the article: ${error.message}.`);
        });
      }
      if (state.name === 'waiting') {
        tell(`No server at ${server}. Start it with ./vat serve --allow-origin ${location.origin}`);
      }
    },
  },
);
connection.open();
