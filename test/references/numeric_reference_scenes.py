"""Scenes of make_numeric_references, in the format of make_reference_data.

Beyond that format: law {type, mu, rolling_resistance, spin_friction}, drag {translational, rotational, quadratic},
spring {center, stiffness}, needs_integrator where no closed form is known, step: longest step of the reference.
"""

BODY = {"m": 1.0, "R": 0.25, "k": 0.15}
HALF = {"type": "half_plane", "n": [1.0, 0.0], "d": 0.0}
OBLIQUE = {"type": "half_plane", "n": [1.0, 0.5], "d": 0.5}
TIMES = [0.2, 0.4, 0.7, 1.1, 1.6, 2.2, 3.0]


def disc(x, y, radius):
    return {"type": "circle", "c": [x, y], "r": radius}


def still(name, shape, law, **coefficients):
    return {"name": name, "shape": shape, "law": dict({"type": law}, **coefficients), "surface": "still"}


def belt(name, shape, velocity, law, **coefficients):
    return dict(still(name, shape, law, **coefficients), surface={"type": "belt", "u": velocity})


def table(name, shape, rate, center, law, **coefficients):
    return dict(still(name, shape, law, **coefficients),
                surface={"type": "turntable", "rate": rate, "centre": center})


def scene(name, description, regions, initial, times=None, **more):
    x, y, vx, vy, *w = [float(c) for c in initial]
    base = [] if regions[0]["shape"] == "everything" else [still("base", None, "smooth")]
    regions = [dict(region) for region in base + regions]
    regions[0]["shape"] = {"type": "everything"}
    return dict({"name": name, "description": description, "sphere": BODY, "regions": regions,
                 "initial": {"x": x, "y": y, "vx": vx, "vy": vy, "w": w}, "output_times": times or TIMES}, **more)


def slope(x, y):
    return [x, y, -9.81]


ALL = "everything"
NUMERIC = {"needs_integrator": True}

