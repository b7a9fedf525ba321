// Written from protocol/schemas/ by `npm run types`; not to be edited.

/** [x, y, z] of a position [m] */
export type Place = [number, number, number];
/** [m] */
export type Length = number;

export type Name = string;
/** Any vector except zero */
export type Direction = [number, number, number];
/** [m/s] */
export type Speed = [number, number, number];

export type Interface =
  | {
      /** A spring with a dashpot, and friction */
      law?: 'penalty';
      /** Stiffness [N/m] */
      stiffness: number;
      /** Damping [N s/m] */
      damping?: number;
      /** Separation speed relative to approach speed */
      restitution?: number;
      /** Coulomb coefficient */
      friction?: number;
      /** Names of two materials; one may be "vat" */
      materials: [Name, Name];
      threshold?: Length;
      /** Contact angle [degrees], measured in the liquid */
      contact_angle?: number;
    }
  | {
      /** Repulsion below the threshold, attraction between threshold and reach */
      law: 'lennard_jones';
      /** At the threshold distance [N/m] */
      stiffness: number;
      /** End of the adhesive layer, relative to the threshold */
      reach?: number;
      /** Names of two materials; one may be "vat" */
      materials: [Name, Name];
      threshold?: Length;
      /** Contact angle [degrees], measured in the liquid */
      contact_angle?: number;
    }
  | {
      /** No overlap at the end of a step; friction without creep */
      law: 'projection';
      /** Separation speed relative to approach speed */
      restitution?: number;
      /** Coulomb coefficient */
      friction?: number;
      /** Names of two materials; one may be "vat" */
      materials: [Name, Name];
      threshold?: Length;
      /** Contact angle [degrees], measured in the liquid */
      contact_angle?: number;
    }
  | {
      /** The particles of the solid or wall contribute to the density and pressure of the liquid */
      law: 'sph';
      /** Names of two materials; one may be "vat" */
      materials: [Name, Name];
      /** Contact angle [degrees], measured in the liquid */
      contact_angle?: number;
    };

export type DefaultInterface =
  | {
      /** A spring with a dashpot, and friction */
      law?: 'penalty';
      /** Stiffness [N/m] */
      stiffness: number;
      /** Damping [N s/m] */
      damping?: number;
      /** Separation speed relative to approach speed */
      restitution?: number;
      /** Coulomb coefficient */
      friction?: number;
    }
  | {
      /** Repulsion below the threshold, attraction between threshold and reach */
      law: 'lennard_jones';
      /** At the threshold distance [N/m] */
      stiffness: number;
      /** End of the adhesive layer, relative to the threshold */
      reach?: number;
    }
  | {
      /** No overlap at the end of a step; friction without creep */
      law: 'projection';
      /** Separation speed relative to approach speed */
      restitution?: number;
      /** Coulomb coefficient */
      friction?: number;
    }
  | {
      /** The particles of the solid or wall contribute to the density and pressure of the liquid */
      law: 'sph';
    };

export type Integrator =
  'explicit_euler' | 'symplectic_euler' | 'velocity_verlet' | 'heun' | 'runge_kutta_4';

export type Shape = Box | Sphere | Cylinder | MeshFile | Mesh | Particles;

export type Emitter = {
  name: Name;
  body: Name;
  position: Place;
  direction?: Direction;
  radius?: Length;
  /** Edge lengths of a rectangular opening [m] */
  size?: [Length, Length];
  /** Speed of the liquid [m/s] */
  speed: number;
  /** Start of the flow [s] */
  from?: number;
  /** End of the flow [s] */
  until?: number;
  /** Maximum number of particles of the body */
  most_particles: number;
  /** Whether liquid flows without a command */
  open?: boolean;
} & Emitter1;
export type Emitter1 = {
  [k: string]: unknown;
};


export interface SpringConstants {
  /** Stiffness [N/m] */
  stiffness: number;
  /** Damping [N s/m] */
  damping?: number;
}

