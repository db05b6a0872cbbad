"""How sliding begins when a rolling sphere loses its grip, for make_numeric_references.

The slip s = rho e begins with 0 and grows like tau^2, where |b| = A and b = f - g - W J v. In polar coordinates
  rho' = b.e - A,   rho theta' = |b| sin(arg b - theta)
is singular there. Its solution has a power series in tau: theta = arg b - asin(rho theta'/|b|) and the integral of
b.e - A give one more order each time they are applied.
"""
import mpmath as mp
from mpmath import mpf

ORDER = 22


class Series:
    """Power series in tau, cut off behind ORDER."""

    def __init__(self, coefficients):
        self.c = list(coefficients)[:ORDER + 1] + [mpf(0)] * (ORDER + 1 - len(coefficients))

    def __add__(self, other):
        return Series([a + b for a, b in zip(self.c, series(other).c)])

    def __sub__(self, other):
        return Series([a - b for a, b in zip(self.c, series(other).c)])

    def __mul__(self, other):
        if not isinstance(other, Series):
            return Series([a * other for a in self.c])
        return Series([mp.fdot(self.c[:n + 1], other.c[n::-1]) for n in range(ORDER + 1)])

    __radd__, __rmul__ = __add__, __mul__

    def __truediv__(self, other):
        out = []
        for n in range(ORDER + 1):
            out.append((self.c[n] - mp.fdot(out, other.c[n:0:-1])) / other.c[0])
        return Series(out)

    def derivative(self):
        return Series([n * a for n, a in enumerate(self.c)][1:])

    def integral(self, start):
        return Series([start] + [a / (n + 1) for n, a in enumerate(self.c)])

    def sqrt(self):
        out = [mp.sqrt(self.c[0])]
        for n in range(1, ORDER + 1):
            out.append((self.c[n] - mp.fdot(out[1:], out[:0:-1])) / (2 * out[0]))
        return Series(out)

    def at(self, tau):
        return mp.polyval(self.c[::-1], tau)


def series(value):
    return value if isinstance(value, Series) else Series([mpf(value)])


def cos_sin(angle):
    """Both from their differential equation."""
    slope, c, s = angle.derivative(), [mp.cos(angle.c[0])], [mp.sin(angle.c[0])]
    for n in range(ORDER):
        c.append(-mp.fdot(slope.c[:n + 1], s[n::-1]) / (n + 1))
        s.append(mp.fdot(slope.c[:n + 1], c[n::-1]) / (n + 1))
    return Series(c), Series(s)


def turn(a):
    return [-1 * a[1], a[0]]


def quaternion_series(q, omega):
    a, b, c, d = [[x] for x in q]
    x, y, z = (o.c for o in omega)

    def product(p, r, n):
        return mp.fdot(p[:n + 1], r[n::-1])
    for n in range(ORDER):
        rates = [-product(x, b, n) - product(y, c, n) - product(z, d, n),
                 product(x, a, n) + product(y, d, n) - product(z, c, n),
                 -product(x, d, n) + product(y, a, n) + product(z, b, n),
                 product(x, c, n) - product(y, b, n) + product(z, a, n)]
        for component, rate in zip((a, b, c, d), rates):
            component.append(rate / (2 * (n + 1)))
    return [Series(component) for component in (a, b, c, d)]


def slide_from_rolling(sphere, tau):
    """Moves a sphere that has just lost its grip on by tau; afterwards it slides."""
    w, ground = sphere.w, sphere.ground
    decay, friction = ground.friction * w.normal / w.kappa, ground.friction * w.normal
    if w.c2 or ground.spin_friction:
        raise ValueError("loss of grip with quadratic drag or spin friction")
    turn_decay = ground.resistance * w.normal * (1 - w.kappa) / w.kappa
    r, v, nu = ([series(c) for c in a] for a in (sphere.r, sphere.v, sphere.nu))
    rho, theta = series(0), None
    for _ in range(2 * ORDER):
        f = [w.free[i] + -w.c * v[i] + -w.stiffness * (r[i] - w.anchor[i]) for i in range(2)]
        g = [w.spin[i] + -w.cr * nu[i] for i in range(2)]
        spun = turn(v)
        b = [f[i] - g[i] - ground.rate * spun[i] for i in range(2)]
        if turn_decay:
            length = (nu[0] * nu[0] + nu[1] * nu[1]).sqrt()
            b = [b[i] + turn_decay * (nu[i] / length) for i in range(2)]
        square = b[0] * b[0] + b[1] * b[1]
        size = square.sqrt()
        direction = ((b[0] * b[1].derivative() - b[1] * b[0].derivative()) / square).integral(
            mp.atan2(b[1].c[0], b[0].c[0]))
        lag = rho * theta.derivative() / size if theta is not None else series(0)
        theta = direction - (lag.derivative() / (series(1) - lag * lag).sqrt()).integral(0)
        e = cos_sin(theta)
        rho = (b[0] * e[0] + b[1] * e[1] - decay).integral(0)
        rho.c[1] = mpf(0)
        v = [(f[i] - friction * e[i]).integral(sphere.v[i]) for i in range(2)]
        r = [v[i].integral(sphere.r[i]) for i in range(2)]
        moved = turn([r[i] - ground.center[i] for i in range(2)])
        nu = [v[i] - rho * e[i] - ground.belt[i] - ground.rate * moved[i] for i in range(2)]
    w3 = [sphere.w3]
    for n in range(ORDER):
        w3.append(((w.normal_spin if n == 0 else 0) - w.cr * w3[n]) / (n + 1))
    omega = [nu[1] * (-1 / w.R), nu[0] * (1 / w.R), Series(w3)]
    q = quaternion_series(sphere.q, omega)
    sphere.t += tau
    sphere.r, sphere.v, sphere.nu = ([c.at(tau) for c in a] for a in (r, v, nu))
    sphere.w3, sphere.q = omega[2].at(tau), [c.at(tau) for c in q]
