#!/usr/bin/python3
"""Somebody else's /clock: the node computes up to its time; pauses, jumps, a bag."""
import os
import subprocess
import tempfile
import unittest

import rosbag
import rospy
import rostest
import std_srvs.srv
from hybrid_sphere.msg import SphereState
from hybrid_sphere.srv import GetState, Step
from rosgraph_msgs.msg import Clock, Log

from node_client import PATIENCE, Listener, let_pass, simulate, wait_for

PERIOD = 0.01  # of the node's ticks [s]
OTHER = """
import rospy
from rosgraph_msgs.msg import Clock
rospy.init_node("other", disable_rostime=True)
clock = rospy.Publisher("/clock", Clock, queue_size=1)
while not rospy.is_shutdown():
    clock.publish(Clock(clock=rospy.Time(5)))
    rospy.rostime.wallsleep(0.05)
"""


class Follower:
    def __init__(self, name):
        self.states = Listener(name + "/state", SphereState)
        self.services = {}
        for service, kind in (("get_state", GetState), ("pause", std_srvs.srv.SetBool), ("step", Step)):
            rospy.wait_for_service(name + "/" + service, PATIENCE)
            self.services[service] = rospy.ServiceProxy(name + "/" + service, kind)

    def at(self, stamp):
        """The state with a stamp, or the first one after it."""
        return self.states.wait_for_one(lambda m: m.header.stamp >= stamp)


