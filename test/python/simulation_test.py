"""hybrid_sphere.Simulation: the numbers of `simulate`, what it refuses, and how it shares the process with others."""
import glob
import os
import pickle
import random
import signal
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy as np

import hybrid_sphere
from common import CONFIG, DATA, HALTING, PAIR, SIMULATE, differences, simulate
from hybrid_sphere import Halted, SceneError, Simulation
from patience import PATIENCE, let_pass

LONG = """
import hybrid_sphere
scene = {"sphere": {"mass": 1, "radius": 1, "body": "solid"},
         "initial_state": {"velocity": [1, 1], "angular_velocity": [1, 2, 3]},
         "drag": {"quadratic": 0.1}, "spring": {"stiffness": 1}, "surface": {"base": {"law": "coulomb", "friction": 0.1}},
         "solver": {"method": "euler", "step": 1e-6}}
simulation = hybrid_sphere.Simulation(scene)
simulation.run([0])
print("ready", flush=True)
%s
"""


class ResultsTest(unittest.TestCase):
    def same_as_simulate(self, scene, directory, *arguments):
        rows, switch_rows, code = simulate(scene, directory, *arguments)
        simulation = Simulation(scene)
        times = np.array([float(row["t"]) for row in rows])
        try:
            states = simulation.run(times)
        except Halted as halt:
            states = halt.states
        if code == 0:
            simulation.advance(10)
        else:
            with self.assertRaises(Halted):
                simulation.advance(10)
        self.assertEqual(differences(states, rows), [], scene)
        self.assertEqual(differences(simulation.switches, switch_rows), [], scene)

    def test_are_those_of_simulate_for_every_scene_of_config(self):
        scenes = sorted(glob.glob(os.path.join(CONFIG, "*.yaml")))
        self.assertGreater(len(scenes), 5)
        with tempfile.TemporaryDirectory() as directory:
            for scene in scenes:
                self.same_as_simulate(scene, directory, "--rate", "10")

    def test_are_those_of_simulate_for_a_tenth_of_the_reference_scenes(self):
        scenes = [path for folder in ("oracle", "reference", "halts")
                  for path in sorted(glob.glob(os.path.join(DATA, folder, "*.yaml"))) if ".expected." not in path]
        self.assertGreater(len(scenes), 300)
        with tempfile.TemporaryDirectory() as directory:
            for scene in scenes[::10]:
                self.same_as_simulate(scene, directory, "--rate", "2")

    def test_do_not_depend_on_how_the_time_is_divided(self):
        times = np.linspace(0, 4, 100)
        whole = Simulation(PAIR)
        states = whole.run(times)
        other = Simulation(PAIR)
        count = 0
        for time_, state in zip(times, states):
            count += other.advance(time_)
            self.assertEqual(other.state, state)
        self.assertEqual(count, 1)
        self.assertTrue(np.array_equal(other.switches, whole.switches))

    def test_come_from_a_dict_a_text_and_a_file_alike(self):
        import pathlib
        path = os.path.join(CONFIG, "paper.yaml")
        with open(path) as file:
            text = file.read()
        expected = Simulation(path).run([1, 5])
        self.assertTrue(np.array_equal(Simulation(text).run([1, 5]), expected))
        self.assertTrue(np.array_equal(Simulation(pathlib.Path(path)).run([1, 5]), expected))
        flow = "{sphere: {mass: 2, radius: 0.5, body: solid}, initial_state: {velocity: [1, 0]}}"
        arrays = {"sphere": {"mass": np.float32(2), "radius": 0.5, "body": "solid"},
                  "initial_state": {"velocity": np.array([1, 0])}}
        self.assertTrue(np.array_equal(Simulation(flow).run([3]), Simulation(arrays).run([3])))

    def test_have_attributes_names_and_texts_in_any_script(self):
        scene = {**PAIR, "surface": {"regions": [{**PAIR["surface"]["regions"][0], "name": "Gl\u00e4tte \u7c97\u7cd9 \U0001f9ca"}]}}
        simulation = Simulation(scene)
        states = simulation.run([0.5, 2])
        self.assertEqual(states[1].region, "Gl\u00e4tte \u7c97\u7cd9 \U0001f9ca")
        self.assertEqual(states["region"].tolist(), ["base", states[1].region])
        self.assertEqual(simulation.switches[0].to_region, states[1].region)
        self.assertEqual(simulation.switches[0].cause, "edge")
        self.assertEqual(simulation.state.mode, "rolling")
        self.assertEqual(states[1].x, states["x"][1])

    def test_without_orientation_are_otherwise_the_same(self):
        full, bare = Simulation(PAIR).run([0.5, 3]), Simulation(PAIR, orientation=False).run([0.5, 3])
        for name in full.dtype.names:
            self.assertEqual(np.array_equal(full[name], bare[name]), name not in ("qx", "qy", "qz", "qw"), name)

    def test_come_with_a_warning_where_a_map_has_a_key_that_map_server_does_not_know(self):
        with tempfile.TemporaryDirectory() as directory:
            with open(os.path.join(directory, "m.pgm"), "w") as file:
                file.write("P2 1 1 255 0")
            with open(os.path.join(directory, "m.yaml"), "w") as file:
                file.write("{image: m.pgm, resolution: 1, origin: [0, 0, 0], occupied_thresh: 0.65, cost: 3}")
            path = os.path.join(directory, "scene.yaml")
            with open(path, "w") as file:
                file.write("{sphere: {mass: 1, radius: 1, body: solid}, surface: {image: {map: m.yaml}}}")
            ignored = "surface.image.map.cost: an unknown key is ignored"
            with self.assertWarnsRegex(UserWarning, ignored):
                self.assertEqual(Simulation(path).run([0])[0].region, "image_0")
            run = subprocess.run([SIMULATE, path, "--duration", "0"], capture_output=True, text=True)
            self.assertIn("simulate: warning: " + ignored, run.stderr)

    def test_begin_anew_after_reset(self):
        simulation = Simulation(PAIR)
        first = simulation.run([0, 2])
        simulation.reset()
        self.assertEqual((simulation.time, len(simulation.switches)), (0, 0))
        self.assertTrue(np.array_equal(simulation.run([0, 2]), first))
        simulation.reset({"position": [5, 0], "velocity": [0, 1]})
        self.assertEqual(simulation.run([0])[0].x, 5)

    def test_before_the_ground_has_acted_have_no_name_of_it(self):
        simulation = Simulation(PAIR)
        self.assertEqual((simulation.state.mode, simulation.state.region, simulation.state.x), ("free", "", -1))
        simulation.advance(0)
        self.assertEqual((simulation.state.mode, simulation.state.region), ("free", "base"))
        simulation.set_state({"position": [1, 0]})
        self.assertEqual(simulation.run([0])[0].region, "rough_half")

    def test_have_whole_names_also_while_the_ground_changes(self):
        long, short = "n" * 100, {"base": {"law": "smooth"}}
        everywhere = {"regions": [{"name": long, "law": "smooth", "half_plane": {"point": [-9, 0], "normal": [1, 0]}}]}
        simulation = Simulation({**PAIR, "surface": everywhere})
        simulation.advance(0.5)
        simulation.set_surface(short)
        self.assertEqual(simulation.state.region, long)
        self.assertEqual(simulation.run([0.5])[0].region, "base")
        simulation.set_surface(everywhere)
        self.assertEqual(simulation.run([1])[0].region, long)
        self.assertEqual(Simulation(PAIR).switches.dtype, Simulation(PAIR).switches.dtype)

    def test_are_those_of_any_number_of_numpy(self):
        expected = Simulation(PAIR).run([2])
        for kind in (np.longdouble, np.float64, np.float32, np.int8, np.uint64):
            scene = {**PAIR, "sphere": {"mass": kind(2), "radius": 0.5, "body": np.str_("solid")}}
            self.assertEqual(Simulation(scene).run(np.array([2], kind))[0], expected[0])

    def test_of_forces_and_impulses_are_those_of_mechanics(self):
        simulation = Simulation({"sphere": {"mass": 2, "radius": 0.5, "body": "solid"}})  # smooth
        simulation.command(force=[4, 0])
        simulation.advance(3)
        self.assertAlmostEqual(simulation.state.x, 0.5 * 2 * 9, 12)
        simulation.command()
        simulation.kick([0, 6])
        simulation.advance(4)
        self.assertAlmostEqual(simulation.state.vx, 6, 12)
        self.assertAlmostEqual(simulation.state.y, 3, 12)
        self.assertAlmostEqual(simulation.kinetic_energy, 36 + 9, 11)
        self.assertEqual(simulation.reaction.tolist(), [0, 0, 2 * 9.81])
        self.assertEqual(simulation.slip.tolist(), [simulation.state.vx, simulation.state.vy])
        simulation.set_surface({"base": {"law": "rough"}})
        self.assertEqual(simulation.advance(4), 1)
        self.assertEqual(simulation.switches[-1].cause, "placed")
        self.assertEqual(simulation.slip.tolist(), [0, 0])
        simulation.set_state({"position": [1, 2]})
        self.assertEqual((simulation.time, simulation.state.x), (4, 1))


