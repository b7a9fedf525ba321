/** Owns the connection and decodes frames, so that the page's thread only draws. */
import { emptyFrame, RequestError, Session } from '../../client/index';
import type { Attributes, Frame, MethodName, Params } from '../../client/index';
import { now } from './clock';
import type { Entrance, FromWorker, Refusal, ToWorker } from './wire';

/** 1/64 of the spacing; smaller errors are not visible. */
const kErrorInRadii = 1 / 32;

let session: Session | undefined;
let isWatched = true;
let attributes: Attributes = {};
const frame = emptyFrame();
const spare: ArrayBuffer[] = [];

function post(message: FromWorker, transfer: Transferable[] = []): void {
  self.postMessage(message, { transfer });
}

/** Returns whether the page's server answers HTTP. */
async function probe(): Promise<boolean> {
  try {
    return (await fetch('/healthz', { cache: 'no-store' })).ok;
  } catch {
    return false; // fetch throws if the server is unreachable
  }
}

function open(entrance: Entrance): void {
  session?.close();
  session = new Session(
    { ...entrance, socket: WebSocket, now, probe, errorInRadii: kErrorInRadii },
    {
      onState: (state) => post({ type: 'state', state }),
      onJoined: (joined) => post({ type: 'joined', joined }),
      onDescription: (description) => post({ type: 'description', description }),
      onEvent: (event) => post({ type: 'event', event }),
      onFrame: (frame, bytes) => post({ type: 'frame', frame, bytes }, [frame.storage]),
      frameFor,
      onResumeToken: (token) => post({ type: 'resume', token }),
      onClockOffset: (offset) => post({ type: 'clock', offset }),
      onFault: (message) => post({ type: 'fault', message }),
    },
  );
  session.watch(isWatched);
  session.askFor(attributes);
  session.open();
}

/** Returns a frame. The page returns its memory: see ToWorker, `reuse`. */
function frameFor(): Frame {
  // A transferred buffer is detached and must be replaced, also if the frame needs no memory.
  if (frame.storage.byteLength === 0) frame.storage = spare.pop() ?? new ArrayBuffer(0);
  return frame;
}

async function request(key: number, method: MethodName, params: object): Promise<void> {
  try {
    if (!session) throw new RequestError('disconnected', `${method}: not connected`);
    const result = await session.request(method, params as Params<typeof method>);
    post({ type: 'result', key, result });
  } catch (error) {
    if (!(error instanceof RequestError)) throw error;
    post({ type: 'refusal', key, refusal: refusalOf(error) });
  }
}

function refusalOf({ kind, message, code, data }: RequestError): Refusal {
  return { kind, message, code, data };
}

self.onmessage = ({ data }: MessageEvent<ToWorker>) => {
  switch (data.type) {
    case 'open':
      open(data);
      break;
    case 'go':
      session?.go(data.session);
      break;
    case 'request':
      void request(data.key, data.method, data.params);
      break;
    case 'acknowledge':
      session?.acknowledge(data.number);
      break;
    case 'reuse':
      spare.push(data.storage);
      break;
    case 'watch':
      isWatched = data.wanted;
      session?.watch(isWatched);
      break;
    case 'refresh':
      session?.refresh();
      break;
    case 'attributes':
      attributes = data.attributes;
      session?.askFor(attributes);
      break;
  }
};
