// Written from protocol/schemas/ by `npm run types`; not to be edited.
import type {
  Appearance,
  Body as SceneBody,
  Interface as SceneInterface,
  Scene,
  Shape
} from './scene_format.js';

/** A secret that grants access */
export type Token = string;
/** Rights of a participant; each role includes the rights of the roles before it */
export type Role = 'viewer' | 'controller' | 'owner' | 'admin';
/** Identifies a session during the life of the server */
export type SessionId = string;

export type Level = 'coarse' | 'normal' | 'fine' | 'finest';
/** The session's tick from which the command is in effect; 0 after a reset. */
export type Tick = number;
/** [x, y, z] in SI units; z points up */
export type Vector = [number, number, number];
/** [w, x, y, z] of a unit quaternion */
export type Quaternion = [number, number, number, number];
/** [x, y, z] of a position [m] */
export type Point = [number, number, number];
/** At most 64 bytes of UTF-8 without control characters */
export type Name = string;
/** At most 64 bytes of UTF-8, with a visible character and without control or direction characters */
export type PersonName = string;
/** Identifies a participant within its session */
export type ParticipantId = number;
/** Identifies a body during the life of its session; 0 is the vat */
export type BodyId = number;
/** Number of a particle within its body */
export type ParticleNumber = number;
/** Identifies a grab during the life of its session */
export type GrabId = number;

export type BodyKind = 'liquid' | 'deformable' | 'rigid';
/** Hashes are comparable if their instruction set is the same */
export type InstructionSet = 'baseline' | 'avx2' | 'avx512';
/** OpenCL device that takes the steps; hashes are comparable if it is the same, or without fast on both */
export type Device = string;
/** Hash of the state of a simulation */
export type Hash = string;
/** Name of a catalogue scene or saved scene, or a scene as in a scene file */
export type SceneReference = string | Scene;
/** No parameters */
export type Nothing = Record<string, never>;
/** Number of ticks that a session has run, including those before resets and loads */
export type Position = number;
/** A participant of the recorded session, who is not in the replay session */
export type RecordedPeople = {
  /** Participant id in the recorded session */
  person: number;
  name: string;
  role: Role;
  /** Bodies that the participant had grabbed */
  grabs: BodyId[];
  /** Target of the grab */
  pointer: null | {
    position: Vector;
  };
}[];
/** JSON pointer into params to the invalid parameter */
export type Path = string;
/** The action that resolves the error */
export type Hint = string;
/** Messages and hints are for people and may change */
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
  | NotRecovered
  | Moved;
/** Body, particle number, other body, particle number, and so on */
export type ConnectedPairs = number[];

export type Motion = [number, number, number];

/** Enters with a token: of an admin, an invitation, a ticket or a participant */
export interface AccessEnterParams {
  token: Token;
}

export interface AccessEnterResult {
  role: Role;
  session?: SessionId;
}
/** Creates a token that is valid once and for a short time */
export interface AccessTicketParams {
  /** An admin has this role in all sessions */
  role: 'viewer' | 'controller' | 'admin';
  session?: SessionId;
}

