// Written from protocol/schemas/ by `npm run types`; not to be edited.
import type {Body as SceneBody, Interface as SceneInterface, Scene} from './scene_format.js';

/** A secret that lets somebody in */
export type Token = string;
/** What a participant may do; each role may do what those before it may */
export type Role = 'viewer' | 'controller' | 'owner' | 'admin';
/** Names a session for the life of the server */
export type SessionId = string;
/** The session's tick from which what was asked is in effect; 0 after a reset. */
export type Tick = number;
/** [x, y, z], z is up, in SI units */
export type Vector = [number, number, number];
/** [w, x, y, z] of a unit quaternion */
export type Quaternion = [number, number, number, number];
/** [x, y, z] of a place [m] */
export type Point = [number, number, number];
/** At most 64 bytes of UTF-8 without control characters */
export type Name = string;
/** At most 64 bytes of UTF-8: something to see, and neither control characters nor marks of direction */
export type PersonName = string;
/** Numbers a participant of a session, and no other one of it */
export type ParticipantId = number;
/** Names a body for the life of its session; 0 is the vat's */
export type BodyId = number;
/** A particle's number within its body */
export type ParticleNumber = number;
/** Names a grab for the life of its session */
export type GrabId = number;

export type BodyKind = 'liquid' | 'deformable' | 'rigid';
/** Hashes can be compared where it is the same */
export type InstructionSet = 'baseline' | 'avx2' | 'avx512';
/** Of the state of a simulation */
export type Hash = string;
/** A scene of the catalogue by its name, or a scene as in a scene file */
export type SceneReference = string | Scene;
/** No parameters */
export type Nothing = Record<string, never>;
/** Ticks that a session had ever run, resets and loads included */
export type Position = number;
/** Who took part when it was recorded; nobody of them is here */
export type RecordedPeople = {
  /** The number of the participant then */
  person: number;
  name: string;
  role: Role;
  /** Bodies that were held */
  grabs: BodyId[];
  /** To where what was held was drawn */
  pointer: null | {
    position: Vector;
  };
}[];
/** The parameter that is at fault, a JSON pointer into params */
export type Path = string;
/** What to do */
export type Hint = string;
/** Messages and hints are for people and may change their words */
export type ReplyError =
  | ParseError
  | InvalidRequest
  | MethodNotFound
  | InvalidParams
  | InternalError
  | NotJoined
  | NoSuchSession
  | NoSuchBody
  | NoSuchScene
  | LimitReached
  | NotAllowed
  | NotAuthenticated
  | Busy
  | RateLimited
  | StorageFailed
  | NotRecovered;
/** Body, number of its particle, other body, number of its particle; and so on */
export type ConnectedPairs = number[];

export type Motion = [number, number, number];

/** Shows a token: an admin's, an invitation, a ticket, or that of a participant */
export interface AccessEnterParams {
  token: Token;
}

export interface AccessEnterResult {
  role: Role;
  session?: SessionId;
}
/** Makes a token that is good once and soon */
export interface AccessTicketParams {
  /** An admin is one in all sessions */
  role: 'viewer' | 'controller' | 'admin';
  session?: SessionId;
}

export interface AccessTicketResult {
  token: Token;
  role: Role;
  /** For which it is good */
  seconds: number;
}
/** Who takes part, as others are told */
export interface Participant {
  participant: ParticipantId;
  name: string;
  role: Role;
  /** Its connection has ended; it may be resumed */
  away: boolean;
  /** The bodies that it holds */
  grabs: BodyId[];
  /** Where it points */
  pointer: null | Pointer;
}
/** A place, or from there a direction */
export interface Pointer {
  position: Point;
  direction?: Vector;
}
/** What an owner decides of a session */
export interface Settings {
  name: string;
  /** Of who joins without an invitation */
  default_role: 'viewer' | 'controller';
  /** Nobody joins without an invitation */
  locked: boolean;
}
/** What a command answers that has nothing else to say */
export interface InEffect {
  tick: Tick;
}
/** The vat at offset zero */
export interface VatDescription {
  min: Vector;
  max: Vector;
  lid: boolean;
}

export interface BodyDescription {
  body: BodyId;
  name: string;
  kind: BodyKind;
  material: string;
  /** Their number when the epoch began; emitters and drains change it, and the frames' blocks tell */
  particles: number;
  /** Of the largest particle [m] */
  radius: number;
  /** Rigid bodies: particles about the centre of mass in body axes, 3 numbers each */
  local_positions?: number[];
}
/** The first tick at which a replay is not what was recorded; it pauses there */
export interface Divergence {
  position: Position;
  tick: Tick;
  reason: string;
}

