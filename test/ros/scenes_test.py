#!/usr/bin/python3
"""One reader for scenes: a file is the same scene in the node, in `simulate` and in Python, or all of them refuse it."""
import csv
import io
import os
import shutil
import subprocess
import tempfile
import threading
import unittest

import hybrid_sphere
import rospy
import rostest
import yaml
from hybrid_sphere.srv import GetState
from nodelet.srv import NodeletLoad, NodeletUnload

from node_client import PATIENCE, case, program

NUMBER = """sphere: {mass: 2, radius: 0.25, body: solid}
initial_state:
  position: [0, 0]
  velocity:
    - %s
    - 0
surface: {base: {law: smooth}}
"""
NAME = """sphere: {mass: 2, radius: 0.25, body: solid}
surface:
  base: {law: smooth}
  regions:
    - {name: %s, circle: {center: [0, 0], radius: 5}, law: rough}
"""
NUMBERS = ("1", "-1", "+2", "1.5", "5.", ".5", "-.5", "+.5", "1e1", "1e+1", "1E1", "1.e1", "1.5e1", "1.5e+1", ".5e1", "1e-3",
           "-0", "0", "-0.0", "00", "010", "-010", "08", "0.10", "1_0", "1_000.5", "0.1_5", "0x10", "0o10", "0b11",
           "1:30", "1:30.5", "'3'", '"3"', "'1e1'", "'0x10'", "'010'", ".inf", "-.inf", ".nan", "1,5", "3d0", "1e", "e1", "--1",
           "1e400", "1e-400", "1e15", "1e16", "123456789012345678901234567890", "0.30000000000000004", "1e-60", "true", "yes",
           "null", "~", "''", "", "[1]", "{a: 1}", "!!float 7", "!!int 8", '!!int "8"', "!!str 9", "2024-01-01", "1 # m/s", "=")
NAMES = ("a", "no", "NO", "on", "y", "true", "null", "~", "12", "'12'", "1e5", "'1e5'", "123E5", "1_0", "_1", "010", "0x10", "0o7",
         "1:30", "2024-01-01", "2024-01-01T00:00:00Z", ".5", ".inf", "=", "'='", "!!str 5", "'a b'", "a b", '"\\u00e9"', "é", "''",
         "base", "!!binary aGk=", "[a]", "a#b", "'a'", "<<")
STRUCTURES = {
    "merge key": NAME % "&n a" + "    - {<<: {law: rough}, name: b, circle: {center: [9, 0], radius: 1}}\n",
    "alias": NAME.replace("{law: smooth}", "&ground {law: smooth}").replace("regions:", "livelock: slide\n  regions:") % "a",
    "alias of a value": NUMBER.replace("mass: 2", "mass: &two 2") % "*two",
    "key twice": NUMBER % "1" + "sphere: {mass: 3, radius: 0.25, body: solid}\n",
    "key twice inside": (NUMBER % "1").replace("mass: 2", "mass: 2, mass: 3"),
    "two documents": NUMBER % "1" + "---\n" + NUMBER % "2",
    "end of document": NUMBER % "1" + "...\n",
    "directive": "%YAML 1.1\n---\n" + NUMBER % "1",
    "a parameter of the node": NUMBER % "1" + "rate: 50\n",
    "tab": (NUMBER % "1").replace("  velocity", "\tvelocity"),
    "json": '{"sphere": {"mass": 2, "radius": 0.25, "body": "solid"}, "initial_state": {"velocity": [1, 0]}}',
    "a key that is a number": NUMBER % "1" + "1: 2\n",
    "empty map": NUMBER % "1" + "drag: {}\n",
    "empty value": NUMBER % "1" + "drag:\n",
    "a list": "[1, 2]",
    "nothing": "",
    "byte order mark": "\ufeff" + NUMBER % "1",
}


def service(name, kind):
    rospy.wait_for_service(name, PATIENCE)
    return rospy.ServiceProxy(name, kind)


class Manager:
    """Of nodelets. To unload one takes a third of a second: meanwhile another manager loads the next one."""

    def __init__(self, name):
        self.load_nodelet = service(name + "/load_nodelet", NodeletLoad)
        self.unload_nodelet = service(name + "/unload_nodelet", NodeletUnload)
        self.unloading = None

    def load(self, name):
        """Whether the simulator takes its parameters."""
        self.finish()
        try:
            return self.load_nodelet(name=name, type="hybrid_sphere/SimulatorNodelet").success
        except rospy.ServiceException:  # the answer of a manager to what a nodelet throws
            return False

    def finish(self):
        if self.unloading:
            self.unloading.join()

    def begin_to_unload(self, name):
        self.unloading = threading.Thread(target=self.unload_nodelet, args=(name,))
        self.unloading.start()


