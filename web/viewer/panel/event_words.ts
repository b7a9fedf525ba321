import type { Event, SessionDescription } from '../../client/index';
import { describeGuard } from './notices';
import type { Notice } from './notices';

/** What an event means to who uses the page; undefined where other parts of the page show it. */
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
    case 'grab.ended': // the marker is gone once the grab is
    case 'session.description': // comes as a report of its own
    case 'session.status':
    case 'session.configured':
    case 'presence.changed':
    case 'replay.ended': // the bar of the replay tells these
    case 'replay.diverged':
    case 'replay.people':
      return undefined;
  }
}