export interface SessionDescription {
  session: SessionId;
  /** Frames of the same epoch belong to this description */
  epoch: number;
  tick: Tick;
  /** Of the session */
  name: string;
  /** The scene's name */
  scene: string;
  /** The scene's title */
  title: string;
  playing: boolean;
  /** Simulated seconds per second that are asked for */
  speed: number;
  /** Simulated time of a tick [s] */
  tick_seconds: number;
  gravity: Vector;
  vat: null | VatDescription;
  /** In the order of a frame's blocks */
  bodies: BodyDescription[];
  /** Of a session that shows a recording */
  replay?: {
    begin: Position;
    end: Position;
    position: Position;
  };
}
/** Pauses, then runs so many ticks */
export interface ControlStepParams {
  ticks?: number;
}
/** Sets how fast time goes on */
export interface ControlSetSpeedParams {
  /** Simulated seconds per second */
  speed: number;
}
/** Makes a viewer a controller; a controller becomes a viewer by it */
export interface ControlHandOverParams {
  participant: ParticipantId;
}

export interface ParameterError {
  code: string;
  path: Path;
  message: string;
}

export interface ParseError {
  code: -32700;
  message: string;
  data: {
    kind: 'parse_error';
    hint: Hint;
    reason: 'parse_error' | 'too_deep' | 'duplicate_key' | 'too_many_values';
  };
}

export interface InvalidRequest {
  code: -32600;
  message: string;
  data: {
    kind: 'invalid_request';
    hint: Hint;
  };
}

export interface MethodNotFound {
  code: -32601;
  message: string;
  data: {
    kind: 'method_not_found';
    hint: Hint;
  };
}

export interface InvalidParams {
  code: -32602;
  message: string;
  data: {
    kind: 'invalid_params';
    hint: Hint;
    path: Path;
    errors: ParameterError[];
  };
}

export interface InternalError {
  code: -32603;
  message: string;
  data: {
    kind: 'internal_error';
    hint: Hint;
  };
}

export interface NotJoined {
  code: 1001;
  message: string;
  data: {
    kind: 'not_joined';
    hint: Hint;
  };
}

export interface NoSuchSession {
  code: 1002;
  message: string;
  data: {
    kind: 'no_such_session';
    hint: Hint;
    path?: Path;
  };
}

export interface NoSuchBody {
  code: 1003;
  message: string;
  data: {
    kind: 'no_such_body';
    hint: Hint;
    path: Path;
  };
}

export interface NoSuchScene {
  code: 1004;
  message: string;
  data: {
    kind: 'no_such_scene';
    hint: Hint;
    path: Path;
  };
}

export interface LimitReached {
  code: 1005;
  message: string;
  data: {
    kind: 'limit_reached';
    hint: Hint;
    path?: Path;
    /** Its name in server.info */
    limit: string;
    maximum: number;
  };
}

export interface NotAllowed {
  code: 1006;
  message: string;
  data: {
    kind: 'not_allowed';
    hint: Hint;
    path?: Path;
    role?: Role;
    least_role?: Role;
  };
}

export interface NotAuthenticated {
  code: 1007;
  message: string;
  data: {
    kind: 'not_authenticated';
    hint: Hint;
  };
}

export interface Busy {
  code: 1008;
  message: string;
  data: {
    kind: 'busy';
    hint: Hint;
    path: Path;
    /** Who has it */
    holder: {
      participant: ParticipantId;
      name: string;
    };
  };
}

export interface RateLimited {
  code: 1009;
  message: string;
  data: {
    kind: 'rate_limited';
    hint: Hint;
    /** Its name in server.info */
    limit: string;
    /** Messages, or bytes, a second */
    maximum: number;
    /** Time until the next one will pass [s] */
    retry_after: number;
  };
}

export interface StorageFailed {
  code: 1010;
  message: string;
  data: {
    kind: 'storage_failed';
    hint: Hint;
  };
}

