#!/usr/bin/python3
"""Tests a controller against the plant: it catches the sphere in a disc, wherever the sphere starts and whatever ground it
crosses. Needs nothing but the messages and services of hybrid_sphere; see README.md beside this file."""
import math
import threading
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import WrenchStamped
from hybrid_sphere.msg import ConstraintSwitch, SphereState
from hybrid_sphere.srv import SetInitialState, SetInitialStateRequest
from std_srvs.srv import SetBool

PLANT = "/hybrid_sphere"
PATIENCE = 60.0  # s of wall time for what must come; on a busy machine it comes late
SLOW = 0.05      # m/s


class Plant:
    """The plant as a test needs it: put the sphere somewhere, let time pass, wait for a state."""

    def __init__(self):
        self.changed = threading.Condition()
        self.states = []    # of the present run
        self.switches = []  # of the present run
        self.begin = None   # stamp of the run's initial state
        self.pause = self.service("pause", SetBool)
        self.set_initial_state = self.service("set_initial_state", SetInitialState)
        rospy.Subscriber(PLANT + "/state", SphereState, self.keep, self.states)
        rospy.Subscriber(PLANT + "/constraint_switch", ConstraintSwitch, self.keep, self.switches)
        self.last = None
        self.wait(lambda: self.last, "a state of the plant")

    @staticmethod
    def service(name, kind):
        rospy.wait_for_service(PLANT + "/" + name, PATIENCE)
        return rospy.ServiceProxy(PLANT + "/" + name, kind)

    def keep(self, message, messages):
        with self.changed:
            if messages is self.states:
                self.last = message
            if self.begin is None or message.header.stamp > self.begin:
                messages.append(message)
            self.changed.notify_all()

    def wait(self, condition, what):
        """Waits until the condition holds; returns its value."""
        end = time.monotonic() + PATIENCE
        with self.changed:
            while not condition():
                if not self.changed.wait(max(0.0, end - time.monotonic())) and time.monotonic() >= end:
                    raise AssertionError("waited %g s for %s" % (PATIENCE, what))
            return condition()

    def start(self, position, velocity=(0.0, 0.0)):
        """A new run from a position [m] and a velocity [m/s]; time starts to pass."""
        self.pause(True)
        request = SetInitialStateRequest()
        request.pose.position.x, request.pose.position.y = position
        request.twist.linear.x, request.twist.linear.y = velocity
        answer = self.set_initial_state(request)
        assert answer.success, answer.message
        self.wait(lambda: self.last.time == 0, "the initial state")
        with self.changed:
            self.begin = self.last.header.stamp
            self.states.clear()
            self.switches.clear()
        self.pause(False)

    def wait_for_state(self, condition, what):
        return self.wait(lambda: next((state for state in self.states if condition(state)), None), what)


class Controller(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.target = rospy.get_param("~x"), rospy.get_param("~y")
        cls.radius = rospy.get_param("~radius")
        cls.commands = rospy.Subscriber(PLANT + "/cmd_wrench", WrenchStamped)
        cls.plant = Plant()
        deadline = time.monotonic() + PATIENCE
        while cls.commands.get_num_connections() == 0:
            assert time.monotonic() < deadline, "no controller sends cmd_wrench"
            time.sleep(0.05)

    def in_disc(self, state):
        position = state.pose.position
        return math.hypot(position.x - self.target[0], position.y - self.target[1]) <= self.radius

    def caught(self, state):
        return self.in_disc(state) and math.hypot(state.twist.linear.x, state.twist.linear.y) < SLOW

    def test_it_catches_the_sphere_on_the_ground_of_the_disc(self):
        self.plant.start((2.5, 1.5))
        self.plant.wait_for_state(self.caught, "the catch")

    def test_it_catches_the_sphere_across_a_switch(self):
        self.plant.start((-2.0, -0.5), velocity=(0.5, 0.0))
        self.plant.wait_for_state(self.caught, "the catch")
        first = self.plant.switches[0]
        self.assertEqual((first.kind, first.to_region), (ConstraintSwitch.APPLIED, "carpet"))

    def test_it_keeps_what_it_has_caught(self):
        self.plant.start((1.0, 0.0))
        caught = self.plant.wait_for_state(self.caught, "the catch")
        self.plant.wait_for_state(lambda state: state.time > caught.time + 3, "three seconds more")
        after = [state for state in list(self.plant.states) if state.time >= caught.time]
        self.assertTrue(all(self.in_disc(state) for state in after))


if __name__ == "__main__":
    rospy.init_node("controller_test")
    rostest.rosrun("hybrid_sphere", "controller_test", Controller)