class Scenes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.mkdtemp()
        cls.managers = [Manager("/manager_%d" % i) for i in range(4)]
        cls.count = 0

    @classmethod
    def tearDownClass(cls):
        for manager in cls.managers:
            manager.finish()
        shutil.rmtree(cls.directory)

    def in_node(self, parameters):
        """What a node makes of its parameters: velocity and ground at the start; None: refused."""
        type(self).count += 1
        name = "/scene_%d" % self.count
        rospy.set_param(name, dict(parameters, paused=True))
        manager = self.managers[self.count % len(self.managers)]
        if not manager.load(name):
            return None
        state = service(name + "/get_state", GetState)().state
        manager.begin_to_unload(name)
        return state.twist.linear.x, state.region

    def in_simulate(self, path):
        run = subprocess.run([program("simulate"), path, "--duration", "0", "--states", "-", "--quiet"], stdout=subprocess.PIPE,
                             stderr=subprocess.DEVNULL)
        if run.returncode == 3:
            return None
        row = next(csv.DictReader(io.StringIO(run.stdout.decode())))
        return float(row["vx"]), row["region"]

    def in_python(self, path):
        try:
            state = hybrid_sphere.Simulation(path).run([0])[0]
            return state.vx, state.region
        except hybrid_sphere.SceneError:
            return None

    def answers(self, text):
        path = os.path.join(self.directory, "scene.yaml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        answers = self.in_simulate(path), self.in_python(path), self.in_node({"scene_file": path})
        self.assertTrue(answers[0] == answers[1] == answers[2], answers)
        return answers[0]

    def same(self, template, spellings):
        """The spellings that are taken."""
        taken = set()
        for spelling in spellings:
            with case(spelling=spelling):
                if self.answers(template % spelling) is not None:
                    taken.add(spelling)
        return taken

    def test_decimal_numbers_are_the_same(self):
        self.assertEqual(self.same(NUMBER, NUMBERS[:20]), set(NUMBERS[:19]))

    def test_numbers_of_other_bases_and_in_quotes_are_the_same(self):
        self.assertEqual(self.same(NUMBER, NUMBERS[20:40]), {"0.10", "'3'", '"3"', "'1e1'"})

    def test_what_is_hardly_a_number_is_the_same(self):
        taken = self.same(NUMBER, NUMBERS[40:])
        self.assertTrue(taken >= {"1e15", "0.30000000000000004", "1 # m/s"}, taken)
        self.assertFalse(taken & {"1,5", "3d0", "1e400", "1e16", "true", "null", "", "[1]", "2024-01-01"}, taken)

    def test_names_of_yaml_1_1_are_the_same(self):
        taken = self.same(NAME, NAMES[:20])
        self.assertTrue(taken >= {"a", "'12'", "'1e5'", "2024-01-01", "1:30"}, taken)
        self.assertFalse(taken & {"no", "NO", "on", "true", "null", "~", "12", "1e5", "123E5"}, taken)

    def test_names_in_quotes_and_other_scripts_are_the_same(self):
        taken = self.same(NAME, NAMES[20:])
        self.assertTrue(taken >= {"'='", "'a b'", "a b", "\u00e9"}, taken)
        self.assertFalse(taken & {".5", ".inf", "''", "base", "[a]"}, taken)

    def test_structures_are_the_same(self):
        taken = set()
        for name, text in STRUCTURES.items():
            with case(structure=name):
                if self.answers(text) is not None:
                    taken.add(name)
        self.assertTrue(taken >= {"alias", "alias of a value", "end of document", "directive", "json"}, taken)
        self.assertFalse(taken & {"merge key", "key twice", "key twice inside", "two documents", "a parameter of the node",
                                  "a key that is a number", "a list", "nothing"}, taken)

    def test_parameters_are_as_in_a_file_or_refused_where_pyyaml_gives_them_as_they_are_written(self):
        """YAML 1.1 makes other numbers of 010, 1_0, 0x10 and 1:30 before the node can see them."""
        for template, spellings in ((NUMBER, ("1e1", "1E1", ".5e1", "+.5", "1.5", "3", "'3'", "yes", "0o10")),
                                    (NAME, ("1e5", "'1e5'", "123E5", "12", "'12'", "no", "_1", ".5", "0o7"))):
            for spelling in spellings:
                with case(spelling=spelling):
                    in_file = self.answers(template % spelling)
                    by_hand = self.in_node(yaml.safe_load(template % spelling))
                    self.assertIn(by_hand, (in_file, None))

    def test_parameters_override_keys_of_the_file(self):
        path = os.path.join(self.directory, "under.yaml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(NUMBER % "1")
        self.assertEqual(self.in_node({"scene_file": path, "initial_state": {"velocity": [3, 0]}}), (3, "base"))
        self.assertEqual(self.in_node({"scene_file": path, "surface": {"base": {"law": "rough"}}}), (1 / 1.4, "base"))
        self.assertIsNone(self.in_node({"scene_file": path, "initial_state": {"speed": 3}}))

    def test_the_file_is_among_the_parameters_but_does_not_override_the_next_one(self):
        paths = []
        for number in ("1", "2"):
            paths.append(os.path.join(self.directory, number + ".yaml"))
            with open(paths[-1], "w", encoding="utf-8") as file:
                file.write(NUMBER % number + ("drag: {translational: 0.5}\n" if number == "1" else ""))
        type(self).count += 1
        name = "/again_%d" % self.count
        manager = self.managers[0]
        for path, velocity in zip(paths, (1, 2)):
            rospy.set_param(name + "/scene_file", path)
            self.assertTrue(manager.load(name))
            parameters = rospy.get_param(name)
            manager.begin_to_unload(name)
            self.assertEqual(parameters["initial_state"]["velocity"], [velocity, 0])
            self.assertEqual((parameters["sphere"]["mass"], parameters["scene_directory"]), (2, self.directory))
            self.assertEqual("drag" in parameters, velocity == 1)
        rospy.set_param(name + "/sphere/mass", 3)
        self.assertTrue(manager.load(name))
        self.assertEqual(rospy.get_param(name + "/sphere/mass"), 3)
        manager.begin_to_unload(name)


if __name__ == "__main__":
    rospy.init_node("scenes_test")
    rostest.rosrun("hybrid_sphere", "scenes_test", Scenes)
