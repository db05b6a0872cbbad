"""Systems of the catalogue as arrays, and as plants: the numbers of the program three_stage, to the bit.

The environment variable THREE_STAGE names the program."""
import ast
import csv
import os
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy as np

import hybrid_sphere
from patience import PATIENCE, let_pass


def bits(numbers):
    return np.asarray(numbers, dtype=float).tobytes()


def three_stage(name, *options):
    """Its two tables: dicts column -> list of texts."""
    with tempfile.TemporaryDirectory() as folder:
        files = [os.path.join(folder, file) for file in ("states", "switches")]
        subprocess.run([os.environ["THREE_STAGE"], "run", name, "--quiet", "--states", files[0], "--switches", files[1],
                        *options], check=True)
        tables = []
        for file in files:
            with open(file, encoding="utf-8") as opened:
                rows = csv.DictReader(opened)
                columns = {column: [] for column in rows.fieldnames}
                for row in rows:
                    for column, text in row.items():
                        columns[column].append(text)
            tables.append(columns)
        return tables


@unittest.skipUnless("THREE_STAGE" in os.environ, "THREE_STAGE names no program")
class Catalogue(unittest.TestCase):
    def check_table(self, columns, array):
        self.assertEqual(list(columns), list(array.dtype.names[:len(columns)]))
        for column, texts in columns.items():
            if array.dtype[column].kind == "U":
                self.assertEqual(texts, list(array[column]), column)
            else:
                self.assertEqual(bits([float(text) for text in texts]), bits(array[column]), column)

    def test_every_entry_is_that_of_three_stage_to_the_bit(self):
        self.assertGreater(len(hybrid_sphere.systems()), 10)
        for name in hybrid_sphere.systems():
            with self.subTest(name):
                states, switches = three_stage(name)
                motion = hybrid_sphere.catalogue(name).solve()
                self.assertEqual(motion.reason, "reached_end")
                self.check_table(states, motion.at([float(t) for t in states["t"]]))
                self.check_table(switches, motion.switches)

    def test_parameters_and_options_are_those_of_three_stage(self):
        states, switches = three_stage("chaplygin_sleigh", "--set", "a=0.25", "--set", "m=3", "--duration", "2.5",
                                       "--accuracy", "1e-6", "--longest-step", "0.125")
        motion = hybrid_sphere.catalogue("chaplygin_sleigh", a=0.25, m=3).solve(2.5, accuracy=1e-6, max_step=0.125)
        self.check_table(states, motion.at([float(t) for t in states["t"]]))
        self.check_table(switches, motion.switches)

    def test_what_an_entry_says(self):
        system = hybrid_sphere.catalogue("chaplygin_sleigh", a=0.25)
        self.assertEqual(system.name, "chaplygin_sleigh")
        self.assertIn("knife edge", system.title)
        self.assertIn("Chaplygin", system.description)
        self.assertEqual(system.parameters["a"], 0.25)
        self.assertEqual(system.parameters["m"], 2)
        self.assertEqual((system.duration, system.coordinates, system.velocities, system.constraints, system.events),
                         (4, ("x", "y", "theta"), ("x_dot", "y_dot", "theta_dot"), ("blade",), ()))
        np.testing.assert_array_equal(system.q, [0.1, -0.2, 0.3])
        np.testing.assert_array_equal(system.v, [1, 0.8, 1.5])
        self.assertIn("chaplygin_sleigh", repr(system))

    def test_refusals_have_key_value_and_allowed(self):
        for make, key, value, allowed in (
                (lambda: hybrid_sphere.catalogue("sledge"), "name", '"sledge"', "chaplygin_sleigh"),
                (lambda: hybrid_sphere.catalogue("chaplygin_sleigh", mass=1), "mass", "1", "t_switch"),
                (lambda: hybrid_sphere.catalogue("chaplygin_sleigh", m=-1), "m", "-1", "1e-09 to 1e+09"),
                (lambda: hybrid_sphere.catalogue("chaplygin_sleigh", m="a"), "m", "'a'", "1e-09 to 1e+09"),
                (lambda: hybrid_sphere.catalogue("chaplygin_sleigh", m=float("nan")), "m", "nan", "1e-09")):
            with self.assertRaises(hybrid_sphere.SceneError) as caught:
                make()
            self.assertEqual((caught.exception.key, caught.exception.value), (key, value))
            self.assertIn(allowed, caught.exception.allowed)
        with self.assertRaises(hybrid_sphere.SceneError):
            hybrid_sphere.catalogue("paper_sphere", k=1e6)  # no sphere has it