export interface NotRecovered {
  code: 1011;
  message: string;
  data: {
    kind: 'not_recovered';
    hint: Hint;
    state: 'recovering' | 'lost';
  };
}
/** Twice a second and after each change */
export interface SessionStatus {
  tick: Tick;
  /** Simulated time [s] */
  time: number;
  playing: boolean;
  speed: number;
  /** Achieved simulated seconds per second */
  real_time_factor: number;
  /** Participants that are connected */
  clients: number;
  particles: number;
  position?: Position;
}
/** A step with impossible values was undone */
export interface SessionGuard {
  tick: Tick;
  cause: 'non_finite' | 'outside_domain' | 'too_fast' | 'too_many_pairs';
  time: number;
  body: BodyId;
  particle: number;
  /** If false, the session has paused at the last good state */
  recovered: boolean;
}
/** The server ends soon: no new connections, sessions and joins */
export interface ServerDraining {
  /** For which clients may stay at most */
  seconds: number;
}
/** The session has come back in another state than it was in, and stands still */
export interface SessionDiverged {
  /** Ticks that it had ever run */
  position: number;
  tick: Tick;
  reason: string;
}
/** The replay has come to its last position, and pauses */
export interface ReplayEnded {
  position: Position;
  tick: Tick;
}
/** Those who were recorded have changed; at most ten times a second */
export interface ReplayPeople {
  people: RecordedPeople;
}

export interface SessionClosed {
  session: SessionId;
  reason: string;
}
/** Who has come, changed or gone; at most ten times a second */
export interface PresenceChanged {
  participants: Participant[];
  left: ParticipantId[];
}
/** The server has ended a grab that nobody moved any more */
export interface GrabEnded {
  grab: GrabId;
  body: BodyId;
  participant: ParticipantId;
  reason: 'idle';
}
/** Somebody asks for control; sent to those who can hand it over */
export interface ControlRequested {
  participant: ParticipantId;
  name: string;
}
/** Asks for frames, or for other frames than before */
export interface FramesSubscribeParams {
  /** Greatest position error per axis [m]; default: a 64th of the finest spacing */
  max_error?: number;
  /** Frames of the ticks that it divides */
  every?: number;
  /** An eighth, a quarter, half or all of the particles of liquid and deformable bodies */
  detail?: number;
  /** Only what is inside [m] */
  region?: {
    min: Point;
    max: Point;
  };
  /** Those that are wanted, each with its greatest error [m/s, kg/m^3, Pa, m/s^2] */
  attributes?: {
    speed?: number;
    density?: number;
    pressure?: number;
    acceleration?: number;
  };
}
/** Acknowledges frames, so that more come */
export interface FramesAckParams {
  /** Of a frame that came, from its header; acknowledges all before it too */
  number: number;
}
/** The tick is there while the client is in a session */
export interface FramesAckResult {
  tick?: Tick;
}
/** Pulls a particle to a place */
export interface GrabStartParams {
  body: BodyId;
  particle: ParticleNumber;
  target: Point;
}

export interface GrabStartResult {
  tick: Tick;
  grab: GrabId;
}
/** Pulls it to another place */
export interface GrabMoveParams {
  grab: GrabId;
  target: Point;
}
/** Lets it go */
export interface GrabEndParams {
  grab: GrabId;
}
/** Changes the caller's name */
export interface ParticipantRenameParams {
  name: PersonName;
}
/** Gives a role; ownership is handed over */
export interface ParticipantSetRoleParams {
  participant: ParticipantId;
  role: 'viewer' | 'controller' | 'owner';
}
/** Ends a participant and its connection */
export interface ParticipantKickParams {
  participant: ParticipantId;
  /** What the close frame tells */
  reason?: string;
}

export interface PresenceListResult {
  tick: Tick;
  participants: Participant[];
}
/** Shows others where one points; without a position, nowhere */
export interface PresencePointParams {
  position?: Point;
  direction?: Vector;
}

export interface RecordingExportResult {
  tick: Tick;
  /** On the server's host and port, for one GET */
  path: string;
  bytes: number;
  /** That it covers */
  ticks: number;
  /** Until when it can be fetched [s] */
  expires: number;
}
/** Brings a recording, part by part */
export interface RecordingImportParams {
  /** That the answer to the first part gave, which has none */
  recording?: string;
  /** Of the whole file [bytes] */
  size: number;
  /** Where the part begins */
  offset: number;
  /** Base64 with padding */
  data: string;
}

