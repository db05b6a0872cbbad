"""Systems whose functions are written in Python: closed forms, systems of the catalogue, errors, signals, memory."""
import gc
import math
import signal
import subprocess
import sys
import traceback
import unittest
import weakref

import numpy as np

import hybrid_sphere
from hybrid_sphere import Number, System
from patience import PATIENCE, let_pass


def sleigh(m=2, I=0.75, a=0.4, t_switch=0.5):  # noqa: E741
    def lagrangian(t, q, v):
        V_x = v[0] - a * v[2] * np.sin(q[2])
        V_y = v[1] + a * v[2] * np.cos(q[2])
        return m / 2 * (V_x**2 + V_y**2) + I / 2 * v[2] ** 2
    system = System(["x", "y", "theta"], lagrangian)
    return system.constrain("blade", lambda t, q, v: v[1] * np.cos(q[2]) - v[0] * np.sin(q[2]), begin=t_switch)


def oscillator(forces=None):
    return System(["x"], lambda t, q, v: (v @ v - q @ q) / 2, forces)


def ball(restitution=0.5):
    return System(["x", "z"], lambda t, q, v: v @ v / 2 - 10 * q[1]).unilateral("floor", lambda t, q: q[1], restitution)


class Quality(unittest.TestCase):
    def test_the_error_is_estimated(self):
        motion = oscillator().solve(10, [1], [0], accuracy=1e-6)
        end = motion.at(10)
        self.assertEqual(motion.estimated_error, end.estimated_error)
        self.assertLess(motion.estimated_error, 1e-6)
        self.assertLess(abs(end.x - np.cos(10)), motion.estimated_error)
        early, late = motion.at([5, 10])["estimated_error"]
        self.assertLess(early, late)

    def test_an_accuracy_that_is_not_assured_is_reported(self):
        self.assertGreater(oscillator().solve(100, [1], [0], accuracy=1e-13).estimated_error, 1e-13)

    def test_a_contact_that_a_step_has_missed_is_reported(self):
        flight = System(["x", "z"], lambda t, q, v: v @ v / 2)
        flight.unilateral("pillar", lambda t, q: q[1] - np.exp(-((q[0] - 5) / 0.01) ** 2))
        motion = flight.solve(10, [0, 0.5], [1, 0])
        self.assertEqual(motion.at([4.0, 5.0, 6.0])["penetrating"].tolist(), ["", "pillar", ""])
        plant = hybrid_sphere.Plant(flight, [0, 0.5], [1, 0])
        plant.advance(5)
        self.assertEqual(plant.state.penetrating, "pillar")