class FollowedClock(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.publisher = rospy.Publisher("/clock", Clock, queue_size=100)
        cls.node = Follower("/hybrid_sphere")
        cls.holding = Follower("/holding")
        cls.rosout = Listener("/rosout", Log)
        wait_for(lambda: cls.publisher.get_num_connections() >= 2, "the nodes on /clock")
        cls.now = rospy.Time(1000, 0)
        cls.tell(0)
        cls.node.states.wait()
        cls.holding.states.wait()

    @classmethod
    def tell(cls, seconds):
        """The clock goes on, or back."""
        cls.now = cls.now + rospy.Duration.from_sec(seconds)
        cls.publisher.publish(Clock(clock=cls.now))

    def go_on(self, seconds, follower=None):
        """The clock goes on as a node follows it that does not stand: it leaves out ticks where it falls behind."""
        states = (follower or self.node).states
        begin = len(states.messages)
        for n in range(round(seconds / PERIOD)):
            self.tell(PERIOD)
            states.wait(begin + n)

    def warnings(self, begin, words):
        """Of the node, since so many messages on /rosout."""
        return [m.msg for m in self.rosout.messages[begin:] if m.name == "/hybrid_sphere" and words in m.msg]

    def test_1_states_are_those_of_simulate_at_the_times_of_the_clock(self):
        begin = self.node.states.messages[0]
        self.assertEqual((begin.time, begin.header.stamp), (0, rospy.Time(1000, 0)))
        self.go_on(1.0)
        last = self.node.at(self.now)
        self.assertAlmostEqual(last.time, 1.0, delta=1e-9)
        self.assertEqual(last.header.stamp, self.now)
        rows = simulate(os.path.join(os.environ["SCENES"], "paper.yaml"), "--times", repr(last.time), "--states", "-")
        self.assertEqual((last.pose.position.x, last.pose.position.y), (float(rows[0]["x"]), float(rows[0]["y"])))
        times = [m.time for m in self.node.states.messages]
        self.assertEqual(len(times), 101, "every tick was taken")
        let_pass(0.3)
        self.assertEqual(len(self.node.states.messages), 101, "without a clock that goes on nothing happens")

    def test_2_a_jump_forward_leaves_out_outputs_and_no_motion(self):
        before = self.node.services["get_state"]().state
        self.tell(5.0)
        after = self.node.at(self.now)
        self.assertAlmostEqual(after.time - before.time, 5.0, delta=1e-9)

    def test_3_after_a_pause_stamps_are_those_of_the_clock(self):
        self.node.services["pause"](True)
        before = self.node.services["get_state"]().state
        self.go_on(0.5, self.holding)
        self.assertEqual(self.node.services["get_state"]().state.time, before.time)
        self.assertIn("/clock", self.node.services["step"](1.0).message)
        self.node.services["pause"](False)
        self.go_on(0.2)
        after = self.node.at(self.now - rospy.Duration.from_sec(PERIOD))
        self.assertAlmostEqual(after.time, before.time + 0.2, delta=1.5 * PERIOD)
        self.assertLess(abs((self.now - after.header.stamp).to_sec()), 1.5 * PERIOD)

    def test_4_a_jump_back_is_a_reset_or_is_waited_out(self):
        reached = self.holding.at(self.now - rospy.Duration.from_sec(PERIOD))
        count = len(self.node.states.messages)
        held = len(self.holding.states.messages)
        end = self.now
        self.tell(-3.0)
        self.go_on(PERIOD)

        def restarts():  # a state from before the jump may arrive after it
            return [m for m in self.node.states.messages[count:] if m.header.stamp < end - rospy.Duration(1)]

        restarted = wait_for(restarts, "the initial state")[0]
        self.assertLess(restarted.time, 2 * PERIOD)
        self.go_on(1.0 - PERIOD)
        after = wait_for(lambda: [m for m in restarts() if m.time >= 0.98], "a second later")[0]
        self.assertLess(abs((self.now - after.header.stamp).to_sec()), 3 * PERIOD)
        late = [m.header.stamp for m in self.holding.states.messages[held:]]
        self.assertTrue(all(reached.header.stamp < stamp <= end for stamp in late), "the other one holds")
        wait_for(lambda: [m for m in list(self.rosout.messages) if m.name == "/holding" and "jumped back" in m.msg], "a warning")
        self.go_on(2.5)
        resumed = wait_for(lambda: [m for m in self.holding.states.messages[held:] if m.header.stamp > end],
                           "the other one continues")[0]
        self.assertGreater(resumed.time, reached.time)
        self.assertGreater(resumed.header.stamp, reached.header.stamp)

    def test_5_small_steps_back_hold_the_time(self):
        """Two clocks of one publisher that disagree by less than 0.25 s, as of a bag that holds /clock."""
        said = len(self.rosout.messages)
        begin = self.node.services["get_state"]().state
        for _ in range(50):
            self.tell(0.02)
            self.tell(-0.01)
        end = self.node.at(self.now)
        self.assertAlmostEqual(end.time - begin.time, 0.5, delta=2 * PERIOD)
        wait_for(lambda: self.warnings(said, "steps back by"), "a warning")
        self.assertEqual(self.warnings(said, "jumped back"), [])
        self.assertLess(len(self.warnings(said, "steps back by")), 20, "not a warning for each step")

    def test_6_of_two_publishers_one_is_followed(self):
        said = len(self.rosout.messages)
        self.go_on(0.05)
        begin = self.node.services["get_state"]().state
        other = subprocess.Popen(["/usr/bin/python3", "-c", OTHER], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

        def warned():
            self.go_on(PERIOD)
            return self.warnings(said, "too, while")

        try:
            wait_for(warned, "a warning that names both")
        finally:
            other.kill()
            other.wait()
        self.go_on(0.05)
        self.assertGreater(self.node.services["get_state"]().state.time, begin.time)
        self.assertEqual(self.warnings(said, "jumped back"), [])

    def test_7_a_bag_with_a_clock_is_followed(self):
        with tempfile.TemporaryDirectory() as directory:
            path = os.path.join(directory, "clock.bag")
            begin = self.now + rospy.Duration(10)
            with rosbag.Bag(path, "w") as bag:
                for n in range(200):
                    stamp = begin + rospy.Duration.from_sec(0.005 * n)
                    bag.write("/somebody", Clock(clock=stamp), stamp)
            subprocess.run(["rosbag", "play", "--clock", "--quiet", path], check=True, timeout=PATIENCE,
                           stdin=subprocess.DEVNULL)
        last = wait_for(lambda: (m := self.node.states.messages[-1]).header.stamp >= begin + rospy.Duration.from_sec(0.9) and m,
                        "the end of the bag")
        self.assertLess(last.header.stamp, begin + rospy.Duration(2))


if __name__ == "__main__":
    rospy.init_node("follow_test")
    rostest.rosrun("hybrid_sphere", "follow_test", FollowedClock)