export interface RecordingImportResult {
  /** For further parts, and replay.open */
  recording: string;
  /** Bytes so far */
  received: number;
  /** Whether it is read, and what follows is told */
  whole: boolean;
  /** Of the session that was recorded */
  name?: string;
  /** That it covers */
  ticks?: number;
  instruction_set?: InstructionSet;
}
/** Makes a session that shows a recording; nobody has joined it yet */
export interface ReplayOpenParams {
  session?: SessionId;
  /** Instead: one that was imported */
  recording?: string;
  name?: Name;
}

export interface ReplayOpenResult {
  tick: Tick;
  session: SessionId;
  begin: Position;
  end: Position;
}

export interface ReplayInfoResult {
  tick: Tick;
  /** Of the session that was recorded */
  name: string;
  begin: Position;
  end: Position;
  position: Position;
  playing: boolean;
  speed: number;
  /** From which it goes anywhere, ascending */
  checkpoints: Position[];
  /** Whether no more of them are to come by themselves */
  filled: boolean;
  /** Of states that are compared */
  hashes: number;
  /** Where it differed since the last seek */
  diverged: null | Divergence;
  people: RecordedPeople;
}
/** Goes to a position, or to a tick of the present run */
export interface ReplaySeekParams {
  position?: Position;
  tick?: Tick;
}

export interface ReplaySeekResult {
  tick: Tick;
  position: Position;
}

export interface SceneListResult {
  /** Of the catalogue, and then those that users have saved */
  scenes: SceneEntry[];
}

export interface SceneEntry {
  name: string;
  title: string;
  description: string;
  /** Of one that a user has saved: the name of a participant */
  saved_by?: string;
  /** The same: when [s since 1970] */
  saved?: number;
}
/** A scene, written out */
export interface SceneGetParams {
  scene?: Name;
  /** The session's with what commands and time have made of its bodies; default: as it was loaded */
  current?: boolean;
}

export interface SceneGetResult {
  tick: Tick;
  scene: Scene;
}
/** Puts another scene into the session, at tick 0 */
export interface SceneLoadParams {
  scene: SceneReference;
}
/** Keeps a scene for all sessions */
export interface SceneSaveParams {
  name: PersonName;
  scene?: Scene;
  key?: Token;
}

export interface SceneSaveResult {
  tick: Tick;
  name: string;
  /** That it takes */
  bytes: number;
  key?: Token;
}
/** Deletes a scene that was saved */
export interface SceneDeleteParams {
  name: PersonName;
  key?: Token;
}

export interface SceneDeleteResult {}
/** What the server is and allows */
export interface ServerInfoResult {
  name: 'vat';
  version: string;
  protocol: 'vat.v1';
  instruction_set: InstructionSet;
  /** Whether a token has to be shown first */
  access: 'open' | 'token';
  /** Where what is kept lives: in a folder, or in memory, where it ends with the server */
  storage: 'folder' | 'memory';
  /** The server's clock [s since 1970] */
  time: number;
  /** Every limit by its name, as in the errors limit_reached */
  limits: {
    [k: string]: number;
  };
  /** The names of all methods */
  methods: string[];
}

export interface ServerSessionsResult {
  sessions: WatchedSession[];
}

export interface WatchedSession {
  session: SessionId;
  name: string;
  /** Of one that is not running only the name is known */
  state: 'running' | 'recovering' | 'lost';
  /** A replay shows a recording */
  kind: 'live' | 'replay';
  scene: string;
  playing: boolean;
  /** It plays, but stands still while nobody is in it */
  hibernating: boolean;
  tick: Tick;
  particles: number;
  participants: WatchedParticipant[];
}

export interface WatchedParticipant {
  participant: ParticipantId;
  name: string;
  role: Role;
  /** It has no connection just now */
  away: boolean;
  /** From which it is connected */
  address?: string;
}
/** Ends the server, once clients have had some time */
export interface ServerDrainParams {
  /** That clients may stay at most; by default the server's setting [s] */
  seconds?: number;
}

export interface ServerDrainResult {
  /** That clients may stay at most [s] */
  seconds: number;
}
/** Makes a session, which plays; nobody has joined it yet */
export interface SessionCreateParams {
  name: Name;
  scene: SceneReference;
}

export interface SessionCreateResult {
  tick: Tick;
  session: SessionId;
}

export interface SessionListResult {
  sessions: SessionEntry[];
}