export interface Material {
  name: Name;
  /** Density; rest density of a liquid [kg/m^3] */
  density?: number;
  /** Constants of a liquid; required for liquid bodies */
  liquid?: {
    /** The square of the speed of sound [m^2/s^2] */
    stiffness: number;
    /** Dynamic viscosity [Pa s] */
    viscosity: number;
    support_radius: Length;
    /** Alpha of the solver tait; damps the sound of impacts */
    artificial_viscosity?: number;
    /** Surface tension [N/m] */
    surface_tension?: number;
  };
  /** Springs between lattice neighbours of deformable bodies */
  springs?: {
    structural?: SpringConstants;
    shear?: SpringConstants;
    bend?: SpringConstants;
  };
  self_contact?: SpringConstants;
  /** Whether an implicit solve computes the springs of deformable bodies */
  implicit_springs?: boolean;
  /** Plastic springs */
  plasticity?: {
    /** Strain at which plastic flow begins */
    yield_strain: number;
    /** Hardening modulus relative to the stiffness of the spring */
    hardening?: number;
    /** Time in which the stress beyond yield falls to 1/e [s] */
    relaxation_time?: number;
    /** Maximum plastic strain */
    max_strain?: number;
  };
  /** Strain at which springs tear */
  tearing_strain?: number;
  /** Maximum strain of springs */
  elongation_limit?: number;
  /** Resistance of deformable bodies to changes of volume [Pa]; [N/m] in two dimensions */
  bulk_modulus?: number;
  appearance?: Appearance;
}
/** Colour and surface in pictures; absent members follow from the name and the constants of the material */
export interface Appearance {
  /** sRGB */
  colour?: string;
  /** 0: mirror, 1: matt */
  roughness?: number;
  /** 0: dielectric, 1: metal */
  metalness?: number;
  /** 0: transparent, 1: opaque */
  opacity?: number;
  absorption_length?: Length;
  /** Pattern on the surface of a solid */
  finish?: 'none' | 'wood' | 'brick' | 'rubber' | 'steel' | 'clay';
}

export interface Wall {
  /** Whether a viscous liquid has the velocity of the wall at the wall */
  no_slip?: boolean;
  velocity?: Speed;
}

export interface Motion {
  /** Kind of the motion */
  type: 'slide';
  axis?: Direction;
  /** Length of the motion [m] */
  stroke: number;
  /** Period of the motion [s] */
  period?: number;
}

export interface Vat {
  min: Place;
  max: Place;
  /** Whether the vat is closed at the top; otherwise the side walls have unlimited height */
  lid?: boolean;
  motion?: Motion;
  /** Properties of the walls */
  walls?: {
    x_min?: Wall;
    x_max?: Wall;
    y_min?: Wall;
    y_max?: Wall;
    z_min?: Wall;
    z_max?: Wall;
  };
}

export interface Periodic {
  /** Periodic axes */
  axes: ('x' | 'y' | 'z')[];
  min: Place;
  max: Place;
}

export interface Numerics {
  integrator?: Integrator;
  /** Length of a step [s] */
  step?: number;
  /** Time between frames [s], a whole number of steps */
  tick?: number;
  /** fixed: all steps have the length step. adaptive: the whole scene uses shorter steps if necessary. local: each particle does, but liquids of tait and incompressible take whole steps */
  control?: 'fixed' | 'adaptive' | 'local';
  /** Relative error of contacts, and of motions whose period is longer than a step, per radian of oscillation */
  tolerance?: number;
  /** Replaces integrator, step, control and tolerance */
  accuracy?: number;
  /** Device of the steps: the CPU, an OpenCL device of vat devices, or auto for the faster one of the CPU and the first device */
  device?: string;
}

export interface VelocityField {
  center?: Place;
  /** Row i contains the derivatives of component i */
  gradient?: [[number, number, number], [number, number, number], [number, number, number]];
  /** Plane waves */
  waves?: {
    /** Amplitude [m/s] */
    amplitude: [number, number, number];
    /** Wave vector [rad/m] */
    wave_vector: [number, number, number];
    /** Phase [rad] */
    phase?: number;
  }[];
}

export interface DisplacementField {
  center?: Place;
  /** Row i contains the derivatives of component i */
  gradient?: [[number, number, number], [number, number, number], [number, number, number]];
  /** Plane waves */
  waves?: {
    /** Amplitude [m] */
    amplitude: [number, number, number];
    /** Wave vector [rad/m] */
    wave_vector: [number, number, number];
    /** Phase [rad] */
    phase?: number;
  }[];
}

export interface Box {
  /** A box */
  type: 'box';
  center?: Place;
  /** Edge lengths [m] */
  size: [Length, Length, Length];
}

export interface Sphere {
  /** A sphere */
  type: 'sphere';
  center?: Place;
  radius: Length;
}

export interface Cylinder {
  /** A cylinder */
  type: 'cylinder';
  center?: Place;
  axis?: Direction;
  radius: Length;
  height: Length;
}

export interface MeshFile {
  /** A closed mesh of triangles in a file */
  type: 'mesh';
  /** Path below the scene file's folder; not in a message */
  file: string;
  /** Factor of the coordinates in the file */
  scale?: number;
}

export interface Mesh {
  /** A closed mesh of triangles */
  type: 'mesh';
  /** Positions of the vertices [m] */
  vertices: Place[];
  /** Three indices of vertices for each triangle */
  triangles: [number, number, number][];
  /** Name of the mesh in messages */
  source?: string;
}

export interface Particles {
  /** Single particles */
  type: 'particles';
  /** Positions in the frame of the body [m] */
  positions: Place[];
  /** Velocities [m/s] */
  velocities?: Speed[];
  /** Masses [kg] */
  masses?: number[];
  /** Radii [m] */
  radii?: Length[];
  /** Indices of fixed particles */
  fixed?: number[];
}

