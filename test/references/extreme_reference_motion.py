"""The closed forms of a sphere on level ground at rest, in mpmath: the motions of make_extreme_references.

Every path is r0 + A(t) v0 + B(t) a. A and B are those of linear drag (t and t^2/2 without it); with quadratic drag a
is 0 and A = log(1 + c |v0| t)/c/|v0|. Symbols as in docs/theory.md.
"""
import mpmath as mp
from mpmath import mpf

ZERO = (mpf(0), mpf(0))


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def mul(c, a):
    return tuple(c * x for x in a)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def norm(a):
    return mp.sqrt(dot(a, a))


def turn(rotation, q):
    """exp(rotation/2) q, quaternions as (w, x, y, z)."""
    angle = norm(rotation)
    if angle == 0:
        return q
    s = mp.sin(angle / 2) / angle
    w, (x, y, z) = mp.cos(angle / 2), mul(s, rotation)
    a, b, c, d = q
    return (w * a - x * b - y * c - z * d, w * b + x * a + y * d - z * c,
            w * c - x * d + y * a + z * b, w * d + x * c - y * b + z * a)


class Motion:
    """From one switch to the next: mode is free, rolling or sliding."""

    def __init__(self, world, state, mode, friction=None):
        self.world, self.start, self.mode = world, state, mode
        share = 1 - world.kappa if mode == "rolling" else 1
        self.rate = share * world.drag / world.m
        speed = norm(state.v)
        self.growth = share * world.quadratic * speed / world.m
        self.a = mul(share / world.m, world.force)
        self.end = None
        self.spin_up = ZERO
        if mode == "sliding":
            self.begin_sliding(friction)

    def begin_sliding(self, friction):
        world, state = self.world, self.start
        slip = world.slip(state.v, state.w)
        direction = mul(1 / norm(slip), slip)
        decay = friction * world.g
        self.a = sub(self.a, mul(decay, direction))
        self.spin_up = mul(decay * (1 - world.kappa) / world.kappa, direction)
        if self.rate == 0 and not any(world.force):
            self.end = norm(slip) * world.kappa / decay
            return
        if cross(state.v, slip) != 0 or any(world.force):
            raise ValueError("sliding beside a drag: along one line only")

        def remaining(t):
            return dot(sub(self.velocity(t), self.nu(t)), direction)
        late = norm(slip) * world.kappa / decay  # the drag only shortens it where v and the slip have one direction
        self.end = mp.findroot(remaining, (mpf(0), late), solver="anderson", tol=mpf(10) ** (-2 * mp.mp.dps + 20))

    # -- the functions A and B, and A's derivative
    def reach(self, t):
        if self.growth != 0:
            return mp.log1p(self.growth * t) / self.growth
        return t if self.rate == 0 else -mp.expm1(-self.rate * t) / self.rate

    def push(self, t):
        return t * t / 2 if self.rate == 0 else (t - self.reach(t)) / self.rate

    def decay(self, t):
        return 1 / (1 + self.growth * t) if self.growth != 0 else mp.exp(-self.rate * t)

    def position(self, t):
        return add(self.start.r, add(mul(self.reach(t), self.start.v), mul(self.push(t), self.a)))

    def velocity(self, t):
        return add(mul(self.decay(t), self.start.v), mul(self.reach(t) if self.growth == 0 else mpf(0), self.a))

    def nu(self, t):
        if self.mode == "rolling":
            return self.velocity(t)
        return add(self.world.nu(self.start.w), mul(t, self.spin_up))

    def omega(self, t):
        nu = self.nu(t)
        return (-nu[1] / self.world.R, nu[0] / self.world.R, self.start.w[2])

    def is_uniform(self):
        return self.rate == self.growth == 0 and not any(self.a) and not any(self.spin_up)

    def orientation(self, t):
        """Where the axis of rotation stays; else None."""
        start = self.start
        if start.q is None:
            return None
        if self.mode == "free" or self.is_uniform():
            return turn(mul(t, start.w), start.q)
        if self.mode == "rolling":
            change, first, second = sub(self.position(t), start.r), start.v, self.a
        else:
            first, second = self.world.nu(start.w), self.spin_up
            change = add(mul(t, first), mul(t * t / 2, second))
        if start.w[2] != 0 or cross(first, second) != 0:
            return None
        return turn((-change[1] / self.world.R, change[0] / self.world.R, mpf(0)), start.q)

    # -- where the path meets an edge
    def times_at_line(self, point, normal, until):
        """Instants after 0 at which normal.(r - point) is 0; the start may be on the line."""
        g0, g1, g2 = dot(normal, sub(self.start.r, point)), dot(normal, self.start.v), dot(normal, self.a)
        if g2 == 0:
            return [] if g0 == 0 or g1 == 0 else self.inverse_reach(-g0 / g1)
        if self.rate == 0:
            root = mp.sqrt(g1 * g1 - 2 * g0 * g2) if g1 * g1 >= 2 * g0 * g2 else None
            return [] if root is None else [t for t in sorted([(-g1 - root) / g2, (-g1 + root) / g2]) if t > 0]

        def g(t):
            return g0 + self.reach(t) * g1 + self.push(t) * g2
        turning = mp.log1p(-self.rate * g1 / g2) / self.rate if self.rate * g1 < g2 else mpf(-1)
        ends = [mpf(0)] + ([turning] if 0 < turning < until else []) + [until]
        return [bisected(g, a, b) for a, b in zip(ends, ends[1:]) if g(a) * g(b) < 0]

    def inverse_reach(self, way):
        if self.growth != 0:
            times = [mp.expm1(self.growth * way) / self.growth]
        elif self.rate == 0:
            times = [way]
        else:
            times = [-mp.log1p(-self.rate * way) / self.rate] if self.rate * way < 1 else []
        return [t for t in times if t > 0]

    def times_at_circle(self, center, radius):
        if not self.is_uniform():
            raise ValueError("circles: on uniform motions only")
        p, v = sub(self.start.r, center), self.start.v
        a, b, c = dot(v, v), dot(p, v), dot(p, p) - radius * radius
        disc = (b * b - a * c)
        if disc <= 0:
            return []
        root = mp.sqrt(disc)
        tiny = mpf(10) ** (-mp.mp.dps + 20) * norm(p) / norm(v)
        return [t for t in sorted([(-b - root) / a, (-b + root) / a]) if t > tiny]


def bisected(g, a, b):
    """A root between two signs, where Newton's method would meet numbers of very different sizes."""
    positive = g(a) > 0
    for _ in range(4 * mp.mp.prec):
        middle = (a + b) / 2
        if (g(middle) > 0) == positive:
            a = middle
        else:
            b = middle
        if b - a <= mpf(10) ** (-mp.mp.dps + 10) * b:
            break
    return (a + b) / 2