export interface SessionEntry {
  session: SessionId;
  name: string;
  /** Of one that is not running only the name is known */
  state: 'running' | 'recovering' | 'lost';
  /** A replay shows a recording */
  kind: 'live' | 'replay';
  scene: string;
  /** Participants that are connected */
  clients: number;
  playing: boolean;
  tick: Tick;
  particles: number;
}
/** Takes part in a session */
export interface SessionJoinParams {
  session?: SessionId;
  name?: PersonName;
  resume?: Token;
}

export interface SessionJoinResult {
  tick: Tick;
  session: SessionId;
  participant: ParticipantId;
  name: string;
  role: Role;
  /** A secret: who joins with it takes the participant over */
  resume: string;
  /** Whether it is one that was there before */
  resumed: boolean;
  settings: Settings;
  participants: Participant[];
  description: SessionDescription;
}
/** Decides who may join, and as what */
export interface SessionConfigureParams {
  name?: PersonName;
  default_role?: 'viewer' | 'controller';
  locked?: boolean;
}

export interface SessionConfigureResult {
  tick: Tick;
  name: string;
  default_role: 'viewer' | 'controller';
  locked: boolean;
}
/** Makes an invitation into the session */
export interface SessionInviteParams {
  role: 'viewer' | 'controller';
  /** By default any number */
  uses?: number;
  /** [s] */
  expires?: number;
}

export interface SessionInviteResult {
  tick: Tick;
  token: Token;
  role: Role;
  /** [s] */
  expires: number;
}
/** Ends a session for all */
export interface SessionCloseParams {
  session: SessionId;
}

export interface SessionHashResult {
  tick: Tick;
  hash: Hash;
  instruction_set: InstructionSet;
  /** Simulated time [s] */
  time: number;
  /** Ticks that the session has ever run */
  position: number;
}
/** What the session's ticks have cost, and sums over what they lead to */
export interface SessionStatsParams {
  /** Whether energies and the like are measured, at the cost of about one of a tick's steps; default false */
  diagnostics?: boolean;
}

export interface SessionStatsResult {
  tick: Tick;
  instruction_set: InstructionSet;
  /** That step sessions */
  threads: number;
  /** Simulated time [s] */
  time: number;
  /** Simulated seconds per second that are achieved */
  real_time_factor: number;
  particles: number;
  sleeping_bodies: number;
  /** This and what follows: since the scene was loaded */
  ticks: number;
  /** Parts of steps and undone ones included */
  substeps: number;
  undone_substeps: number;
  /** Wall time of the ticks [s] */
  seconds: number;
  /** [s] */
  longest_tick: number;
  stages: {
    stage: string;
    calls: number;
    seconds: number;
  }[];
  diagnostics?: Diagnostics;
}
/** Where it was asked for */
export interface Diagnostics {
  /** [J] */
  kinetic_energy: number;
  /** About the origin [J] */
  gravitational_energy: number;
  /** Of static springs and of cells that keep their volume [J] */
  elastic_energy: number;
  /** Between bodies and at walls [J] */
  contact_energy: number;
  momentum: Vector;
  angular_momentum: Vector;
  /** Of liquid: the mean of what is above the density at rest, over that */
  mean_density_error: number;
  /** The greatest of these */
  max_density_error: number;
  torn_springs: number;
  /** Since time 0 */
  emitted_particles: number;
  /** The same */
  drained_particles: number;
}
/** Keeps the session's state under a name */
export interface SessionSaveParams {
  name: PersonName;
}

export interface SessionSaveResult {
  tick: Tick;
  name: string;
  hash: Hash;
  /** That it takes */
  bytes: number;
}
/** Goes to a state that was saved, and on from there */
export interface SessionLoadParams {
  name: PersonName;
}

export interface SessionSavesResult {
  tick: Tick;
  states: SavedState[];
}

export interface SavedState {
  name: string;
  /** Name of a participant */
  saved_by: string;
  /** When [s since 1970] */
  saved: number;
  /** The session's tick then */
  at_tick: number;
  /** Simulated time [s] */
  time: number;
  hash: Hash;
  bytes: number;
}
/** Deletes a saved state */
export interface SessionDeleteSaveParams {
  name: PersonName;
}
/** The bodies' state in full precision */
export interface StateQueryParams {
  /** Names or ids; by default all */
  bodies?: (BodyId | Name)[];
}

export interface StateQueryResult {
  tick: Tick;
  /** Simulated time [s] */
  time: number;
  bodies: BodyState[];
}