class SameAsTheCatalogue(unittest.TestCase):
    def check(self, system, name, tolerance=1e-11, **parameters):
        known = hybrid_sphere.catalogue(name, **parameters)
        wanted, got = known.solve(accuracy=1e-12), system.solve(known.duration, known.q, known.v, accuracy=1e-12)
        self.assertEqual((got.reason, got.end), (wanted.reason, wanted.end))
        times = np.linspace(0, got.end, 101)
        # At a switch rounding decides whether a sample comes before it.
        times = times[np.all(np.abs(np.subtract.outer(times, wanted.switches["t"])) > 1e-9, axis=1)]
        for mine, theirs in ((got.at(times), wanted.at(times)), (got.switches, wanted.switches)):
            self.assertEqual(mine.dtype.names, theirs.dtype.names)
            self.assertEqual(len(mine), len(theirs))
            for column in mine.dtype.names:
                if mine[column].dtype.kind == "U":
                    self.assertEqual(list(mine[column]), list(theirs[column]), column)
                else:
                    scale = 1 + np.abs(theirs[column].astype(float)).max()
                    np.testing.assert_allclose(mine[column], theirs[column], 0, tolerance * scale, column)
        return got

    def test_chaplygins_sleigh(self):
        self.check(sleigh(), "chaplygin_sleigh")

    def test_a_skate(self):
        m, I, gs = 1.25, 0.3, 4  # noqa: E741
        skate = System(["x", "y", "theta"],
                       lambda t, q, v: m / 2 * (v[0]**2 + v[1]**2) + I / 2 * v[2]**2 + m * gs * q[0])
        skate.constrain("blade", lambda t, q, v: v[0] * np.sin(q[2]) - v[1] * np.cos(q[2]), begin=0.5)
        self.check(skate, "knife_edge_incline")

    def test_two_functions_and_an_array_for_them(self):
        m, R, I, J = 2, 0.5, 0.25, 0.125  # noqa: E741
        mass = np.diag([m, m, J, I])
        disk = System(("x", "y", "theta", "phi"), lambda t, q, v: v @ mass @ v / 2)
        disk.constrain("rolling", lambda t, q, v: v[:2] - R * v[3] * np.array([np.cos(q[2]), np.sin(q[2])]), begin=0.5)
        self.check(disk, "rolling_disk")

    def test_a_nonlinear_constraint(self):
        particle = System(["x", "y"], lambda t, q, v: 2 / 2 * np.dot(v, v) - 2 * 5 * q[1])
        particle.constrain("speed", lambda t, q, v: v @ v - 9, begin=0.5)
        self.check(particle, "constant_speed")

    def test_quasi_velocities_and_a_guard(self):
        values = hybrid_sphere.catalogue("paper_sphere_quasi").parameters
        m, R, k, edge = (values[name] for name in ("m", "R", "k", "edge"))

        def rate(q, v):
            w, x, y, z = q[2:]
            return [v[0], v[1], *(0.5 * np.array([-(v[2] * x + v[3] * y + v[4] * z), v[2] * w + v[3] * z - v[4] * y,
                                                  v[3] * w + v[4] * x - v[2] * z, v[4] * w + v[2] * y - v[3] * x]))]

        def normalize(q):
            return np.append(q[:2], q[2:] / np.linalg.norm(q[2:]))
        sphere = System(["x", "y", "qw", "qx", "qy", "qz"],
                        lambda t, q, v: m / 2 * (v[:2] @ v[:2] + k**2 * (v[2:] @ v[2:])),
                        velocities=["x_dot", "y_dot", "w1", "w2", "w3"], rate=rate, normalize=normalize)
        sphere.constrain("rolling", lambda t, q, v: (v[0] - R * v[3], v[1] + R * v[2]),
                         while_positive=lambda t, q: q[0] - edge)
        self.check(sphere, "paper_sphere_quasi")


