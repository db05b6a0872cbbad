"""Equations of motion for make_numeric_references: the sphere between two switches, to as many digits as wanted.

A world is a scene in numbers, a Sphere its state with the mode that it moves in:
  free      no tangential force of the ground
  rolling   no slip
  resisted  no slip, against a rolling resistance; stopped: the resistance holds it where it is on the ground
  sliding   friction against the slip
  resisted_sliding the same, and a rolling resistance against turning; skidding: the resistance keeps it from turning
"""
import random

import mpmath as mp
from mpmath import mpf

SEQUENCE = list(range(2, 22, 2))
FEW_DIGITS = 30  # below which a shorter sequence will do


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1]


def add(a, b):
    return [a[0] + b[0], a[1] + b[1]]


def sub(a, b):
    return [a[0] - b[0], a[1] - b[1]]


def mul(c, a):
    return [c * a[0], c * a[1]]


def turn(a):
    return [-a[1], a[0]]


def norm(a):
    return mp.sqrt(dot(a, a))


def unit(a):
    return mul(1 / norm(a), a)


def shortened(a, longest):
    return a if norm(a) <= longest else mul(longest, unit(a))


def extrapolate(rhs, y, h):
    """One step of the modified midpoint rule with 2, 4, ... substeps, extrapolated to none."""
    rows = []
    slope = rhs(y)
    for j, n in enumerate(SEQUENCE if mp.mp.dps > FEW_DIGITS else SEQUENCE[:7]):
        d = h / n
        before, now = y, [a + d * b for a, b in zip(y, slope)]
        for _ in range(n - 1):
            before, now = now, [a + 2 * d * b for a, b in zip(before, rhs(now))]
        row = [[(a + b + d * c) / 2 for a, b, c in zip(before, now, rhs(now))]]
        for k in range(j):
            factor = mpf(n * n) / (SEQUENCE[j - k - 1] ** 2) - 1
            row.append([a + (a - b) / factor for a, b in zip(row[k], rows[j - 1][k])])
        rows.append(row)
    return rows[-1][-1]


class Ground:
    def __init__(self, spec, number, data):
        law, motion = data.typed(spec["law"], None), data.typed(spec.get("surface"), "still")
        self.law = law["type"]
        self.friction, self.resistance, self.spin_friction = (
            number(law.get(key, 0.0)) for key in ("mu", "rolling_resistance", "spin_friction"))
        self.belt = [number(c) for c in motion.get("u", [0.0, 0.0])]
        self.rate = number(motion.get("rate", 0.0))
        self.center = [number(c) for c in motion.get("centre", [0.0, 0.0])]
        self.field = data.field_of(spec)
        shape = spec["shape"]
        self.everywhere = shape["type"] == "everything"
        if shape["type"] == "half_plane":
            normal, offset = [number(c) for c in shape["n"]], number(shape["d"])
            self.inside = lambda r: dot(normal, r) - offset
            self.crossing = lambda r, v: dot(normal, v)
        elif shape["type"] == "circle":
            middle, radius = [number(c) for c in shape["c"]], number(shape["r"])
            sign = -1 if shape.get("outside") else 1
            self.inside = lambda r: sign * (radius ** 2 - dot(sub(r, middle), sub(r, middle)))
            self.crossing = lambda r, v: -2 * sign * dot(sub(r, middle), v)

    def velocity(self, r):
        return add(self.belt, mul(self.rate, turn(sub(r, self.center))))


