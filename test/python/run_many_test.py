"""hybrid_sphere.run_many: each run is that of a Simulation, whatever the number of threads; what it refuses and halts."""
import collections
import os
import signal
import subprocess
import sys
import threading
import types
import unittest

import numpy as np

from common import CONFIG, HALTING, PAIR
from hybrid_sphere import Halted, SceneError, Simulation, run_many
from patience import PATIENCE, let_pass

TIMES = [0, 0.5, 1, 4]
LONG = """
import hybrid_sphere
scene = {"sphere": {"mass": 1, "radius": 1, "body": "solid"}, "initial_state": {"velocity": [1, 1]},
         "spring": {"stiffness": 1}, "drag": {"quadratic": 0.1}, "surface": {"base": {"law": "coulomb", "friction": 0.1}},
         "solver": {"method": "euler", "step": 1e-6}}
hybrid_sphere.run_many(scene, [0])
print("ready", flush=True)
hybrid_sphere.run_many(scene, [1e6], {"initial_state.velocity[0]": range(500)}, threads=2)
"""


def with_velocity(scene, velocity):
    return {**scene, "initial_state": {**scene["initial_state"], "velocity": velocity}}


class RunManyTest(unittest.TestCase):
    def setUp(self):
        draw = np.random.default_rng(2005)
        self.vx, self.vy = draw.uniform(0.5, 2, 300), draw.normal(0, 0.3, 300)
        self.samples = {"initial_state.velocity[0]": self.vx, "initial_state.velocity[1]": self.vy}

    def test_is_many_simulations(self):
        runs = run_many(PAIR, TIMES, self.samples, switches=True)
        self.assertEqual((runs.states.shape, runs.halts), ((300, 4), {}))
        switches = runs.switches
        for i in range(0, 300, 7):
            alone = Simulation(with_velocity(PAIR, [self.vx[i], self.vy[i]]))
            self.assertTrue(np.array_equal(runs.states[i], alone.run(TIMES)), i)
            mine = switches[switches["run"] == i]
            for name in alone.switches.dtype.names:
                self.assertEqual(mine[name].tolist(), alone.switches[name].tolist())

    def test_takes_a_list_of_scenes(self):
        scenes = [with_velocity(PAIR, [vx, vy]) for vx, vy in zip(self.vx, self.vy)]
        runs = run_many(scenes, TIMES)
        self.assertTrue(np.array_equal(runs.states, run_many(PAIR, TIMES, self.samples).states))
        self.assertIsNone(runs.switches)
        self.assertEqual(run_many(PAIR, TIMES).states.shape, (1, 4))
        self.assertEqual(run_many([], TIMES).states.shape, (0, 4))
        mixed = run_many([PAIR, os.path.join(CONFIG, "incline.yaml"), os.path.join(CONFIG, "paper.yaml")], [3])
        self.assertEqual(mixed.states[1, 0], Simulation(os.path.join(CONFIG, "incline.yaml")).run([3])[0])

    def test_does_not_depend_on_the_threads(self):
        one = run_many(PAIR, TIMES, self.samples, switches=True)
        for threads in (2, 5, None):
            many = run_many(PAIR, TIMES, self.samples, switches=True, threads=threads)
            self.assertTrue(np.array_equal(many.states, one.states))
            self.assertTrue(np.array_equal(many.switches, one.switches))

    def test_takes_any_mapping_sequence_and_iterable(self):
        expected = run_many(PAIR, TIMES, self.samples, fields=["x", "mode"]).states
        for samples in (types.MappingProxyType(self.samples), collections.UserDict(self.samples)):
            self.assertTrue(np.array_equal(run_many(PAIR, TIMES, samples, fields=iter(["x", "mode"])).states, expected))
        scenes = [with_velocity(PAIR, [vx, vy]) for vx, vy in zip(self.vx, self.vy)]
        for many in (collections.deque(scenes), np.array(scenes, object), iter(scenes)):
            self.assertTrue(np.array_equal(run_many(many, TIMES, fields=("x", "mode")).states, expected))

    def test_has_as_many_threads_as_it_is_to_have(self):
        scene = {**PAIR, "drag": {"quadratic": 0.1}, "solver": {"method": "euler", "step": 1e-5}}
        before, most = len(os.listdir("/proc/self/task")), [0]
        stop = threading.Event()

        def count():
            while not stop.is_set():
                most[0] = max(most[0], len(os.listdir("/proc/self/task")))
                let_pass(0.001)
        counting = threading.Thread(target=count)
        counting.start()
        run_many(scene, [3], {"sphere.mass": np.ones(4)}, threads=3)
        stop.set()
        counting.join()
        self.assertEqual(most[0], before + 1 + 2)

    def test_varies_any_number_of_a_scene(self):
        mass, x = np.linspace(1, 3, 20), np.linspace(-0.5, 0.5, 20)
        samples = np.zeros(20, [("sphere.mass", float), ("surface.regions[rough_half].half_plane.point[0]", "f4")])
        samples["sphere.mass"], samples["surface.regions[rough_half].half_plane.point[0]"] = mass, x
        runs = run_many(PAIR, [3], samples, switches=True)
        self.assertTrue(np.allclose(runs.switches["t"], 1 + x.astype("f4").astype(float), rtol=1e-15))
        self.assertTrue(np.allclose(runs.switches["energy1"] / mass, runs.switches["energy1"][0]))

    def test_leaves_out_what_is_not_wanted(self):
        whole = run_many(PAIR, TIMES, self.samples).states
        some = run_many(PAIR, TIMES, self.samples, fields=["region", "stage", "x", "vy"]).states
        self.assertEqual(some.dtype.names, ("region", "stage", "x", "vy"))
        for name in some.dtype.names:
            self.assertTrue(np.array_equal(some[name], whole[name]), name)
        turned = run_many(PAIR, TIMES, self.samples, fields=["qw", "t"]).states
        self.assertTrue(np.array_equal(turned["qw"], whole["qw"]))

    def test_keeps_the_others_where_some_halt(self):
        velocities = np.array([0.5, -1, 3, 0.4])
        runs = run_many(HALTING, [0.5, 5], {"initial_state.velocity[0]": velocities})
        self.assertEqual(sorted(runs.halts), [0, 3])
        self.assertIsInstance(runs.halts[3], Halted)
        self.assertEqual(runs.halts[0].reason, "livelock")
        self.assertEqual(runs.states[0, 1].t, runs.halts[0].time)
        self.assertEqual(runs.states[1:3, 1]["t"].tolist(), [5, 5])
        self.assertTrue(np.isfinite(runs.states["x"]).all())

    def test_refuses_with_the_first_run(self):
        def refusal(*arguments, **named):
            with self.assertRaises(SceneError) as caught:
                run_many(*arguments, **named)
            return caught.exception
        masses = np.linspace(1, 2, 500)
        masses[[333, 77, 400]] = [-1, -2, np.nan]
        for threads in (1, 2):
            error = refusal(PAIR, TIMES, {"sphere.mass": masses}, threads=threads)
            self.assertEqual((error.key, error.value), ("samples[77].sphere.mass", "-2"))
        self.assertIn("nearest", str(refusal(PAIR, TIMES, {"sphere.mas": [1]})))
        self.assertEqual(refusal(PAIR, TIMES, {}).key, "samples")
        self.assertEqual(refusal(PAIR, TIMES, [1, 2]).key, "samples")
        self.assertEqual(refusal(PAIR, TIMES, {"sphere.mass": 1}).key, "samples[sphere.mass]")
        self.assertEqual(refusal(PAIR, TIMES, {"sphere.mass": ["heavy"]}).key, "samples[sphere.mass]")
        self.assertEqual(refusal(PAIR, TIMES, {"sphere.mass": [1, 2], "sphere.radius": [1]}).key, "samples[sphere.radius]")
        self.assertEqual(refusal(PAIR, TIMES, fields=["speed"]).key, "fields")
        self.assertEqual(refusal(PAIR, TIMES, fields=["x", "x"]).value, '"x"')
        self.assertEqual(refusal(PAIR, TIMES, {"sphere.mass": np.ma.array([1.], mask=[1])}).value, "a masked array")
        self.assertEqual(refusal(PAIR, TIMES, {"\ud800": [1]}).key, "samples")
        self.assertEqual(refusal(PAIR, TIMES, threads=0).key, "threads")
        with self.assertRaises(TypeError):
            run_many(PAIR, TIMES, threads=2.5)
        self.assertEqual(refusal(PAIR, [-1]).key, "times[0]")
        self.assertEqual(refusal([PAIR, {"sphere": 1}], TIMES).key, "scenes[1].sphere")

    def test_ends_by_a_signal(self):
        process = subprocess.Popen([sys.executable, "-c", LONG], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.assertEqual(process.stdout.readline(), "ready\n")
        let_pass(0.3)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, -signal.SIGINT, errors)
        self.assertIn("KeyboardInterrupt", errors)


if __name__ == "__main__":
    unittest.main()