export interface Spring {
  /** Indices of both particles */
  particles: [number, number];
  /** Stiffness [N/m] */
  stiffness: number;
  /** Damping [N s/m] */
  damping?: number;
  /** Length without force [m]; by default the initial distance */
  rest_length?: number;
}

export interface Body {
  name: Name;
  /** Kind of the body */
  kind: 'liquid' | 'deformable' | 'rigid';
  material: Name;
  shape: Shape;
  spacing?: Length;
  /** Mass of the whole body [kg] */
  mass?: number;
  radius?: Length;
  position?: Place;
  /** Orientation of the frame as a unit quaternion [w, x, y, z] */
  orientation?: [number, number, number, number];
  velocity?: Speed;
  /** Angular velocity about the centre of mass, in world axes [rad/s] */
  angular_velocity?: [number, number, number];
  /** Further springs of a deformable body */
  springs?: Spring[];
  velocity_field?: VelocityField;
  displacement_field?: DisplacementField;
  /** Relative to the spacing */
  jitter?: number;
  /** Number of the random sequence of jitter */
  seed?: number;
  /** Whether a rigid body is held permanently */
  fixed?: boolean;
  /** Time until which a rigid body is held [s] */
  release?: number;
  /** Least number of parts of a step with local steps, rounded up to a power of two; not for liquids */
  sub_steps?: number;
  /** A deformable body melts */
  melting?: {
    into: Name;
    /** Time of melting [s] */
    at: number;
  };
  motion?: Motion;
  /** A rigid body rotates only about an axle through its centre of mass */
  axle?: {
    direction?: Direction;
    /** Damping of a brake [N m s] */
    damping?: number;
  };
}

export interface Drain {
  name: Name;
  min: Place;
  max: Place;
}
/** A scene file, or the scene of a message; protocol/SCENE.md describes all members */
export interface Scene {
  /** Address of this schema, for editors */
  $schema?: string;
  /** Version of the format */
  format: 'vat.scene/1';
  /** Name of the scene; by default the name of the file */
  name?: string;
  /** Title for people */
  title?: string;
  /** Description for people */
  description?: string;
  /** Acceleration [m/s^2] */
  gravity?: [number, number, number];
  /** Materials of the bodies */
  materials: Material[];
  default_interface?: DefaultInterface;
  /** Contacts of pairs of materials */
  interfaces?: Interface[];
  vat?: Vat;
  periodic?: Periodic;
  /** Liquid solver */
  pressure_solver?: 'gas' | 'tait' | 'incompressible';
  /** Smoothing kernel of tait and incompressible */
  kernel?: 'wendland_c2' | 'cubic_spline';
  /** Precision of the sums over pairs of tait and incompressible */
  pair_precision?: 'single' | 'double';
  /** Whether the solver gas uses half of the pressure force */
  printed_pressure_force?: boolean;
  /** Model of surface tension */
  surface_tension_model?: 'curvature' | 'cohesion';
  /** Tolerances of the solver incompressible */
  incompressible?: {
    /** Mean relative excess of the density at the end of a step */
    density_tolerance?: number;
    /** Mean relative change of the density by the velocities in a step */
    divergence_tolerance?: number;
    /** Maximum number of iterations of each linear solve */
    most_iterations?: number;
  };
  /** 3, or 2 for a scene in the plane y = 0 */
  dimensions?: 2 | 3;
  /** Acceleration towards a centre, proportional to the distance */
  central_field?: {
    center?: Place;
    /** Angular frequency of the oscillation about the centre [rad/s] */
    angular_frequency: number;
  };
  /** Initial drag on liquid particles */
  settling?: {
    /** Drag coefficient per mass [1/s] */
    drag: number;
    /** End of the drag [s] */
    until: number;
  };
  /** Bodies below a speed sleep until something moves them */
  sleeping?: {
    /** Speed below which bodies fall asleep [m/s] */
    speed?: number;
    /** Time below this speed [s] */
    after?: number;
  };
  /** Inflow of liquid */
  emitters?: Emitter[];
  /** Boxes that remove liquid particles */
  drains?: Drain[];
  /** Switches of forces */
  forces?: {
    /** Gravity and the central field */
    gravity?: boolean;
    /** Pressure of liquids */
    pressure?: boolean;
    /** Viscosity of liquids, including no-slip walls */
    viscosity?: boolean;
    /** Springs of deformable bodies */
    springs?: boolean;
    /** Interfaces between bodies, and contact of a body with itself */
    contacts?: boolean;
    /** Walls of the vat */
    walls?: boolean;
  };
  numerics?: Numerics;
  /** The bodies */
  bodies: Body[];
}
