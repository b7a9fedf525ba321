"""simulation_test.py PROGRAM: tests vat.Simulation, and compares it with the program."""

import gc
import re
import signal
import subprocess
import sys
import threading
import unittest

import numpy as np
import vat

PROGRAM = sys.argv.pop(1)

MATERIALS = [
    {"name": "wood", "density": 600},
    {"name": "rubber", "density": 900, "springs": {"structural": {"stiffness": 600, "damping": 1}}},
    {"name": "water", "density": 1000,
     "liquid": {"stiffness": 150, "viscosity": 0.5, "support_radius": 0.1}}]
BALL = {"name": "ball", "kind": "rigid", "material": "wood", "spacing": 0.05,
        "shape": {"type": "sphere", "radius": 0.1}, "position": [0, 0, 1]}
SCENE = {"format": "vat.scene/1", "materials": MATERIALS, "bodies": [BALL]}
BOX = {"min": [-0.5, -0.5, 0], "max": [0.5, 0.5, 1]}
DROP = {"name": "drop", "kind": "liquid", "material": "water", "spacing": 0.05,
        "shape": {"type": "box", "size": [0.2, 0.2, 0.2]}, "position": [0, 0, 0.3]}


def hash_of(scene: str, seconds: float) -> str:
    """Returns the hash that the program prints."""
    done = subprocess.run([PROGRAM, "simulate", scene, "--until", str(seconds), "--hash"],
                          check=True, capture_output=True, text=True)
    found = re.search("^hash ([0-9a-f]{16}) ", done.stdout, re.MULTILINE)
    assert found is not None, done.stdout
    return found[1]


class Steps(unittest.TestCase):
    def test_hashes_are_those_of_the_program(self) -> None:
        for scene in ("dam-break", "rigid-stack", "pour"):
            with self.subTest(scene):
                simulation = vat.Simulation(scene)
                simulation.advance(0.1)
                self.assertEqual(simulation.hash, hash_of(scene, 0.1))

    def test_free_fall(self) -> None:
        simulation = vat.Simulation(SCENE)
        report = simulation.advance(0.5)
        self.assertEqual(report.steps, round(0.5 / simulation.step_size))
        self.assertAlmostEqual(simulation.time, 0.5, 12)
        pose = simulation["ball"].pose
        assert pose is not None
        # g = 9.81 m/s^2; velocity Verlet is exact for a constant acceleration.
        self.assertAlmostEqual(pose.center_of_mass[2], 1 - 9.81 * 0.5**2 / 2, 9)
        self.assertAlmostEqual(pose.velocity[2], -9.81 * 0.5, 9)
        np.testing.assert_allclose(pose.orientation, (1, 0, 0, 0), atol=1e-12)

    def test_a_call_lets_other_threads_run(self) -> None:
        # Without a switch interval, another thread runs only if the call releases the lock.
        interval = sys.getswitchinterval()
        self.addCleanup(sys.setswitchinterval, interval)
        sys.setswitchinterval(1e6)
        simulation = vat.Simulation("dam-break")
        started, ended = threading.Event(), threading.Event()

        def run() -> None:
            started.set()
            simulation.step(400)
            ended.set()

        thread = threading.Thread(target=run)
        thread.start()
        started.wait()
        self.assertFalse(ended.is_set())
        thread.join()

    def test_a_signal_ends_the_steps(self) -> None:
        simulation = vat.Simulation(SCENE)
        running = threading.Event()

        def interrupt() -> None:
            running.wait()
            signal.raise_signal(signal.SIGINT)

        thread = threading.Thread(target=interrupt)
        thread.start()
        with self.assertRaises(KeyboardInterrupt):
            running.set()
            for _ in range(1 << 40):  # also if the signal arrives between two calls
                simulation.step(1000)
        thread.join()
        simulation.step()

    def test_a_failed_step(self) -> None:
        scene = {**SCENE, "gravity": [0, 0, 0], "bodies": [{**BALL, "velocity": [0, 0, 999]}]}
        simulation = vat.Simulation(scene)
        with self.assertRaisesRegex(vat.StepError, "outside_domain.* body 1, at "):
            simulation.advance(2000)
        time = simulation.time
        self.assertGreater(time, 1)  # the domain has 1000 m or more
        with self.assertRaises(vat.StepError):
            simulation.step()
        self.assertEqual(simulation.time, time)