class RefusalTest(unittest.TestCase):
    def refusal(self, call, *arguments, **named):
        with self.assertRaises(SceneError) as caught:
            call(*arguments, **named)
        return caught.exception

    def test_of_a_scene_has_key_value_and_what_is_allowed(self):
        error = self.refusal(Simulation, {**PAIR, "sphere": {"mass": -1, "radius": 1, "body": "solid"}})
        self.assertEqual((error.key, error.value), ("sphere.mass", "-1"))
        self.assertIn("[kg]", error.allowed)
        self.assertEqual(str(error), "sphere.mass: -1 is refused; allowed: " + error.allowed)
        self.assertIsInstance(error, ValueError)

    def test_can_be_sent_to_another_process(self):
        for error in (self.refusal(Simulation, {"sphere": 1}), Halted("why", "undecided", 1.5)):
            other = pickle.loads(pickle.dumps(error))
            self.assertEqual((type(other), str(other), vars(other)), (type(error), str(error), vars(error)))

    def test_names_what_no_scene_can_hold(self):
        for value in (object(), {1, 2}, b"bytes", 1j, 10**400, float("nan"), "\ud800", [[[[[[[[[[[[[[[[[[1]]]]]]]]]]]]]]]]]]):
            error = self.refusal(Simulation, {**PAIR, "initial_state": {"position": [value, 0]}})
            self.assertTrue(error.key.startswith("initial_state.position"), error)
        self.assertEqual(self.refusal(Simulation, {1: 2}).key, "scene")
        self.assertEqual(self.refusal(Simulation, "no_such_file.yaml").key, "")
        loop = {}
        loop["sphere"] = loop
        self.refusal(Simulation, loop)

    def test_leaves_a_simulation_as_it_was(self):
        simulation = Simulation(PAIR)
        simulation.advance(0.5)
        before = simulation.state
        self.assertEqual(self.refusal(simulation.run, [1, 0.9]).key, "times[1]")
        self.assertEqual(self.refusal(simulation.run, [0.4]).key, "times[0]")
        self.assertEqual(self.refusal(simulation.run, [np.nan]).value, "nan")
        self.assertEqual(self.refusal(simulation.run, 1.0).key, "times")
        self.assertEqual(self.refusal(simulation.command, force=[np.inf, 0]).key, "command.force[0]")
        self.assertEqual(self.refusal(simulation.command, torque="up").key, "command.torque")
        self.assertEqual(self.refusal(simulation.set_surface, {"base": {"law": "sticky"}}).key, "surface.base.law")
        self.assertEqual(self.refusal(simulation.set_state, {"speed": 1}).key, "state.speed")
        self.assertEqual(self.refusal(simulation.reset, {"position": [1]}).key, "initial_state.position")
        refused = self.refusal(simulation.advance, 0.4)
        self.assertEqual((refused.key, refused.value, refused.allowed), ("time", "0.4", "a number from 0.5 to 1e+15 [s]"))
        self.assertEqual(self.refusal(simulation.advance, np.nan).value, "nan")
        self.assertEqual(self.refusal(simulation.advance, 2e15).key, "time")
        self.assertEqual(self.refusal(simulation.kick, [np.inf, 0]).value, "(inf, 0)")
        refused = self.refusal(setattr, simulation, "accuracy", 2)
        self.assertEqual((refused.key, refused.value, refused.allowed), ("accuracy", "2", "a number from 1e-14 to 1"))
        self.assertEqual((simulation.state, simulation.accuracy), (before, 1e-9))

    def test_of_what_are_no_real_numbers(self):
        simulation = Simulation(PAIR)
        for times in (np.ma.array([1., 2.], mask=[0, 1]), np.array([1j]), ["1"], [True], np.array([1], "M8[s]"), [None],
                      [[1, 2]], {1: 2}):
            self.assertTrue(self.refusal(simulation.run, times).key.startswith("times"))
            self.assertEqual(self.refusal(simulation.kick, times).key, "impulse")
        self.assertEqual(self.refusal(Simulation, "paper.yaml\0.txt").key, "scene")
        self.assertEqual((simulation.time, simulation.switches.size), (0, 0))

    def test_reads_a_copy_of_what_changes_meanwhile(self):
        class Path(os.PathLike):
            def __init__(self, container):
                self.container = container

            def __fspath__(self):
                self.container.clear()
                return "solid"
        sphere = {"mass": 2, "radius": 0.5}
        sphere["body"] = Path(sphere)
        self.assertEqual(Simulation({**PAIR, "sphere": sphere}).run([2])[0], Simulation(PAIR).run([2])[0])
        corners = []
        corners.extend([Path(corners), 1, 2])
        self.refusal(Simulation, {**PAIR, "initial_state": {"position": corners}})

    def test_lets_other_exceptions_pass(self):
        class Sequence:
            def __array__(self, *_):
                raise MemoryError
        with self.assertRaises(MemoryError):
            Simulation(PAIR).run(Sequence())

    def test_of_friction_without_pressure_names_the_ground(self):
        simulation = Simulation({**PAIR, "gravity": [0, 0, 0]})
        error = self.refusal(simulation.set_surface, {"base": {"law": "coulomb", "friction": 0.1}})
        self.assertEqual(error.key, "surface.base.law")