export interface BodyState {
  body: BodyId;
  name: string;
  kind: BodyKind;
  /** Of its particles in the order of their numbers [m] */
  positions: Vector[];
  /** [m/s] */
  velocities: Vector[];
  /** Which particles are there, where some are gone */
  numbers?: ParticleNumber[];
  center_of_mass?: Vector;
  orientation?: Quaternion;
  velocity?: Vector;
  angular_velocity?: Vector;
}
/** Springs and contacts */
export interface StateConnectionsParams {
  /** Name or id: those of this body alone */
  body?: BodyId | Name;
  /** Of springs, and of contacts; default 2000 */
  most?: number;
}

export interface StateConnectionsResult {
  tick: Tick;
  /** Simulated time [s] */
  time: number;
  springs: ConnectedSprings;
  contacts: ConnectedContacts;
}

export interface ConnectedSprings {
  /** How many there are */
  total: number;
  /** Every so many of them is told */
  every: number;
  pairs: ConnectedPairs;
  /** Length over length at rest, less 1, pair by pair */
  strains: number[];
}

export interface ConnectedContacts {
  /** How many there are */
  total: number;
  /** Every so many of them is told */
  every: number;
  pairs: ConnectedPairs;
  /** Along the line between the two [N], pair by pair; below 0 where it pulls */
  forces: number[];
}
/** Adds a body */
export interface WorldAddBodyParams {
  body: SceneBody;
  /** Where it is and how it moves, as state.query tells it, in place of what the body says */
  state?: ParticleMotion | RigidMotion;
}
/** Of each particle of a liquid or deformable body */
export interface ParticleMotion {
  /** [m] */
  positions: Point[];
  /** [m/s] */
  velocities: Motion[];
}
/** Of a rigid body */
export interface RigidMotion {
  center_of_mass: Point;
  /** [w, x, y, z], of length 1 */
  orientation: [number, number, number, number];
  velocity: Motion;
  angular_velocity: Motion;
}

export interface WorldAddBodyResult {
  tick: Tick;
  body: BodyId;
}
/** Takes a body away */
export interface WorldRemoveBodyParams {
  body: BodyId;
}
/** Makes a deformable body liquid */
export interface WorldMeltBodyParams {
  body: BodyId;
  material: Name;
}
/** Opens or closes an emitter */
export interface WorldSetEmitterParams {
  emitter: Name;
  open: boolean;
}
/** Sets gravity */
export interface WorldSetGravityParams {
  /** [m/s^2] */
  gravity: [number, number, number];
}
/** Sets what happens where two materials meet */
export interface WorldSetInterfaceParams {
  interface: SceneInterface;
}
/** Pushes a body for a while */
export interface WorldApplyForceParams {
  body: BodyId;
  /** On the whole body [N] */
  force: [number, number, number];
  /** [s] */
  duration: number;
}
/** Puts a body elsewhere, as it is */
export interface WorldMoveBodyParams {
  body: BodyId;
  position: Point;
  /** [w, x, y, z] of a rigid body, of length 1; by default as it is */
  orientation?: [number, number, number, number];
  /** Of all of it, which then does not turn [m/s]; by default as it is */
  velocity?: [number, number, number];
}
/** Adds a material, or replaces the constants of the one of its name */
export interface WorldSetMaterialParams {
  material: unknown;
}
/** Steps with another integrator, or in steps of another length */
export interface WorldSetNumericsParams {
  integrator?: unknown;
  /** [s]; the tick, which stays, is a whole number of them */
  step?: number;
}
/** Moves the vat by hand */
export interface WorldMoveVatParams {
  offset: Point;
}

