#!/usr/bin/python3
"""sim.launch with record:=, until Ctrl-C: the bag that is left."""
import os
import shutil
import signal
import subprocess
import tempfile
import unittest
import xmlrpc.client

import rosbag
import rosgraph
import rospy
import rostest
import std_srvs.srv
from hybrid_sphere.msg import ConstraintSwitch, SphereState

from csv_rows import parsed, switch_row
from node_client import PATIENCE, Listener, program, simulate, wait_for

NODE = "/hybrid_sphere"
TOPICS = {NODE + "/" + name for name in ("state", "pose", "twist", "odom", "constraint_switch", "surface_map")} | {"/tf"}
SWITCHES = 6


class Record(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.mkdtemp()
        # Like a shell that has gone there.
        environment = {key: value for key, value in os.environ.items() if key != "DISPLAY"}
        self.options = {"cwd": self.directory, "env": dict(environment, PWD=self.directory), "stdout": subprocess.PIPE,
                        "stderr": subprocess.STDOUT}
        self.launched = None

    def tearDown(self):
        if self.launched and self.launched.poll() is None:
            self.end()
        shutil.rmtree(self.directory)

    def end(self):
        self.launched.send_signal(signal.SIGINT)
        return self.launched.communicate(timeout=2 * PATIENCE)[0].decode()

    def launch(self, *arguments):
        self.launched = subprocess.Popen(["roslaunch", "hybrid_sphere", "sim.launch", "rviz:=false", *arguments],
                                         **self.options)

    @staticmethod
    def recorded_topics():
        """Topics with a connection from the simulator to the recorder."""
        try:
            node = xmlrpc.client.ServerProxy(rosgraph.Master("/test").lookupNode(NODE))
            return {info[4] for info in node.getBusInfo("/test")[2] if info[1] == "/record"}
        except (rosgraph.MasterException, OSError):
            return set()

    def test_a_relative_path_and_every_switch_of_a_run_that_began_paused(self):
        self.launch("scene:=checkerboard", "paused:=true", "record:=a run.bag", "real_time_factor:=4")
        wait_for(lambda: TOPICS <= self.recorded_topics(), "the recorder")
        switches = Listener(NODE + "/constraint_switch", ConstraintSwitch)
        wait_for(switches.subscriber.get_num_connections, "a connection of our own")
        rospy.ServiceProxy(NODE + "/pause", std_srvs.srv.SetBool)(False)
        switches.wait(SWITCHES)
        switches.stop()
        output = self.end()
        path = os.path.join(self.directory, "a run.bag")
        self.assertEqual(os.listdir(self.directory), ["a run.bag"], output)
        messages = {topic: [] for topic in TOPICS}
        with rosbag.Bag(path) as bag:
            for topic, message, _ in bag.read_messages():
                messages[topic].append(message)
        for topic in TOPICS:
            self.assertGreater(len(messages[topic]), 0, topic)
        recorded = [switch_row(m) for m in messages[NODE + "/constraint_switch"]]
        self.assertGreaterEqual(len(recorded), SWITCHES)
        scene = os.path.join(rospy.get_param("~config"), "checkerboard.yaml")
        expected = simulate(scene, "--duration", str(recorded[-1][1] + 1), "--switches", "-")
        self.assertEqual(recorded, [parsed(row) for row in expected[:len(recorded)]])
        result = subprocess.run([program("plot"), path, "-o", os.path.join(self.directory, "run.svg")],
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("%d switches" % len(recorded), result.stdout)

    def test_a_bag_that_cannot_be_written_is_said_and_the_simulator_goes_on(self):
        self.launch("record:=no/such.bag")
        said = []
        while "process has died" not in "".join(said):
            said.append(self.launched.stdout.readline().decode())
            self.assertNotEqual(said[-1], "", said)
        states = Listener(NODE + "/state", SphereState)
        states.wait(3)
        states.stop()
        self.assertIn("Error opening file: %s/no/such.bag" % self.directory, "".join(said) + self.end())

    def test_without_the_argument_nothing_is_recorded(self):
        self.launch()
        wait_for(lambda: rosgraph.Master("/test").getSystemState()[0] and rospy.has_param(NODE + "/rate"), "the node")
        Listener(NODE + "/state", SphereState).wait()
        self.assertNotIn("/record", {node for _, nodes in rosgraph.Master("/test").getSystemState()[1] for node in nodes})
        self.end()
        self.assertEqual(os.listdir(self.directory), [])


if __name__ == "__main__":
    rospy.init_node("record_test")
    rostest.rosrun("hybrid_sphere", "record_test", "__main__")
