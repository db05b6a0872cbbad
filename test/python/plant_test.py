"""hybrid_sphere.Plant: its snapshots and inputs, and the arrays of motions."""
import gc
import os
import tempfile
import unittest
import weakref

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


def oscillator(u):
    """m x'' = -k x, with the inputs m and k."""
    return hybrid_sphere.System(["x"], lambda t, q, v: (u[0] * v[0]**2 - u[1] * q[0]**2) / 2)


class Inputs(unittest.TestCase):
    """Functions of the input."""

    def test_change_the_lagrangian(self):
        # With m = 1, k = 4 up to t = pi / 4, x = cos(2 t) = 0, x' = -2; then with m = 4, k = 4: x = -2 sin(t - pi / 4).
        plant = hybrid_sphere.Plant(oscillator, [1], [0], input=[1, 4], accuracy=1e-12)
        np.testing.assert_array_equal(plant.input, [1, 4])
        plant.advance(np.pi / 4)
        plant.set_input([4, 4])
        plant.advance(np.pi / 4 + 1)
        self.assertAlmostEqual(plant.state.x, -2 * np.sin(1), delta=1e-11)

    def test_change_constraints_by_an_impulse(self):
        def driven(u):
            system = hybrid_sphere.System(["x", "y"], lambda t, q, v: v @ v)
            return system.constrain("wheel", lambda t, q, v: [v[0] - u[0]])
        plant = hybrid_sphere.Plant(driven, [0, 0], [1, 2], input=[1])
        plant.set_input([3])
        plant.advance(1)
        self.assertEqual((plant.state.x, plant.state.y, len(plant.switches)), (3, 2, 1))
        self.assertEqual((plant.switches[0].Lambda_wheel, plant.switches[0].applied), (4, ""))

    def test_change_guards_and_loads(self):
        def braked(u):
            system = hybrid_sphere.System(["x"], lambda t, q, v: v @ v / 2)
            system.friction("brake", lambda t, q, v: v[0], 0.5, load=lambda t, q, v: u[0])
            return system.constrain("wall", lambda t, q, v: v[0], while_positive=lambda t, q: q[0] - u[1])
        plant = hybrid_sphere.Plant(braked, [0], [2], input=[0, 10])
        plant.advance(1)
        plant.set_input([2, 3.5])  # x = 2 + 2 s - s^2 / 2 comes to 3.5 at s = 1
        plant.advance(3)
        self.assertAlmostEqual(plant.switches["t"][-1], 2, delta=1e-9)
        self.assertIn("wall", plant.switches["applied"][-1])

    def test_may_make_systems_of_the_catalogue_and_of_bodies(self):
        plant = hybrid_sphere.Plant(lambda u: hybrid_sphere.catalogue("knife_edge_incline", gs=u[0], t_switch=1e9), [0, 0, 0],
                                    [0, 0, 0], input=[2])
        plant.advance(1)
        self.assertAlmostEqual(plant.state.x, 1, delta=1e-9)
        at_rest = hybrid_sphere.Plant(lambda u: hybrid_sphere.catalogue("knife_edge_incline", m=u[0]), input=[2])
        np.testing.assert_array_equal([at_rest.state.x], hybrid_sphere.catalogue("knife_edge_incline").q[:1])

        def pushed(u):
            return hybrid_sphere.MultibodySystem([0, 0, 0]).point_mass("a", 1, [0, 0, 0]).apply("a", (u, [0, 0, 0]))
        plant = hybrid_sphere.Plant(pushed, *pushed([0, 0, 0]).initial(), input=[2, 0, 0])
        plant.advance(1)
        plant.set_input([0, 2, 0])
        plant.advance(2)
        np.testing.assert_allclose(hybrid_sphere.columns(plant.state, ("a.x", "a.y")), [3, 1], rtol=1e-9)

    def test_belong_to_the_present(self):
        plant = hybrid_sphere.Plant(oscillator, [1], [0], input=[1, 4])
        saved = plant.save()
        ends = []
        for _ in range(2):
            plant.restore(saved)
            np.testing.assert_array_equal(plant.input, [1, 4])
            plant.advance(0.5)
            plant.set_input([2, 3])
            gc.collect()
            plant.advance(1)
            ends.append(plant.state.tobytes())
        self.assertEqual(*ends)
        hybrid_sphere.Plant(oscillator, [2], [0], input=[1, 1]).restore(saved)
        with self.assertRaises(ValueError):
            hybrid_sphere.Plant(lambda u: oscillator(u), [2], [0], input=[1, 1]).restore(saved)

    def test_refused_change_nothing(self):
        def system(u):
            if u[0] > 5:
                raise ZeroDivisionError
            if u[0] > 4:
                return None
            rod = hybrid_sphere.System(["x", "y"], lambda t, q, v: v @ v)
            rod.holonomic("other" if u[0] > 3 else "rod", lambda t, q: q @ q - u[0]**2)
            return rod.event("late", lambda t, q, v: t - 9) if u[0] < 0 else rod
        plant = hybrid_sphere.Plant(system, [1, 0], [0, 1], input=[1])
        for wrong, error, message in (([2], ValueError, "constraint rod: they are off"), ([3.5], ValueError, "other coordinates"),
                                      ([-1], ValueError, "other coordinates"), ([4.5], TypeError, "NoneType; it has to be a Model"),
                                      ([6], ZeroDivisionError, ""), ([1, 2], ValueError, "2 numbers, not 1"),
                                      ([np.nan], ValueError, "finite")):
            with self.assertRaisesRegex(error, message):
                plant.set_input(wrong)
        plant.advance(1)
        np.testing.assert_allclose(plant.state.x, np.cos(1), rtol=1e-9)

    def test_at_the_start_are_needed(self):
        for wrong in (None, True, False):
            with self.assertRaisesRegex(ValueError, "first input is missing"):
                hybrid_sphere.Plant(oscillator, [1], [0], input=wrong)
        with self.assertRaisesRegex(TypeError, "a Model, or a function"):
            hybrid_sphere.Plant("oscillator", [1], [0])
        forced = hybrid_sphere.Plant(oscillator([1, 0]), [0], [0], input=[2])
        forced.advance(1)
        self.assertAlmostEqual(forced.state.x, 1, delta=1e-9)

    def test_may_refer_to_what_has_the_plant(self):
        class Owner:
            def system(self, u):
                return hybrid_sphere.System(["x" if u[0] < 3 else "y"], lambda t, q, v: u[0] * v[0]**2 if self else 0)
        owner = Owner()
        owner.plant = hybrid_sphere.Plant(owner.system, [0], [1], input=[1])
        owner.plant.set_input([2])
        with self.assertRaises(ValueError):
            owner.plant.set_input([3])  # other coordinates
        owner.saved = owner.plant.save()
        alive = weakref.ref(owner)
        del owner
        gc.collect()
        self.assertIsNone(alive())


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
