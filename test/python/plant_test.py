"""hybrid_sphere.Plant: its snapshots, and the arrays of motions."""
import os
import tempfile
import unittest

import numpy as np

import hybrid_sphere


class Snapshots(unittest.TestCase):
    def test_are_of_one_system_and_its_input(self):
        def mass(m):
            return hybrid_sphere.System(["x"], lambda t, q, v: m / 2 * v[0]**2)
        one, other = mass(1), mass(10)
        plant = hybrid_sphere.Plant(one, [0], [1])
        saved = plant.save()
        for wrong in (hybrid_sphere.Plant(other, [0], [1]), hybrid_sphere.Plant(one, [0], [1], input=True)):
            with self.assertRaises(ValueError):
                wrong.restore(saved)
        plant.advance(1)
        plant.restore(saved)
        self.assertEqual((plant.time, plant.state.x), (0, 0))
        again = hybrid_sphere.Plant(one, [5], [1])
        again.restore(saved)
        self.assertEqual(again.state.x, 0)


class OnSwitch(unittest.TestCase):
    """x = t + t^2/2 = 1 at t = sqrt(3) - 1, with the speed sqrt(3)."""

    def setUp(self):
        system = hybrid_sphere.System(["x"], lambda t, q, v: v[0]**2 / 2)
        system.event("line", lambda t, q, v: q[0] - 1)
        self.plant = hybrid_sphere.Plant(system, [0], [1], input=True)
        self.plant.set_input([1])
        self.crossing = np.sqrt(3) - 1

    def test_sees_the_plant_at_the_switch(self):
        seen = []
        self.assertEqual(self.plant.advance(2, lambda switch: seen.append((switch.t, self.plant.time, self.plant.state.x))), 1)
        np.testing.assert_allclose(seen, [(self.crossing, self.crossing, 1)], rtol=1e-14)
        self.assertEqual(len(self.plant.switches), 1)
        self.assertAlmostEqual(self.plant.state.x, 4, delta=1e-12)

    def test_may_set_an_input_that_acts_from_there_on(self):
        self.plant.advance(1.5, on_switch=lambda switch: self.plant.set_input([-3]))
        rest = 1.5 - self.crossing
        self.assertAlmostEqual(self.plant.state.x, 1 + np.sqrt(3) * rest - 1.5 * rest**2, delta=1e-12)

    def test_may_not_advance_or_restore(self):
        saved = self.plant.save()
        for name, call in (("advance", lambda switch: self.plant.advance(3)), ("restore", lambda switch: self.plant.restore(saved))):
            with self.assertRaisesRegex(RuntimeError, name + r"\(\) is called in on_switch"):
                self.plant.advance(2, call)
            self.assertAlmostEqual(self.plant.time, self.crossing, delta=1e-14)
            self.plant.restore(saved)

    def test_that_raises_leaves_the_plant_at_the_switch(self):
        with self.assertRaises(ZeroDivisionError):
            self.plant.advance(2, lambda switch: 1 / 0)
        self.assertAlmostEqual(self.plant.time, self.crossing, delta=1e-14)
        self.assertAlmostEqual(self.plant.state.x, 1, delta=1e-14)
        self.assertEqual(self.plant.advance(2), 0)
        self.assertAlmostEqual(self.plant.state.x, 4, delta=1e-12)


class Arrays(unittest.TestCase):
    def test_have_one_type_and_can_be_saved(self):
        system = hybrid_sphere.System(["x", "y"], lambda t, q, v: v @ v / 2)
        system.constrain("rail", lambda t, q, v: v[1] - v[0], begin=1)
        plant = hybrid_sphere.Plant(system, [0, 0], [1, 0])
        kept = np.zeros(2, plant.state.dtype)
        kept[0] = plant.state
        plant.advance(2)
        kept[1] = plant.state
        self.assertEqual(kept["active"].tolist(), ["", "rail"])
        with tempfile.TemporaryDirectory() as directory:
            for array in (kept, plant.switches, system.solve(2, [0, 0], [1, 0]).at([0, 2])):
                path = os.path.join(directory, "array.npy")
                np.save(path, array)
                self.assertTrue(np.array_equal(np.load(path), array))

    def test_are_of_the_system_as_it_was(self):
        system = hybrid_sphere.System(["x"], lambda t, q, v: v[0]**2 / 2)

        def changing(t, q, v):
            if "late" not in system.events:
                system.event("late", lambda t, q, v: t - 0.5)
            return v[0] - 1
        system.constrain("first", changing, begin=0.25)
        motion = system.solve(1, [0], [2])
        self.assertEqual(motion.switches["events"].tolist(), [""])
        self.assertEqual(len(system.solve(1, [0], [2]).switches), 2)


class Columns(unittest.TestCase):
    """Two rails from t = 1 on, one of them with two functions."""

    def setUp(self):
        system = hybrid_sphere.System(["x", "y", "z"], lambda t, q, v: v @ v / 2)
        system.constrain("rail", lambda t, q, v: [v[0] - v[1], v[2] - 1], begin=1).constrain("still", lambda t, q, v: v[0], begin=1)
        self.system, self.motion = system, system.solve(2, [0, 0, 0], [1, 3, 0])

    def test_of_states_side_by_side(self):
        states = self.motion.at([0, 0.5])
        np.testing.assert_allclose(hybrid_sphere.columns(states, self.system.coordinates), [[0, 0, 0], [0.5, 1.5, 0]], rtol=1e-15)
        np.testing.assert_allclose(hybrid_sphere.columns(states[1], self.system.velocities), [1, 3, 0], rtol=1e-15)
        self.assertEqual(hybrid_sphere.columns(states, ()).shape, (2, 0))

    def test_of_a_constraint_by_its_name(self):
        event = self.motion.switches[0]
        np.testing.assert_allclose(hybrid_sphere.columns(event, "Lambda_rail"), [3, 1], rtol=1e-12)
        np.testing.assert_allclose(hybrid_sphere.columns(event, "Lambda_still"), [-4], rtol=1e-12)
        self.assertEqual(hybrid_sphere.columns(self.motion.at([0, 1, 2]), "lambda_rail").shape, (3, 2))

    def test_that_are_not_there_are_refused(self):
        for wrong in ("rail", ["x", "w"], "lambda_rail_3"):
            with self.assertRaisesRegex(ValueError, "no column .*; allowed: t, stage, x"):
                hybrid_sphere.columns(self.motion.at(0), wrong)

    def test_of_two_constraints_are_told_apart(self):
        self.system.constrain("rail_3", lambda t, q, v: v[0], begin=1)
        with self.assertRaisesRegex(ValueError, "lambda_rail_3"):
            self.system.solve(2, [0, 0, 0], [1, 3, 0])


if __name__ == "__main__":
    unittest.main()