class ClosedForms(unittest.TestCase):
    def test_oscillator_with_time_in_everything(self):
        # L = (1 + t^2)(v^2/2): (1 + t^2) v constant, x = v0 atan t; Q = -2 t: (1 + t^2) v = v0 - t^2
        system = System(["x"], lambda t, q, v: (1 + t**2) * v[0]**2 / 2, lambda t, q, v: [-2 * t])
        end = system.solve(2, [0], [3], accuracy=1e-12).at(2)
        self.assertAlmostEqual(end.x_dot, (3 - 4) / 5, 11)
        self.assertAlmostEqual(end.x, 4 * math.atan(2) - 2, 11)

    def test_a_pendulum_in_either_coordinates(self):
        length, g = 0.7, 9.81
        angle = System(["phi"], lambda t, q, v: length**2 * v[0]**2 / 2 + g * length * np.cos(q[0]))
        place = System(["x", "y"], lambda t, q, v: v @ v / 2 - g * q[1])
        place.holonomic("rod", lambda t, q: q @ q - length**2)
        times = np.linspace(0, 3, 31)
        a = angle.solve(3, [1.2], [0.5], accuracy=1e-12).at(times)
        start = length * np.array([math.sin(1.2), -math.cos(1.2)])
        way = length * np.array([math.cos(1.2), math.sin(1.2)])
        b = place.solve(3, start, 0.5 * way, accuracy=1e-12).at(times)
        np.testing.assert_allclose(b["x"], length * np.sin(a["phi"]), 0, 1e-10)
        np.testing.assert_allclose(b["y"], -length * np.cos(a["phi"]), 0, 1e-10)
        self.assertLess(b["residual"].max(), 1e-12)

    def test_a_bouncing_ball(self):
        motion = ball(0.5).solve(3, [0, 5], [1, 0])
        # Falls 1 s, then hops of 2 v/g with v = 10, 5, 2.5, ...: after 1, 2, 2.5, 2.75, ... s, up to 3 s
        np.testing.assert_allclose(motion.switches["t"][:4], [1, 2, 2.5, 2.75], 0, 1e-8)
        np.testing.assert_allclose(motion.switches["z_dot_after"][:3], [5, 2.5, 1.25], 0, 1e-7)
        np.testing.assert_allclose(motion.switches["Lambda_floor"][:3], [15, 7.5, 3.75], 0, 1e-7)

    def test_friction_under_a_load_and_at_a_contact(self):
        # m v' = -mu N: stops after v/(mu g) at v^2/(2 mu g), and stays.
        free = System(["x"], lambda t, q, v: v[0]**2 / 2)
        free.friction("ground", lambda t, q, v: v[0], 0.2, load=lambda t, q, v: 10)
        on_floor = ball(0).friction("ground", lambda t, q, v: v[0], 0.2, contact="floor")
        for motion in (free.solve(3, [0], [2]), on_floor.solve(3, [0, 0], [2, 0])):
            np.testing.assert_allclose(motion.at([1, 1.5, 3])["x"], [1, 1, 1], 0, 1e-8)
            self.assertEqual([("+ground" in s, "ground" in a) for s, a in zip(motion.at([0.5, 2])["sliding"],
                                                                             motion.at([0.5, 2])["active"])],
                             [(True, False), (False, True)])

    def test_friction_along_a_plane(self):
        # Deceleration mu N against the slip in every direction; from rest it takes the larger static coefficient.
        block = System(["x", "y"], lambda t, q, v: v @ v / 2)
        block.friction("ground", lambda t, q, v: v, 0.2, load=lambda t, q, v: 10)
        motion = block.solve(3, [0, 0], [1.2, 1.6])
        np.testing.assert_allclose([motion.at(3.0)[key] for key in ("x", "y")], [0.6, 0.8], 0, 1e-9)
        self.assertEqual(motion.at(0.5)["sliding"], "ground")
        pushed = System(["x", "y"], lambda t, q, v: v @ v / 2 + t * (0.6 * q[0] + 0.8 * q[1]))
        pushed.friction("ground", lambda t, q, v: v, 0.2, load=lambda t, q, v: 10, static_coefficient=0.3)
        motion = pushed.solve(5, [0, 0], [0, 0])
        np.testing.assert_allclose(motion.switches["t"], [3], 0, 1e-9)
        speed = (25 - 9) / 2 - 2 * (5 - 3)
        np.testing.assert_allclose([motion.at(5.0)[key] for key in ("x_dot", "y_dot")], [0.6 * speed, 0.8 * speed],
                                   0, 1e-8)
        with self.assertRaisesRegex(ValueError, "static_coefficient: 0.1 is refused; allowed: coefficient or more"):
            oscillator().friction("f", lambda t, q, v: v[0], 0.2, load=lambda t, q, v: 1, static_coefficient=0.1)

    def test_events_and_resets(self):
        system = oscillator().event("left", lambda t, q, v: q[0], "falling")
        system.event("top", lambda t, q, v: v[0], "either")
        motion = system.solve(7, [1], [0])
        self.assertEqual([name for name in motion.switches["events"] if name],
                         list(motion.switches["events"]))
        left = motion.switches[motion.switches["events"] == "left"]
        np.testing.assert_allclose(left["t"], [math.pi / 2], 0, 1e-8)
        kicked = oscillator().event("left", lambda t, q, v: q[0], "falling", lambda t, q, v: -v)
        motion = kicked.solve(3, [1], [0])
        np.testing.assert_allclose(motion.switches["t"], [math.pi / 2], 0, 1e-8)
        self.assertAlmostEqual(motion.switches[0].x_dot_after, 1, 8)

    def test_an_interval_and_a_guard_together(self):
        system = System(["x", "y"], lambda t, q, v: v @ v / 2)
        system.constrain("rail", lambda t, q, v: v[1], begin=1, end=2, while_positive=lambda t, q: 1.5 - q[0])
        motion = system.solve(3, [0, 0], [1, 1])
        np.testing.assert_allclose(motion.switches["t"], [1, 1.5], 0, 1e-12)
        self.assertEqual(list(motion.switches["applied"]), ["rail", ""])

    def test_input_is_a_force_in_the_lagrangian(self):
        def lagrangian(t, q, v):
            return v[0]**2 + v[0] * v[1] + v[1]**2 - q[0]**2 / 2
        with_force = System(["a", "b"], lambda t, q, v: lagrangian(t, q, v) + 0.25 * q[0] - 1.5 * q[1])
        without = System(["a", "b"], lagrangian)
        plant = hybrid_sphere.Plant(without, [0.3, -0.2], [1, 0.5], input=True)
        plant.set_input([0.25, -1.5])
        plant.advance(2)
        end = with_force.solve(2, [0.3, -0.2], [1, 0.5]).at(2)
        for name in ("a", "b", "a_dot", "b_dot"):
            self.assertAlmostEqual(plant.state[name], end[name], 9)

    def test_any_periods_give_the_same_switches(self):
        whole = hybrid_sphere.Plant(ball(0.5), [0, 5], [1, 0])
        whole.advance(2.9)
        for steps in (3, 50):
            plant = hybrid_sphere.Plant(ball(0.5), [0, 5], [1, 0])
            for time_reached in np.linspace(0, 2.9, steps + 1)[1:]:
                plant.advance(time_reached)
            self.assertEqual(plant.switches.tobytes(), whole.switches.tobytes())
            self.assertEqual(plant.state, whole.state)

    def test_events_of_ones_own_on_a_system_of_the_catalogue(self):
        system = hybrid_sphere.catalogue("chaplygin_sleigh").event("turned", lambda t, q, v: q[2] - 1, "rising")
        system.constrain("wall", lambda t, q, v: v[0], begin=3.5)
        motion = system.solve()
        self.assertEqual([str(e) for e in motion.switches["events"]], ["turned", "", ""])
        self.assertEqual(motion.at(3.8).active, "blade;wall")