class Solution(unittest.TestCase):
    def setUp(self):
        self.motion = hybrid_sphere.catalogue("visiting_particle").solve()

    def test_one_time_is_one_item(self):
        state = self.motion.at(1.0)
        self.assertEqual(state.t, 1)
        self.assertEqual(state, self.motion.at([0.5, 1.0])[1])
        self.assertEqual(self.motion.at([]).shape, (0,))
        times = np.linspace(0, self.motion.end, 50)
        forwards, backwards = self.motion.at(times), self.motion.at(times[::-1])
        self.assertEqual(forwards.tobytes(), backwards[::-1].tobytes())

    def test_what_holds_is_told(self):
        for event in self.motion.switches:
            self.assertEqual(self.motion.at(event.t).active, event.active)
            self.assertEqual(event.active, event.applied)
        applied, held = self.motion.constraints[self.motion.switches[0].applied]
        self.assertGreaterEqual(applied, 1)
        self.assertLess(held, self.motion.end)
        self.assertGreater(self.motion.steps, 0)
        self.assertGreater(self.motion.evaluations, self.motion.steps)
        self.assertIn("reached_end", repr(self.motion))
        self.assertEqual(self.motion.message, "the requested end")

    def test_other_times_are_refused(self):
        for wrong in (self.motion.end * 1.001, -0.001, float("nan"), [1, float("inf")], [[1, 2]]):
            with self.assertRaises(ValueError):
                self.motion.at(wrong)

    def test_a_motion_that_stops_early_says_why(self):
        fall = hybrid_sphere.catalogue("constant_speed", x_dot=0, y_dot=0, t_switch=0)
        motion = fall.solve()
        self.assertEqual(motion.reason, "no_direction")
        self.assertEqual(motion.end, 0)
        self.assertIn("speed", motion.message)

    def test_the_start_and_its_refusals(self):
        sleigh = hybrid_sphere.catalogue("chaplygin_sleigh")
        motion = sleigh.solve(1, q=[1, 2, 0], v=np.array([1, 0, 0]), t=-1)
        self.assertEqual((motion.begin, motion.end), (-1, 0))
        self.assertAlmostEqual(motion.at(0).x, 2, 9)
        for wrong in (dict(q=[1, 2]), dict(v=[[1, 2, 3]]), dict(accuracy=1), dict(max_step=0),
                      dict(q=[1, 2, float("nan")]), dict(duration=-1), dict(t=float("inf"))):
            with self.assertRaises(ValueError, msg=wrong):
                sleigh.solve(**wrong)
        with self.assertRaises(ValueError):
            sleigh.solve(q="abc")
        with self.assertRaises(ValueError):
            sleigh.solve(4, t=1, q=[0, 0, 0], v=[0, 1, 0])  # the blade is down already
        self.assertEqual(sleigh.solve(4, t=1, q=[0, 0, 0], v=[0, 1, 0], project=True).reason, "reached_end")

    def test_rounded_positions_are_put_onto_the_constraints(self):
        rod = hybrid_sphere.System(["x", "y"], lambda t, q, v: v @ v / 2 - 9.81 * q[1])
        rod.holonomic("length", lambda t, q: q @ q - 1)
        rounded = dict(q=[0.7071, -0.7071], v=[0, 0])
        with self.assertRaises(ValueError) as refused:
            rod.solve(1, **rounded)
        self.assertIn("project_positions", str(refused.exception))
        motion = rod.solve(1, **rounded, project_positions=True)
        plant = hybrid_sphere.Plant(rod, **rounded, project_positions=True)
        for of_q, of_v in (motion.projection, plant.projection):
            np.testing.assert_allclose(rounded["q"] + of_q, [0.5**0.5, -0.5**0.5], rtol=1e-15)
            np.testing.assert_array_equal(of_v, [0, 0])
        np.testing.assert_allclose([motion.at(0).x, plant.state.x], 0.5**0.5, rtol=1e-15)

    def test_a_blade_with_any_heading_is_accepted(self):
        skate = hybrid_sphere.System(["x", "y", "theta"], lambda t, q, v: v @ v / 2)
        skate.constrain("blade", lambda t, q, v: v[0] * np.sin(q[2]) - v[1] * np.cos(q[2]))
        for heading in np.arange(0, 2 * np.pi, np.pi / 12):
            motion = skate.solve(1, [0, 0, heading], [np.cos(heading), np.sin(heading), 1])
            self.assertEqual(motion.reason, "reached_end")
        with self.assertRaises(ValueError):
            skate.solve(1, [0, 0, np.pi / 2], [1e-6, 1, 1])


