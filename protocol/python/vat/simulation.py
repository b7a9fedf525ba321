"""A simulation in this process."""

import json
import os
import tempfile
from collections.abc import Iterator, Mapping
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from vat import _native
from vat.errors import StepError
from vat.recording import Recording
from vat.results import Advance, BodyDiagnostics, Diagnostics, Event, Pose, Quaternion, Vector
from vat.scenes import SceneSource, scene_text

Numbers = NDArray[np.float64]

PICTURE_SECONDS = 2.0  # simulated time that a notebook shows of a simulation


class Body:
    """A body of a simulation.

    Positions, velocities, masses and radii are read-only arrays without a copy. An array shows the
    state at the time of the access. It keeps its values when the simulation advances.
    """

    def __init__(self, host: _native.Simulation, identity: int) -> None:
        self._host = host
        self.id = identity  #: unique in the simulation

    def __repr__(self) -> str:
        return f"<vat.Body {self.id}: {self.name!r}, {self.kind} {self.material}>"

    @property
    def name(self) -> str:
        return self._host.body_name(self.id)

    @property
    def kind(self) -> str:
        """liquid, deformable or rigid."""
        return self._host.body_kind(self.id)

    @property
    def material(self) -> str:
        return self._host.body_material(self.id)

    @property
    def positions(self) -> Numbers:
        """Positions of the particles, shape (n, 3) [m]."""
        return self._host.body_positions(self.id)

    @property
    def velocities(self) -> Numbers:
        """Velocities of the particles, shape (n, 3) [m/s]."""
        return self._host.body_velocities(self.id)

    @property
    def masses(self) -> Numbers:
        """Masses of the particles, shape (n) [kg]."""
        return self._host.body_masses(self.id)

    @property
    def radii(self) -> Numbers:
        """Radii of the particles, shape (n) [m]."""
        return self._host.body_radii(self.id)

    @property
    def numbers(self) -> NDArray[np.uint32]:
        """Numbers of the particles, shape (n), ascending. The number of a particle never changes,
        also if particles flow in and out.
        """
        return self._host.body_numbers(self.id)

    @property
    def density(self) -> Numbers:
        """SPH density at the particles of a liquid, shape (n) [kg/m^3]. The cost is about that of a
        step. Raises InputError for other kinds.
        """
        return self._host.liquid_fields(self.id)[0]

    @property
    def pressure(self) -> Numbers:
        """Pressure at the particles of a liquid, shape (n) [Pa], as density."""
        return self._host.liquid_fields(self.id)[1]

    @property
    def pose(self) -> Pose | None:
        """Pose and motion of a rigid body. None for other kinds."""
        pose = self._host.body_pose(self.id)
        return None if pose is None else Pose(**pose)

    @property
    def is_asleep(self) -> bool:
        return self._host.body_is_asleep(self.id)


