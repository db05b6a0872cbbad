#!/usr/bin/python3
"""The node and `simulate` agree to the bit: states at the node's output times, and switches."""
import unittest

import rospy
import rostest

from csv_rows import parsed, state_row, switch_row
from node_client import Client, simulate, wait_for

RATE = 333  # n/rate is not a binary fraction
DURATION = 6


class Agreement(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = Client(rospy.get_param("~node"))
        cls.scene = rospy.get_param("~scene")
        cls.begin = cls.client.start()
        cls.client.states.wait_for_one(lambda m: m.header.stamp > cls.begin and m.time > DURATION)

    def of_this_run(self, messages):
        return [m for m in list(messages) if m.header.stamp > self.begin and m.time <= DURATION]

    def test_states(self):
        asked = ("--rate", str(RATE), "--duration", str(DURATION))
        rows = {row[0]: row for row in (parsed(r) for r in simulate(self.scene, *asked, "--states", "-"))}
        states = self.of_this_run(self.client.states.messages)
        self.assertGreater(len(states), DURATION * RATE / 10)
        self.assertEqual({s.stage for s in states}, {1, 3})
        for state in states:
            self.assertIn(state.time, rows)
            self.assertEqual(state_row(state), rows[state.time])

    def test_states_at_times_asked_for(self):
        states = self.of_this_run(self.client.states.messages)[::50]
        times = ",".join(repr(s.time) for s in states)
        for state, row in zip(states, simulate(self.scene, "--times", times, "--states", "-")):
            self.assertEqual(state_row(state), parsed(row))

    def test_switches(self):
        rows = [parsed(row) for row in simulate(self.scene, "--duration", str(DURATION), "--switches", "-")]
        wait_for(lambda: len(self.of_this_run(self.client.switches.messages)) >= len(rows), "the switches")
        switches = self.of_this_run(self.client.switches.messages)
        self.assertGreater(len(rows), 3)
        self.assertEqual([switch_row(s) for s in switches], rows)


if __name__ == "__main__":
    rospy.init_node("agreement_test")
    rostest.rosrun("hybrid_sphere", "agreement_test", Agreement)