class Views(unittest.TestCase):
    def test_arrays_of_a_body(self) -> None:
        simulation = vat.Simulation({**SCENE, "vat": BOX, "bodies": [BALL, DROP]})
        for body in simulation:
            with self.subTest(body.name):
                count = len(body.masses)
                self.assertEqual(body.positions.shape, (count, 3))
                self.assertEqual(body.velocities.shape, (count, 3))
                self.assertEqual(body.radii.shape, (count,))
                np.testing.assert_array_equal(body.numbers, np.arange(count))
                for array in (body.positions, body.velocities, body.masses, body.radii):
                    self.assertFalse(array.flags.owndata)
                    self.assertFalse(array.flags.writeable)
        drop = simulation["drop"]
        self.assertEqual((drop.kind, drop.material, drop.pose), ("liquid", "water", None))
        self.assertAlmostEqual(drop.masses.sum(), 1000 * 0.2**3, 9)
        error = max(drop.density.max() / 1000 - 1, 0)
        self.assertAlmostEqual(error, simulation.diagnostics().max_density_error, 12)
        self.assertEqual(drop.pressure.shape, drop.masses.shape)
        self.assertEqual([len(simulation), simulation.particle_count],
                         [2, sum(len(body.masses) for body in simulation)])

    def test_two_accesses_show_the_same_memory(self) -> None:
        body = vat.Simulation("dam-break")["column"]
        self.assertEqual(body.positions.ctypes.data, body.positions.ctypes.data)

    def test_a_view_keeps_its_values(self) -> None:
        changes = {
            "step": lambda simulation: simulation.advance(0.1),
            "removal": lambda simulation: simulation.remove_body("drop"),
            "end": lambda simulation: None,
        }
        for name, change in changes.items():
            with self.subTest(name):
                simulation = vat.Simulation({**SCENE, "vat": BOX, "bodies": [BALL, DROP]})
                simulation.advance(0.01)
                drop = simulation["drop"]
                views = [drop.positions, drop.velocities, drop.masses]
                copies = [view.copy() for view in views]
                change(simulation)
                del simulation, drop
                gc.collect()
                for view, copy in zip(views, copies):
                    np.testing.assert_array_equal(view, copy)

    def test_a_new_view_shows_the_new_state(self) -> None:
        simulation = vat.Simulation(SCENE)
        views = []
        for _ in range(3):
            views.append(simulation["ball"].positions[:, 2].mean())
            simulation.advance(0.1)
        self.assertEqual(views, sorted(views, reverse=True))
        self.assertEqual(len(set(views)), 3)

    def test_views_do_not_change_the_steps(self) -> None:
        hashes = set()
        for look in (False, True):
            simulation, views = vat.Simulation("pour"), []
            for _ in range(5):
                simulation.advance(0.02)
                views += [body.positions for body in simulation] if look else []
            hashes.add(simulation.hash)
        self.assertEqual(len(hashes), 1)

    def test_a_removed_body(self) -> None:
        simulation = vat.Simulation(SCENE)
        ball = simulation["ball"]
        simulation.remove_body(ball)
        self.assertNotIn("ball", simulation)
        for use in (lambda: ball.positions, lambda: simulation["ball"], lambda: simulation[1]):
            with self.assertRaises(KeyError):
                use()


class Commands(unittest.TestCase):
    def setUp(self) -> None:
        self.simulation = vat.Simulation({**SCENE, "vat": BOX})

    def test_each_command_changes_the_scene_or_the_state(self) -> None:
        simulation = self.simulation
        cube = {"name": "cube", "kind": "deformable", "material": "rubber", "spacing": 0.05,
                "shape": {"type": "box", "size": [0.1, 0.1, 0.1]}, "position": [0.3, 0.3, 0.2]}
        commands = {
            "add_body": lambda: simulation.add_body(cube),
            "move_body": lambda: simulation.move_body("ball", (0, 0, 0.5), velocity=(0, 1, 0)),
            "set_gravity": lambda: simulation.set_gravity((0, 0, -1.62)),
            "set_material": lambda: simulation.set_material({"name": "wood", "density": 700}),
            "set_interface": lambda: simulation.set_interface(
                {"materials": ["wood", "vat"], "stiffness": 2e4}),
            "set_numerics": lambda: simulation.set_numerics("heun", simulation.step_size / 2),
            "move_vat": lambda: simulation.move_vat((0.1, 0, 0)),
            "apply_force": lambda: simulation.apply_force("ball", (0, 0, 1), 0.1),
            "grab": lambda: simulation.grab("ball", 0, (0, 0, 0.7)),
            "melt_body": lambda: simulation.melt_body("cube", "water"),
            "remove_body": lambda: simulation.remove_body("ball"),
        }
        before = (simulation.hash, simulation.scene)
        for name, command in commands.items():
            command()
            after = (simulation.hash, simulation.scene)
            self.assertNotEqual(after, before, name)
            before = after
        self.assertEqual([body.name for body in simulation], ["cube"])
        self.assertEqual(simulation["cube"].kind, "liquid")

    def test_an_emitter(self) -> None:
        counts = []
        for is_open in (True, False):
            simulation = vat.Simulation("pour")
            for emitter in simulation.scene["emitters"]:
                simulation.set_emitter(emitter["name"], is_open=is_open)
            simulation.advance(0.2)
            counts.append(simulation.diagnostics().emitted_particles)
        self.assertGreater(counts[0], counts[1])

    def test_a_grab_pulls_until_its_release(self) -> None:
        self.simulation.set_gravity((0, 0, 0))
        with self.simulation.grab("ball", 0, (0.2, 0, 1)) as grab:
            self.simulation.advance(0.5)
            grab.move((0.1, 0, 0.9))
            self.simulation.advance(1.5)
            np.testing.assert_allclose(self.simulation["ball"].positions[0], (0.1, 0, 0.9), atol=0.01)
        with self.assertRaisesRegex(vat.InputError, "grab"):
            grab.move((0, 0, 1))

    def test_invalid_commands_change_nothing(self) -> None:
        simulation = self.simulation
        before = simulation.hash
        cases = {
            "no_such_body": lambda: simulation.remove_body(99),
            "missing": lambda: simulation.add_body({"name": "cube"}),
            "unknown_name": lambda: simulation.set_numerics("rk9", 1e-3),
            "out_of_range": lambda: simulation.set_gravity((0, 0, 1e9)),
        }
        for code, command in cases.items():
            with self.subTest(code):
                with self.assertRaises((vat.InputError, KeyError)) as raised:
                    command()
                if isinstance(raised.exception, vat.InputError):
                    self.assertEqual(raised.exception.code, code)
                self.assertEqual(simulation.hash, before)

    def test_wrong_arguments_name_the_argument(self) -> None:
        cases = {
            "gravity must have 3 finite numbers": lambda: self.simulation.set_gravity((0, 0)),
            "gravity must have 3": lambda: self.simulation.set_gravity((0, 0, float("nan"))),
            "force must have 3": lambda: self.simulation.apply_force("ball", "abc", 1),
            "unit quaternion": lambda: self.simulation.move_body(
                "ball", (0, 0, 0.5), orientation=(2, 0, 0, 0)),
            "threads must be from 1 to 256": lambda: vat.Simulation(SCENE, threads=0),
            "steps must be from 0": lambda: self.simulation.step(-1),
        }
        for message, command in cases.items():
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                command()

    def test_an_unknown_integrator_has_a_suggestion(self) -> None:
        with self.assertRaisesRegex(vat.InputError, 'one of .* did you mean "heun"\\?$'):
            self.simulation.set_numerics("huen", 1e-3)


