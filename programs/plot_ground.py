"""The ground under a motion: regions from a SurfaceMap or a scene file, as outlines to draw."""
import math

import numpy as np

LAWS = ["smooth", "rough", "rubber", "coulomb"]  # in the order of SurfaceRegion.law
CIRCLE_CORNERS = 180


class Region:
    """What lies where, with which law. One of `outline` [m] (n, 2) and `edge` (point, normal); neither: everywhere."""

    def __init__(self, name, law, outline=None, edge=None, outside=False, belt=(0, 0), turntable=(0, (0, 0)),
                 friction=0.0):
        self.name = name
        self.law = law
        self.friction = friction  # mu of the law coulomb
        self.outline = outline
        self.edge = edge
        self.outside = outside
        self.belt = belt
        self.turntable = turntable  # rate [rad/s] and centre [m]

    def ground_velocity(self, x, y):
        """Of the ground itself at places, (2, n) [m/s]."""
        rate, center = self.turntable
        return np.array([self.belt[0] - rate * (y - center[1]), self.belt[1] + rate * (x - center[0])])


class Ground:
    """The regions, later ones over earlier ones, on a base without an edge."""

    def __init__(self, base, regions):
        self.base = base
        self.regions = regions
        self.by_name = {region.name: region for region in regions}

    def named(self, name):
        return self.by_name.get(name, self.base)


class Body:
    """The sphere of a scene."""

    def __init__(self, mass, radius, gyration_radius_squared):
        self.mass = mass
        self.radius = radius
        self.gyration_radius_squared = gyration_radius_squared

    def kinetic_energy(self, v, w):
        """[J] of velocities (2, n) [m/s] and angular velocities (3, n) [rad/s]."""
        return self.mass / 2 * (np.sum(v**2, axis=0) + self.gyration_radius_squared * np.sum(w**2, axis=0))


def circle(center, radius):
    angle = np.linspace(0, 2 * math.pi, CIRCLE_CORNERS, endpoint=False)
    return np.column_stack([center[0] + radius * np.cos(angle), center[1] + radius * np.sin(angle)])


def pair(value):
    x, y = value
    return float(x), float(y)


def from_message(message):
    """@param message  hybrid_sphere/SurfaceMap, of the package or as a bag defines it"""
    def region(m):
        shape = {}
        if m.shape == 1:
            shape["edge"] = ((m.points[0].x, m.points[0].y), (m.normal.x, m.normal.y))
        elif m.shape == 2:
            shape["outline"] = circle((m.points[0].x, m.points[0].y), m.radius)
        elif m.shape == 3:
            shape["outline"] = np.array([(p.x, p.y) for p in m.points])
        return Region(m.name, LAWS[m.law], outside=m.outside and m.shape in (2, 3), friction=m.friction,
                      belt=(m.belt.x, m.belt.y),
                      turntable=(m.turntable_rate, (m.turntable_center.x, m.turntable_center.y)), **shape)
    return Ground(region(message.base), [region(m) for m in message.regions])


def region_from_scene(keys, name):
    shape = {}
    if "half_plane" in keys:
        shape["edge"] = (pair(keys["half_plane"]["point"]), pair(keys["half_plane"]["normal"]))
    elif "circle" in keys:
        shape["outline"] = circle(pair(keys["circle"]["center"]), float(keys["circle"]["radius"]))
    elif "polygon" in keys:
        shape["outline"] = np.array([pair(corner) for corner in keys["polygon"]])
    elif name != "base":
        raise KeyError("half_plane, circle or polygon")
    turntable = keys.get("turntable")
    if turntable:
        shape["turntable"] = (float(turntable["rate"]), pair(turntable["center"]))
    if keys["law"] not in LAWS:
        raise ValueError("law: %r" % keys["law"])
    return Region(name, keys["law"], outside=bool(keys.get("outside", False)), belt=pair(keys.get("belt", (0, 0))),
                  friction=float(keys.get("friction", 0)), **shape)


def from_scene(scene):
    """Ground and body of a scene file's keys. Throws KeyError, TypeError, ValueError where they are not one."""
    surface = scene.get("surface") or {}
    regions = [region_from_scene(keys, keys["name"]) for keys in surface.get("regions") or []]
    ground = Ground(region_from_scene(surface.get("base") or {"law": "smooth"}, "base"), regions)
    sphere = scene["sphere"]
    radius = float(sphere["radius"])
    if "gyration_radius" in sphere:
        squared = float(sphere["gyration_radius"])**2
    else:
        squared = {"solid": 2 / 5, "shell": 2 / 3}[sphere["body"]] * radius**2
    return ground, Body(float(sphere["mass"]), radius, squared)


def clipped(edge, box):
    """The part of a rectangle (4, 2) on the side of a line to which its normal points."""
    point, normal = (np.array(part, dtype=float) for part in edge)
    depth = (box - point) @ (normal / np.hypot(*normal))
    corners = []
    for i in range(len(box)):
        j = (i + 1) % len(box)
        if depth[i] >= 0:
            corners.append(box[i])
        if (depth[i] >= 0) != (depth[j] >= 0):
            corners.append(box[i] + (box[j] - box[i]) * depth[i] / (depth[i] - depth[j]))
    return np.array(corners).reshape(-1, 2)


def signed_area(outline):
    x, y = outline.T
    return 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))