SCENES = [
    # rubber
    scene("rubber_half", "Rubber takes the slip and the spin.", [still("rubber", HALF, "rubber")],
          [-0.5, 0, 1, 0.25, 2, -3, 4]),
    scene("rubber_slope_disc", "A rubber disc on a slope, left again.", [still("rubber", disc(0.5, 0, 0.5), "rubber")],
          [-0.5, 0, 1, 0.25, 2, -3, 4], gravity=slope(0.5, -0.25)),
    scene("rubber_belt_torque", "A rubber belt and a torque about all axes.",
          [belt("rubber", HALF, [0.5, 0.25], "rubber")], [-0.5, 0, 1, 0.25, 2, -3, 4], torque=[0.01, 0.02, 0.03]),
    scene("rubber_turntable", "A rubber turntable gives the sphere its spin.",
          [table("rubber", disc(0.5, 0, 0.75), 2.0, [0.5, 0.0], "rubber")], [-0.75, 0, 1, 0.25, 2, -3, 4]),
    scene("rubber_from_rough", "From rough ground to rubber: one constraint for another, only spin is lost.",
          [still("base", ALL, "rough"), still("rubber", HALF, "rubber")], [-0.5, 0, 1, 0.25, 0, 0, 4]),
    scene("rubber_throw_back", "Rubber throws a sphere with backspin back.", [still("rubber", HALF, "rubber")],
          [-0.5, 0, 1, 0.25, 2, -24, 4]),
    # drag
    scene("drag_rotational_smooth", "Rotational drag on smooth ground, then rough.", [still("rough", HALF, "rough")],
          [-0.5, 0, 1, 0.25, 2, -3, 4], drag={"rotational": 0.02}),
    scene("drag_both_belt", "Translational and rotational drag on a belt.",
          [belt("belt", HALF, [0.5, 0.25], "rough")], [-0.5, 0, 1, 0.25, 2, -3, 4],
          drag={"translational": 0.5, "rotational": 0.01}),
    scene("drag_both_turntable", "Translational and rotational drag on a turntable.",
          [table("table", HALF, 2.0, [0.25, 0.0], "rough")], [-0.5, 0, 1, 0.25, 2, -3, 4],
          drag={"translational": 0.25, "rotational": 0.01}, force=[0.1, 0.05]),
    scene("drag_rotational_torque", "Rotational drag and a torque on rough ground.", [still("base", ALL, "rough")],
          [0, 0, 1, 0.25, -1, 4, 4], drag={"rotational": 0.02}, torque=[0.02, 0.01, 0.03]),
    scene("drag_quadratic_smooth", "Quadratic drag under gravity in the plane.", [still("rough", HALF, "rough")],
          [-0.75, 0, 2, 0.5, 2, -3, 4], drag={"quadratic": 0.75}, gravity=slope(0.5, -0.5), **NUMERIC),
    scene("drag_quadratic_turntable", "Quadratic and linear drag on a turntable.",
          [table("table", disc(0.25, 0, 1), 2.5, [0.25, 0.0], "rough")], [-1, 0, 1.5, 0.25, 0, 3, 1],
          drag={"quadratic": 0.5, "translational": 0.125}, **NUMERIC),
    scene("drag_quadratic_rotational", "Quadratic and rotational drag, with a force, over an oblique edge.",
          [belt("belt", OBLIQUE, [0.25, -0.5], "rough")], [-0.5, 0, 1.5, 0.5, 2, -3, 4],
          drag={"quadratic": 0.5, "rotational": 0.01}, force=[0.25, 0.5], **NUMERIC),
    # spring
    scene("spring_smooth_rough", "A spring pulls the sphere to and fro over an edge.", [still("rough", HALF, "rough")],
          [-0.75, 0.1, 0.5, 0.25, 2, -3, 4], spring={"center": [0.0, 0.0], "stiffness": 4.0}),
    scene("spring_drag_disc", "A damped spring and a rough disc.", [still("rough", disc(0.25, 0, 0.5), "rough")],
          [-1, 0.1, 0.5, 0.75, 2, -3, 4], spring={"center": [0.25, 0.125], "stiffness": 6.0},
          drag={"translational": 0.75}),
    scene("spring_belt", "A spring holds the sphere back on a belt.", [belt("belt", HALF, [1.0, 0.5], "rough")],
          [-0.5, 0, 1, 0.25, 2, -3, 4], spring={"center": [0.25, 0.0], "stiffness": 2.0}),
    scene("spring_turntable", "A spring on a turntable.", [table("base", ALL, 2.0, [0.25, 0.0], "rough")],
          [-0.5, 0, 1, 0.25, 0, 3, 1], spring={"center": [0.0, 0.125], "stiffness": 3.0}),
    scene("spring_quadratic", "A spring with quadratic drag.", [still("rough", OBLIQUE, "rough")],
          [-0.75, 0, 1, 0.5, 2, -3, 4], spring={"center": [0.25, 0.0], "stiffness": 5.0}, drag={"quadratic": 0.5},
          **NUMERIC),
    # rolling resistance and spin friction
    scene("resistance_level", "Rolling resistance on level ground brings the sphere to rest.",
          [still("rough", HALF, "rough", rolling_resistance=0.05)], [-0.25, 0, 1, 0.25, 2, 4, 0]),
    scene("resistance_belt", "Rolling resistance on a belt: in the end the sphere goes with it.",
          [belt("belt", HALF, [0.25, 0.5], "rough", rolling_resistance=0.05)], [-0.25, 0, 1, 0.25, 2, 4, 0]),
    scene("resistance_slope", "Rolling down a slope against a resistance, across its fall line.",
          [still("base", ALL, "rough", rolling_resistance=0.02)], [0, 0, 1, 1.0, -4, 4, 1], gravity=slope(0.75, 0.0),
          **NUMERIC),
    scene("resistance_slope_stops", "Rolling up a slope; the resistance holds the sphere there.",
          [still("base", ALL, "rough", rolling_resistance=0.1)], [0, 0, -1, 0.5, -2, -4, 1], gravity=slope(0.5, 0.0),
          **NUMERIC),
    scene("resistance_turntable", "Rolling resistance on a turntable.",
          [table("base", ALL, 1.5, [0.0, 0.0], "rough", rolling_resistance=0.02)], [0.25, 0, 0.75, 0.5, 0, 3, 1],
          times=[0.2, 0.7, 1.1, 2.0], **NUMERIC),
    scene("resistance_drag", "Rolling resistance and drag, over two grounds.",
          [still("base", ALL, "rough", rolling_resistance=0.01), still("more", HALF, "rough", rolling_resistance=0.05)],
          [-0.5, 0, 1, 0.25, -1, 4, 0], drag={"translational": 0.25}, **NUMERIC),
    scene("spin_friction_rough", "Spin friction uses up the spin about the normal.",
          [still("base", ALL, "rough", spin_friction=0.02)], [0, 0, 1, 0.25, -1, 4, 10]),
    scene("spin_friction_turntable", "Spin friction gives the sphere the spin of a turntable.",
          [table("base", ALL, 2.0, [0.25, 0.0], "rough", spin_friction=0.02)], [-0.5, 0, 1, 0.25, 0, 3, -4]),
    scene("spin_friction_torque", "A torque about the normal too weak for spin friction, on and off the ground.",
          [still("rough", disc(0.5, 0, 0.5), "rough", spin_friction=0.04)], [-0.5, 0, 1, 0.125, -1, 4, 2],
          torque=[0.0, 0.0, 0.05]),
    scene("both_resistances", "Rolling resistance and spin friction on level ground.",
          [still("rough", HALF, "rough", rolling_resistance=0.04, spin_friction=0.01)], [-0.25, 0, 1, 0.25, 2, 4, 8]),
    # friction with what has no closed form
    scene("coulomb_drag", "Sliding with drag until the slip is used up.", [still("friction", HALF, "coulomb", mu=0.1)],
          [-0.25, 0, 1.5, 0.25, 2, -3, 4], drag={"translational": 0.5}, **NUMERIC),
    scene("coulomb_drag_slope", "Sliding with drag on a slope, and over an edge into rough ground.",
          [still("base", ALL, "coulomb", mu=0.05), still("rough", OBLIQUE, "rough")], [-0.5, 0, 1.5, 0.25, 2, -3, 4],
          drag={"translational": 0.5}, gravity=slope(0.25, -0.5), **NUMERIC),
    scene("coulomb_quadratic", "Sliding with quadratic drag.", [belt("belt", HALF, [0.25, 0.5], "coulomb", mu=0.125)],
          [-0.25, 0, 1.5, 0.25, 2, -3, 4], drag={"quadratic": 0.5}, **NUMERIC),
    scene("coulomb_rotational_drag", "Sliding with rotational drag.", [still("base", ALL, "coulomb", mu=0.125)],
          [-0.25, 0, 1.5, 0.25, 2, -3, 4], drag={"rotational": 0.01}, **NUMERIC),
    scene("coulomb_spring", "Sliding against a spring.", [still("base", ALL, "coulomb", mu=0.25)],
          [-0.25, 0, 1.5, 0.25, 2, -3, 4], spring={"center": [0.0, 0.0], "stiffness": 2.0}, **NUMERIC),
    scene("coulomb_turntable_drag", "Sliding on a turntable with drag.",
          [table("table", HALF, 1.5, [0.5, 0.0], "coulomb", mu=0.25)], [-0.25, 0, 1.0, 0.25, 2, -3, 4],
          drag={"translational": 0.25}, times=[0.1, 0.2, 0.25, 0.5, 1.0, 2.0], **NUMERIC),
    scene("coulomb_resistances", "Slides, then rolls against a resistance, spins against friction.",
          [still("base", ALL, "coulomb", mu=0.2, rolling_resistance=0.02, spin_friction=0.01)],
          [0, 0, 1.5, 0.25, 2, -3, 4], **NUMERIC),
    scene("coulomb_turntable_slope_rolls", "Slip to roll on a tilted turntable with force and torque.",
          [table("base", ALL, 1.0, [0.25, 0.0], "coulomb", mu=0.5)], [0, 0, 0.5, 0.25, 1, 2, 1],
          gravity=slope(0.25, -0.5), torque=[0.01, 0.0, 0.02], times=[0.05, 0.1, 0.25, 0.5, 1.0], **NUMERIC),
    # sliding against a rolling resistance
    scene("scrub_level", "Slides against a resistance, then rolls against it.",
          [still("base", ALL, "coulomb", mu=0.2, rolling_resistance=0.1)], [0, 0, 1.5, 0.25, 2, -3, 4], **NUMERIC),
    scene("scrub_skids", "A large resistance: the sphere turns no more, slides on and stops.",
          [still("base", ALL, "coulomb", mu=0.1, rolling_resistance=0.3)], [0, 0, 1.5, 0.25, 2, -3, 4], **NUMERIC),
    scene("scrub_turntable", "Slides, and rolls, on a turntable of felt.",
          [table("table", HALF, 1.5, [0.5, 0.0], "coulomb", mu=0.25, rolling_resistance=0.05)],
          [-0.25, 0, 1.0, 0.25, 2, -3, 4], times=[0.1, 0.2, 0.25, 0.3, 0.5, 1.0], **NUMERIC),
    scene("scrub_spring", "Slides against a spring and a resistance.",
          [still("base", ALL, "coulomb", mu=0.25, rolling_resistance=0.125)], [-0.25, 0, 1.5, 0.25, 2, -3, 4],
          spring={"center": [0.0, 0.0], "stiffness": 2.0}, times=[0.1, 0.2, 0.3, 0.45, 0.6], **NUMERIC),
    scene("scrub_drag", "Slides against a resistance and every drag.",
          [still("base", ALL, "coulomb", mu=0.125, rolling_resistance=0.0625)], [-0.25, 0, 1.5, 0.25, 2, -3, 4],
          drag={"translational": 0.25, "rotational": 0.01, "quadratic": 0.125}, **NUMERIC),
    # loss of grip
    scene("grip_lost_turntable", "Rolls on a tilted turntable till friction cannot turn it any more.",
          [table("base", ALL, 6.0, [0.0, 0.0], "coulomb", mu=0.06)], [0.05, 0, 0, 0, 0, 0, 1],
          gravity=slope(0.5, 0.0), times=[0.1, 0.4, 0.8, 1.2, 1.6], **NUMERIC),
    scene("grip_lost_spring", "Rolls away from the centre of a spring till it pulls too hard.",
          [still("base", ALL, "coulomb", mu=0.1)], [0.25, 0, 1.5, 0.75, -3, 5, 1],
          spring={"center": [0.0, 0.0], "stiffness": 4.0}, times=[0.1, 0.4, 0.9, 1.3, 1.7], **NUMERIC),
    scene("grip_lost_turntable_drag", "The same on a turntable with drag and a force.",
          [table("base", ALL, 6.0, [0.25, 0.0], "coulomb", mu=0.06)], [0.25, 0.05, 0, 0, 0, 0, 1], force=[0.5, 0.25],
          drag={"translational": 0.125}, times=[0.1, 0.4, 0.8, 1.2], **NUMERIC),
]