class Plant(unittest.TestCase):
    def test_any_periods_give_the_same_motion(self):
        system = hybrid_sphere.catalogue("visiting_particle")
        end = system.duration
        whole = hybrid_sphere.Plant(system)
        whole.advance(end)
        draw = np.random.default_rng(3)
        for count in (1, 7, 100, 1000):
            plant = hybrid_sphere.Plant(system)
            times = np.append(np.sort(draw.uniform(0, end, count)), end)
            told = sum(plant.advance(time) for time in times)
            self.assertEqual(told, len(plant.switches))
            self.assertEqual(plant.switches.tobytes(), whole.switches.tobytes())
            self.assertEqual(plant.state, whole.state)
            again = hybrid_sphere.Plant(system)
            states = again.run(times)
            self.assertEqual(states[-1], whole.state)
            self.assertEqual(list(states["t"]), list(times))
        self.assertEqual(whole.time, end)
        self.assertGreater(whole.evaluations, whole.steps)

    def test_input_is_a_force(self):
        system = hybrid_sphere.catalogue("knife_edge_incline", gs=0, t_switch=1e9)
        plant = hybrid_sphere.Plant(system, input=True)
        np.testing.assert_array_equal(plant.input, [0, 0, 0])
        plant.advance(1)
        before = plant.state
        plant.set_input([1.25 * 2, 0, 0.3])
        plant.advance(2)
        self.assertAlmostEqual(plant.state.x, before.x + before.x_dot + 1, 9)
        self.assertAlmostEqual(plant.state.theta_dot, before.theta_dot + 1, 9)
        for wrong in ([1], [1, 2, float("nan")], [[1, 2, 3]]):
            with self.assertRaises(ValueError):
                plant.set_input(wrong)
        np.testing.assert_array_equal(plant.input, [2.5, 0, 0.3])
        without = hybrid_sphere.Plant(system)
        self.assertIsNone(without.input)
        with self.assertRaises(ValueError):
            without.set_input([0, 0, 0])

    def test_a_present_is_kept(self):
        plant = hybrid_sphere.Plant(hybrid_sphere.catalogue("visiting_particle"), input=True)
        plant.advance(1)
        saved, switches = plant.save(), plant.switches
        ends = []
        for _ in range(2):
            plant.restore(saved)
            self.assertEqual(plant.time, 1)
            self.assertEqual(plant.switches.tobytes(), switches.tobytes())
            plant.set_input([0.1, 0, 0])
            plant.advance(6)
            ends.append((plant.state.tobytes(), plant.switches.tobytes()))
        self.assertEqual(ends[0], ends[1])
        with self.assertRaises(ValueError):
            plant.restore(hybrid_sphere.Plant(hybrid_sphere.catalogue("chaplygin_sleigh")).save())

    def test_a_halt_has_reason_time_and_states(self):
        system = hybrid_sphere.catalogue("constant_speed", x_dot=0, y_dot=5, g=10, t_switch=0.5, c=1)
        plant = hybrid_sphere.Plant(system)
        with self.assertRaises(hybrid_sphere.Halted) as caught:
            plant.run([0.1, 0.2, 0.75])
        self.assertEqual((caught.exception.reason, caught.exception.time), ("no_velocity", 0.5))
        self.assertEqual(list(caught.exception.states["t"]), [0.1, 0.2])
        self.assertEqual(plant.time, 0.5)
        with self.assertRaises(hybrid_sphere.Halted) as again:
            plant.advance(1)
        self.assertEqual(pickle.loads(pickle.dumps(again.exception)).time, 0.5)

    def test_refusals(self):
        system = hybrid_sphere.catalogue("chaplygin_sleigh")
        plant = hybrid_sphere.Plant(system)
        plant.advance(1)
        for wrong in (lambda: plant.advance(0.5), lambda: plant.advance(float("nan")), lambda: plant.run([2, 1.5]),
                      lambda: hybrid_sphere.Plant(system, horizon=0), lambda: hybrid_sphere.Plant(system, q=[1])):
            with self.assertRaises(ValueError):
                wrong()
        self.assertEqual(plant.time, 1)
        self.assertIn("t = 1 s", repr(plant))

    def test_two_threads_at_once_are_refused_and_two_plants_run(self):
        system = hybrid_sphere.catalogue("chaplygin_ball")
        plant = hybrid_sphere.Plant(system)
        refused = []

        def run(one):
            try:
                one.advance(1000)
            except RuntimeError:
                refused.append(one)
        threads = [threading.Thread(target=run, args=[one]) for one in (plant, plant, hybrid_sphere.Plant(system))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertLessEqual(len(refused), 1)
        self.assertEqual(plant.time, 1000)


class Stubs(unittest.TestCase):
    def test_they_name_what_there_is(self):
        with open(os.path.join(os.path.dirname(hybrid_sphere.__file__), "__init__.pyi"), encoding="utf-8") as file:
            declared = ast.parse(file.read()).body
        named = set()
        for one in declared:
            if isinstance(one, (ast.ClassDef, ast.FunctionDef)):
                self.assertTrue(getattr(hybrid_sphere, one.name).__doc__, one.name)
                named.add(one.name)
            if isinstance(one, ast.ClassDef):
                members = {part.name for part in one.body if isinstance(part, ast.FunctionDef)}
                members |= {part.target.id for part in one.body if isinstance(part, ast.AnnAssign)}
                there = set(vars(getattr(hybrid_sphere, one.name)))
                if not issubclass(getattr(hybrid_sphere, one.name), Exception):
                    self.assertLessEqual(members, there | {"__init__"}, one.name)
                    self.assertLessEqual({name for name in there if not name.startswith("_")}, members, one.name)
        self.assertLessEqual({"System", "MultibodySystem", "Solution", "Plant", "Snapshot", "Number", "systems", "catalogue"}, named)


INTERRUPTED = """
import sys, hybrid_sphere
system = hybrid_sphere.catalogue("chaplygin_ball")
plant = hybrid_sphere.Plant(system)
what = {"advance": lambda: plant.advance(1e9), "run": lambda: plant.run([1e9]), "solve": lambda: system.solve(1e6)}
plant.run([0])
try:
    print("ready", flush=True)
    what[sys.argv[1]]()
except KeyboardInterrupt:
    assert plant.time < 1e9
    plant.advance(plant.time + 1)
    print("interrupted", flush=True)
"""


class Signals(unittest.TestCase):
    def test_ctrl_c_ends_what_takes_long(self):
        for what in ("advance", "run", "solve"):
            process = subprocess.Popen([sys.executable, "-c", INTERRUPTED, what], stdout=subprocess.PIPE, text=True)
            self.assertEqual(process.stdout.readline(), "ready\n")
            let_pass(0.3)
            process.send_signal(signal.SIGINT)
            answer = process.communicate(timeout=PATIENCE)[0]
            self.assertEqual(answer, "interrupted\n")


if __name__ == "__main__":
    unittest.main()
