#!/usr/bin/python3
"""A map of ten thousand regions is taken, and given, beside the loop."""
import math
import random
import threading
import unittest
import xmlrpc.client

import rosgraph
import rospy
import rostest
from hybrid_sphere.msg import SurfaceMap, SurfaceRegion
from hybrid_sphere.srv import SetSurfaceMap
from nav_msgs.msg import OccupancyGrid
from visualization_msgs.msg import MarkerArray

from node_client import Client, Listener, circle, initial_state, polygon, surface, wait_for

NODE = "/hybrid_sphere"
SIDE = 100  # regions along each axis


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

    def test_the_loop_goes_on_while_a_request_waits(self):
        """The thread that takes maps waits for a transform, for a second; the loop makes 500 states meanwhile."""
        request = surface()
        request.header.frame_id = "nowhere"
        begin = self.client.present().header.stamp
        self.assertFalse(self.client.set_surface_map(request).success)
        end = self.client.state().header.stamp
        self.assertGreater(len([m for m in list(self.client.states.messages) if begin < m.header.stamp < end]), 20)

    def test_all_of_the_map_is_given(self):
        self.assertTrue(self.client.set_surface_map(patchwork("patch")).success)
        got = self.client.get_surface_map().map
        self.assertEqual(len(got.regions), SIDE * SIDE)
        self.assertEqual(got.regions[1].radius, 0.4)

    def test_the_map_is_in_force_when_the_service_has_answered(self):
        self.assertTrue(self.client.set_surface_map(patchwork("patch")).success)
        answered = self.client.state()
        self.client.states.wait_for_one(lambda m: m.header.stamp > answered.header.stamp and
                                        m.region.startswith("patch_"))

    def test_while_a_polygon_of_very_many_corners_is_drawn_maps_are_answered(self):
        corners = 300000
        angles = [2 * math.pi * i / corners for i in range(corners)]
        radii = [3 + math.sin(40 * a) + random.Random(i).uniform(0, 1e-6) for i, a in enumerate(angles)]
        star = polygon("star", [(r * math.cos(a), r * math.sin(a)) for r, a in zip(radii, angles)])
        markers = Listener(NODE + "/surface_markers", MarkerArray)
        markers.wait()
        drawn = len(markers.messages)
        self.assertTrue(self.client.set_surface_map(surface(star)).success)
        self.assertTrue(self.client.set_surface_map(surface(polygon("small", [(0, 0), (1, 0), (0, 1)]))).success)
        self.assertEqual(self.client.get_surface_map().map.regions[0].name, "small")

        def last_is_of_the_small_map():
            texts = [m.text for m in markers.messages[-1].markers]
            return len(markers.messages) > drawn and "small: rough" in texts

        wait_for(last_is_of_the_small_map, "the markers of the small map")
        markers.stop()

    def test_what_a_large_map_has_taken_is_given_back(self):
        process = xmlrpc.client.ServerProxy(rosgraph.Master("/test").lookupNode(NODE)).getPid("/test")[2]

        def megabytes():
            with open("/proc/%d/status" % process) as file:
                return [int(line.split()[1]) for line in file if line.startswith("VmRSS")][0] / 1000

        maps = Listener(NODE + "/surface_map", rospy.AnyMsg)
        grids = rospy.Publisher(NODE + "/surface_grid", OccupancyGrid, queue_size=1)
        wait_for(grids.get_num_connections, "the node on ~surface_grid")
        maps.wait()
        before = megabytes()
        grid = OccupancyGrid()
        grid.header.frame_id = rospy.get_param(NODE + "/world_frame", "world")
        grid.info.width = grid.info.height = 1000
        grid.info.resolution = 0.05
        grid.info.origin.orientation.w = 1
        cells = random.Random(1)
        grid.data = [100 * cells.getrandbits(1) for _ in range(grid.info.width * grid.info.height)]
        seen = len(maps.messages)
        grids.publish(grid)
        maps.wait(seen + 1)
        wait_for(lambda: megabytes() > before + 100, "the large map in memory")
        self.assertTrue(self.client.set_surface_map(surface()).success)
        wait_for(lambda: megabytes() < before + 50, "the memory")  # what is being drawn is drawn first
        maps.stop()
        grids.unregister()

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
