import type { RequestError } from '../../client/index';

/** The maximum number of displayed errors of a list. */
const kMostFaults = 3;

/**
 * The advice for users by the error's kind. The server's hints address developers of clients. Other
 * kinds need no advice.
 */
const kAdvice: Readonly<Record<string, string>> = {
  disconnected: 'Try again once the page is connected.',
  internal_error: 'The server has failed. Nothing was changed. Inform the operator of the server.',
  limit_reached: 'Reduce the request, or remove bodies or saved items, and try again.',
  no_such_body: 'It may have been removed.',
  no_such_scene: 'Choose another one.',
  no_such_session: 'The session may have ended.',
  not_authenticated: 'Open your invitation link, or ask for a new one.',
  not_recovered:
    'Wait while the session is recovering. If it is lost, inform the operator of the server.',
  storage_failed:
    'Nothing was changed. Free space on the server’s disk, or inform its operator, and try again.',
  timed_out: 'The server is busy, or the connection is slow. Try again.',
};

/** Returns the error as text, with advice. */
export function describeError(error: RequestError): string {
  const { kind, data } = error;
  const list = (data?.errors ?? [])
    .slice(0, kMostFaults)
    .map((fault) => `${fault.path}: ${fault.message}`);
  const first = capital(whatHappened(error));
  const parts = list.length > 1 ? [first, ...list] : [first];
  const advice = adviceFor(error) ?? kAdvice[kind];
  return sentence(parts.join('; ')) + (advice === undefined ? '' : ` ${advice}`);
}

/** Returns whether the error requires a higher role, which viewers can request. */
export function needsControl({ kind, data }: RequestError): boolean {
  return kind === 'not_allowed' && data?.role === 'viewer' && data.least_role === 'controller';
}

/** Returns the message without the method, which users do not know. */
function whatHappened(error: RequestError): string {
  const { kind, message, data } = error;
  if (kind === 'method_not_found') {
    return `This server is older than the page and does not support this: ${message}`;
  }
  if (kind === 'timed_out') return 'The server did not answer';
  if (needsControl(error)) return 'Viewers cannot do this. Only controllers can';
  if (kind === 'not_allowed' && data?.least_role !== undefined) {
    return `This needs the role ${data.least_role}`;
  }
  return message;
}

function adviceFor({ kind, data }: RequestError): string | undefined {
  if (kind === 'busy' && data?.holder !== undefined) {
    return `Wait until ${data.holder.name} releases it, or use another body.`;
  }
  if (kind === 'rate_limited' && data?.retry_after !== undefined) {
    return `Too many requests. Try again in ${Math.max(1, Math.ceil(data.retry_after))} s.`;
  }
  return undefined;
}

/** Returns the error as text for display next to its field, without the field's path. */
export function describeFault(error: RequestError): string {
  const faults = (error.data?.errors ?? []).slice(0, kMostFaults).map(({ message }) => message);
  return faults.length > 0 ? sentence(capital(faults.join('; '))) : describeError(error);
}

function sentence(text: string): string {
  return text.replace(/([^.!?])$/, '$1.');
}

function capital(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
