/**
 * The control messages of protocol/PROTOCOL.md as types, which are written from its schemas. SI
 * units; vectors are [x, y, z].
 */
import { kEventNames } from './protocol.js';
import type { Events, Methods, ReplyError, Role } from './protocol.js';

export type {
  BodyDescription,
  BodyKind as BodyKindName,
  BodyState,
  Diagnostics,
  Events,
  InEffect,
  InstructionSet as InstructionSetName,
  Methods,
  Participant,
  RecordedPeople,
  ReplyError,
  Role as RoleName,
  SceneEntry,
  SceneReference,
  ServerInfoResult as ServerInfo,
  SessionDescription,
  Settings as SessionSettings,
  SessionEntry,
  SessionGuard as GuardEvent,
  SessionJoinResult as JoinedAs,
  SessionStatsResult as SessionStats,
  SessionStatus,
  Vector,
  VatDescription,
} from './protocol.js';
export type {
  Body as SceneBody,
  Emitter as SceneEmitter,
  Interface as SceneInterface,
  Material as SceneMaterial,
  Scene,
  Shape as SceneShape,
} from './scene_format.js';

export const kSubprotocol = 'vat.v1';

export type MethodName = keyof Methods;
export type Params<M extends MethodName> = Methods[M]['params'];
export type Result<M extends MethodName> = Methods[M]['result'];

/** The values of particles that frames may have, each with the greatest error that it may have. */
export type Attributes = NonNullable<Params<'frames.subscribe'>['attributes']>;

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
  /** Of a request that came too soon: when to come again [s]. */
  retry_after?: number;
  errors?: { code: string; path: string; message: string }[];
  /** Of what needs more than the caller's role. */
  role?: Role | 'none';
  least_role?: Role;
  /** Of a body that another holds. */
  holder?: { participant: number; name: string };
}
