"""hybrid_sphere.linearize, equilibrium and modes: closed forms, the bicycle's published eigenvalues, what is refused."""
import unittest

import numpy as np

import hybrid_sphere
from hybrid_sphere import ContactShape, MultibodySystem, Plant, System, equilibrium, linearize, modes

# Of the extrapolated differences, some 1e-11 of the sizes of their terms, which are below 10.
TOLERANCE = 1e-9


def pendulum(g=9.81, m=2.0):
    return System(["phi"], lambda t, q, v: m * (v[0]**2 / 2 + g * np.cos(q[0])))


class ClosedForms(unittest.TestCase):
    def test_of_a_pendulum(self):
        system = pendulum()
        near = linearize(system, Plant(system, [0.5], [0.25]).state, input=True)
        np.testing.assert_allclose(near.rate, [0.25, -9.81 * np.sin(0.5)], rtol=1e-14)
        np.testing.assert_allclose(near.A, [[0, 1], [-9.81 * np.cos(0.5), 0]], atol=TOLERANCE)
        np.testing.assert_allclose(near.B, [[0], [0.5]], atol=TOLERANCE)
        self.assertEqual(near.names, ("phi", "phi_dot"))
        self.assertEqual(repr(near), "<hybrid_sphere.Linearization of phi phi_dot; 1 input>")

    def test_without_an_input_there_is_no_column(self):
        system = pendulum()
        self.assertEqual(linearize(system, system.solve(1, [0.5], [0]).at(1)).B.shape, (2, 0))

    def test_of_parameters_as_inputs(self):
        # phi'' = -g / l sin(phi) + u / (m l^2), with the inputs l and u
        def steered(u):
            return System(["phi"], lambda t, q, v: 2 * (u[0]**2 * v[0]**2 / 2 + 9.81 * u[0] * np.cos(q[0])),
                          lambda t, q, v: [u[1]])
        state = Plant(steered, [0.5], [0.25], input=[1.5, 3]).state
        near = linearize(steered, state, input=[1.5, 3])
        self.assertAlmostEqual(near.rate[1], -9.81 / 1.5 * np.sin(0.5) + 3 / 4.5, delta=1e-13)
        self.assertAlmostEqual(near.A[1, 0], -9.81 / 1.5 * np.cos(0.5), delta=TOLERANCE)
        of_length = 9.81 / 1.5**2 * np.sin(0.5) - 2 * 3 / (2 * 1.5**3)
        np.testing.assert_allclose(near.B, [[0, 0], [of_length, 1 / 4.5]], atol=TOLERANCE)

    def test_under_the_constraints_of_the_state(self):
        # On the rail y = x both have half of the force -x; before t = 1, x alone has it.
        system = System(["x", "y"], lambda t, q, v: (v @ v - q[0]**2) / 2)
        system.constrain("rail", lambda t, q, v: [v[1] - v[0]], begin=1)
        motion = system.solve(2, [1, 1], [0, 0])
        np.testing.assert_allclose(linearize(system, motion.at(0.5)).A[2:, 0], [-1, 0], atol=TOLERANCE)
        np.testing.assert_allclose(linearize(system, motion.at(1.5)).A[2:, 0], [-0.5, -0.5], atol=TOLERANCE)

    def test_of_what_slides(self):
        # a = -mu N / m v / abs(v): its derivative by v is -mu N / m (1 - e e^T) / abs(v).
        puck = System(["x", "y"], lambda t, q, v: v @ v).friction("plane", lambda t, q, v: v, 0.5, load=lambda t, q, v: 4)
        near = linearize(puck, Plant(puck, [0, 0], [3, 4]).state)
        np.testing.assert_allclose(near.rate[2:], [-0.6, -0.8], rtol=1e-14)
        np.testing.assert_allclose(near.A[2:, 2:], -np.array([[0.64, -0.48], [-0.48, 0.36]]) / 5, atol=TOLERANCE)
        for speed in (3, -3):
            block = System(["x"], lambda t, q, v: v @ v).friction("rail", lambda t, q, v: v[0], 0.5, load=lambda t, q, v: 4 + q[0])
            near = linearize(block, Plant(block, [0], [speed]).state)
            np.testing.assert_allclose(near.rate[1:], [-np.sign(speed)], rtol=1e-14)
            np.testing.assert_allclose(near.A[1], [-np.sign(speed) / 4, 0], atol=TOLERANCE)

    def test_of_a_system_of_the_catalogue(self):
        system = hybrid_sphere.catalogue("knife_edge_incline", t_switch=1e9)
        near = linearize(system, system.solve(0.5).at(0.5))
        np.testing.assert_allclose(near.A[:3, 3:], np.eye(3), atol=TOLERANCE)


