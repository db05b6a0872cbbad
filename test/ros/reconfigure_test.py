#!/usr/bin/python3
"""What may be changed while the node runs: by dynamic_reconfigure, in the node and in the nodelet alike."""
import math
import unittest

import rospy
import rostest
from dynamic_reconfigure.client import Client as Reconfigure
from hybrid_sphere.msg import SimulatorStatus
from rosgraph_msgs.msg import Log
from visualization_msgs.msg import Marker, MarkerArray

from csv_rows import parsed, state_row
from node_client import PATIENCE, Client, Console, Listener, case, initial_state, simulate, wait_for


class Adjusted(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.node = rospy.get_param("~node")
        cls.scene = rospy.get_param("~scene")
        cls.reconfigure = Reconfigure(cls.node, timeout=PATIENCE)
        cls.client = Client(cls.node)

    def setUp(self):
        self.client.pause(False)
        self.adjust(rate=200, real_time_factor=1, accuracy=1e-9, trail_length=2000)

    def adjust(self, **values):
        answer = self.reconfigure.update_configuration(values)
        for name, value in values.items():
            self.assertEqual(answer[name], value)
        return answer

    def restart(self):
        """The stamp of a state before the initial state of the scene."""
        state = rospy.get_param(self.node + "/initial_state")
        return self.client.start(initial_state(state["position"], state["velocity"], state["angular_velocity"]))

    def test_the_parameters_are_those_in_force(self):
        self.assertEqual(self.reconfigure.get_configuration(PATIENCE)["rate"], 200)
        self.adjust(rate=333.0)
        self.assertEqual(rospy.get_param(self.node + "/rate"), 333)

    def test_another_rate_goes_on_at_its_own_multiples_and_the_trajectory_is_the_same(self):
        begin = self.restart()
        for rate in (50.0, 1000.0, 128.0):
            self.adjust(rate=rate)
            now = self.client.state().time
            self.client.states.wait_for_one(lambda m: m.header.stamp > begin and m.time > now + 0.3)
        states = [m for m in list(self.client.states.messages) if m.header.stamp > begin]
        first = max(i for i, m in enumerate(states) if i == 0 or m.time < states[i - 1].time)
        states = states[first:]  # what was on its way before the initial state
        self.assertTrue(all(a.time < b.time for a, b in zip(states, states[1:])))
        times = [m.time for m in states]
        self.assertTrue(any(round(t * 1000) / 1000 == t and round(t * 128) / 128 != t for t in times))
        self.assertEqual(times[-1], round(times[-1] * 128) / 128)
        asked = ",".join(repr(t) for t in times[::5])
        for state, row in zip(states[::5], simulate(self.scene, "--times", asked, "--states", "-")):
            self.assertEqual(state_row(state), parsed(row))

    def test_another_factor_never_sprints(self):
        self.restart()
        for factor in (0.1, 5.0, 0.5, 1.0):
            self.adjust(real_time_factor=factor)
            self.client.state()
        times = [m.time for m in list(self.client.states.messages)[-200:]]
        steps = [b - a for a, b in zip(times, times[1:]) if b > a]
        self.assertLess(max(steps), 5 * 0.25 + 0.01)
        status = Listener(self.node + "/status", SimulatorStatus)
        status.wait_for_one(lambda m: m.real_time_factor_target == 1)
        status.stop()

    def test_as_fast_as_it_can_and_back(self):
        self.adjust(real_time_factor=0.0)
        begin = self.client.state()
        later = self.client.states.wait_for_one(lambda m: m.time > begin.time + 20)
        self.assertGreater(later.header.stamp, begin.header.stamp)
        self.adjust(real_time_factor=1.0)
        status = Listener(self.node + "/status", SimulatorStatus)
        status.wait_for_one(lambda m: m.real_time_factor_target == 1 and 0 < m.real_time_factor < 5)
        status.stop()

    def test_a_factor_between_0_and_the_least_is_refused(self):
        answer = self.reconfigure.update_configuration({"real_time_factor": 1e-5})
        self.assertEqual(answer["real_time_factor"], 1)

    def test_what_is_outside_of_its_range_is_refused_and_not_put_to_its_end(self):
        console = Console(rospy.get_param("~process"))
        asked = {"rate": (-5.0, "a number from 1 to 10000"), "accuracy": (2.0, "a number from 1e-14 to 1"),
                 "real_time_factor": (1001.0, "a number from 0 to 100"), "arrow_scale": (-1.0, "a number from 0 to 10"),
                 "trail_length": (-1, "a whole number from 0 to 20000"), "impulse_lifetime": (math.inf, "a number from 0")}
        for name, (value, allowed) in asked.items():
            with case(name=name):
                before = self.reconfigure.get_configuration(PATIENCE)[name]
                said = len(console.said(Log.WARN))
                self.assertEqual(self.reconfigure.update_configuration({name: value})[name], before)
                self.assertIn("%s: %.6g is refused; allowed: %s" % (name, value, allowed),
                              console.wait_for_next(Log.WARN, said))
                self.assertEqual(rospy.get_param(self.node + "/" + name), before)

    def test_a_node_that_was_started_beyond_the_ranges_keeps_that(self):
        beyond = Reconfigure("/beyond", timeout=PATIENCE)
        answer = beyond.update_configuration({"arrow_scale": 2.0})
        self.assertEqual((answer["arrow_scale"], answer["rate"], answer["trail_length"]), (2, 0.5, 100000))
        answer = beyond.update_configuration({"rate": 0.25})  # another one is not in the range
        self.assertEqual(answer["rate"], 0.5)
        beyond.close()

    def test_what_is_no_number_is_refused_by_its_name_and_all_goes_on(self):
        console = Console(rospy.get_param("~process"))
        for name in ("rate", "real_time_factor", "accuracy", "impulse_lifetime", "arrow_scale"):
            with case(name=name):
                before = self.reconfigure.get_configuration(PATIENCE)[name]
                said = len(console.said(Log.WARN))
                self.assertEqual(self.reconfigure.update_configuration({name: math.nan})[name], before)
                self.assertIn(name + ": nan is refused; allowed: ", console.wait_for_next(Log.WARN, said))
                self.assertEqual(rospy.get_param(self.node + "/" + name), before)
                self.client.state()

    def test_another_accuracy_is_in_force(self):
        self.adjust(accuracy=1e-4)
        self.assertEqual(rospy.get_param(self.node + "/accuracy"), 1e-4)
        begin = self.restart()
        self.client.switch_after(begin)

    def test_no_trail(self):
        self.adjust(trail_length=0)
        markers = Listener(self.node + "/markers", MarkerArray)
        count = len(markers.messages)
        def trails():
            return [m for a in list(markers.messages)[count:] for m in a.markers if m.ns == "trail"]
        self.assertEqual(wait_for(trails, "the trail")[-1].action, Marker.DELETE)
        markers.stop()


if __name__ == "__main__":
    rospy.init_node("reconfigure_test")
    rostest.rosrun("hybrid_sphere", "reconfigure_test", Adjusted)