export interface AccessTicketResult {
  token: Token;
  role: Role;
  /** Period of validity */
  seconds: number;
}
/** A participant of the session */
export interface Participant {
  participant: ParticipantId;
  name: string;
  role: Role;
  /** Whether its connection has ended; it can resume */
  away: boolean;
  /** The bodies that it has grabbed */
  grabs: BodyId[];
  /** The position of its pointer */
  pointer: null | Pointer;
}
/** A position, or a ray that starts there */
export interface Pointer {
  position: Point;
  direction?: Vector;
}
/** Settings of a session, made by its owner */
export interface Settings {
  name: string;
  /** Role of participants that join without an invitation */
  default_role: 'viewer' | 'controller';
  /** Whether joining needs an invitation */
  locked: boolean;
  /** Points among which the governor chooses. Absent without the owner's permission for the present scene */
  governor?: GovernorPoint[];
}
/** Numerics with their measured error and cost */
export interface GovernorPoint {
  integrator?: unknown;
  /** [s] */
  step?: number;
  /** Choice of the step lengths */
  control?: 'fixed' | 'adaptive' | 'local';
  /** Relative phase error of adaptive and local steps */
  tolerance?: number;
  /** Of incompressible liquids */
  density_tolerance?: number;
  /** Of incompressible liquids */
  divergence_tolerance?: number;
  /** Relative error */
  error: number;
  /** Computing time per simulated second [s] */
  seconds: number;
}
/** Result of commands without further data */
export interface InEffect {
  tick: Tick;
}
/** The vat at displacement 0 */
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
  /** Number of particles at the start of the epoch; emitters and drains change it, and frames contain the current number */
  particles: number;
  /** Radius of the largest particle [m] */
  radius: number;
  /** Rigid bodies: particles relative to the centre of mass in body axes, 3 numbers each */
  local_positions?: number[];
  shape?: Shape;
  /** Deformable bodies with a shape: lattice spacing [m] */
  spacing?: number;
  /** Deformable bodies with a shape: particles at rest in the axes of the shape, 3 numbers each */
  rest_positions?: number[];
}
/** First tick at which the replay differs from the recording; it pauses there */
export interface Divergence {
  position: Position;
  tick: Tick;
  reason: string;
}

export interface MaterialDescription {
  name: string;
  appearance: Appearance;
  /** Strain at which springs tear, if they do */
  tearing_strain?: number;
}

export interface SessionDescription {
  session: SessionId;
  /** Frames of the same epoch belong to this description */
  epoch: number;
  tick: Tick;
  /** Name of the session */
  name: string;
  /** Name of the scene */
  scene: string;
  level?: Level;
  /** Title of the scene */
  title: string;
  playing: boolean;
  /** Set speed [simulated seconds per second] */
  speed: number;
  /** Simulated time of a tick [s] */
  tick_seconds: number;
  gravity: Vector;
  vat: null | VatDescription;
  /** Complete appearances, in the order of the scene */
  materials: MaterialDescription[];
  /** In the order of the blocks in frames */
  bodies: BodyDescription[];
  /** Present if the session is a replay */
  replay?: {
    begin: Position;
    end: Position;
    position: Position;
  };
}
/** Pauses, then runs a number of ticks */
export interface ControlStepParams {
  ticks?: number;
}
/** Sets the speed */
export interface ControlSetSpeedParams {
  /** Simulated seconds per second */
  speed: number;
}
/** Makes a viewer a controller; a calling controller becomes a viewer */
export interface ControlHandOverParams {
  participant: ParticipantId;
}

export interface ParameterError {
  code: string;
  path: Path;
  message: string;
  suggestion?: string;
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
    suggestion?: string;
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
    suggestion?: string;
  };
}

export interface NoSuchScene {
  code: 1004;
  message: string;
  data: {
    kind: 'no_such_scene';
    hint: Hint;
    path: Path;
    suggestion?: string;
  };
}

export interface LimitReached {
  code: 1005;
  message: string;
  data: {
    kind: 'limit_reached';
    hint: Hint;
    path?: Path;
    /** Name in server.info */
    limit: string;
    maximum: number;
    /** Only for sessions_per_address: number of abandoned sessions among them */
    abandoned?: number;
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
    /** Participant who has grabbed the body */
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
    /** Name in server.info */
    limit: string;
    /** Messages or bytes per second */
    maximum: number;
    /** Time until the next message is accepted [s] */
    retry_after: number;
  };
}

