/**
 * Types of the control messages of protocol/PROTOCOL.md, generated from its schemas. Units are SI;
 * vectors are [x, y, z].
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
  MaterialDescription,
  Methods,
  Participant,
  RecordedPeople,
  ReplyError,
  Role as RoleName,
  Level,
  SceneEntry,
  SceneLevelsResult,
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
  Appearance,
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

/** Optional attributes of particles in frames, each with its maximum error. */
export type Attributes = NonNullable<Params<'frames.subscribe'>['attributes']>;

export type EventName = keyof Events;
export type Event = { [E in EventName]: { event: E; params: Events[E] } }[EventName];

const kNames: ReadonlySet<string> = new Set(kEventNames);

export function isEventName(name: string): name is EventName {
  return kNames.has(name);
}

/** The `data` of an error reply. */
export interface ErrorData {
  kind?: ReplyError['data']['kind'];
  /** The action that resolves the error. */
  hint?: string;
  /** JSON pointer to the invalid parameter. */
  path?: string;
  limit?: string;
  maximum?: number;
  /** The URL of the node with the session, if the session has moved. */
  url?: string;
  /** For rate-limited requests: the delay until a retry can succeed [s]. */
  retry_after?: number;
  errors?: { code: string; path: string; message: string }[];
  /** The required role, if the caller's role is insufficient. */
  role?: Role | 'none';
  least_role?: Role;
  /** The participant who holds the body. */
  holder?: { participant: number; name: string };
}
