"""Scenes with extreme numbers, for make_extreme_references: level ground at rest, half-planes, polygons, circles."""
import math

SOLID = math.sqrt(0.4)
EVERYWHERE = {"type": "everything"}
SCENES = []


def scene(name, description, regions, initial, times, sphere=(2.0, 0.25, SOLID), **more):
    """sphere: m, R, k/R; initial: x, y, vx, vy, w1, w2, w3."""
    m, radius, ratio = sphere
    x, y, vx, vy = initial[:4]
    SCENES.append(dict({"name": name, "description": description, "sphere": {"m": m, "R": radius, "k": radius * ratio},
                        "regions": regions, "initial": {"x": x, "y": y, "vx": vx, "vy": vy, "w": list(initial[4:])},
                        "output_times": times}, **more))


def base(law):
    return {"name": "base", "shape": EVERYWHERE, "law": law}


def coulomb(mu):
    return {"type": "coulomb", "mu": mu}


def half(law="rough", normal=(1.0, 0.0), offset=0.0):
    return {"name": "half", "shape": {"type": "half_plane", "n": list(normal), "d": offset}, "law": law}


def strip(low, high, law="rough", name="strip", reach=1000.0):
    return {"name": name, "law": law,
            "shape": {"type": "polygon", "v": [[low, -reach], [high, -reach], [high, reach], [low, reach]]}}


def disc(x, y, radius, law="rough", name="disc"):
    return {"name": name, "law": law, "shape": {"type": "circle", "c": [x, y], "r": radius}}


ONTO_ROUGH = [base("smooth"), half()]


def paper(name, description, sphere=(2.0, 0.25, SOLID), speed=1.0, way=1.0):
    """The paper's scene, with spins of the size v/R and a way of any length before the edge."""
    radius, second = sphere[1], way / speed
    initial = [-2.0 * way, 0.5 * way, 2.0 * speed, -0.75 * speed] + [c * speed / radius for c in (1.0, 1.25, -0.5)]
    scene(name, description, ONTO_ROUGH, initial, [0.5 * second, 1.5 * second, 4.0 * second, 20.0 * second], sphere)


# -- the sphere
paper("radius_1e-6", "A radius of 1e-6 m: spins of 1e6 rad/s.", (2.0, 1e-6, SOLID))
paper("radius_1e6", "A radius of 1e6 m: spins of 1e-6 rad/s.", (2.0, 1e6, SOLID))
paper("mass_1e-6", "A mass of 1e-6 kg.", (1e-6, 0.25, SOLID))
paper("mass_1e6", "A mass of 1e6 kg.", (1e6, 0.25, SOLID))
paper("gyration_1e-4", "k/R = 1e-4: the impulse changes the spin 1e8 times as much as the velocity.", (2.0, 0.25, 1e-4))
paper("gyration_shell", "k/R = sqrt(2/3), the largest.", (2.0, 0.25, 0.816496580927726))
paper("radius_mass_1e-6", "Radius and mass 1e-6, in a scene of its size.", (1e-6, 1e-6, SOLID), way=1e-6)
paper("radius_mass_1e6", "Radius and mass 1e6, in a scene of its size.", (1e6, 1e6, SOLID), way=1e6)

# -- speeds and times
paper("speed_1e-9", "A speed of 1e-9 m/s over a way of 1e-9 m.", speed=1e-9, way=1e-9)
paper("speed_1e6", "A speed of 1e6 m/s.", speed=1e6)
paper("speed_1e6_long", "1e6 m/s for 20 s: 2e7 revolutions.", speed=1e6, way=1e6)
paper("time_1e6", "1e-6 m/s: the switch is at 1e6 s.", speed=1e-6)
paper("time_1e9", "1e-9 m/s: the switch is at 1e9 s.", speed=1e-9)
scene("time_1e9_revolutions", "1 m/s for 1e9 s: the switch is at 1e9 s after 6e8 revolutions.",
      [base("rough"), half("smooth", offset=1e9)], [0.0, 0.0, 1.0, 0.25, -1.0, 4.0, 1.0], [1e3, 1e6, 9e8, 1.5e9])
scene("time_1e9_late_strip", "A strip of 1e-3 m after 1e9 s at 1 m/s.",
      [base("smooth"), strip(1e9, 1e9 + 1e-3, reach=1e12)], [0.0, 0.0, 1.0, 0.125, 2.0, -3.0, 1.0], [1e6, 2e9],
      exact=True)

# -- geometry
scene("graze_1e-9", "An edge met at 1e-9 rad.", [base("smooth"), half(normal=(0.0, 1.0))],
      [0.0, -1e-9, 1.0, 1e-9, -3.0, -2.0, 1.0], [0.5, 1.5, 4.0, 1e3])
scene("graze_1e-9_oblique", "An oblique edge met at 1e-9 rad, which throws the sphere back.",
      [base("smooth"), half(normal=(-3.0, 4.0))],
      [0.0, -1e-9, 0.8, 0.6 + 1e-9, 3.0, -2.0, 1.0], [0.5, 1.5, 4.0, 1e3])
scene("graze_disc", "A disc met 2^-53 of its radius inside a tangent: a chord of 3e-8 m.",
      [base("smooth"), disc(0.0, 0.0, 1.0)], [-2.0, 1 - 2.0 ** -53, 1.0, 0.0, 3.0, -2.0, 1.0],
      [1.0, 3.0, 10.0], exact=True)