class Refusals(unittest.TestCase):
    def test_exceptions_of_functions_come_out_as_they_are(self):
        class Own(BaseException):
            pass

        def fail(t, q, v):
            if t > 0.5:
                raise Own("at", t)
            return [0.0]
        for ask in (lambda: oscillator(fail).solve(2, [1], [0]),
                    lambda: hybrid_sphere.Plant(oscillator(fail), [1], [0]).run([0.25, 2])):
            try:
                ask()
                self.fail("nothing is raised")
            except Own as error:
                self.assertGreater(error.args[1], 0.5)
                self.assertIn("fail", [frame.name for frame in traceback.extract_tb(error.__traceback__)])

    def test_every_function_may_raise(self):
        def fail(*arguments):
            raise KeyError("mine")
        for make in (lambda: System(["x"], fail), lambda: oscillator(fail), lambda: oscillator().constrain("f", fail),
                     lambda: oscillator().holonomic("f", fail), lambda: oscillator().unilateral("f", fail),
                     lambda: oscillator().constrain("f", lambda t, q, v: v[0], while_positive=fail),
                     lambda: oscillator().event("f", fail),
                     lambda: oscillator().friction("f", lambda t, q, v: v[0], 1, load=fail),
                     lambda: System(["x"], lambda t, q, v: v[0]**2, velocities=["u"], rate=fail),
                     lambda: System(["x"], lambda t, q, v: v[0]**2, normalize=fail)):
            with self.assertRaisesRegex(KeyError, "mine"):
                make().solve(1, [1], [0.5], project=True)

    def test_wrong_results_name_the_function(self):
        for make, function in (
                (lambda wrong: System(["x"], lambda t, q, v: wrong), "lagrangian"),
                (lambda wrong: oscillator(lambda t, q, v: wrong), "forces"),
                (lambda wrong: oscillator().constrain("f", lambda t, q, v: wrong), "constraint f"),
                (lambda wrong: oscillator().unilateral("f", lambda t, q: wrong), "f"),
                (lambda wrong: oscillator().event("f", lambda t, q, v: wrong), "event f")):
            for wrong in ("1", None, [], [[1.0]], np.zeros((2, 3)), [None], {}, [1j]):
                with self.assertRaisesRegex((ValueError, TypeError), function, msg=(function, wrong)):
                    make(wrong).solve(1, [1], [0.5])
        for make in (lambda: System(["x"], lambda t, q, v: v @ v / 2, lambda t, q, v: [1, 2]),
                     lambda: System(["x", "y"], lambda t, q, v: v)):
            system = make()
            with self.assertRaisesRegex(ValueError, "returns"):
                system.solve(1, np.ones(len(system.coordinates)), np.ones(len(system.coordinates)))

    def test_what_is_not_finite_ends_the_motion(self):
        def late(t, value):
            return float("nan") if t > 1 else value
        for system, function in ((oscillator(lambda t, q, v: [late(t, 0)]), "forces"),
                                 (System(["x"], lambda t, q, v: late(t, v @ v / 2)), "lagrangian"),
                                 (System(["x"], lambda t, q, v: v @ v / 2 * np.sqrt(late(t, 1))), "lagrangian")):
            motion = system.solve(2, [1], [1])
            self.assertEqual(motion.reason, "not_finite")
            self.assertIn(function, motion.message)
            self.assertLess(abs(motion.end - 1), 0.1)

    def test_numbers_of_another_call_are_refused(self):
        kept = []

        def lagrangian(t, q, v):
            kept.append(v[0])
            return v[0]**2 / 2 + kept[0]
        with self.assertRaisesRegex(ValueError, "call"):
            System(["x"], lagrangian).solve(1, [1], [0])

    def test_systems_that_make_no_sense(self):
        L = lambda t, q, v: v @ v  # noqa: E731
        for make in (lambda: System([], L), lambda: System(["x", "x"], L), lambda: System(["x", ""], L),
                     lambda: System(["x"], L, velocities=["a", "b"]), lambda: System(["x"], L, rate=lambda q, v: v),
                     lambda: oscillator().constrain("", L), lambda: oscillator().constrain("f", L).holonomic("f", L),
                     lambda: oscillator().unilateral("f", L, 2), lambda: oscillator().friction("f", L, 1),
                     lambda: oscillator().friction("f", L, 1, contact="g"), lambda: oscillator().event("e", L, "down"),
                     lambda: oscillator().event("e", L).event("e", L), lambda: oscillator().solve(1),
                     lambda: System(["t"], L).solve(1, [1], [1]), lambda: oscillator().solve(q=[1], v=[1]),
                     lambda: oscillator().constrain("f", lambda t, q, v: v[0], begin=2, end=1).solve(1, [1], [1])):
            with self.assertRaises(ValueError):
                make()
        for make in (lambda: System("xy", L), lambda: System(["x"], 3), lambda: oscillator(3),
                     lambda: oscillator().constrain("f", None)):
            with self.assertRaises(TypeError):
                make()

    def test_a_function_may_add_to_its_system(self):
        def lagrangian(t, q, v):
            added = len(system.constraints)
            if added < 100:
                system.constrain("f%d" % added, lambda t, q, v: v[0], begin=5)
            return v @ v / 2
        system = System(["x"], lagrangian)
        system.constrain("f", lambda t, q, v: v[0], begin=5)
        self.assertEqual(system.solve(1, [1], [1]).at(1).x, 2)
        self.assertGreater(len(system.constraints), 5)

    def test_after_an_exception_a_plant_goes_on(self):
        calls = []

        def forces(t, q, v):
            calls.append(t)
            if len(calls) in (60, 200, 333):
                raise KeyError
            return [0, -10]
        systems = [System(["x", "z"], lambda t, q, v: v @ v / 2, f) for f in (forces, lambda t, q, v: [0, -10])]
        plants = [hybrid_sphere.Plant(system.unilateral("floor", lambda t, q: q[1], 0.5), [0, 5], [1, 0])
                  for system in systems]
        raised = 0
        while plants[0].time < 2.9:
            try:
                plants[0].advance(2.9)
            except KeyError:
                raised += 1
        plants[1].advance(2.9)
        self.assertEqual(raised, 3)
        self.assertEqual(plants[0].state, plants[1].state)
        self.assertEqual(plants[0].switches.tobytes(), plants[1].switches.tobytes())

    def test_a_function_must_not_advance_its_own_plant(self):
        plants = []

        def forces(t, q, v):
            if plants:
                plants[0].advance(2)
            return [0.0]
        plants.append(hybrid_sphere.Plant(oscillator(forces), [1], [0]))
        with self.assertRaises(RuntimeError):
            plants[0].advance(1)


