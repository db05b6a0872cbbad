"""`plot --html`: one motion as a page for a browser, which the Python module hybrid_sphere writes."""
import csv
import math

import numpy as np

import plot_ground
import plot_inputs
from plot_inputs import InputError

STATE_NUMBERS = ["t", "x", "y", "qx", "qy", "qz", "qw", "vx", "vy", "wx", "wy", "wz", "stage"]
STATE_TEXTS = ["mode", "region"]
SWITCH_NUMBERS = ["t", "x", "y", "Px", "Py", "Lx", "Ly", "Lz", "vx1", "vy1", "wx1", "wy1", "wz1",
                  "vx2", "vy2", "wx2", "wy2", "wz2", "energy1", "energy2"]
SWITCH_TEXTS = ["kind", "from_region", "to_region", "cause"]
CAUSES = ["edge", "placed", "slip ended", "grip lost", "livelock", "livelock ended", "kicked", "accumulation"]
KINDS = ["", "applied", "released", "exchanged"]


class Motion:
    """States and switches as columns by their names in the tables of `simulate`, and the scene."""

    def __init__(self):
        self.states = {name: [] for name in STATE_NUMBERS + STATE_TEXTS}
        self.switches = {name: [] for name in SWITCH_NUMBERS + SWITCH_TEXTS}
        self.scene = None


def add(columns, values):
    for column, value in zip(columns.values(), values):
        column.append(value)


def clear(columns):
    for column in columns.values():
        column.clear()


def region_of(message):
    """A SurfaceRegion as in a scene file."""
    keys = {"law": plot_ground.LAWS[message.law]}
    if keys["law"] == "coulomb":
        keys["friction"] = message.friction
    for name in ("rolling_resistance", "spin_friction"):
        if getattr(message, name):
            keys[name] = getattr(message, name)
    if message.turntable_rate:
        center = message.turntable_center
        keys["turntable"] = {"rate": message.turntable_rate, "center": [center.x, center.y]}
    elif message.belt.x or message.belt.y:
        keys["belt"] = [message.belt.x, message.belt.y]
    if message.shape == message.HALF_PLANE:
        keys["half_plane"] = {"point": [message.points[0].x, message.points[0].y],
                              "normal": [message.normal.x, message.normal.y]}
    elif message.shape == message.CIRCLE:
        keys["circle"] = {"center": [message.points[0].x, message.points[0].y], "radius": message.radius}
    elif message.shape == message.POLYGON:
        keys["polygon"] = [[point.x, point.y] for point in message.points]
    if message.shape != message.EVERYWHERE:
        keys["name"] = message.name
    if message.shape in (message.CIRCLE, message.POLYGON):
        keys["outside"] = bool(message.outside)
    return keys


def body_of(states, energies, radius):
    """The sphere of a bag, which says its radius and its energies: mass and radius of gyration follow from these where
    the motion tells them apart; otherwise it is solid."""
    v = np.square(states["vx"]) + np.square(states["vy"])
    w = np.square(states["wx"]) + np.square(states["wy"]) + np.square(states["wz"])
    terms = np.column_stack([v, w * radius**2]) / 2
    (mass, inertia), _, rank, _ = np.linalg.lstsq(terms, energies, rcond=1e-9)
    if rank == 2 and mass > 0 and 1e-6 * mass < inertia <= mass * 2 / 3 * (1 + 1e-9):
        return {"mass": float(mass), "radius": radius,
                "gyration_radius": radius * min(math.sqrt(inertia / mass), math.sqrt(2 / 3))}
    of_unit_mass = terms @ [1, 2 / 5]
    square = of_unit_mass @ of_unit_mass
    mass = float(of_unit_mass @ np.array(energies) / square) if square > 0 else 1.0
    return {"mass": mass if mass > 0 else 1.0, "radius": radius, "body": "solid"}