class World:
    """The scene in numbers; with a seed, every input is moved by one ulp."""

    def __init__(self, scene, data, seed=None):
        self.random = random.Random(seed) if seed is not None else None
        number = self.number
        sphere = scene["sphere"]
        m, self.R, self.k = (number(sphere[key]) for key in "mRk")
        self.m, R, k = m, self.R, self.k
        self.kappa = k * k / (R * R + k * k)
        inertia = m * k * k
        gravity = [number(c) for c in scene.get("gravity", data.STANDARD_GRAVITY)]
        force = [number(c) for c in scene.get("force", [0.0, 0.0])]
        torque = [number(c) for c in scene.get("torque", [0.0, 0.0, 0.0])]
        self.free = [force[i] / m + gravity[i] for i in range(2)]
        self.spin = [R * torque[1] / inertia, -R * torque[0] / inertia]
        self.normal_spin = torque[2] / inertia
        self.normal = -gravity[2]
        drag = scene.get("drag", {})
        self.c = number(drag.get("translational", 0.0)) / m
        self.c2 = number(drag.get("quadratic", 0.0)) / m
        self.cr = number(drag.get("rotational", 0.0)) / inertia
        spring = scene.get("spring", {"center": [0.0, 0.0], "stiffness": 0.0})
        self.stiffness, self.anchor = number(spring["stiffness"]) / m, [number(c) for c in spring["center"]]
        self.grounds = [Ground(spec, number, data) for spec in scene["regions"]]
        self.step = mpf(scene.get("step", 0.125))

    def number(self, x):
        value = mpf(float(x))
        if self.random is None or value == 0:
            return value
        return value + self.random.choice((-1, 1)) * mp.ldexp(mpf(1), mp.frexp(abs(value))[1] - 53)

    def acceleration(self, r, v):
        """Forces but those of the ground, on the centre, over m."""
        out = [self.free[i] - self.c * v[i] - self.stiffness * (r[i] - self.anchor[i]) for i in range(2)]
        return sub(out, mul(self.c2 * norm(v), v)) if self.c2 else out

    def spin_acceleration(self, nu):
        return sub(self.spin, mul(self.cr, nu))

    def ground_at(self, r, chosen):
        """Topmost ground; `chosen` tells on which side of edges the sphere goes on."""
        for i in reversed(range(len(self.grounds))):
            ground = self.grounds[i]
            if ground.everywhere or chosen.get(i, ground.inside(r)) > 0:
                return i
        raise ValueError("no ground")


def quaternion_rate(q, omega):
    a, b, c, d = q
    x, y, z = omega
    return [(-x * b - y * c - z * d) / 2, (x * a + y * d - z * c) / 2, (-x * d + y * a + z * b) / 2,
            (x * c - y * b + z * a) / 2]


