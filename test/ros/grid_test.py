#!/usr/bin/python3
"""~surface_grid: occupied cells become rough ground, what is no such grid changes nothing."""
import math
import re
import unittest

import rospy
import rostest
from hybrid_sphere.msg import SurfaceMap, SurfaceRegion
from nav_msgs.msg import OccupancyGrid
from rosgraph_msgs.msg import Log

from node_client import Client, Console, Listener, case, initial_state, let_pass, surface, wait_for

NODE = "/hybrid_sphere"


def grid():
    """Two rows of four cells of 0.5 m from (-1, 2) on; 50 is the threshold."""
    message = OccupancyGrid()
    message.header.frame_id = "world"
    message.info.width, message.info.height, message.info.resolution = 4, 2, 0.5
    message.info.origin.position.x, message.info.origin.position.y = -1, 2
    message.info.origin.orientation.w = 1
    message.data = [49, 50, 100, -1,
                    49, 50, 100, 0]
    return message


class Grid(unittest.TestCase):
    def setUp(self):
        self.client = Client()
        self.maps = Listener(NODE + "/surface_map", SurfaceMap)
        self.maps.wait()
        self.publisher = rospy.Publisher(NODE + "/surface_grid", OccupancyGrid, queue_size=10)
        wait_for(self.publisher.get_num_connections, "the node on surface_grid")

    def tearDown(self):
        self.publisher.unregister()
        self.maps.stop()

    def test_occupied_cells_are_rough_ground(self):
        self.assertTrue(self.client.set_surface_map(surface(base=SurfaceRegion.ROUGH)).success)
        self.publisher.publish(grid())
        got = self.maps.wait_for_one(lambda m: m.regions and m.regions[0].name == "grid_0")
        self.assertEqual(got.base.law, SurfaceRegion.SMOOTH)  # that of the scene
        self.assertEqual([r.law for r in got.regions], [SurfaceRegion.ROUGH])
        corners = {(p.x, p.y) for p in got.regions[0].points}
        self.assertEqual(corners, {(-0.5, 2), (0.5, 2), (0.5, 3), (-0.5, 3)})
        self.client.state()  # a later tick than that in which the maps switched the ground
        begin = self.client.start(initial_state((-0.9, 2.5), (1, 0)))
        event = self.client.switch_after(begin)
        self.assertEqual((event.from_region, event.to_region, event.position.x), ("base", "grid_0", -0.5))

    def test_refused_grids_change_nothing(self):
        console = Console(NODE)
        ground = self.client.get_surface_map().map

        def spoilt(change):
            message = grid()
            change(message)
            return message

        cases = [
            (lambda m: setattr(m.header, "frame_id", "odom"), 'surface_grid.header.frame_id: "odom"'),
            (lambda m: (setattr(m.info, "width", 0), setattr(m, "data", [])), "surface_grid.info"),
            (lambda m: setattr(m.info, "resolution", 0), "surface_grid.info.resolution: 0"),
            (lambda m: setattr(m.info, "resolution", math.nan), "surface_grid.info.resolution: nan"),
            (lambda m: setattr(m.info.origin.orientation, "x", 0.1), "surface_grid.info.origin.orientation: "),
            (lambda m: setattr(m, "data", m.data[1:]), "surface_grid.data: 7 values"),
            (lambda m: setattr(m, "data", [-2] + m.data[1:]), "surface_grid.data[0]: -2"),
        ]
        counts = []
        for change, words in cases:
            with case(words=words):
                said = len(console.said(Log.WARN))
                let_pass(1.1)  # one warning a second
                self.publisher.publish(spoilt(change))
                warning = console.wait_for_next(Log.WARN, said)
                self.assertIn(words, warning)
                self.assertIn(" is refused; allowed: ", warning)
                counts.append(int(re.search(r"message dropped \((\d+) so far\)", warning).group(1)))
                self.assertEqual(self.client.get_surface_map().map, ground)
        self.assertEqual(counts, list(range(counts[0], counts[0] + len(cases))))


if __name__ == "__main__":
    rospy.init_node("grid_test")
    rostest.rosrun("hybrid_sphere", "grid_test", Grid)