class Scenes(unittest.TestCase):
    def test_faults_name_the_member(self) -> None:
        with self.assertRaises(vat.InputError) as raised:
            vat.Simulation({**SCENE, "bodies": [{**BALL, "spacing": -1, "velocty": [0, 0, 1]}]})
        faults = {fault.path: fault for fault in raised.exception.faults}
        self.assertEqual(faults["/bodies/0/spacing"].code, "out_of_range")
        self.assertEqual(faults["/bodies/0/velocty"].suggestion, "velocity")

    def test_an_unknown_name_has_a_suggestion(self) -> None:
        with self.assertRaisesRegex(vat.InputError, 'did you mean "dam-break"\\?$'):
            vat.Simulation("dam-brake")

    def test_every_scene_of_the_catalogue_loads(self) -> None:
        self.assertIn("sliding-vat-solids", vat.scene_names())
        for name in vat.scene_names():
            with self.subTest(name):
                scene = vat.load_scene(name)
                self.assertEqual(scene["name"], name)

    def test_a_level_changes_the_distance_of_particles(self) -> None:
        coarse, normal = (vat.load_scene("dam-break", level) for level in ("coarse", "normal"))
        self.assertGreater(coarse["bodies"][0]["spacing"], normal["bodies"][0]["spacing"])
        with self.assertRaisesRegex(ValueError, "coarse, normal, fine or finest"):
            vat.load_scene("dam-break", "rough")


class Snapshots(unittest.TestCase):
    def test_a_snapshot_continues_with_the_same_bits(self) -> None:
        simulation = vat.Simulation("pour")
        simulation.advance(0.1)
        saved = simulation.snapshot()
        hashes = [simulation.hash]
        simulation.advance(0.1)
        hashes.append(simulation.hash)
        restored = vat.Simulation("dam-break")
        restored.restore(saved)
        for other in (vat.Simulation.load(saved, threads=2), restored):
            self.assertEqual(other.hash, hashes[0])
            other.advance(0.1)
            self.assertEqual(other.hash, hashes[1])

    def test_damaged_bytes(self) -> None:
        saved = vat.Simulation(SCENE).snapshot()
        for data in (b"", saved[:-1], saved[:50] + b"x" + saved[51:]):
            with self.assertRaises(vat.InputError):
                vat.Simulation.load(data)


class Diagnostics(unittest.TestCase):
    def test_energy_of_a_falling_ball_is_constant(self) -> None:
        simulation = vat.Simulation(SCENE)
        first = simulation.diagnostics()
        simulation.advance(0.3)
        last = simulation.diagnostics()
        self.assertAlmostEqual(last.energy / first.energy, 1, 9)
        self.assertGreater(last.kinetic_energy, first.kinetic_energy)
        ball = last.bodies[0]
        self.assertEqual((ball.name, last.time), ("ball", simulation.time))
        self.assertAlmostEqual(ball.linear_momentum[2], -ball.mass * 9.81 * 0.3, 9)


if __name__ == "__main__":
    unittest.main()
