"""hybrid_sphere.Number: its derivatives are exact, and numpy works on it."""
import math
import random
import unittest

import numpy as np

import hybrid_sphere
from hybrid_sphere import Number

STEP = 1e-30  # of f(x + i h) = f + i h f', which has no rounding of differences


def slope(f, x):
    return f(complex(x, STEP)).imag / STEP


def curvature(f, x):
    """By central differences of slopes, extrapolated: error some h^4 f''''''/100 + eps/h."""
    def difference(h):
        return (slope(f, x + h) - slope(f, x - h)) / (2 * h)
    h = 1e-3 * max(1, abs(x))
    h = min(h, 0.1 * abs(x)) if x else h
    return (4 * difference(h / 2) - difference(h)) / 3


# Where each is analytic in a neighbourhood.
COMPLEX = {
    "sqrt": (0.3, 2.5), "sin": (-2, 0.7, 4), "cos": (-2, 0.7, 4), "tan": (-0.9, 0.4, 2), "arcsin": (-0.6, 0.3),
    "arccos": (-0.6, 0.3), "arctan": (-3, 0.2), "sinh": (-2, 0.7), "cosh": (-2, 0.7), "tanh": (-2, 0.3),
    "arcsinh": (-2, 0.3), "arccosh": (1.4, 5), "arctanh": (-0.6, 0.3), "exp": (-3, 0.5), "exp2": (-3, 0.5),
    "expm1": (-3, 0.5), "log": (0.2, 4), "log2": (0.2, 4), "log10": (0.2, 4), "log1p": (-0.5, 2),
}


class Functions(unittest.TestCase):
    def check(self, name, got, x, value, first, second):
        scale = max(1, abs(value), abs(first), abs(second))
        self.assertLessEqual(abs(got.value - value), 1e-14 * scale, (name, x))
        self.assertLessEqual(abs(got.gradient[0] - first), 1e-14 * scale, (name, x))
        self.assertLessEqual(abs(got.hessian[0, 0] - second), 1e-8 * scale, (name, x))

    def test_their_derivatives_are_those_of_complex_steps(self):
        for name, places in COMPLEX.items():
            f = getattr(np, name)
            for x in places:
                self.check(name, f(Number(x, [1])), x, float(f(x)), slope(f, x), curvature(f, x))

    def test_error_function_and_cube_root(self):
        for x in (-1.5, 0.3, 2.0):
            bell = 2 / math.sqrt(math.pi) * math.exp(-x * x)
            self.check("erf", Number(x, [1]).erf(), x, math.erf(x), bell, -2 * x * bell)
            self.check("erfc", Number(x, [1]).erfc(), x, math.erfc(x), -bell, 2 * x * bell)
            root = math.copysign(abs(x) ** (1 / 3), x)
            self.check("cbrt", np.cbrt(Number(x, [1])), x, root, root / (3 * x), -2 * root / (9 * x * x))

    def test_linear_ones(self):
        for x in (-1.5, 2.25):
            for name in ("radians", "deg2rad", "degrees", "rad2deg", "fabs", "negative", "positive", "absolute"):
                f = getattr(np, name)
                self.check(name, f(Number(x, [1])), x, f(x), (f(x * 1.0625) - f(x)) / (x * 0.0625), 0)

    def test_steps_are_constant(self):
        for name in ("floor", "ceil", "rint", "trunc"):
            got = getattr(np, name)(np.array([Number(2.6, [1])]))[0]
            self.check(name, got, 2.6, getattr(np, name)(2.6), 0, 0)

    def test_powers(self):
        for x, p in ((2.5, 2), (-1.5, 3), (2.5, -1.5), (0.0, 2), (0.0, 3), (-2.0, 0), (-2.0, 1),
                     (1.7, np.float64(2.2))):
            second = p * (p - 1) * x ** (p - 2) if p not in (0, 1) else 0
            self.check("power", Number(x, [1]) ** p, x, x ** p, p * x ** (p - 1) if p else 0, second)
        for x in (-1.0, 0.5, 3.0):
            self.check("base", 2.5 ** Number(x, [1]), x, 2.5 ** x, math.log(2.5) * 2.5 ** x,
                       math.log(2.5) ** 2 * 2.5 ** x)

    def test_two_numbers(self):
        x, y = 1.25, -0.75
        for f, g in ((np.arctan2, lambda a, b: np.arctan(a / b) - math.pi),
                     (np.hypot, lambda a, b: np.sqrt(a * a + b * b)),
                     (np.power, lambda a, b: np.exp(b * np.log(a))),
                     (np.fmod, lambda a, b: a + b), (np.remainder, lambda a, b: a + 2 * b),
                     (np.fmin, lambda a, b: b), (np.fmax, lambda a, b: a),
                     (np.minimum, lambda a, b: b), (np.maximum, lambda a, b: a)):
            got = f(Number(x, [1, 0]), Number(y, [0, 1]))
            wanted = f(x, y)
            if f is np.arctan2:
                wanted = np.arctan2(x, y)
                g = lambda a, b: math.pi / 2 - np.arctan(b / a)  # noqa: E731
            self.assertLess(abs(got.value - wanted), 1e-15, f)
            h = g(Number(x, [1, 0]), Number(y, [0, 1]))
            np.testing.assert_allclose(got.gradient, h.gradient, 1e-14, 1e-15, str(f))
            np.testing.assert_allclose(got.hessian, h.hessian, 1e-13, 1e-14, str(f))

    def test_the_sign_of_another(self):
        self.assertEqual(repr(Number(2, [1]).copysign(-0.0)), "Number(-2, [-1])")