class Sphere:
    """State and mode; y is [time, x, y, w3, q...] and what the mode integrates besides."""

    def __init__(self, world, initial):
        self.w, number = world, world.number
        self.t, self.r = mpf(0), [number(initial["x"]), number(initial["y"])]
        self.v = [number(initial["vx"]), number(initial["vy"])]
        omega = [number(c) for c in initial["w"]]
        self.nu, self.w3 = [world.R * omega[1], -world.R * omega[0]], omega[2]
        self.q = [mpf(float(c)) for c in initial.get("q", [1, 0, 0, 0])]
        self.ground, self.mode, self.spin_stuck, self.spin_sign = None, "free", False, mpf(0)

    def omega(self):
        return [-self.nu[1] / self.w.R, self.nu[0] / self.w.R, self.w3]

    def slip(self):
        return sub(sub(self.v, self.nu), self.ground.velocity(self.r))

    def pull(self):
        """Rate of change of the slip without friction: f - g - W J v."""
        w = self.w
        out = sub(w.acceleration(self.r, self.v), w.spin_acceleration(self.nu))
        return sub(out, mul(self.ground.rate, turn(self.v)))

    def drive(self):
        """B: rate of change of nu when rolling without resistance."""
        w, kappa = self.w, self.w.kappa
        f, g = w.acceleration(self.r, self.v), w.spin_acceleration(self.nu)
        out = add(mul(1 - kappa, f), mul(kappa, g))
        return sub(out, mul((1 - kappa) * self.ground.rate, turn(self.v)))

    def decay(self):
        """A of the velocity that dies: slip, or nu against a rolling resistance."""
        w = self.w
        if self.mode == "sliding":
            return self.ground.friction * w.normal / w.kappa
        if self.mode == "skidding":
            return self.ground.friction * w.normal
        return self.ground.resistance * (1 - w.kappa) * w.normal

    def reaction(self):
        """Largest reaction when rolling, over m."""
        return norm(sub(add(self.drive(), mul(self.ground.rate, turn(self.v))), self.w.acceleration(self.r, self.v)))

    def polar(self):
        return self.mode in ("sliding", "resisted", "skidding", "resisted_sliding")

    # -- slip and rolling beside each other: s' = push_slip - slip_decay e_s, nu' = push_turn - turn_decay e_nu
    def slip_decay(self):
        return self.ground.friction * self.w.normal / self.w.kappa

    def turn_decay(self):
        return self.ground.resistance * self.w.normal * (1 - self.w.kappa) / self.w.kappa

    def push_slip(self, e_nu):
        return add(self.pull(), mul(self.turn_decay(), e_nu))

    def push_turn(self, e_s):
        return add(self.w.spin_acceleration(self.nu), mul((1 - self.w.kappa) * self.slip_decay(), e_s))

    def drive_over_ground(self):
        """f - W J v: rate of change of v - u without a reaction."""
        return sub(self.w.acceleration(self.r, self.v), mul(self.ground.rate, turn(self.v)))

    def settle(self, slips, turns):
        """Mode of least acceleration, and the rates of s and nu where they begin from 0: docs/theory.md 4.6."""
        w, kappa = self.w, self.w.kappa
        grip = self.ground.friction * w.normal if self.ground.law == "coulomb" else mp.inf
        hold = self.ground.resistance * w.normal
        f, zero = self.drive_over_ground(), [mpf(0), mpf(0)]
        share = mul(kappa / (1 - kappa), w.spin_acceleration(self.nu))

        def rates(reaction, couple):
            turning = mul((1 - kappa) / kappa, sub(share, add(reaction, couple)))
            return sub(add(f, reaction), turning), turning
        if slips and turns:
            return "resisted_sliding", zero, zero
        if slips:
            reaction = mul(-grip, unit(self.slip()))
            held = sub(share, reaction)
            if norm(held) <= hold:
                return "skidding", zero, zero
            return "resisted_sliding", zero, rates(reaction, mul(hold, unit(held)))[1]
        if turns:
            couple = mul(hold, unit(self.nu))
            reaction = sub(mul(kappa, sub(w.spin_acceleration(self.nu), f)), mul(1 - kappa, couple))
            if norm(reaction) <= grip:
                return "resisted", zero, zero
            return "resisted_sliding", rates(mul(grip, unit(reaction)), couple)[0], zero
        held = add(share, f)
        if norm(held) <= hold and norm(f) <= grip:
            return "stopped", zero, zero
        if norm(held) > hold:
            couple = mul(hold, unit(held))
            reaction = sub(mul(kappa, sub(w.spin_acceleration(self.nu), f)), mul(1 - kappa, couple))
            if norm(reaction) <= grip:
                return "resisted", zero, add(f, reaction)
        reaction = mul(-grip, unit(f))
        if norm(sub(share, reaction)) <= hold:
            return "skidding", add(f, reaction), zero
        for _ in range(4000):  # the one of reaction and couple that is best beside the other, in turn
            couple = shortened(sub(share, reaction), hold)
            reaction = shortened(sub(mul(1 - kappa, sub(share, couple)), mul(kappa, f)), grip)
        return ("resisted_sliding",) + rates(reaction, couple)

    def begin(self, mode, slip_rate, turn_rate, tau):
        """Goes on in a mode; s and nu that begin from 0 do so on straight lines, for a time tau."""
        growing = [rate != [0, 0] for rate in (slip_rate, turn_rate)]
        self.mode = mode
        if not any(growing):
            return
        w = self.w
        e_s = unit(slip_rate) if growing[0] else unit(self.slip()) if mode == "resisted_sliding" else None
        acceleration = w.acceleration(self.r, self.v)
        if mode == "resisted":
            acceleration = add(turn_rate, mul(self.ground.rate, turn(self.v)))
        else:
            acceleration = sub(acceleration, mul(self.ground.friction * w.normal, e_s))
        q = quaternion_rate(self.q, self.omega())
        w3 = self.spin_rate()
        nu_rate = turn_rate
        if mode == "resisted_sliding" and not growing[1]:
            e_nu = unit(self.nu)
            nu_rate = sub(self.push_turn(e_s), mul(self.turn_decay(), e_nu))
        self.t += tau
        self.r = add(self.r, add(mul(tau, self.v), mul(tau * tau / 2, acceleration)))
        self.v = add(self.v, mul(tau, acceleration))
        self.nu = add(self.nu, mul(tau, nu_rate))
        self.q, self.w3 = [a + tau * b for a, b in zip(self.q, q)], self.w3 + tau * w3
        if mode == "skidding":
            self.nu = [mpf(0), mpf(0)]

    def spin_rate(self):
        w = self.w
        if self.ground.law == "rubber" or self.spin_stuck:
            return mpf(0)
        couple = self.ground.spin_friction * w.normal * (1 - w.kappa) / (w.kappa * w.R)
        return w.normal_spin - w.cr * self.w3 - couple * self.spin_sign

    def choose_spin(self):
        w, ground = self.w, self.ground
        couple = ground.spin_friction * w.normal * (1 - w.kappa) / (w.kappa * w.R)
        over = self.w3 - ground.rate
        drift = w.normal_spin - w.cr * self.w3
        self.spin_stuck = couple > 0 and over == 0 and abs(drift) <= couple
        self.spin_sign = mp.sign(over) if over != 0 else mp.sign(drift)

    # -- integration variables
    def pack(self):
        y = [self.t] + self.r + [self.w3] + self.q
        if self.mode == "sliding":
            s = self.slip()
            return y + self.v + [norm(s), mp.atan2(s[1], s[0])]
        if self.mode in ("skidding", "resisted_sliding"):
            s = self.slip()
            y += [norm(s), mp.atan2(s[1], s[0])]
            return y if self.mode == "skidding" else y + [norm(self.nu), mp.atan2(self.nu[1], self.nu[0])]
        if self.mode == "resisted":
            return y + [norm(self.nu), mp.atan2(self.nu[1], self.nu[0])]
        return y + (self.v + self.nu if self.mode == "free" else self.v)

    def unpack(self, y):
        self.t, self.r, self.w3, self.q = y[0], y[1:3], y[3], y[4:8]
        u = self.ground.velocity(self.r)
        if self.mode == "sliding":
            self.v = y[8:10]
            self.nu = sub(sub(self.v, [y[10] * mp.cos(y[11]), y[10] * mp.sin(y[11])]), u)
        elif self.mode in ("skidding", "resisted_sliding"):
            s = [y[8] * mp.cos(y[9]), y[8] * mp.sin(y[9])]
            turns = self.mode == "resisted_sliding"
            self.nu = [y[10] * mp.cos(y[11]), y[10] * mp.sin(y[11])] if turns else [mpf(0), mpf(0)]
            self.v = add(add(s, self.nu), u)
        elif self.mode == "resisted":
            self.nu = [y[8] * mp.cos(y[9]), y[8] * mp.sin(y[9])]
            self.v = add(self.nu, u)
        elif self.mode == "stopped":
            self.v, self.nu = u, [mpf(0), mpf(0)]
        elif self.mode == "free":
            self.v, self.nu = y[8:10], y[10:12]
        else:
            self.v, self.nu = y[8:10], sub(y[8:10], u)

    def rhs(self, y):
        self.unpack(y)
        w = self.w
        out = [mpf(1)] + list(self.v) + [self.spin_rate()] + quaternion_rate(self.q, self.omega())
        if self.mode == "free":
            return out + w.acceleration(self.r, self.v) + w.spin_acceleration(self.nu)
        if self.mode == "rolling":
            return out + add(self.drive(), mul(self.ground.rate, turn(self.v)))
        if self.mode == "stopped":
            return out + mul(self.ground.rate, turn(self.v))
        if self.mode == "resisted_sliding":
            return self.resisted_sliding_rhs(y, out)
        size, angle = y[-2], y[-1]
        e = [mp.cos(angle), mp.sin(angle)]
        if self.mode == "sliding":
            push = self.pull()
            out += sub(w.acceleration(self.r, self.v), mul(self.ground.friction * w.normal, e))
        elif self.mode == "skidding":
            push = self.drive_over_ground()
        else:
            push = self.drive()
        return [size * c for c in out] + [size * (dot(push, e) - self.decay()), dot(push, turn(e))]

    def resisted_sliding_rhs(self, y, out):
        """In the time ds = dt (1/|s| + 1/|nu|)."""
        slip, turning = y[8], y[10]
        e_s, e_nu = [mp.cos(y[9]), mp.sin(y[9])], [mp.cos(y[11]), mp.sin(y[11])]
        pace = slip * turning / (slip + turning)
        share = turning / (slip + turning)  # pace/slip
        of_slip, of_turn = self.push_slip(e_nu), self.push_turn(e_s)
        return [pace * c for c in out] + [
            pace * (dot(of_slip, e_s) - self.slip_decay()), share * dot(of_slip, turn(e_s)),
            pace * (dot(of_turn, e_nu) - self.turn_decay()), (1 - share) * dot(of_turn, turn(e_nu))]

    def step(self, longest):
        if not self.polar():
            return longest
        y = self.pack()
        if self.mode == "resisted_sliding":
            pace = y[8] * y[10] / (y[8] + y[10])
            decays = 2 * (self.slip_decay() + self.turn_decay())
            return min(longest / pace, 4 * longest / (decays + norm(self.pull())))
        push = {"sliding": self.pull, "skidding": self.drive_over_ground}.get(self.mode, self.drive)()
        return min(longest / y[-2], 4 * longest / (self.decay() + norm(push)))
