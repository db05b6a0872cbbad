#!/usr/bin/python3
"""The nodelet: several simulators in one process, unloaded and loaded again; what is refused is not loaded."""
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Log
from nodelet.srv import NodeletList, NodeletLoad, NodeletUnload

from csv_rows import parsed, state_row
from node_client import PATIENCE, Client, Console, simulate

TYPE = "hybrid_sphere/SimulatorNodelet"
SCENES = ("bounce_back", "archipelago")


class Nodelets(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = rospy.get_param("~scenes")
        cls.load = cls.service("load_nodelet", NodeletLoad)
        cls.unload = cls.service("unload_nodelet", NodeletUnload)
        cls.list = cls.service("list", NodeletList)

    @staticmethod
    def service(name, service_class):
        rospy.wait_for_service("/manager/" + name, PATIENCE)
        return rospy.ServiceProxy("/manager/" + name, service_class)

    def put(self, name):
        return self.load(name="/" + name, type=TYPE, remap_source_args=[], remap_target_args=[], my_argv=[], bond_id="")

    def test_two_in_one_process_are_two_simulators(self):
        for scene in SCENES:
            self.assertTrue(self.put(scene).success)
        self.assertEqual(sorted(self.list().nodelets), sorted("/" + scene for scene in SCENES))
        for scene in SCENES:
            state = Client("/" + scene).state()
            path = "%s/%s.yaml" % (self.directory, scene)
            self.assertEqual(state_row(state), parsed(simulate(path, "--times", repr(state.time), "--states", "-")[0]))
        for scene in SCENES:
            self.assertTrue(self.unload("/" + scene).success)
        self.assertEqual(self.list().nodelets, [])
        self.assertTrue(self.put(SCENES[0]).success)
        self.assertTrue(self.unload("/" + SCENES[0]).success)

    def test_a_refused_scene_is_not_loaded(self):
        rospy.set_param("/refused", {"sphere": {"mass": -1, "radius": 0.1, "body": "solid"}})
        console = Console("/manager")
        try:
            self.assertFalse(self.put("refused").success)
        except rospy.ServiceException:
            pass  # the answer of a manager to what a nodelet throws
        self.assertIn("sphere.mass: -1 is refused", console.wait_for_next(Log.FATAL, 0))
        self.assertNotIn("/refused", self.list().nodelets)


if __name__ == "__main__":
    rospy.init_node("nodelet_test")
    rostest.rosrun("hybrid_sphere", "nodelet_test", Nodelets)
