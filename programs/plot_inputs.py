"""What `plot` reads: bags with the messages of hybrid_sphere, and the tables of `simulate`."""
import contextlib
import csv
import os

import numpy as np

import plot_ground

STATE_COLUMNS = ["t", "x", "y", "vx", "vy", "wx", "wy", "wz"]
SWITCH_COLUMNS = ["t", "x", "y", "Px", "Py", "vx1", "vy1", "wx1", "wy1", "wz1", "vx2", "vy2", "wx2", "wy2", "wz2",
                  "energy1", "energy2"]


LARGEST = 1e100  # of what can be drawn: sums and squares of it are finite


class InputError(Exception):
    """What cannot be read, and why."""


class Run:
    """One motion: columns by their names in the tables of `simulate`, and `slip` (2, n) [m/s] and `energy` [J]."""

    def __init__(self, name):
        self.name = name
        self.states = None    # columns, or None
        self.switches = None  # columns, or None
        self.slip = None
        self.energy = None
        self.ground = None
        self.missing = 0      # switches that were not recorded

    def velocities(self, columns="states", suffix=""):
        """v (2, n) and omega (3, n) of a table."""
        table = getattr(self, columns)
        return (np.array([table[name + suffix] for name in ("vx", "vy")]),
                np.array([table[name + suffix] for name in ("wx", "wy", "wz")]))


def number(text):
    """Throws ValueError."""
    value = float(text)
    if not abs(value) <= LARGEST:
        raise ValueError(text)
    return value


def row_of(texts, names, where):
    """The numbers of a table's row."""
    row = []
    for name in names:
        try:
            row.append(number(texts[name] or ""))
        except ValueError:
            raise InputError("%s: %s: %s is refused; allowed: a number from -%g to %g" % (
                where, name, texts[name] or "nothing", LARGEST, LARGEST))
    return row


def columns_of(rows, names):
    return dict(zip(names, np.array(rows, dtype=float).reshape(-1, len(names)).T))


class Topics:
    """The messages of one sphere, whose topics have one namespace."""

    def __init__(self):
        self.states, self.switches, self.ground = [], [], None
        self.slip, self.energy, self.begins = [], [], []
        self.first = None  # stamp less the time of the first message [s]
        self.last_time = None
        self.next_index = 0
        self.missing = 0

    def time(self, message):
        """Goes on where a new initial state begins again at 0: what the stamps tell."""
        stamp = message.header.stamp
        if self.first is None:
            self.first = (stamp.secs, stamp.nsecs, message.time)
        secs, nsecs, time = self.first
        return (stamp.secs - secs) + (stamp.nsecs - nsecs) * 1e-9 + time

    def add_state(self, m):
        if self.last_time is not None and m.time < self.last_time:
            self.begins.append(len(self.states))
        self.last_time = m.time
        v, w = m.twist.linear, m.twist.angular
        self.states.append([self.time(m), m.pose.position.x, m.pose.position.y, v.x, v.y, w.x, w.y, w.z])
        self.slip.append([m.slip.x, m.slip.y])
        self.energy.append(m.kinetic_energy)

    def add_switch(self, m):
        row = [self.time(m), m.position.x, m.position.y, m.impulse.x, m.impulse.y]
        for twist in (m.twist_before, m.twist_after):
            row += [twist.linear.x, twist.linear.y, twist.angular.x, twist.angular.y, twist.angular.z]
        self.switches.append(row + [m.energy_before, m.energy_after])
        # A new initial state counts from 0 again.
        self.missing += m.index - self.next_index if m.index > self.next_index else 0
        self.next_index = m.index + 1

    def add_map(self, m):
        self.ground = plot_ground.from_message(m)

    def run(self, name):
        run = Run(name)
        run.ground = self.ground
        run.missing = self.missing
        for kind, rows in (("SphereState", self.states), ("SphereState", self.slip), ("SphereState", [self.energy]),
                           ("ConstraintSwitch", self.switches)):
            if not (np.abs(np.array(rows, dtype=float)) <= LARGEST).all():
                raise InputError("%s: a number of %s is refused; allowed: -%g to %g" % (name, kind, LARGEST, LARGEST))
        run.switches = columns_of(self.switches, SWITCH_COLUMNS)
        if not self.states:
            return run
        run.states = columns_of(self.states, STATE_COLUMNS)
        run.slip = np.array(self.slip).T
        run.energy = np.array(self.energy)
        # No line from where one initial state has come to to where the next one begins.
        for index in self.begins:
            for name in STATE_COLUMNS[1:]:
                run.states[name][index] = np.nan
        return run