class Collector:
    """The messages of one sphere. Of several motions, each from an initial state of its own, the last one stays."""

    def __init__(self):
        self.motion = Motion()
        self.energies = []
        self.radius = None
        self.surface = {}
        self.motions = 1
        self.switches_are_new = False  # those of a motion may come before its first state

    def add_state(self, m):
        states = self.motion.states
        if states["t"] and m.time < states["t"][-1]:
            clear(states)
            self.energies.clear()
            if not self.switches_are_new:
                clear(self.motion.switches)
            self.switches_are_new = False
            self.motions += 1
        p, q, v, w = m.pose.position, m.pose.orientation, m.twist.linear, m.twist.angular
        add(states, [m.time, p.x, p.y, q.x, q.y, q.z, q.w, v.x, v.y, w.x, w.y, w.z, m.stage, m.mode, m.region])
        self.energies.append(m.kinetic_energy)
        self.radius = p.z

    def add_switch(self, m):
        switches = self.motion.switches
        if switches["t"] and m.index == 0:
            clear(switches)
            self.switches_are_new = True
        row = [m.time, m.position.x, m.position.y, m.impulse.x, m.impulse.y]
        row += [m.angular_impulse.x, m.angular_impulse.y, m.angular_impulse.z]
        for twist in (m.twist_before, m.twist_after):
            row += [twist.linear.x, twist.linear.y, twist.angular.x, twist.angular.y, twist.angular.z]
        add(switches, row + [m.energy_before, m.energy_after, KINDS[m.kind], m.from_region, m.to_region,
                             CAUSES[m.cause]])

    def add_map(self, m):
        self.surface = {"base": region_of(m.base), "regions": [region_of(region) for region in m.regions]}


def read_bag(path):
    """The motion of a bag with one sphere, and how many there were before it."""
    from hybrid_sphere.msg import ConstraintSwitch, SphereState, SurfaceMap

    take = {SphereState: Collector.add_state, ConstraintSwitch: Collector.add_switch, SurfaceMap: Collector.add_map}
    spheres = plot_inputs.collected(path, take, Collector)
    found = {name: sphere for name, sphere in spheres.items() if sphere.motion.states["t"]}
    if len(found) != 1:
        raise InputError("%s: the states of %d spheres are refused; allowed with --html: those of one" % (path, len(found)))
    sphere, = found.values()
    sphere.motion.scene = {"sphere": body_of(sphere.motion.states, sphere.energies, sphere.radius),
                           "surface": sphere.surface}
    return sphere.motion, sphere.motions - 1


def number(row, name, path, reader):
    return plot_inputs.row_of(row, [name], "%s: line %d" % (path, reader.line_num))[0]


def read_tables(paths, scene):
    """The motion of a table of states, and of one of switches if there is one."""
    motion = Motion()
    motion.scene = scene
    del motion.switches["cause"]  # which a table does not have
    kinds = []
    for path in paths:
        kind, _, _ = plot_inputs.read_table(path)  # which refuses what is none
        kinds.append(kind)
        columns = getattr(motion, kind)
        with open(path, newline="", encoding="utf-8") as file:
            reader = csv.DictReader(file)
            missing = [name for name in columns if name not in reader.fieldnames]
            if missing:
                raise InputError("%s: the column %s is missing" % (path, missing[0]))
            for row in reader:
                for name, column in columns.items():
                    column.append(row[name] if name in STATE_TEXTS + SWITCH_TEXTS else number(row, name, path, reader))
    if kinds not in (["states"], ["states", "switches"]):
        raise InputError("tables of %s are refused; allowed with --html: of states, then of switches" % " and ".join(kinds))
    if scene is None:
        raise InputError("%s: --scene is missing, which says what the ground is" % paths[0])
    return motion


def write(output, paths, scene, title):
    """Writes the page of the inputs. Returns the numbers of states and switches, and sentences to be said.
    @param scene  name of a scene file, or None; Throws InputError, ImportError."""
    import hybrid_sphere

    said = []
    if all(path.endswith(".csv") for path in paths):
        motion = read_tables(paths, scene)
    elif len(paths) == 1:
        motion, before = read_bag(paths[0])
        if before:
            said.append("%s: the last of %d motions is shown" % (paths[0], before + 1))
        motion.scene = scene or motion.scene
    else:
        raise InputError("%d inputs are refused; allowed with --html: a bag, or the tables of one run" % len(paths))
    try:
        said += hybrid_sphere.write_html(output, motion.scene, motion.states, motion.switches, title=title)
    except hybrid_sphere.SceneError as error:
        raise InputError("%s: %s" % (scene or paths[0], error) if error.key else str(error))
    except (OSError, RuntimeError) as error:
        raise InputError("%s: cannot be written: %s" % (output, getattr(error, "strerror", None) or error))
    return len(motion.states["t"]), len(motion.switches["t"]), said