scene("graze_disc_miss", "A disc that the path touches: nothing is entered.",
      [base("smooth"), disc(0.0, 0.0, 1.0)], [-2.0, 1.0, 1.0, 0.0, 3.0, -2.0, 1.0], [1.0, 3.0, 10.0], exact=True)
scene("sliver_1e-9", "A strip of 1e-9 m crossed at 100 m/s: 1e-11 s.", [base("smooth"), strip(1.0, 1.000000001)],
      [0.0, 0.0, 100.0, 10.0, 5.0, -20.0, 1.0], [0.005, 0.02, 1.0])
scene("sliver_one_ulp", "A strip of 2.2e-16 m crossed at 100 m/s: 2.2e-18 s.",
      [base("smooth"), strip(1.0, 1.0 + 2.0 ** -52)], [0.0, 0.0, 100.0, 10.0, 5.0, -20.0, 1.0], [0.005, 0.02, 1.0],
      exact=True)
scene("sliver_throw_back", "A strip of 1e-9 m that throws the sphere back.", [base("smooth"), strip(1.0, 1.000000001)],
      [0.0, 0.0, 100.0, 10.0, 5.0, -2000.0, 1.0], [0.005, 0.02, 1.0])
scene("coordinates_1e8", "A scene at (1e8, -1e8) m.",
      [base("smooth"), half(offset=1e8), disc(100000003.0, -1e8, 0.5, "smooth")],
      [99999999.0, -1e8, 1.0, 0.0625, 1.0, 3.0, 0.0], [0.5, 2.0, 4.0, 8.0])
scene("coordinates_1e8_drag", "Drag at (1e8, -1e8) m.", [base("smooth"), half(offset=1e8)],
      [99999999.0, -1e8, 1.0, 0.0625, 1.0, 3.0, 0.0], [0.5, 2.0, 4.0, 8.0], drag=1.0)

# -- drag
STIFF = [base("smooth"), half(offset=0.5)]
scene("drag_1e6_1s", "Drag at the rate 1e6 1/s for 1 s, pushed on: an edge in the middle of the way.", STIFF,
      [0.0, 0.0, 3.0, 0.5, 1.0, 2.0, 0.5], [1e-7, 1e-6, 0.25, 1.0], force=[2e6, 0.0], drag=2e6)
scene("drag_1e6_100s", "Drag at the rate 1e6 1/s for 100 s.", STIFF,
      [0.0, 0.0, 3.0, 0.5, 1.0, 2.0, 0.5], [1e-6, 1.0, 40.0, 100.0], force=[2e4, 0.0], drag=2e6)
scene("drag_1e6_rolling", "Rolling against a drag at the rate 1e6 1/s for 100 s.",
      [base("rough"), half("smooth", offset=0.5)],
      [0.0, 0.0, 3.0, 0.0, 0.0, 12.0, 0.0], [1e-6, 1.0, 40.0, 100.0], force=[2e4, 0.0], drag=2e6)
scene("drag_stops_before", "Drag that stops the sphere 1e-9 m before an edge.",
      [base("smooth"), half(offset=1.000000001)],
      [0.0, 0.0, 1e6, 0.0, 1.0, 2.0, 0.5], [1e-6, 1.0, 100.0], drag=2e6)
scene("drag_stops_behind", "Drag that lets the sphere pass an edge by 1e-9 m.",
      [base("smooth"), half(offset=0.999999999)],
      [0.0, 0.0, 1e6, 0.0, 1.0, 2.0, 0.5], [1e-6, 1.0, 100.0], drag=2e6)
scene("quadratic_1e6_1s", "Quadratic drag that begins at the rate 1e6 1/s, for 1 s.",
      [base("smooth"), half(offset=5e-6)],
      [0.0, 0.0, 1.0, 0.5, 1.0, 2.0, 0.5], [1e-7, 1e-6, 1e-3, 1.0], drag={"quadratic": 2e6}, needs_integrator=True)
scene("quadratic_1e6_100s", "Quadratic drag that begins at the rate 1e6 1/s, for 100 s.",
      [base("smooth"), half(offset=1.2e-5)], [0.0, 0.0, 1.0, 0.5, 1.0, 2.0, 0.5], [1e-6, 1.0, 40.0, 100.0],
      drag={"quadratic": 2e6}, needs_integrator=True)
scene("drag_1e6_sliding_1s", "Friction beside a drag at the rate 1e6 1/s: a stiff slip for 0.4 s.",
      [base(coulomb(0.2))], [0.0, 0.0, 3.0, 0.0, 0.0, -8.0, 0.0], [1e-6, 0.1, 0.6, 1.0], drag=2e6,
      needs_integrator=True)
scene("slow_drag_1e6_sliding_100s", "Friction of 1e-3 beside a drag at the rate 1e6 1/s: a stiff slip for 82 s.",
      [base(coulomb(0.001))], [0.0, 0.0, 3.0, 0.0, 0.0, -8.0, 0.0], [1e-6, 1.0, 60.0, 100.0], drag=2e6,
      needs_integrator=True)

# -- friction
scene("friction_1e-9", "A coefficient of friction of 1e-9: a slip of 1e-2 m/s lasts for 3e5 s.",
      [base("smooth"), half(coulomb(1e-9))], [-1.0, 0.0, 1.0, 0.25, -1.0, 3.96, 0.0], [0.5, 2.0, 1e5, 1e6])
scene("friction_1e5", "A coefficient of friction of 1e5: the slip lasts for 1e-6 s.",
      [base("smooth"), half(coulomb(1e5))],
      [-1.0, 0.0, 2.0, 0.5, 6.0, -4.0, 0.0], [0.25, 0.500001, 0.75, 3.0])