ENDLESS = """
import hybrid_sphere
system = hybrid_sphere.System(["x"], lambda t, q, v: (v @ v - q @ q) / 2)
system.solve(1e-3, [1], [0])
try:
    print("ready", flush=True)
    system.solve(1e6, [1], [0])
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""


class Resources(unittest.TestCase):
    def test_ctrl_c_ends_it(self):
        process = subprocess.Popen([sys.executable, "-c", ENDLESS], stdout=subprocess.PIPE, text=True)
        self.assertEqual(process.stdout.readline(), "ready\n")
        let_pass(0.3)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.communicate(timeout=PATIENCE)[0], "interrupted\n")

    def test_a_thousand_motions_leave_nothing(self):
        def resident():
            with open("/proc/self/statm") as file:
                return int(file.read().split()[1]) * 4096

        def one():
            motion = ball(0.5).event("e", lambda t, q, v: q[0] - 0.2).solve(1.2, [0, 5], [1, 0])
            motion.at([0.5, 1.2])
            plant = hybrid_sphere.Plant(sleigh(), [0, 0, 0], [1, 1, 1], input=True)
            plant.set_input([1, 0, 0])
            plant.restore(plant.save())
            plant.advance(0.1)
            try:
                oscillator(lambda t, q, v: [1, 2]).solve(1, [1], [0])
            except ValueError:
                pass
            Number(1.0, [1, 2]) * 3 / np.sin(Number(1.0, [1, 0])) ** Number(0.5, [0, 1])
        for _ in range(100):
            one()
        gc.collect()
        before, objects = resident(), sys.getallocatedblocks()
        for _ in range(1000):
            one()
        gc.collect()
        self.assertLess(resident() - before, 2e6)
        self.assertLess(sys.getallocatedblocks() - objects, 1000)

    def test_circles_are_collected(self):
        class Robot:
            def __init__(self):
                self.system = System(["x"], self.lagrangian).event("e", lambda t, q, v: self.event(q))
                self.motion = self.system.solve(1, [1], [1])
                self.plant = hybrid_sphere.Plant(self.system, [1], [1])
                self.saved = self.plant.save()

            def lagrangian(self, t, q, v):
                return v @ v / 2

            def event(self, q):
                return q[0] - 1.5
        robots = [weakref.ref(Robot()) for _ in range(10)]
        gc.collect()
        self.assertEqual([robot() for robot in robots], [None] * 10)
        robot = Robot()
        gc.collect()
        self.assertEqual(robot.motion.at(1).x, 2)
        part = robot.plant
        alive = weakref.ref(robot)
        del robot
        gc.collect()
        part.advance(1)
        self.assertEqual((part.state.x, len(part.switches)), (2, 1))
        del part
        gc.collect()
        self.assertIsNone(alive())


if __name__ == "__main__":
    unittest.main()