def random_expression(draw, depth):
    """A function of x, y, z that is analytic everywhere, as text."""
    if depth == 0:
        return draw.choice(["x", "y", "z", "%.2f" % draw.uniform(-2, 2)])
    a, b = random_expression(draw, depth - 1), random_expression(draw, depth - 1)
    return draw.choice(["(%s + %s)", "(%s - %s)", "(%s * %s)", "(%s / (2 + np.cos(%s)))",
                        "(np.sin(%s) * np.exp(-(%s)**2 / 9))", "np.arctan(%s) * (%s)",
                        "np.sqrt(3 + np.sin(%s)) - (%s)", "np.tanh(%s) ** 3 + (%s)",
                        "(2.5 + np.cos(%s)) ** np.sin(%s)", "(-(%s) + 1 - (%s) * 2)"]) % (a, b)


class Expressions(unittest.TestCase):
    def test_random_ones_have_the_derivatives_of_complex_steps(self):
        draw = random.Random(7)
        checked = 0
        for _ in range(300):
            text = random_expression(draw, 4)
            f = eval("lambda x, y, z: " + text, {"np": np})  # noqa: S307
            at = [draw.uniform(-1.5, 1.5) for _ in range(3)]
            numbers = [Number(x, row) for x, row in zip(at, np.eye(3))]
            got = f(*numbers)
            if not isinstance(got, Number) or not np.isfinite(got.hessian).all() or abs(got.value) > 1e3:
                continue

            def partial(i, place):
                moved = [complex(x, STEP * (k == i)) for k, x in enumerate(place)]
                return complex(f(*moved)).imag / STEP
            gradient = [partial(i, at) for i in range(3)]
            scale = 1 + np.abs(gradient).max() + np.abs(got.hessian).max()
            np.testing.assert_allclose(got.gradient, gradient, 0, 1e-13 * scale, text)
            self.assertTrue((got.hessian == got.hessian.T).all())
            h = 1e-4
            for i in range(3):
                for j in range(3):
                    def place(d):
                        return [x + d * (k == j) for k, x in enumerate(at)]
                    differences = [(partial(i, place(s)) - partial(i, place(-s))) / (2 * s) for s in (h, h / 2)]
                    second = (4 * differences[1] - differences[0]) / 3
                    self.assertLess(abs(got.hessian[i, j] - second), 1e-7 * scale, text)
            checked += 1
        self.assertGreater(checked, 200)


