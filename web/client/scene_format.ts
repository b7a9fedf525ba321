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
      law?: 'penalty';
      /** [N/m] */
      stiffness: number;
      /** [N s/m] */
      damping?: number;
      restitution?: number;
      /** Coulomb coefficient */
      friction?: number;
      /** Names of two materials; one may be "vat" */
      materials: [Name, Name];
      threshold?: Length;
      /** [degrees] */
      contact_angle?: number;
    }
  | {
      law: 'lennard_jones';
      /** At the threshold distance [N/m] */
      stiffness: number;
      /** End of the adhesive layer, relative to the threshold */
      reach?: number;
      /** Names of two materials; one may be "vat" */
      materials: [Name, Name];
      threshold?: Length;
      /** [degrees] */
      contact_angle?: number;
    }
  | {
      law: 'projection';
      restitution?: number;
      /** Coulomb coefficient */
      friction?: number;
      /** Names of two materials; one may be "vat" */
      materials: [Name, Name];
      threshold?: Length;
      /** [degrees] */
      contact_angle?: number;
    }
  | {
      law: 'sph';
      /** Names of two materials; one may be "vat" */
      materials: [Name, Name];
      /** [degrees] */
      contact_angle?: number;
    };

export type DefaultInterface =
  | {
      law?: 'penalty';
      /** [N/m] */
      stiffness: number;
      /** [N s/m] */
      damping?: number;
      restitution?: number;
      /** Coulomb coefficient */
      friction?: number;
    }
  | {
      law: 'lennard_jones';
      /** At the threshold distance [N/m] */
      stiffness: number;
      /** End of the adhesive layer, relative to the threshold */
      reach?: number;
    }
  | {
      law: 'projection';
      restitution?: number;
      /** Coulomb coefficient */
      friction?: number;
    }
  | {
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
  
  size?: [Length, Length];
  /** [m/s] */
  speed: number;
  /** [s] */
  from?: number;
  /** [s] */
  until?: number;
  most_particles: number;
  open?: boolean;
} & Emitter1;
export type Emitter1 = {
  [k: string]: unknown;
};


export interface SpringConstants {
  /** [N/m] */
  stiffness: number;
  /** [N s/m] */
  damping?: number;
}

export interface Material {
  name: Name;
  /** [kg/m^3] */
  density?: number;
  liquid?: {
    /** The square of the speed of sound [m^2/s^2] */
    stiffness: number;
    /** [Pa s] */
    viscosity: number;
    support_radius: Length;
    artificial_viscosity?: number;
    /** [N/m] */
    surface_tension?: number;
  };
  /** Springs between lattice neighbours of deformable bodies */
  springs?: {
    structural?: SpringConstants;
    shear?: SpringConstants;
    bend?: SpringConstants;
  };
  self_contact?: SpringConstants;
  implicit_springs?: boolean;
  plasticity?: {
    yield_strain: number;
    hardening?: number;
    /** [s] */
    relaxation_time?: number;
    max_strain?: number;
  };
  tearing_strain?: number;
  elongation_limit?: number;
  /** [Pa] */
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
  no_slip?: boolean;
  velocity?: Speed;
}

export interface Motion {
  type: 'slide';
  axis?: Direction;
  /** [m] */
  stroke: number;
  /** [s] */
  period?: number;
}

export interface Vat {
  min: Place;
  max: Place;
  lid?: boolean;
  motion?: Motion;
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
  axes: ('x' | 'y' | 'z')[];
  min: Place;
  max: Place;
}

export interface Numerics {
  integrator?: Integrator;
  /** [s] */
  step?: number;
  /** [s] */
  tick?: number;
  control?: 'fixed' | 'adaptive' | 'local';
  tolerance?: number;
  /** Replaces integrator, step, control and tolerance */
  accuracy?: number;
}

export interface VelocityField {
  center?: Place;
  /** Row i contains the derivatives of component i */
  gradient?: [[number, number, number], [number, number, number], [number, number, number]];
  waves?: {
    
    amplitude: [number, number, number];
    
    wave_vector: [number, number, number];
    /** [rad] */
    phase?: number;
  }[];
}

export interface DisplacementField {
  center?: Place;
  /** Row i contains the derivatives of component i */
  gradient?: [[number, number, number], [number, number, number], [number, number, number]];
  waves?: {
    
    amplitude: [number, number, number];
    
    wave_vector: [number, number, number];
    /** [rad] */
    phase?: number;
  }[];
}

export interface Box {
  type: 'box';
  center?: Place;
  
  size: [Length, Length, Length];
}

export interface Sphere {
  type: 'sphere';
  center?: Place;
  radius: Length;
}

export interface Cylinder {
  type: 'cylinder';
  center?: Place;
  axis?: Direction;
  radius: Length;
  height: Length;
}

export interface MeshFile {
  type: 'mesh';
  /** Path below the scene file's folder; not in a message */
  file: string;
  scale?: number;
}

export interface Mesh {
  type: 'mesh';
  vertices: Place[];
  triangles: [number, number, number][];
  /** Name of the mesh in messages */
  source?: string;
}

export interface Particles {
  type: 'particles';
  positions: Place[];
  velocities?: Speed[];
  masses?: number[];
  radii?: Length[];
  fixed?: number[];
}

export interface Spring {
  
  particles: [number, number];
  /** [N/m] */
  stiffness: number;
  /** [N s/m] */
  damping?: number;
  /** [m] */
  rest_length?: number;
}

export interface Body {
  name: Name;
  kind: 'liquid' | 'deformable' | 'rigid';
  material: Name;
  shape: Shape;
  spacing?: Length;
  /** Mass of the whole body [kg] */
  mass?: number;
  radius?: Length;
  position?: Place;
  /** [w, x, y, z] */
  orientation?: [number, number, number, number];
  velocity?: Speed;
  /** [rad/s] */
  angular_velocity?: [number, number, number];
  springs?: Spring[];
  velocity_field?: VelocityField;
  displacement_field?: DisplacementField;
  /** Relative to the spacing */
  jitter?: number;
  seed?: number;
  fixed?: boolean;
  /** [s] */
  release?: number;
  melting?: {
    into: Name;
    /** [s] */
    at: number;
  };
  motion?: Motion;
  axle?: {
    direction?: Direction;
    /** [N m s] */
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
  format: 'vat.scene/1';
  name?: string;
  title?: string;
  description?: string;
  /** [m/s^2] */
  gravity?: [number, number, number];
  materials: Material[];
  default_interface?: DefaultInterface;
  interfaces?: Interface[];
  vat?: Vat;
  periodic?: Periodic;
  pressure_solver?: 'gas' | 'tait' | 'incompressible';
  kernel?: 'wendland_c2' | 'cubic_spline';
  pair_precision?: 'single' | 'double';
  printed_pressure_force?: boolean;
  surface_tension_model?: 'curvature' | 'cohesion';
  incompressible?: {
    density_tolerance?: number;
    divergence_tolerance?: number;
    most_iterations?: number;
  };
  dimensions?: 2 | 3;
  central_field?: {
    center?: Place;
    /** [rad/s] */
    angular_frequency: number;
  };
  settling?: {
    /** [1/s] */
    drag: number;
    /** [s] */
    until: number;
  };
  sleeping?: {
    /** [m/s] */
    speed?: number;
    /** [s] */
    after?: number;
  };
  emitters?: Emitter[];
  drains?: Drain[];
  forces?: {
    gravity?: boolean;
    pressure?: boolean;
    viscosity?: boolean;
    springs?: boolean;
    contacts?: boolean;
    walls?: boolean;
  };
  numerics?: Numerics;
  bodies: Body[];
}