def bicycle():
    """The benchmark of Meijaard, Papadopoulos, Ruina, Schwab, Proc. R. Soc. A 463 (2007) 1955-1982, table 1."""
    left, rear, front = [0, 1, 0], [0, 0, 0.3], [1.02, 0, 0.35]
    system = MultibodySystem()
    system.body("rear wheel", 2, [0.0603, 0.12, 0.0603], rear).body("frame", 85, [9.2, 11, 2.8, 0, -2.4, 0], [0.3, 0, 0.9])
    system.body("fork", 4, [0.05892, 0.06, 0.00708, 0, 0.00756, 0], [0.9, 0, 0.7])
    system.body("front wheel", 3, [0.1405, 0.28, 0.1405], front)
    system.hinge("rear hub", "frame", "rear wheel", rear, left)
    system.hinge("steering", "frame", "fork", [1.1, 0, 0], [-np.sin(np.pi / 10), 0, np.cos(np.pi / 10)])
    system.hinge("front hub", "fork", "front wheel", front, left)
    system.rolling("rear tyre", "rear wheel", ContactShape.disk(0.3, left))
    return system.rolling("front tyre", "front wheel", ContactShape.disk(0.35, left))


class Bicycle(unittest.TestCase):
    def test_has_the_published_eigenvalues(self):
        published = {0: [5.530943717653927, 3.131643247906560, -3.131643247906560, -5.530943717653927],
                     5: [-0.322866429004087, -0.775341882195845 + 4.464867713788229j,
                         -0.775341882195845 - 4.464867713788229j, -14.078389692798220]}
        system = bicycle()
        for speed, expected in published.items():
            time = 0.1 if speed > 0 else 0  # the wheels have turned by then
            state = system.solve(time, *system.initial({"frame": ([speed, 0, 0], [0, 0, 0])})).at(time)
            found = modes(system, state)
            np.testing.assert_allclose(found.eigenvalues, expected, rtol=1e-9)
            self.assertEqual(found.neutral, 6)  # x, y, the heading, the angles of two wheels, the speed


class Equilibria(unittest.TestCase):
    def test_of_a_pendulum_with_a_torque(self):
        rest = equilibrium(pendulum(), [0.2], input=[3.0])
        self.assertAlmostEqual(rest.phi, np.arcsin(3 / 2 / 9.81), delta=1e-13)
        found = modes(pendulum(), rest, input=[3.0])
        frequency = np.sqrt(9.81 * np.cos(rest.phi))
        np.testing.assert_allclose(found.eigenvalues, [frequency * 1j, -frequency * 1j], atol=TOLERANCE)
        np.testing.assert_allclose(found.vectors[1], found.eigenvalues * found.vectors[0], atol=TOLERANCE)
        self.assertEqual((found.neutral, found.names), (0, ("phi", "phi_dot")))

    def test_with_constraints_and_parameters(self):
        def hanging(u):  # on a rod of length u
            system = System(["x", "z"], lambda t, q, v: v @ v / 2 - 9.81 * q[1])
            return system.holonomic("rod", lambda t, q: (q @ q - u[0]**2) / 2)
        rest = equilibrium(hanging, [0.5, -1.8], input=[2.0])
        np.testing.assert_allclose([rest.x, rest.z, rest.lambda_rod], [0, -2, -9.81 / 2], atol=1e-12)
        found = modes(hanging, rest, input=[2.0])
        np.testing.assert_allclose(found.eigenvalues.imag, [np.sqrt(9.81 / 2), -np.sqrt(9.81 / 2)], atol=TOLERANCE)

    def test_are_refused_where_there_are_none(self):
        falling = System(["x"], lambda t, q, v: v @ v / 2 - q[0])
        with self.assertRaisesRegex(hybrid_sphere.Halted, "no equilibrium is found: after 1 iterations"):
            equilibrium(falling, [0])
        with self.assertRaisesRegex(ValueError, "state: its accelerations are off"):
            modes(pendulum(), Plant(pendulum(), [0.5], [0]).state)


class Refusals(unittest.TestCase):
    def test_of_states_of_another_system(self):
        system, state = pendulum(), Plant(pendulum(), [0.5], [0]).state
        other = System(["x"], lambda t, q, v: v @ v)
        known = {"t": 0, "phi": 0, "phi_dot": 0, "active": "", "sliding": ""}
        self.assertEqual(linearize(system, known).A[1, 0].round(9), -9.81)
        for call, message in ((lambda: linearize(other, state), 'no field "x"'), (lambda: linearize(system, 3), 'no field "t"'),
                              (lambda: linearize(system, pendulum().solve(1, [0.5], [0]).at([0, 1])), 'field "t" is refused'),
                              (lambda: linearize(system, {**known, "active": "blade"}),
                               'constraint "blade" is refused; allowed: none'),
                              (lambda: linearize(system, {**known, "sliding": "+blade"}), 'constraint "blade"'),
                              (lambda: linearize(system, {**known, "phi": np.nan}), "phi"),
                              (lambda: linearize(system, state, [1, 2]), "the input has 2 numbers, not 1"),
                              (lambda: linearize(pendulum, state), "the first input is missing")):
            with self.assertRaisesRegex(ValueError, message):
                call()
        for wrong in (3, "pendulum"):
            with self.assertRaises(TypeError):
                linearize(wrong, state)

    def test_of_equations_without_a_solution_halt(self):
        massless = System(["x", "y"], lambda t, q, v: v[0]**2 / 2)
        with self.assertRaises(hybrid_sphere.Halted) as caught:
            linearize(massless, {"t": 2, "x": 0, "y": 0, "x_dot": 0, "y_dot": 0, "active": "", "sliding": ""})
        self.assertEqual((caught.exception.reason, caught.exception.time), ("singular", 2))


if __name__ == "__main__":
    unittest.main()