class RandomSceneTest(unittest.TestCase):
    """Ten thousand dicts give a scene or a SceneError, nothing else."""

    VALUES = [None, True, "", "rough", "coulomb", "solid", "base", 0, -1, 1, 0.3, 1e300, -1e-300, float("nan"),
              float("inf"), 2**70, [], {}, [1, 2], [0, 0, 0], [1, [2]], {"law": "rough"}, (1, 2), np.float32(3),
              np.arange(2), np.zeros((2, 2)), b"x", object(), {3: 4}, np.longdouble(1), np.zeros(2, np.longdouble),
              np.clongdouble(1), np.datetime64(1, "s"), np.ma.masked, np.str_("rough"), np.bool_(True), {"half_plane": {"point": [0, 0], "normal": [0, 1]}}]
    SEEDS = [PAIR, HALTING, {
        "sphere": {"mass": 1, "radius": 1, "gyration_radius": 0.5},
        "initial_state": {"position": [0, 0], "orientation": [0, 0, 0, 1]},
        "gravity": [1, 0, -9], "wrench": {"force": [1, 0], "torque": [0, 0, 1]}, "drag": {"quadratic": 1},
        "spring": {"stiffness": 1, "center": [1, 1]}, "solver": {"method": "auto", "accuracy": 1e-6},
        "surface": {"base": {"law": "coulomb", "friction": 0.2, "rolling_resistance": 0.01},
                    "regions": [{"name": "a", "law": "rough", "polygon": [[0, 0], [1, 0], [0, 1]]},
                                {"name": "b", "law": "rubber", "circle": {"center": [2, 2], "radius": 1},
                                 "turntable": {"rate": 1, "center": [2, 2]}}]}}]

    def changed(self, draw, value, depth=0):
        """A copy with something in it replaced, left out, repeated or put beside it."""
        if not isinstance(value, (dict, list)) or not value or draw.random() < 0.15:
            return draw.choice(self.VALUES)
        if isinstance(value, list):
            place = draw.randrange(len(value))
            return value[:place] + [self.changed(draw, value[place], depth + 1)] * draw.choice([0, 1, 1, 1, 2]) + \
                value[place + 1:]
        key = draw.choice(list(value))
        copy = dict(value)
        change = self.changed(draw, copy.pop(key), depth + 1)
        if draw.random() < 0.9:
            copy[draw.choice([key, key, key, key, "extra", draw.choice(list(value))])] = change
        return copy

    def test_is_a_scene_or_a_scene_error(self):
        draw = random.Random(2005)
        accepted = 0
        for _ in range(10000):
            scene = draw.choice(self.SEEDS)
            for _ in range(draw.choice([1, 1, 1, 2, 3])):
                scene = self.changed(draw, scene)
            try:
                Simulation(scene)
                accepted += 1
            except SceneError as error:
                self.assertIn("allowed" if error.key else "", str(error))
        self.assertGreater(accepted, 500)


