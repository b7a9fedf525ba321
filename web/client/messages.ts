/** The control messages of protocol/PROTOCOL.md as types. SI units; vectors are [x, y, z]. */

export type Vector = [number, number, number];

export const kSubprotocol = 'vat.v1';

/** Hashes can be compared where it is the same. */
export type InstructionSetName = 'baseline' | 'avx2' | 'avx512';

export type BodyKindName = 'liquid' | 'deformable' | 'rigid';

/** Each may do what those before it may. */
export type RoleName = 'viewer' | 'controller' | 'owner';

/** A scene of the catalogue by its name, or a scene object as in a scene file. */
export type SceneReference = string | Record<string, unknown>;

export interface BodyDescription {
  /** Id, for the life of the session. */
  body: number;
  name: string;
  kind: BodyKindName;
  material: string;
  /** When the epoch began; emitters and drains change it, and the frames' blocks tell. */
  particles: number;
  radius: number;
  /** Rigid bodies: particles about the centre of mass in body axes, 3 numbers each. */
  local_positions?: number[];
}

export interface VatDescription {
  min: Vector;
  max: Vector;
  lid: boolean;
}

export interface SessionDescription {
  session: string;
  /** Frames of the same epoch belong to this description. */
  epoch: number;
  tick: number;
  name: string;
  scene: string;
  title: string;
  playing: boolean;
  speed: number;
  tick_seconds: number;
  gravity: Vector;
  vat: VatDescription | null;
  /** In the order of a frame's blocks. */
  bodies: BodyDescription[];
}

export interface SessionStatus {
  tick: number;
  time: number;
  playing: boolean;
  speed: number;
  /** Achieved simulated seconds per second. */
  real_time_factor: number;
  clients: number;
  particles: number;
}

export interface GuardEvent {
  tick: number;
  cause: 'non_finite' | 'outside_domain' | 'too_fast' | 'too_many_pairs';
  time: number;
  body: number;
  particle: number;
  /** If false, the session has paused at the last good state. */
  recovered: boolean;
}

export interface SceneEntry {
  name: string;
  title: string;
  description: string;
}

export interface SessionEntry {
  session: string;
  name: string;
  scene: string;
  clients: number;
  playing: boolean;
  tick: number;
  particles: number;
}

export interface BodyState {
  body: number;
  name: string;
  kind: BodyKindName;
  positions: Vector[];
  velocities: Vector[];
  /** Rigid bodies only, as are the three below. */
  center_of_mass?: Vector;
  orientation?: [number, number, number, number];
  velocity?: Vector;
  angular_velocity?: Vector;
}

export interface ServerInfo {
  name: string;
  version: string;
  protocol: string;
  instruction_set: InstructionSetName;
  /** Server's clock [s since 1970]. */
  time: number;
  limits: Record<string, number>;
  methods: string[];
}

/** Since the scene was loaded; times in seconds. */
export interface SessionStats {
  instruction_set: InstructionSetName;
  threads: number;
  particles: number;
  sleeping_bodies: number;
  ticks: number;
  /** Parts of steps and undone ones included. */
  substeps: number;
  undone_substeps: number;
  seconds: number;
  longest_tick: number;
  stages: { stage: string; calls: number; seconds: number }[];
}

/** What a client is told of itself when it joins. */
export interface JoinedAs {
  participant: number;
  name: string;
  role: RoleName;
  /** A secret: who joins with it takes the participant over. */
  resume: string;
  resumed: boolean;
}

/** The tick from which a command is in effect. */
export interface InEffect {
  tick: number;
}

type Nothing = Record<string, never>;
interface Method<Params, Result> {
  params: Params;
  result: Result;
}

/** Every method: what it takes and what it answers. */
export interface Methods {
  'server.info': Method<Nothing, ServerInfo>;
  'scene.list': Method<Nothing, { scenes: SceneEntry[] }>;
  'session.create': Method<{ name: string; scene: SceneReference }, InEffect & { session: string }>;
  'session.list': Method<Nothing, { sessions: SessionEntry[] }>;
  'session.join': Method<
    { session?: string; name?: string; resume?: string },
    InEffect & JoinedAs & { session: string; description: SessionDescription }
  >;
  'session.leave': Method<Nothing, InEffect>;
  'session.close': Method<{ session: string }, InEffect>;
  'scene.load': Method<{ scene: SceneReference }, InEffect>;
  'control.play': Method<Nothing, InEffect>;
  'control.pause': Method<Nothing, InEffect>;
  'control.step': Method<{ ticks?: number }, InEffect>;
  'control.reset': Method<Nothing, InEffect>;
  'control.set_speed': Method<{ speed: number }, InEffect>;
  'world.add_body': Method<{ body: Record<string, unknown> }, InEffect & { body: number }>;
  'world.remove_body': Method<{ body: number }, InEffect>;
  'world.set_gravity': Method<{ gravity: Vector }, InEffect>;
  'world.set_interface': Method<{ interface: Record<string, unknown> }, InEffect>;
  'world.apply_force': Method<{ body: number; force: Vector; duration: number }, InEffect>;
  'grab.start': Method<
    { body: number; particle: number; target: Vector },
    InEffect & { grab: number }
  >;
  'grab.move': Method<{ grab: number; target: Vector }, InEffect>;
  'grab.end': Method<{ grab: number }, InEffect>;
  'frames.subscribe': Method<
    {
      max_error?: number;
      every?: number;
      detail?: number;
      region?: { min: Vector; max: Vector };
      attributes?: { speed?: number; density?: number; pressure?: number };
    },
    InEffect
  >;
  'frames.unsubscribe': Method<Nothing, InEffect>;
  /** The tick is there while the client is in a session. */
  'frames.ack': Method<{ number: number }, Partial<InEffect>>;
  'state.query': Method<
    { bodies?: (string | number)[] },
    InEffect & { time: number; bodies: BodyState[] }
  >;
  'session.stats': Method<Nothing, InEffect & SessionStats>;
  'session.hash': Method<
    Nothing,
    InEffect & { hash: string; instruction_set: InstructionSetName; time: number }
  >;
}
export type MethodName = keyof Methods;
export type Params<M extends MethodName> = Methods[M]['params'];
export type Result<M extends MethodName> = Methods[M]['result'];

/** Every event: what its notification carries. */
export interface Events {
  'session.description': SessionDescription;
  'session.status': SessionStatus;
  'session.guard': GuardEvent;
  'session.closed': { session: string; reason: string };
}
export type EventName = keyof Events;
export type Event = { [E in EventName]: { event: E; params: Events[E] } }[EventName];

const kEventNames: ReadonlySet<string> = new Set<EventName>([
  'session.description',
  'session.status',
  'session.guard',
  'session.closed',
]);

export function isEventName(name: string): name is EventName {
  return kEventNames.has(name);
}

/** The `data` of an error reply. */
export interface ErrorData {
  kind?: string;
  path?: string;
  limit?: string;
  maximum?: number;
  errors?: { code: string; path: string; message: string }[];
}