/** Every method: what it takes and what it answers. */
export interface Methods {
  'access.enter': { params: AccessEnterParams; result: AccessEnterResult };
  'access.ticket': { params: AccessTicketParams; result: AccessTicketResult };
  'control.play': { params: Nothing; result: InEffect };
  'control.pause': { params: Nothing; result: InEffect };
  'control.step': { params: ControlStepParams; result: InEffect };
  'control.reset': { params: Nothing; result: InEffect };
  'control.set_speed': { params: ControlSetSpeedParams; result: InEffect };
  'control.request': { params: Nothing; result: InEffect };
  'control.hand_over': { params: ControlHandOverParams; result: InEffect };
  'frames.subscribe': { params: FramesSubscribeParams; result: InEffect };
  'frames.unsubscribe': { params: Nothing; result: InEffect };
  'frames.ack': { params: FramesAckParams; result: FramesAckResult };
  'grab.start': { params: GrabStartParams; result: GrabStartResult };
  'grab.move': { params: GrabMoveParams; result: InEffect };
  'grab.end': { params: GrabEndParams; result: InEffect };
  'participant.rename': { params: ParticipantRenameParams; result: InEffect };
  'participant.set_role': { params: ParticipantSetRoleParams; result: InEffect };
  'participant.kick': { params: ParticipantKickParams; result: InEffect };
  'presence.list': { params: Nothing; result: PresenceListResult };
  'presence.point': { params: PresencePointParams; result: InEffect };
  'recording.export': { params: Nothing; result: RecordingExportResult };
  'recording.import': { params: RecordingImportParams; result: RecordingImportResult };
  'replay.open': { params: ReplayOpenParams; result: ReplayOpenResult };
  'replay.info': { params: Nothing; result: ReplayInfoResult };
  'replay.seek': { params: ReplaySeekParams; result: ReplaySeekResult };
  'scene.list': { params: Nothing; result: SceneListResult };
  'scene.get': { params: SceneGetParams; result: SceneGetResult };
  'scene.load': { params: SceneLoadParams; result: InEffect };
  'scene.save': { params: SceneSaveParams; result: SceneSaveResult };
  'scene.delete': { params: SceneDeleteParams; result: SceneDeleteResult };
  'server.info': { params: Nothing; result: ServerInfoResult };
  'server.sessions': { params: Nothing; result: ServerSessionsResult };
  'server.drain': { params: ServerDrainParams; result: ServerDrainResult };
  'session.create': { params: SessionCreateParams; result: SessionCreateResult };
  'session.list': { params: Nothing; result: SessionListResult };
  'session.join': { params: SessionJoinParams; result: SessionJoinResult };
  'session.configure': { params: SessionConfigureParams; result: SessionConfigureResult };
  'session.invite': { params: SessionInviteParams; result: SessionInviteResult };
  'session.leave': { params: Nothing; result: InEffect };
  'session.close': { params: SessionCloseParams; result: InEffect };
  'session.hash': { params: Nothing; result: SessionHashResult };
  'session.stats': { params: SessionStatsParams; result: SessionStatsResult };
  'session.save': { params: SessionSaveParams; result: SessionSaveResult };
  'session.load': { params: SessionLoadParams; result: InEffect };
  'session.saves': { params: Nothing; result: SessionSavesResult };
  'session.delete_save': { params: SessionDeleteSaveParams; result: InEffect };
  'state.query': { params: StateQueryParams; result: StateQueryResult };
  'state.connections': { params: StateConnectionsParams; result: StateConnectionsResult };
  'world.add_body': { params: WorldAddBodyParams; result: WorldAddBodyResult };
  'world.remove_body': { params: WorldRemoveBodyParams; result: InEffect };
  'world.melt_body': { params: WorldMeltBodyParams; result: InEffect };
  'world.set_emitter': { params: WorldSetEmitterParams; result: InEffect };
  'world.set_gravity': { params: WorldSetGravityParams; result: InEffect };
  'world.set_interface': { params: WorldSetInterfaceParams; result: InEffect };
  'world.apply_force': { params: WorldApplyForceParams; result: InEffect };
  'world.move_body': { params: WorldMoveBodyParams; result: InEffect };
  'world.set_material': { params: WorldSetMaterialParams; result: InEffect };
  'world.set_numerics': { params: WorldSetNumericsParams; result: InEffect };
  'world.move_vat': { params: WorldMoveVatParams; result: InEffect };
}

/** Every event: what its notification carries. */
export interface Events {
  'session.description': SessionDescription;
  'session.status': SessionStatus;
  'session.guard': SessionGuard;
  'server.draining': ServerDraining;
  'session.diverged': SessionDiverged;
  'replay.ended': ReplayEnded;
  'replay.diverged': Divergence;
  'replay.people': ReplayPeople;
  'session.closed': SessionClosed;
  'session.configured': Settings;
  'presence.changed': PresenceChanged;
  'grab.ended': GrabEnded;
  'control.requested': ControlRequested;
}

export const kEventNames = [
  'session.description',
  'session.status',
  'session.guard',
  'server.draining',
  'session.diverged',
  'replay.ended',
  'replay.diverged',
  'replay.people',
  'session.closed',
  'session.configured',
  'presence.changed',
  'grab.ended',
  'control.requested',
] as const;