class ProcessTest(unittest.TestCase):
    def test_halt_has_time_reason_and_states(self):
        simulation = Simulation(HALTING)
        with self.assertRaises(Halted) as caught:
            simulation.run([0, 0.1, 100])
        halt = caught.exception
        self.assertEqual(halt.reason, "livelock")
        self.assertEqual(halt.states["t"].tolist(), [0, 0.1])
        self.assertEqual(halt.time, simulation.time)
        self.assertEqual(halt.time, simulation.state.t)
        with self.assertRaises(Halted) as caught:
            simulation.advance(100)
        self.assertIsNone(caught.exception.states)

    def test_ends_a_long_computation_by_a_signal(self):
        for call in ("advance(1e6)", "run([1e6])"):
            process = subprocess.Popen([sys.executable, "-c", LONG % ("simulation." + call)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                       text=True)
            self.assertEqual(process.stdout.readline(), "ready\n")
            let_pass(0.2)
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate(timeout=PATIENCE)
            self.assertEqual(process.returncode, -signal.SIGINT, errors)
            self.assertIn("KeyboardInterrupt", errors)

    def test_is_one_threads_at_a_time_and_lets_others_run(self):
        scene = {**PAIR, "drag": {"quadratic": 0.1}, "solver": {"method": "euler", "step": 1e-5}}
        simulation = Simulation(scene)
        computing = threading.Thread(target=simulation.advance, args=(3,))
        computing.start()
        refused = 0
        while computing.is_alive():
            try:
                simulation.time
            except RuntimeError as error:
                refused += "another thread" in str(error)
        self.assertGreater(refused, 0)
        self.assertEqual(simulation.time, 3)

    def test_a_handler_of_signals_may_not_use_it_meanwhile(self):
        simulation = Simulation({**PAIR, "drag": {"quadratic": 0.1}, "solver": {"method": "euler", "step": 1e-6}})
        seen = []

        def look(*_):
            try:
                simulation.state
            except RuntimeError as error:
                signal.setitimer(signal.ITIMER_REAL, 0)
                seen.append(error)
                raise
        before = signal.signal(signal.SIGALRM, look)
        self.addCleanup(signal.signal, signal.SIGALRM, before)
        signal.setitimer(signal.ITIMER_REAL, 0.1, 0.1)
        with self.assertRaises(RuntimeError):
            simulation.advance(1e5)
        self.assertEqual(len(seen), 1)
        self.assertGreater(simulation.time, 0)  # and it goes on from there
        simulation.advance(simulation.time + 1e-3)

    def test_keeps_no_memory(self):
        def resident():
            with open("/proc/self/statm") as file:
                return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

        def use(times):
            for _ in range(times):
                simulation = Simulation(PAIR)
                simulation.run([0, 1, 2])
                simulation.switches, simulation.state, simulation.reaction
                try:
                    simulation.run([0])
                except SceneError:
                    pass
        use(2000)
        before = resident()
        use(20000)
        self.assertLess(resident() - before, 4 << 20)  # 200 bytes each, of some thousand

    def test_the_interpreter_ends_while_a_thread_computes(self):
        code = LONG % ("import threading; threading.Thread(target=simulation.advance, args=(1e6,), daemon=True).start()\n"
                       "try:\n    while True: simulation.time\nexcept RuntimeError: pass")  # it is another thread's
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=PATIENCE)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_what_is_destroyed_at_the_end_may_still_compute(self):
        code = ("import hybrid_sphere\nclass Last:\n    def __init__(self):\n        self.simulation = hybrid_sphere.Simulation("
                "\"{sphere: {mass: 1, radius: 1, body: solid}, initial_state: {velocity: [1, 0]}}\")\n"
                "    def __del__(self):\n        self.simulation.advance(3)\n        print(self.simulation.time)\n"
                "last = Last()\nlast.itself = last\n")
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=PATIENCE)
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "3.0\n", ""))

    def test_messages_do_not_wait_for_it(self):
        code = "import sys, hybrid_sphere; sys.exit('numpy' in sys.modules or hybrid_sphere.SceneError is None)"
        subprocess.run([sys.executable, "-c", code], check=True)

    def test_has_all_that_it_names(self):
        for name in hybrid_sphere.__all__:
            self.assertIsNotNone(getattr(hybrid_sphere, name), name)
        with self.assertRaises(AttributeError):
            hybrid_sphere.no_such_name


if __name__ == "__main__":
    unittest.main()
