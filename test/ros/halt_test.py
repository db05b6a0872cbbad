#!/usr/bin/python3
"""Where the computation cannot go on the node holds the last state, until it is told how to go on."""
import unittest

import rospy
import rostest
from hybrid_sphere.msg import SurfaceMap, SurfaceRegion
from rosgraph_msgs.msg import Log
from tf2_msgs.msg import TFMessage

from node_client import Client, Console, Listener, half_plane, initial_state, made_of, surface, wait_for

NODE = "/hybrid_sphere"
# At rest on the lower belt the sphere gets v = kappa u = 2/7 m/s; it comes to the edge, 0.1 m away, after 0.35 s.
HALT = 0.35


def belts():
    base = made_of(SurfaceRegion(law=SurfaceRegion.ROUGH), belt=(0, 1))
    return surface(made_of(half_plane("upper", (0, 0), (0, 1)), belt=(0, -1)), base=base, livelock=SurfaceMap.STOP)


class Halt(unittest.TestCase):
    def setUp(self):
        self.console = Console(NODE)
        self.client = Client()
        self.assertTrue(self.client.set_surface_map(belts()).success)
        self.errors = len(self.console.said(Log.ERROR))
        self.begin = self.client.start(initial_state((0, -0.1)))

    def wait_for_halt(self, begin):
        """The last of some states whose time stands, while their stamps go on."""
        def stands():
            states = [m for m in list(self.client.states.messages) if m.header.stamp > begin and m.time > 0][-20:]
            return len(states) == 20 and len({m.time for m in states}) == 1 and states

        states = wait_for(stands, "the halt")
        stamps = [m.header.stamp for m in states]
        self.assertTrue(all(a < b for a, b in zip(stamps, stamps[1:])))
        self.assertAlmostEqual(states[-1].time, HALT, delta=1e-9)
        return states[-1]

    def test_the_last_state_is_held_and_the_reason_said_once(self):
        state = self.wait_for_halt(self.begin)
        self.assertAlmostEqual(state.pose.position.y, 0, delta=1e-9)
        self.client.states.wait(len(self.client.states.messages) + 100)
        self.assertEqual(self.client.states.messages[-1].time, state.time)
        said = self.console.said(Log.ERROR)[self.errors:]
        self.assertEqual(len(said), 1, said)
        self.assertIn("halted at t = 0.35", said[0])
        self.assertIn("upper", said[0])

    def test_a_reset_starts_anew(self):
        halted = self.wait_for_halt(self.begin)
        tf = Listener("/tf", TFMessage)
        tf.wait()
        self.assertTrue(self.client.reset().success)
        self.client.states.wait_for_one(lambda m: m.header.stamp > halted.header.stamp and m.time < halted.time)
        self.wait_for_halt(halted.header.stamp)
        self.console.wait_for_next(Log.ERROR, self.errors + 1)  # a second time
        stamps = [t.header.stamp for m in list(tf.messages) for t in m.transforms if t.child_frame_id == "sphere"]
        self.assertTrue(all(a < b for a, b in zip(stamps, stamps[1:])))
        tf.stop()

    def test_another_initial_state_goes_on(self):
        self.wait_for_halt(self.begin)
        begin = self.client.start(initial_state((0, -0.1), (0, -2), (8, 0, 0)))
        self.client.states.wait_for_one(lambda m: m.header.stamp > begin and m.time > 2 * HALT)

    def test_another_map_goes_on_from_the_instant_of_the_halt(self):
        halted = self.wait_for_halt(self.begin)
        self.client.states.wait_for_one(lambda m: m.header.stamp.to_sec() > halted.header.stamp.to_sec() + 1.0)
        last = self.client.states.messages[-1]
        self.assertTrue(self.client.set_surface_map(surface()).success)
        state = self.client.states.wait_for_one(lambda m: m.header.stamp > last.header.stamp and m.time > halted.time)
        # Time has stood: it is the next tick after the halt, or one soon after.
        self.assertLess(state.time, HALT + 0.5)
        self.assertEqual(state.mode, "free")
        self.assertAlmostEqual(abs(state.pose.position.y), 2 / 7 * (state.time - HALT), delta=1e-9)
        stamps = [m.header.stamp for m in self.client.states.messages]
        self.assertTrue(all(a < b for a, b in zip(stamps, stamps[1:])))


if __name__ == "__main__":
    rospy.init_node("halt_test")
    rostest.rosrun("hybrid_sphere", "halt_test", Halt)
