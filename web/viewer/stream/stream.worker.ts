/** Owns the connection and decodes frames, so that the page's thread only draws. */
import { emptyFrame, FrameRecording, RequestError, Session } from '../../client/index';
import type {
  Attributes,
  Event,
  Frame,
  MethodName,
  Params,
  SessionDescription,
} from '../../client/index';
import { now } from './clock';
import { RecordedSession } from './recorded_session';
import { download, sourceOf } from './recording_file';
import type { Entrance, FromWorker, Refusal, ToWorker } from './wire';

/** 1/64 of the spacing; smaller errors are not visible. */
const kErrorInRadii = 1 / 32;
/** More particles would take the server longer than a frame; see `vat bench codec`. */
const kMostParticles = 200_000;

let session: Session | undefined;
/** The recording that is shown in place of a session. */
let recorded: RecordedSession | undefined;
let isWatched = true;
let attributes: Attributes = {};
const frame = emptyFrame();
const spare: ArrayBuffer[] = [];

function post(message: FromWorker, transfer: Transferable[] = []): void {
  self.postMessage(message, { transfer });
}

/** Returns whether the server of this WebSocket address answers HTTP. */
async function probe(url: string): Promise<boolean> {
  const address = new URL('/healthz', url.replace(/^ws/, 'http'));
  try {
    return (await fetch(address, { cache: 'no-store' })).ok;
  } catch {
    return false; // fetch throws if the server is unreachable
  }
}

function open(entrance: Entrance): void {
  close();
  session = new Session(
    {
      ...entrance,
      socket: WebSocket,
      now,
      probe: () => probe(entrance.url),
      errorInRadii: kErrorInRadii,
      mostParticles: kMostParticles,
    },
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

function close(): void {
  session?.close();
  recorded?.close();
  session = recorded = undefined;
}

async function play(file: Blob | string, page: string): Promise<void> {
  let recording: FrameRecording;
  try {
    const blob = typeof file === 'string' ? await download(file, page) : file;
    recording = await FrameRecording.open(sourceOf(blob));
  } catch (error) {
    post({ type: 'unreadable', message: error instanceof Error ? error.message : String(error) });
    return;
  }
  close();
  const handlers = {
    onDescription: (description: SessionDescription) => post({ type: 'description', description }),
    onEvent: (event: Event) => post({ type: 'event', event }),
    onFrame: (frame: Frame, bytes: number) =>
      post({ type: 'frame', frame, bytes }, [frame.storage]),
    frameFor,
    onFault: (message: string) => post({ type: 'unreadable', message }),
  };
  recorded = new RecordedSession(recording, handlers, now);
  post({ type: 'recorded' });
  recorded.start();
  if (!isWatched) recorded.watch(false);
}

/** Returns a frame. The page returns its memory: see ToWorker, `reuse`. */
function frameFor(): Frame {
  // A transferred buffer is detached and must be replaced, also if the frame needs no memory.
  if (frame.storage.byteLength === 0) frame.storage = spare.pop() ?? new ArrayBuffer(0);
  return frame;
}

async function request(key: number, method: MethodName, params: object): Promise<void> {
  try {
    const target = recorded ?? session;
    if (!target) throw new RequestError('disconnected', `${method}: not connected`);
    const result = await target.request(method, params as Params<typeof method>);
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
      recorded?.acknowledge(data.number);
      break;
    case 'play':
      void play(data.file, data.page);
      break;
    case 'loop':
      recorded?.loop(data.wanted);
      break;
    case 'reuse':
      spare.push(data.storage);
      break;
    case 'watch':
      isWatched = data.wanted;
      session?.watch(isWatched);
      recorded?.watch(isWatched);
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
