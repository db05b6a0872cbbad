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


if __name__ == "__main__":
    unittest.main()
