#!/usr/bin/python3
"""No switch is lost: a logger that is connected from the start receives all of 10,000, in order."""
import signal
import subprocess
import unittest

import rospy
import rostest
from hybrid_sphere.msg import ConstraintSwitch
from std_srvs.srv import SetBool

from node_client import PATIENCE, Listener, program, wait_for

STRIPS = 5000
SPEED = 1000.0  # m/s: 10,000 switches in a second of simulated time


def scene():
    """Rough strips of 0.1 m, 0.2 m apart; every edge is a switch."""
    strips = [{"name": "strip_%d" % i, "law": "rough",
               "polygon": [[0.2 * i, -1], [0.2 * i + 0.1, -1], [0.2 * i + 0.1, 1], [0.2 * i, 1]]}
              for i in range(STRIPS)]
    return {"sphere": {"mass": 1.0, "radius": 0.1, "body": "solid"},
            "initial_state": {"position": [-1, 0], "velocity": [7 / 5 * SPEED, 0]}, "surface": {"regions": strips}}


class Lossless(unittest.TestCase):
    def receive_all(self, name, **parameters):
        rospy.set_param("/" + name, dict(scene(), paused=True, **parameters))
        node = subprocess.Popen([program("hybrid_sphere_node"), "__name:=" + name], stdout=subprocess.DEVNULL)
        try:
            logger = Listener("/" + name + "/constraint_switch", ConstraintSwitch)
            wait_for(logger.is_connected, "the node")
            pause = rospy.ServiceProxy("/" + name + "/pause", SetBool)
            pause.wait_for_service(PATIENCE)
            self.assertTrue(pause(False).success)
            switches = logger.wait(2 * STRIPS)
        finally:
            node.send_signal(signal.SIGINT)
            node.wait(PATIENCE)
        self.assertEqual([m.index for m in switches], list(range(2 * STRIPS)))
        self.assertTrue(all(a.header.stamp < b.header.stamp for a, b in zip(switches, switches[1:])))
        self.assertEqual([m.kind for m in switches], [ConstraintSwitch.APPLIED, ConstraintSwitch.RELEASED] * STRIPS)

    def test_in_real_time(self):
        self.receive_all("real_time", rate=1000)

    def test_as_fast_as_it_can(self):
        self.receive_all("flat_out", real_time_factor=0)


if __name__ == "__main__":
    rospy.init_node("lossless_test")
    rostest.rosrun("hybrid_sphere", "lossless_test", Lossless)
