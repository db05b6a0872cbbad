#!/usr/bin/python3
"""A map of ten thousand regions is taken, and given, while the node keeps its rate."""
import threading
import unittest

import rospy
import rostest
from hybrid_sphere.msg import SurfaceMap, SurfaceRegion
from hybrid_sphere.srv import SetSurfaceMap
from visualization_msgs.msg import MarkerArray

from node_client import Client, Listener, circle, initial_state, polygon, surface

NODE = "/hybrid_sphere"
SIDE = 100  # regions along each axis
LONGEST_GAP = 0.1  # s between two states, at 500 Hz
ATTEMPTS = 3  # a map that holds up the node does so every time, a busy machine does not


def patchwork(name):
    """SIDE x SIDE discs and squares of every law around the origin."""
    regions = []
    for i in range(SIDE * SIDE):
        x, y = i % SIDE - SIDE / 2, i // SIDE - SIDE / 2
        if i % 2:
            regions.append(circle("%s_%d" % (name, i), (x, y), 0.4))
        else:
            corners = [(x - 0.3, y - 0.3), (x + 0.3, y - 0.3), (x + 0.3, y + 0.3), (x - 0.3, y + 0.3)]
            regions.append(polygon("%s_%d" % (name, i), corners, law=SurfaceRegion.RUBBER))
    return surface(*regions)


class LargeMap(unittest.TestCase):
    def setUp(self):
        self.client = Client()
        self.assertTrue(self.client.set_surface_map(surface()).success)
        self.client.start(initial_state((0.1, 0), (0, 0.3)))  # over one region after the other

    def longest_gap(self, begin, end):
        """Between two states from one stamp to another [s]: what is left out of the node's ticks shows there."""
        stamps = [m.header.stamp.to_sec() for m in list(self.client.states.messages)
                  if begin <= m.header.stamp <= end]
        self.assertGreater(len(stamps), 10)
        return max(b - a for a, b in zip(stamps, stamps[1:]))

    def test_the_node_keeps_its_rate(self):
        markers = Listener(NODE + "/surface_markers", MarkerArray)
        markers.wait()
        large = patchwork("patch")
        gaps = []
        while not gaps or (min(gaps) >= LONGEST_GAP and len(gaps) < ATTEMPTS):
            begin = self.client.state().header.stamp
            drawn = len(markers.messages)
            answer = self.client.set_surface_map(large)
            self.assertTrue(answer.success, answer.message)
            got = self.client.get_surface_map().map
            markers.wait(drawn + 1)
            gaps.append(self.longest_gap(begin, self.client.state().header.stamp))
        self.assertEqual(len(got.regions), SIDE * SIDE)
        self.assertEqual(got.regions[1].radius, 0.4)
        self.assertLess(min(gaps), LONGEST_GAP)

    def test_the_map_is_in_force_when_the_service_has_answered(self):
        self.assertTrue(self.client.set_surface_map(patchwork("patch")).success)
        answered = self.client.state()
        self.client.states.wait_for_one(lambda m: m.header.stamp > answered.header.stamp and
                                        m.region.startswith("patch_"))

    def test_callers_come_each_in_turn(self):
        answers = {}

        def call(name):
            service = self.client.service("set_surface_map", SetSurfaceMap)
            answers[name] = service(patchwork(name))

        maps = Listener(NODE + "/surface_map", SurfaceMap)
        maps.wait()
        seen = len(maps.messages)
        callers = [threading.Thread(target=call, args=(name,)) for name in ("a", "b")]
        for caller in callers:
            caller.start()
        for caller in callers:
            caller.join()
        self.assertTrue(answers["a"].success and answers["b"].success)
        both = [m.regions[0].name for m in maps.wait(seen + 2)[seen:]]
        self.assertEqual(sorted(both), ["a_0", "b_0"])
        self.assertEqual(self.client.get_surface_map().map.regions[0].name, both[-1])


if __name__ == "__main__":
    rospy.init_node("large_map_test")
    rostest.rosrun("hybrid_sphere", "large_map_test", LargeMap)
