"""What the tests of the Python module share. The environment says where things are: SIMULATE (the program), SOURCE (the
repository)."""
import csv
import os
import subprocess
import sys

import numpy as np

sys.dont_write_bytecode = True

SIMULATE = os.environ["SIMULATE"]
CONFIG = os.path.join(os.environ["SOURCE"], "config")
DATA = os.path.join(os.environ["SOURCE"], "test", "data")

# Two grounds, a switch at t = 1 s.
PAIR = {
    "sphere": {"mass": 2, "radius": 0.5, "body": "solid"},
    "initial_state": {"position": [-1, 0], "velocity": [1, 0.25], "angular_velocity": [0, 0, 3]},
    "surface": {"regions": [{"name": "rough_half", "law": "rough",
                             "half_plane": {"point": [0, 0], "normal": [1, 0]}}]},
}
# Grounds that throw the sphere at each other, and say that this is to stop it.
HALTING = {
    "sphere": {"mass": 1, "radius": 0.5, "body": "solid"},
    "initial_state": {"position": [-1, 0], "velocity": [0.5, 0]},
    "surface": {
        "livelock": "stop",
        "base": {"law": "rough", "belt": [2, 0]},
        "regions": [{"name": "back", "law": "rough", "belt": [-2, 0],
                     "half_plane": {"point": [0, 0], "normal": [1, 0]}}],
    },
}


def simulate(scene, directory, *arguments):
    """What the program writes: (states, switches), each a list of rows by column; the exit code."""
    states, switches = os.path.join(directory, "states.csv"), os.path.join(directory, "switches.csv")
    command = [SIMULATE, scene, "--states", states, "--switches", switches, "--quiet", *arguments]
    code = subprocess.run(command, capture_output=True, text=True).returncode

    def rows(path):
        with open(path, newline="") as table:
            return list(csv.DictReader(table))
    return rows(states), rows(switches), code


def differences(array, rows):
    """The columns in which an array is not what a table of the program says, to the bit."""
    if len(array) != len(rows):
        return ["%d items, %d rows" % (len(array), len(rows))]
    wrong = []
    for name in rows[0] if rows else []:
        column = [row[name] for row in rows]
        if array.dtype[name].kind == "U":
            same = column == array[name].tolist()
        else:
            same = np.array_equal(np.array(column, float).astype(array.dtype[name]), array[name])
        if not same:
            wrong.append(name)
    return wrong