class Simulation:
    """A particle simulation of one scene.

        sim = vat.Simulation("dam-break")
        sim.advance(0.1)
        print(sim["column"].positions.max(axis=0))

    Results have the same bits for any number of threads. Several threads of Python may use a
    simulation; their calls wait for each other, and steps release the interpreter's lock. A command
    takes effect at once. A command or scene that is invalid raises InputError and changes nothing.
    """

    def __init__(self, scene: SceneSource, *, threads: int = 1, instructions: str = "") -> None:
        """Creates the simulation of a scene: a name of the catalogue, a file or a dictionary.

        `threads` is the number of threads of a step, 1 to 256. `instructions` is baseline, avx2 or
        avx512; by default the best set of the machine.
        """
        text, folder = scene_text(scene)
        self._host = _native.Simulation(text, folder, checked_threads(threads), instructions)
        self._last_grab = 0

    @classmethod
    def load(cls, snapshot: bytes, *, threads: int = 1) -> "Simulation":
        """Returns the simulation of a snapshot. It continues with the same bits."""
        simulation = cls.__new__(cls)
        simulation._host = _native.Simulation.load(snapshot, checked_threads(threads))
        simulation._last_grab = 0
        return simulation

    def __repr__(self) -> str:
        return f"<vat.Simulation at {self.time:g} s: {len(self)} bodies, {self.particle_count} particles>"

    # Time

    def advance(self, seconds: float) -> Advance:
        """Advances the simulation by a time [s], rounded to whole steps. Raises StepError if a step
        fails.
        """
        steps = round(seconds / self.step_size)
        if steps < 0:
            raise ValueError("seconds must not be negative")
        return self.step(steps)

    def step(self, steps: int = 1) -> Advance:
        """Takes steps of `step_size`. The scene's step control may divide each step. Raises
        StepError if a step fails.
        """
        if not 0 <= steps < 1 << 53:
            raise ValueError("steps must be from 0 to 2^53 - 1")
        counts = self._host.step(steps)
        events = [Event(**event) for event in counts.pop("events")]
        if counts.pop("failed"):
            last = events[-1]
            raise StepError(f"a step failed ({last.cause}) at particle {last.particle} of the body "
                            f"{last.body}, at {last.time:g} s with a step of {last.step:g} s")
        return Advance(events=events, **counts)

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self._host.time

    @property
    def step_size(self) -> float:
        """Nominal step [s]."""
        return self._host.step_size

    @property
    def tick(self) -> float:
        """Interval of the scene in which a server publishes frames [s]."""
        return self._host.steps_per_tick * self._host.step_size

    # Bodies

    def __getitem__(self, body: str | int) -> Body:
        """Returns the body with a name or an id. Raises KeyError if there is none."""
        identity = body if isinstance(body, int) else self._host.find_body(body)
        if identity is None or not self._host.has_body(identity):
            names = ", ".join(each.name for each in self)
            raise KeyError(f"no body {body!r}; the bodies are {names}")
        return Body(self._host, identity)

    def __iter__(self) -> Iterator[Body]:
        return (Body(self._host, identity) for identity in self._host.body_ids())

    def __len__(self) -> int:
        return len(self._host.body_ids())

    def __contains__(self, body: object) -> bool:
        if isinstance(body, int):
            return self._host.has_body(body)
        return isinstance(body, str) and self._host.find_body(body) is not None

    @property
    def particle_count(self) -> int:
        return self._host.particle_count

    # State

    @property
    def scene(self) -> dict[str, Any]:
        """The scene, with all changes by commands."""
        return cast(dict[str, Any], json.loads(self._host.scene))

    @property
    def hash(self) -> str:
        """Hash of all data that determine the next steps, as `./vat simulate --hash` prints it."""
        return f"{self._host.state_hash:016x}"

    @property
    def arithmetic(self) -> str:
        """Instruction set of the steps. Hashes are equal for equal sets only."""
        return self._host.arithmetic

    def diagnostics(self) -> Diagnostics:
        """Measures the state. The cost is about that of a step."""
        values = self._host.diagnostics()
        bodies = [BodyDiagnostics(**body) for body in values.pop("bodies")]
        return Diagnostics(bodies=bodies, **values)

    def snapshot(self) -> bytes:
        """Returns the state with its scene, for `restore` and `load`."""
        return self._host.snapshot()

    def restore(self, snapshot: bytes) -> None:
        """Continues with the state and the scene of a snapshot of any simulation with the same
        arithmetic.
        """
        self._host.restore(snapshot)

    # Pictures

    def record(self, file: str | os.PathLike[str], seconds: float, *, every: float | None = None,
               max_error: float | None = None) -> Recording:
        """Advances the simulation by a time [s] and writes its frames to a file in .vatrec.

        `every` is the time between two frames [s], by default a tick, rounded to whole steps.
        `max_error` is the greatest error of a position [m], by default a hundredth of the spacing.
        """
        steps = max(1, round((every or self.tick) / self.step_size))
        recorder = _native.Recorder(os.fspath(file), steps * self.step_size, max_error)
        recorder.add(self._host)
        for _ in range(round(seconds / self.step_size) // steps):
            self.step(steps)
            recorder.add(self._host)
        recorder.finish()
        return Recording(file)

    def _repr_html_(self) -> str:
        """Returns a picture of the next PICTURE_SECONDS. The simulation does not advance."""
        with tempfile.TemporaryDirectory() as folder:
            copy = Simulation.load(self.snapshot())
            return copy.record(os.path.join(folder, "picture.vatrec"), PICTURE_SECONDS)._repr_html_()

    # Commands

    def add_body(self, body: Mapping[str, Any], folder: str | os.PathLike[str] = ".") -> Body:
        """Adds a body, described as in a scene file. `folder` has its mesh file."""
        return Body(self._host, self._host.add_body(json.dumps(body), os.fspath(folder)))

    def remove_body(self, body: Body | str | int) -> None:
        self._host.remove_body(self._id(body))

    def move_body(self, body: Body | str | int, center_of_mass: Vector, *,
                  orientation: Quaternion | None = None, velocity: Vector | None = None) -> None:
        """Moves a body to a centre of mass [m]. `orientation` is for rigid bodies only. `velocity`
        [m/s] replaces the velocity of all particles.
        """
        self._host.move_body(self._id(body), center_of_mass, orientation, velocity)

    def melt_body(self, body: Body | str | int, material: str) -> None:
        """Turns a deformable body into a liquid of a material."""
        self._host.melt_body(self._id(body), material)

    def set_material(self, material: Mapping[str, Any]) -> None:
        """Adds a material, or replaces the constants of the material with its name."""
        self._host.set_material(json.dumps(material))

    def set_interface(self, interface: Mapping[str, Any]) -> None:
        """Adds or replaces the interface between two materials."""
        self._host.set_interface(json.dumps(interface))

    def set_gravity(self, gravity: Vector) -> None:
        """Sets gravity [m/s^2]."""
        self._host.set_gravity(gravity)

    def set_numerics(self, integrator: str, step: float) -> None:
        """Sets the integrator and the nominal step [s]. The tick is unchanged."""
        self._host.set_numerics(integrator, step)

    def set_emitter(self, name: str, *, is_open: bool) -> None:
        """Opens or closes an emitter."""
        self._host.set_emitter(name, is_open)

    def move_vat(self, offset: Vector) -> None:
        """Moves the vat to a displacement [m], at a limited speed."""
        self._host.move_vat(offset)

    def apply_force(self, body: Body | str | int, force: Vector, duration: float) -> None:
        """Applies a force [N] to a body, equally to its mass, for a time [s]."""
        self._host.apply_force(self._id(body), force, duration)

    def grab(self, body: Body | str | int, particle: int, target: Vector) -> "Grab":
        """Connects the particle with an index to a target [m] by a critically damped spring."""
        self._last_grab = self._host.grab_start(self._last_grab, self._id(body), particle, target)
        return Grab(self._host, self._last_grab)

    def _id(self, body: Body | str | int) -> int:
        return body.id if isinstance(body, Body) else self[body].id


class Grab:
    """A grabbed particle. As a context manager, it releases the particle at the end."""

    def __init__(self, host: _native.Simulation, identity: int) -> None:
        self._host = host
        self._id = identity

    def move(self, target: Vector) -> None:
        """Moves the target [m]."""
        self._host.grab_move(self._id, target)

    def release(self) -> None:
        self._host.grab_end(self._id)

    def __enter__(self) -> "Grab":
        return self

    def __exit__(self, *_: object) -> None:
        self.release()


def checked_threads(threads: int) -> int:
    if not 1 <= threads <= 256:
        raise ValueError("threads must be from 1 to 256")
    return threads
