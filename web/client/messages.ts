/**
 * The control messages of protocol/PROTOCOL.md as types, which are written from its schemas. SI
 * units; vectors are [x, y, z].
 */
import { kEventNames } from './protocol';
import type { Events, Methods, ReplyError } from './protocol';

export type {
  BodyDescription,
  BodyKind as BodyKindName,
  BodyState,
  Events,
  InEffect,
  InstructionSet as InstructionSetName,
  Methods,
  ReplyError,
  Role as RoleName,
  SceneEntry,
  SceneReference,
  ServerInfoResult as ServerInfo,
  SessionDescription,
  SessionEntry,
  SessionGuard as GuardEvent,
  SessionJoinResult as JoinedAs,
  SessionStatsResult as SessionStats,
  SessionStatus,
  Vector,
  VatDescription,
} from './protocol';
export type { Body as SceneBody, Interface as SceneInterface, Scene } from './scene_format';

export const kSubprotocol = 'vat.v1';

export type MethodName = keyof Methods;
export type Params<M extends MethodName> = Methods[M]['params'];
export type Result<M extends MethodName> = Methods[M]['result'];

export type EventName = keyof Events;
export type Event = { [E in EventName]: { event: E; params: Events[E] } }[EventName];

const kNames: ReadonlySet<string> = new Set(kEventNames);

export function isEventName(name: string): name is EventName {
  return kNames.has(name);
}

/** The `data` of an error reply, of whatever kind. */
export interface ErrorData {
  kind?: ReplyError['data']['kind'];
  /** What to do. */
  hint?: string;
  /** The parameter that is at fault, a JSON pointer into the params. */
  path?: string;
  limit?: string;
  maximum?: number;
  errors?: { code: string; path: string; message: string }[];
}