class Arithmetic(unittest.TestCase):
    def test_python_and_numpy_numbers_mix(self):
        x = Number(3.0, [1])
        for two in (2, 2.0, np.float64(2), np.float32(2), np.int64(2), np.array(2.0)[()], True + 1):
            for got, value, first in ((x + two, 5, 1), (two + x, 5, 1), (x - two, 1, 1), (two - x, -1, -1),
                                      (x * two, 6, 2), (two * x, 6, 2), (x / two, 1.5, 0.5), (two / x, 2 / 3, -2 / 9),
                                      (x ** two, 9, 6), (x % two, 1, 1), (x // two, 1, 0)):
                self.assertIsInstance(got, Number)
                self.assertEqual(got.value, value)
                self.assertAlmostEqual(got.gradient[0], first, 15)

    def test_arrays_work(self):
        v = np.array([Number(3.0, [1, 0]), Number(4.0, [0, 1])])
        for square in (v @ v, np.dot(v, v), np.sum(v * v), np.linalg.norm(v) ** 2, (v ** 2).sum(), v.dot(v)):
            self.assertAlmostEqual(square.value, 25, 13)
            np.testing.assert_allclose(square.gradient, [6, 8], 1e-14)
            np.testing.assert_allclose(square.hessian, [[2, 0], [0, 2]], 1e-13, 1e-14)
        matrix = np.array([[2.0, 1.0], [1.0, 3.0]])
        np.testing.assert_allclose((v @ matrix @ v).hessian, 2 * matrix)
        self.assertEqual(np.array([v[0], 1.0]).dtype, object)
        self.assertEqual((2.0 * v)[1].value, 8)
        self.assertEqual((v[0] * np.array([1.0, 2.0]))[1].value, 6)
        self.assertEqual((np.array([1.0, 2.0]) * v[0])[1].value, 6)
        self.assertEqual(np.sin(v)[0].value, math.sin(3))
        self.assertEqual(np.clip(v[0], 0, 2), 2)
        for array in (np.add(v[0], np.array([1.0, 2.0])), np.add(np.array([1.0, 2.0]), v[0])):
            self.assertEqual([x.value for x in array], [4, 5])
        self.assertEqual(np.multiply(v[0], 2, dtype=object).value, 6)
        self.assertEqual(np.add.outer(v[0], [1, 2])[1].value, 5)
        self.assertTrue(np.less(v[0], 4) and np.equal(3, v[0]) and np.sign(v[1]) == 1 and np.square(v[1]).value == 16)

    def test_either_argument_may_be_plain(self):
        x = Number(0.5, [1])
        for f, a, b in ((np.arctan2, 1.0, x), (np.arctan2, x, 1.0), (np.hypot, 2, x), (np.hypot, x, 2),
                        (np.fmod, 2.25, x), (np.power, 2, x), (np.maximum, 0, x), (np.minimum, x, 1),
                        (np.copysign, x, -1.0)):
            d = 2.0**-20
            values = [f(*(n.value + s if n is x else n for n in (a, b))) for s in (-d, d)]
            self.assertAlmostEqual(f(a, b).gradient[0], (values[1] - values[0]) / (2 * d), 9, f)
        with self.assertRaises(TypeError):
            np.isfinite(x)
        with self.assertRaises((TypeError, AttributeError)):
            np.arctan2("a", x)

    def test_comparisons_compare_values(self):
        x = Number(1.5, [1])
        self.assertTrue(x > 1 and 1 < x and x <= 1.5 and x == 1.5 and x != 2 and not x < np.float64(1.5))
        self.assertTrue(Number(0.5) and not Number(0))
        self.assertEqual(abs(Number(-2, [1])).gradient[0], -1)
        with self.assertRaises(TypeError):
            hash(x)

    @np.errstate(all="ignore")
    def test_not_finite_where_not_differentiable(self):
        self.assertFalse(np.isfinite(np.sqrt(Number(0, [1])).gradient[0]))
        self.assertTrue(math.isnan(np.log(Number(-1, [1])).value))
        self.assertTrue(math.isinf((1 / Number(0, [1])).value))

    def test_refusals(self):
        x = Number(1.5, [1])
        for wrong in (lambda: math.sin(x), lambda: float(x), lambda: np.array([1.0]).__setitem__(0, x)):
            with self.assertRaisesRegex(TypeError, "np.sin"):
                wrong()
        for wrong in (lambda: x + "a", lambda: x * None, lambda: x + 1j, lambda: Number("a"),
                      lambda: Number(1, "abc"), lambda: x.arctan2("a"), lambda: pow(x, 2, 3)):
            with self.assertRaises(TypeError):
                wrong()
        with self.assertRaises(ValueError):
            x + Number(1, [1, 0])
        with self.assertRaises(ValueError):
            Number(1, [1], [[1, 2]])

    def test_hessian_of_the_constructor(self):
        x = Number(2.0, [1, 3], [[1, 2], [2, 5]])
        np.testing.assert_array_equal((2 * x).hessian, [[2, 4], [4, 10]])
        np.testing.assert_array_equal((x * x).hessian, 4 * np.array([[1, 2], [2, 5]]) + 2 * np.outer([1, 3], [1, 3]))
        self.assertEqual(repr(x), "Number(2, [1, 3])")
        self.assertEqual(hybrid_sphere.Number, Number)


if __name__ == "__main__":
    unittest.main()