@contextlib.contextmanager
def no_classes_from_bags():
    """rosbag makes Python code of the definition that a bag has of each message, and runs it, also for messages that
    are read raw. Within this nothing of a bag is run, and messages can only be read raw."""
    import genpy.dynamic
    import rosbag.bag

    def refuse(*_):
        raise InputError("a message cannot be read without running the definition that the bag has of it")

    kept = rosbag.bag._get_message_type, genpy.dynamic.generate_dynamic
    rosbag.bag._get_message_type, genpy.dynamic.generate_dynamic = lambda connection: None, refuse
    try:
        yield
    finally:
        rosbag.bag._get_message_type, genpy.dynamic.generate_dynamic = kept


def messages_of(bag, classes, path):
    """Topic and message of each message of these classes. Throws InputError for those of another version."""
    topics = [name for name, info in bag.get_type_and_topic_info().topics.items() if info.msg_type in classes]
    for topic, (name, data, md5sum, *_), _ in bag.read_messages(topics=topics, raw=True) if topics else []:
        if name not in classes:
            continue
        message = classes[name]()
        if md5sum != message._md5sum:
            raise InputError("%s: %s of %s is of another version of hybrid_sphere: its md5sum is %s, not %s" % (
                path, name, topic, md5sum, message._md5sum))
        yield topic, message.deserialize(data)


def collected(path, take, make):
    """What collectors have of a bag's messages, one collector for each namespace. Throws InputError.
    @param take  the method of a collector for each class of messages; make()  gives a new one"""
    import genpy
    import rosbag

    classes = {message._type: message for message in take}
    spheres = {}
    try:
        with no_classes_from_bags(), rosbag.Bag(path) as bag:
            for topic, message in messages_of(bag, classes, path):
                namespace = topic.rpartition("/")[0]
                if namespace not in spheres:
                    spheres[namespace] = make()
                take[type(message)](spheres[namespace], message)
    except rosbag.ROSBagUnindexedException:
        raise InputError("%s: has no index, as its recording was cut off; rosbag reindex %s makes one" % (path, path))
    except OSError as error:
        raise InputError("%s: cannot be read: %s" % (path, error.strerror or error))
    except (rosbag.ROSBagException, genpy.DeserializationError, ValueError, KeyError, IndexError) as error:
        raise InputError("%s: is no bag that can be read: %s" % (path, error))
    return spheres


def read_bag(path):
    """The runs of a bag, one for each namespace that has states or switches."""
    from hybrid_sphere.msg import ConstraintSwitch, SphereState, SurfaceMap

    take = {SphereState: Topics.add_state, ConstraintSwitch: Topics.add_switch, SurfaceMap: Topics.add_map}
    spheres = collected(path, take, Topics)
    found = {name: sphere for name, sphere in spheres.items() if sphere.states or sphere.switches}
    if not found:
        raise InputError("%s: has neither hybrid_sphere/SphereState nor hybrid_sphere/ConstraintSwitch" % path)
    file = os.path.basename(path)
    return [sphere.run(file if len(found) == 1 else "%s %s" % (file, name)) for name, sphere in sorted(found.items())]


def read_table(path):
    """("states" or "switches", columns, names of the regions) of a table of `simulate`."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            reader = csv.DictReader(file)
            header = reader.fieldnames or []
            kind, names = next(((kind, names) for kind, names in
                                (("switches", SWITCH_COLUMNS), ("states", STATE_COLUMNS)) if set(names) <= set(header)),
                               (None, None))
            if kind is None:
                raise InputError("%s: its first line is neither that of the states nor that of the switches which "
                                 "simulate writes" % path)
            rows, regions = [], []
            for row in reader:
                rows.append(row_of(row, names, "%s: line %d" % (path, reader.line_num)))
                regions.append(row.get("region"))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InputError("%s: cannot be read: %s" % (path, getattr(error, "strerror", None) or error))
    return kind, columns_of(rows, names), regions


def complete(run, regions, ground, body):
    """What the states leave out follows from the scene: the slip relative to the ground, and the kinetic energy."""
    run.ground = ground
    if run.states is None or body is None:
        return
    v, w = run.velocities()
    run.energy = body.kinetic_energy(v, w)
    run.slip = v + body.radius * np.array([-w[1], w[0]])
    names = np.array(regions, dtype=object)
    for name in set(regions):
        here = names == name
        run.slip[:, here] -= ground.named(name).ground_velocity(run.states["x"][here], run.states["y"][here])


def read(paths, scene=(None, None)):
    """The runs of the files, in their order. Switches belong to the states named before them.
    @param scene  ground and body, for tables; Throws InputError."""
    runs, open_run = [], None
    for path in paths:
        if not path.endswith(".csv"):
            runs += read_bag(path)
            open_run = None
            continue
        kind, table, regions = read_table(path)
        if kind == "switches" and open_run is not None and open_run.switches is None:
            open_run.switches = table
            continue
        run = Run(os.path.basename(path))
        setattr(run, kind, table)
        complete(run, regions, *scene)
        runs.append(run)
        open_run = run if kind == "states" else None
    return runs
