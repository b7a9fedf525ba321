"""Values that a simulation returns. All units are SI."""

from dataclasses import dataclass

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]  #: unit length, (w, x, y, z)


@dataclass(frozen=True)
class Event:
    """A failed step, which was repeated in parts."""

    cause: str  #: non_finite, outside_domain, too_fast or too_many_pairs
    time: float  #: end of the failed step or part [s]
    body: int  #: id of the body
    particle: int  #: index within the body
    step: float  #: length of the failed step or part [s]
    recovered: bool


@dataclass(frozen=True)
class Advance:
    """Counts of the steps of one call."""

    steps: int  #: including parts of steps and undone steps
    undone_steps: int  #: failed steps, which were repeated in parts
    wall_stops: int  #: corrections of particles and bodies beyond a wall of the vat
    unsolved_drifts: int  #: solves of implicit springs that did not reach the tolerance
    force_evaluations: int  #: of all particles
    particle_evaluations: int  #: of single particles
    events: list[Event]  #: the first failed steps, and the last


@dataclass(frozen=True)
class Pose:
    """Pose and motion of a rigid body."""

    center_of_mass: Vector  #: [m]
    orientation: Quaternion  #: from body axes to world axes
    velocity: Vector  #: of the centre of mass [m/s]
    angular_velocity: Vector  #: world axes [rad/s]


@dataclass(frozen=True)
class BodyDiagnostics:
    """Sums over the particles of a body. In two dimensions, they are per metre of depth."""

    id: int
    name: str
    mass: float  #: [kg]
    center_of_mass: Vector  #: [m]
    linear_momentum: Vector  #: [kg m/s]
    angular_momentum: Vector  #: about the world origin [kg m^2/s]
    outer_force: Vector  #: of walls and other bodies, without gravity [N]
    outer_torque: Vector  #: about the centre of mass [N m]
    orientation: Quaternion | None  #: only of rigid bodies
    angular_velocity: Vector | None  #: only of rigid bodies; world axes [rad/s]


@dataclass(frozen=True)
class Diagnostics:
    """Measurements of the state of a simulation."""

    time: float  #: [s]
    bodies: list[BodyDiagnostics]
    kinetic_energy: float  #: [J]
    gravitational_energy: float  #: [J]
    elastic_energy: float  #: of springs and of cells with a bulk modulus [J]
    contact_energy: float  #: of contacts and walls [J]
    mean_density_error: float  #: of liquids: mean of max(0, density / rest density - 1)
    max_density_error: float  #: of liquids: maximum of density / rest density - 1, at least 0
    axle_torque: float | None  #: sum over the axles [N m]; only of scenes with axles
    torn_springs: int
    particles_outside: int  #: beyond a wall of the vat
    sleeping_bodies: int
    emitted_particles: int  #: since time 0
    drained_particles: int  #: since time 0

    @property
    def energy(self) -> float:
        """Sum of the four energies [J]."""
        return (self.kinetic_energy + self.gravitational_energy + self.elastic_energy
                + self.contact_energy)