export interface StorageFailed {
  code: 1010;
  message: string;
  data: {
    kind: 'storage_failed';
    hint: Hint;
    /** Time after which a retry may succeed, if a cluster cannot store commands [s] */
    retry_after?: number;
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

export interface Moved {
  code: 1012;
  message: string;
  data: {
    kind: 'moved';
    hint: Hint;
    session: SessionId;
    /** WebSocket URL of the node with the session; empty: not known yet */
    url: string;
  };
}
/** Sent twice per second and after each change */
export interface SessionStatus {
  tick: Tick;
  /** Simulated time [s] */
  time: number;
  playing: boolean;
  speed: number;
  /** Achieved simulated seconds per second */
  real_time_factor: number;
  /** Connected participants */
  clients: number;
  particles: number;
  position?: Position;
  /** Only if the governor is permitted and the session uses one of its points */
  governor?: {
    /** Index of the present point; 0 is the most accurate */
    point: number;
    /** Relative error of the present point */
    error: number;
  };
}
/** A step with invalid values was undone */
export interface SessionGuard {
  tick: Tick;
  cause: 'non_finite' | 'outside_domain' | 'too_fast' | 'too_many_pairs';
  time: number;
  body: BodyId;
  particle: number;
  /** If false, the session has paused at the last valid state */
  recovered: boolean;
}
/** The CPU takes the steps in place of the device */
export interface SessionDevice {
  tick: Tick;
  /** not_on_device: until the device again supports all features of the scene. device_failed: until the next load */
  code: 'not_on_device' | 'device_failed';
  /** JSON pointer to the unsupported feature in the scene, or /device */
  path: string;
  message: string;
}
/** The server ends soon and accepts no new connections, sessions and joins */
export interface ServerDraining {
  /** Time until the server closes the connections */
  seconds: number;
}
/** The recovered session differs from its log, and pauses */
export interface SessionDiverged {
  /** Number of ticks that the session has run */
  position: number;
  tick: Tick;
  reason: string;
}
/** The replay has reached its last position and pauses */
export interface ReplayEnded {
  position: Position;
  tick: Tick;
}
/** The recorded participants have changed; sent at most ten times per second */
export interface ReplayPeople {
  people: RecordedPeople;
}

export interface SessionClosed {
  session: SessionId;
  reason: string;
}
/** Another node of the cluster continues the session. Requests without a reply were not executed */
export interface SessionMoved {
  session: SessionId;
  /** WebSocket URL of the node; empty: not known yet */
  url: string;
}
/** The governor has changed the numerics of the session */
export interface GovernorSwitched {
  tick: Tick;
  /** Index of the new point; 0 is the most accurate */
  point: number;
  /** Relative error of the new point */
  error: number;
  /** behind: the session was slower than requested. reserve: the more accurate point fits into the free time */
  reason: 'behind' | 'reserve';
}
/** Added, changed and removed participants; sent at most ten times per second */
export interface PresenceChanged {
  participants: Participant[];
  left: ParticipantId[];
}
/** The server can no longer, or can again, store the session's commands */
export interface SessionStorage {
  /** True while the server rejects commands with storage_failed */
  failing: boolean;
  /** Only if failing */
  reason?: 'full' | 'read_only' | 'corrupt' | 'newer' | 'locked' | 'failed' | 'unreachable';
}
/** The server has ended a grab that was not moved */
export interface GrabEnded {
  grab: GrabId;
  body: BodyId;
  participant: ParticipantId;
  reason: 'idle';
}
/** A notification of this client was rejected; sent when the count is a power of two */
export interface NotificationRejected {
  /** Rejected notifications of this connection */
  count: number;
  /** Method of the last one */
  method: string;
  /** As in an error reply */
  code: number;
  /** As in an error reply */
  kind: string;
  message: string;
}
/** A participant requests control; sent to participants who can hand it over */
export interface ControlRequested {
  participant: ParticipantId;
  name: string;
}
/** Subscribes to frames, or changes the subscription */
export interface FramesSubscribeParams {
  /** Maximum position error per axis [m]; default: 1/64 of the smallest spacing */
  max_error?: number;
  /** Sends frames of ticks that are multiples of this number */
  every?: number;
  /** An eighth, a quarter, half or all of the particles of liquid and deformable bodies */
  detail?: number;
  /** Sends only particles inside this box [m] */
  region?: {
    min: Point;
    max: Point;
  };
  /** Requested attributes, each with its maximum error [m/s, kg/m^3, Pa, m/s^2] */
  attributes?: {
    speed?: number;
    density?: number;
    pressure?: number;
    acceleration?: number;
  };
}
/** Acknowledges frames, so that the server sends more */
export interface FramesAckParams {
  /** Number in the header of a received frame; also acknowledges all earlier frames */
  number: number;
  /** Whether the client could not decode the frame; the server then sends a key frame */
  rejected?: boolean;
}
/** Contains the tick if the client is in a session */
export interface FramesAckResult {
  tick?: Tick;
}
/** Pulls a particle to a target */
export interface GrabStartParams {
  /** Name or id */
  body: BodyId | Name;
  particle: ParticleNumber;
  target: Point;
}

export interface GrabStartResult {
  tick: Tick;
  grab: GrabId;
}
/** Moves the target of a grab */
export interface GrabMoveParams {
  grab: GrabId;
  target: Point;
}
/** Ends a grab */
export interface GrabEndParams {
  grab: GrabId;
}
/** Changes the caller's name */
export interface ParticipantRenameParams {
  name: PersonName;
}
/** Sets the role of a participant; if it becomes owner, the previous owner becomes a controller */
export interface ParticipantSetRoleParams {
  participant: ParticipantId;
  role: 'viewer' | 'controller' | 'owner';
}
/** Removes a participant and closes its connection */
export interface ParticipantKickParams {
  participant: ParticipantId;
  /** Reason in the close frame */
  reason?: string;
}

export interface PresenceListResult {
  tick: Tick;
  participants: Participant[];
}
/** Shows the caller's pointer to others; without a position, hides it */
export interface PresencePointParams {
  position?: Point;
  direction?: Vector;
}

export interface RecordingExportResult {
  tick: Tick;
  /** Path on the server's host and port, for one GET */
  path: string;
  bytes: number;
  /** Number of recorded ticks */
  ticks: number;
  /** End of the period for the download [s] */
  expires: number;
}
/** Uploads a recording in parts */
export interface RecordingImportParams {
  /** Id from the reply to the first part; absent in the first part */
  recording?: string;
  /** Size of the whole file [bytes] */
  size: number;
  /** Position of the part in the file */
  offset: number;
  /** Base64 with padding */
  data: string;
}

export interface RecordingImportResult {
  /** Id for further parts and for replay.open */
  recording: string;
  /** Received bytes */
  received: number;
  /** Whether the file is complete; the reply then has the other members */
  whole: boolean;
  /** Name of the recorded session */
  name?: string;
  /** Number of recorded ticks */
  ticks?: number;
  instruction_set?: InstructionSet;
}
/** Creates a session that replays a recording; the caller does not join it */
export interface ReplayOpenParams {
  session?: SessionId;
  /** Instead of a session: id of an imported recording */
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
  /** Name of the recorded session */
  name: string;
  begin: Position;
  end: Position;
  position: Position;
  playing: boolean;
  speed: number;
  /** Positions of the stored states from which seeks continue, ascending */
  checkpoints: Position[];
  /** Whether the server has stopped adding checkpoints */
  filled: boolean;
  /** Number of compared state hashes */
  hashes: number;
  /** First difference since the last seek */
  diverged: null | Divergence;
  people: RecordedPeople;
}
/** Seeks to a position, or to a tick of the current run */
export interface ReplaySeekParams {
  position?: Position;
  tick?: Tick;
}

export interface ReplaySeekResult {
  tick: Tick;
  position: Position;
}

export interface SceneListResult {
  /** Catalogue scenes, then saved scenes */
  scenes: SceneEntry[];
}

export interface SceneEntry {
  name: string;
  title: string;
  description: string;
  /** Saved scenes: name of the participant who saved it */
  saved_by?: string;
  /** Saved scenes: time of saving [s since 1970] */
  saved?: number;
}
/** Returns the levels of detail of a catalogue scene */
export interface SceneLevelsParams {
  scene: Name;
}

export interface SceneLevelsResult {
  /** Levels that the server accepts, from coarse to finest */
  levels: {
    level: Level;
    /** Maximum number */
    particles: number;
    /** Expected simulated seconds per second, if no other session plays */
    real_time_factor: number;
  }[];
  offered: Level;
}
/** Returns a complete scene */
export interface SceneGetParams {
  scene?: Name;
  /** Whether to return the session's scene in its current state, after commands and simulated time; default: as loaded */
  current?: boolean;
}

export interface SceneGetResult {
  tick: Tick;
  scene: Scene;
}
/** Replaces the session's scene, at tick 0 */
export interface SceneLoadParams {
  scene: SceneReference;
  level?: Level;
}
/** Saves a scene for all sessions */
export interface SceneSaveParams {
  name: PersonName;
  scene?: Scene;
  key?: Token;
}

export interface SceneSaveResult {
  tick: Tick;
  name: string;
  /** Size of the scene */
  bytes: number;
  key?: Token;
}
/** Deletes a saved scene */
export interface SceneDeleteParams {
  name: PersonName;
  key?: Token;
}

export interface SceneDeleteResult {}
/** Properties and limits of the server */
export interface ServerInfoResult {
  name: 'vat';
  version: string;
  protocol: 'vat.v1';
  instruction_set: InstructionSet;
  /** Whether clients need a token */
  access: 'open' | 'token';
  /** Storage of saved data: in a folder, or in memory until the server ends */
  storage: 'folder' | 'memory';
  /** The server's clock [s since 1970] */
  time: number;
  /** Name of the server as a node of a cluster; absent: no cluster */
  node?: string;
  /** WebSocket URLs of the cluster's nodes; absent: no cluster */
  nodes?: string[];
  /** Every limit by its name, as in the error limit_reached */
  limits: {
    [k: string]: number;
  };
  /** Names of all methods */
  methods: string[];
}

export interface ServerSessionsResult {
  sessions: WatchedSession[];
}

export interface WatchedSession {
  session: SessionId;
  name: string;
  /** If the session is not running, only the name is known */
  state: 'running' | 'recovering' | 'lost' | 'elsewhere';
  /** Node of the cluster with the session; absent: no cluster */
  node?: string;
  /** A replay shows a recording */
  kind: 'live' | 'replay';
  scene: string;
  playing: boolean;
  /** Whether the session is stopped because no client is in it */
  hibernating: boolean;
  tick: Tick;
  particles: number;
  participants: WatchedParticipant[];
  /** Whether this client may close the session */
  closable: boolean;
}

export interface WatchedParticipant {
  participant: ParticipantId;
  name: string;
  role: Role;
  /** Whether it is disconnected */
  away: boolean;
  /** Address of its connection */
  address?: string;
}
/** Ends the server after a period for clients */
export interface ServerDrainParams {
  /** Period for clients; default: the server's setting [s] */
  seconds?: number;
}

export interface ServerDrainResult {
  /** Period for clients [s] */
  seconds: number;
}
/** Moves a session to another node of the cluster */
export interface ServerMoveParams {
  session: SessionId;
  /** Name of the node that continues the session */
  node: string;
}

export interface ServerMoveResult {
  session: SessionId;
  /** WebSocket URL of the node */
  url: string;
}
/** Creates a session, which plays; the caller does not join it */
export interface SessionCreateParams {
  name: Name;
  scene: SceneReference;
  level?: Level;
}

export interface SessionCreateResult {
  tick: Tick;
  session: SessionId;
  /** Token of the owner for access.enter; present if another node of a cluster has created the session */
  ticket?: string;
}

export interface SessionListResult {
  sessions: SessionEntry[];
}

export interface SessionEntry {
  session: SessionId;
  name: string;
  /** If the session is not running, only the name is known */
  state: 'running' | 'recovering' | 'lost' | 'elsewhere';
  /** Node of the cluster with the session; absent: no cluster */
  node?: string;
  /** A replay shows a recording */
  kind: 'live' | 'replay';
  scene: string;
  /** Connected participants */
  clients: number;
  playing: boolean;
  tick: Tick;
  particles: number;
  /** Whether this client may close the session */
  closable: boolean;
}
/** Joins a session */
export interface SessionJoinParams {
  session?: SessionId;
  name?: PersonName;
  resume?: Token;
  /** Greatest role of a new participant */
  role?: 'viewer' | 'controller';
}

export interface SessionJoinResult {
  tick: Tick;
  session: SessionId;
  participant: ParticipantId;
  name: string;
  role: Role;
  /** Secret with which a client can resume the participant */
  resume: string;
  /** Whether an existing participant was resumed */
  resumed: boolean;
  settings: Settings;
  participants: Participant[];
  description: SessionDescription;
}
/** Sets who may join, and the default role */
export interface SessionConfigureParams {
  name?: PersonName;
  default_role?: 'viewer' | 'controller';
  locked?: boolean;
  /** Permits the governor to choose among these points, ordered by increasing error. An empty list ends the permission */
  governor?: GovernorPoint[];
}

export interface SessionConfigureResult {
  tick: Tick;
  name: string;
  default_role: 'viewer' | 'controller';
  locked: boolean;
  /** Absent without a permission for the present scene */
  governor?: GovernorPoint[];
}
/** Creates an invitation to the session */
export interface SessionInviteParams {
  role: 'viewer' | 'controller';
  /** Number of uses; default: unlimited */
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
/** Ends a session for all participants */
export interface SessionCloseParams {
  session: SessionId;
}

export interface SessionHashResult {
  tick: Tick;
  hash: Hash;
  instruction_set: InstructionSet;
  device?: Device;
  /** Simulated time [s] */
  time: number;
  /** Number of ticks that the session has run */
  position: number;
}
/** Returns the cost of the session's ticks, and diagnostics */
export interface SessionStatsParams {
  /** Whether to measure diagnostics such as energies, at the cost of about one step; default false */
  diagnostics?: boolean;
}

export interface SessionStatsResult {
  tick: Tick;
  instruction_set: InstructionSet;
  /** Number of threads that step sessions */
  threads: number;
  /** Simulated time [s] */
  time: number;
  /** Achieved simulated seconds per second */
  real_time_factor: number;
  particles: number;
  sleeping_bodies: number;
  /** This and the following members: since the scene was loaded */
  ticks: number;
  /** Including parts of steps and undone steps */
  substeps: number;
  undone_substeps: number;
  device?: Device;
  /** Steps that the device has taken; only if a device takes the steps */
  device_steps?: number;
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
/** Present if requested */
export interface Diagnostics {
  /** [J] */
  kinetic_energy: number;
  /** Relative to the origin [J] */
  gravitational_energy: number;
  /** Energy of static springs and of cells with volume conservation [J] */
  elastic_energy: number;
  /** Energy of contacts between bodies and at walls [J] */
  contact_energy: number;
  momentum: Vector;
  angular_momentum: Vector;
  /** Liquid: mean relative excess above the rest density */
  mean_density_error: number;
  /** Liquid: maximum of this excess */
  max_density_error: number;
  torn_springs: number;
  /** Number since time 0 */
  emitted_particles: number;
  /** Number since time 0 */
  drained_particles: number;
  /** Sum of the torques about the axles of bodies, without brakes; present with axles [N m] */
  axle_torque?: number;
}
/** Saves the session's state under a name */
export interface SessionSaveParams {
  name: PersonName;
}

export interface SessionSaveResult {
  tick: Tick;
  name: string;
  hash: Hash;
  /** Size of the saved state */
  bytes: number;
}
/** Continues from a saved state */
export interface SessionLoadParams {
  name: PersonName;
}

export interface SessionSavesResult {
  tick: Tick;
  states: SavedState[];
}

export interface SavedState {
  name: string;
  /** Name of the participant who saved it */
  saved_by: string;
  /** Time of saving [s since 1970] */
  saved: number;
  /** Tick of the session when it was saved */
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
/** Returns the state of bodies in full precision */
export interface StateQueryParams {
  /** Names or ids; default: all */
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
  /** Positions of the particles in the order of their numbers [m] */
  positions: Vector[];
  /** [m/s] */
  velocities: Vector[];
  /** Particle numbers; absent if no particle was removed */
  numbers?: ParticleNumber[];
  center_of_mass?: Vector;
  orientation?: Quaternion;
  velocity?: Vector;
  angular_velocity?: Vector;
}
/** Returns springs and contacts */
export interface StateConnectionsParams {
  /** Name or id of a body whose springs and contacts are returned; default: all */
  body?: BodyId | Name;
  /** Maximum number of springs, and of contacts; default 2000 */
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
  /** Number of all springs */
  total: number;
  /** Springs are sampled at this interval */
  every: number;
  pairs: ConnectedPairs;
  /** Length divided by rest length, minus 1, for each pair */
  strains: number[];
}

export interface ConnectedContacts {
  /** Number of all contacts */
  total: number;
  /** Contacts are sampled at this interval */
  every: number;
  pairs: ConnectedPairs;
  /** Force along the connecting line [N], for each pair; negative if attractive */
  forces: number[];
}
/** Adds a body */
export interface WorldAddBodyParams {
  body: SceneBody;
  /** Position and motion as in state.query; replaces those in the body */
  state?: ParticleMotion | RigidMotion;
}
/** Motion of each particle of a liquid or deformable body */
export interface ParticleMotion {
  /** [m] */
  positions: Point[];
  /** [m/s] */
  velocities: Motion[];
}
/** Motion of a rigid body */
export interface RigidMotion {
  center_of_mass: Point;
  /** Unit quaternion [w, x, y, z] */
  orientation: [number, number, number, number];
  velocity: Motion;
  angular_velocity: Motion;
}

export interface WorldAddBodyResult {
  tick: Tick;
  body: BodyId;
}
/** Removes a body */
export interface WorldRemoveBodyParams {
  body: BodyId;
}
/** Melts a deformable body */
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
/** Sets the interface of two materials */
export interface WorldSetInterfaceParams {
  interface: SceneInterface;
}
/** Applies a force to a body for some time */
export interface WorldApplyForceParams {
  body: BodyId;
  /** Total force on the body [N] */
  force: [number, number, number];
  /** [s] */
  duration: number;
}
/** Moves a body without changing its shape */
export interface WorldMoveBodyParams {
  body: BodyId;
  position: Point;
  /** Unit quaternion [w, x, y, z] of a rigid body; default: unchanged */
  orientation?: [number, number, number, number];
  /** Velocity of the whole body, which then does not rotate [m/s]; default: unchanged */
  velocity?: [number, number, number];
}
/** Adds a material, or replaces the constants of the material with this name */
export interface WorldSetMaterialParams {
  material: unknown;
}
/** Sets values of the numerics */
export interface WorldSetNumericsParams {
  integrator?: unknown;
  /** [s]; the tick does not change, and must be a whole number of steps */
  step?: number;
  /** Choice of the step lengths */
  control?: 'fixed' | 'adaptive' | 'local';
  /** Relative phase error of adaptive and local steps */
  tolerance?: number;
  /** Of incompressible liquids */
  density_tolerance?: number;
  /** Of incompressible liquids */
  divergence_tolerance?: number;
}
/** Moves the vat by hand */
export interface WorldMoveVatParams {
  offset: Point;
}

/** Parameters and result of each method. */
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
  'scene.levels': { params: SceneLevelsParams; result: SceneLevelsResult };
  'scene.get': { params: SceneGetParams; result: SceneGetResult };
  'scene.load': { params: SceneLoadParams; result: InEffect };
  'scene.save': { params: SceneSaveParams; result: SceneSaveResult };
  'scene.delete': { params: SceneDeleteParams; result: SceneDeleteResult };
  'server.info': { params: Nothing; result: ServerInfoResult };
  'server.sessions': { params: Nothing; result: ServerSessionsResult };
  'server.drain': { params: ServerDrainParams; result: ServerDrainResult };
  'server.move': { params: ServerMoveParams; result: ServerMoveResult };
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

/** Parameters of each event. */
export interface Events {
  'session.description': SessionDescription;
  'session.status': SessionStatus;
  'session.guard': SessionGuard;
  'session.device': SessionDevice;
  'server.draining': ServerDraining;
  'session.diverged': SessionDiverged;
  'replay.ended': ReplayEnded;
  'replay.diverged': Divergence;
  'replay.people': ReplayPeople;
  'session.closed': SessionClosed;
  'session.moved': SessionMoved;
  'session.configured': Settings;
  'governor.switched': GovernorSwitched;
  'presence.changed': PresenceChanged;
  'session.storage': SessionStorage;
  'grab.ended': GrabEnded;
  'notification.rejected': NotificationRejected;
  'control.requested': ControlRequested;
}

export const kEventNames = [
  'session.description',
  'session.status',
  'session.guard',
  'session.device',
  'server.draining',
  'session.diverged',
  'replay.ended',
  'replay.diverged',
  'replay.people',
  'session.closed',
  'session.moved',
  'session.configured',
  'governor.switched',
  'presence.changed',
  'session.storage',
  'grab.ended',
  'notification.rejected',
  'control.requested',
] as const;
