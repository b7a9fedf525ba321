import type { Event, SessionDescription } from '../../client/index';
import { formatError } from './format';
import { describeGuard } from './notices';
import type { Notice } from './notices';

/** Returns an event as text; undefined if other parts of the page display it. */
export function eventInWords(
  { event, params }: Event,
  description?: SessionDescription,
): Notice | undefined {
  switch (event) {
    case 'session.guard':
      return {
        level: params.recovered ? 'warning' : 'error',
        text: describeGuard(params, description),
      };
    case 'session.device':
      return {
        level: 'warning',
        text: `The processor computes in place of the device: ${params.message} (${params.path}).`,
      };
    case 'session.closed':
      return { level: 'warning', text: `The session was closed: ${params.reason}` };
    case 'control.requested':
      return { level: 'warning', text: `${params.name} asks for control.` };
    case 'server.draining':
      return {
        level: 'warning',
        text: `The server stops within ${Math.ceil(params.seconds)} s. The page reconnects when the server runs again.`,
      };
    case 'session.diverged':
      return {
        level: 'error',
        text: `The restored session differs from its log and is paused: ${params.reason}. Reset it, or choose a scene.`,
      };
    case 'session.storage':
      return params.failing
        ? {
            level: 'error',
            text: 'The server cannot store changes of this session, and rejects them.',
          }
        : { level: 'warning', text: 'The server stores changes of this session again.' };
    case 'governor.switched':
      return {
        level: 'warning',
        text:
          params.reason === 'behind'
            ? `The server reduces the accuracy to keep up: error ${formatError(params.error)}.`
            : `The server computes more accurately again: error ${formatError(params.error)}.`,
      };
    case 'session.moved': // the page shows that it connects to the next server
    case 'grab.ended': // the marker disappears with the grab
    case 'session.description': // reported separately
    case 'session.status':
    case 'session.configured':
    case 'presence.changed':
    case 'replay.ended': // displayed in the bar of the replay
    case 'replay.diverged':
    case 'replay.people':
      return undefined;
  }
}
