#!/usr/bin/python3
"""Services of the node: what they do, and that a refusal changes nothing."""
import copy
import math
import unittest

import rospy
import rostest
from geometry_msgs.msg import Point, Vector3
from hybrid_sphere.msg import ConstraintSwitch, SurfaceMap, SurfaceRegion
from hybrid_sphere.srv import GetState, Kick, SetInitialState

from node_client import Client, Listener, case, circle, half_plane, initial_state, made_of, polygon, surface


def changed(message, path, value):
    """A copy of a message with one field changed: ("regions", 0, "law"), for example."""
    copied = copy.deepcopy(message)
    owner = copied
    for step in path[:-1]:
        owner = owner[step] if isinstance(step, int) else getattr(owner, step)
    setattr(owner, path[-1], value)
    return copied


def without_header(message):
    return changed(message, ("header",), None)


class Services(unittest.TestCase):
    def setUp(self):
        self.client = Client()
        self.map = surface(half_plane(), circle("disc", (-8, 3), 1.5),
                           polygon("square", [(-9, -9), (-8, -9), (-8, -8), (-9, -8)]))
        self.assertTrue(self.client.set_surface_map(self.map).success)
        self.client.start(initial_state((-6, 0), (0.1, 0), (0, 0, 1)))

    def assert_refused(self, call, *words):
        """The call is refused with these words, and map, motion and switches go on as they were."""
        ground = self.client.get_surface_map().map
        before = self.client.state()
        switches = len(self.client.switches.messages)
        answer = call()
        self.assertFalse(answer.success)
        for word in words + (" is refused; allowed: ",):
            self.assertIn(word, answer.message)
        after = self.client.state()
        self.assertEqual(self.client.get_surface_map().map, ground)
        self.assertGreater(after.time, before.time)
        self.assertEqual(after.twist, before.twist)
        self.assertAlmostEqual(after.pose.position.x, -6 + 0.1 * after.time, delta=1e-14)
        self.assertEqual(len(self.client.switches.messages), switches)

    def test_a_map_comes_back_as_it_was_sent(self):
        sent = surface(half_plane("a", (1, 2), (-3, 0.5)), circle("b", (1e3, -7), 0.1, outside=True),
                       polygon("c", [(0, 0), (4, 0), (1, 1), (0, 4)], law=SurfaceRegion.SMOOTH),
                       polygon("d", [(50, 50), (51, 50), (50.5, 51)], outside=True), base=SurfaceRegion.ROUGH)
        self.assertTrue(self.client.set_surface_map(sent).success)
        got = self.client.get_surface_map().map
        self.assertEqual(got.header.frame_id, "world")
        self.assertEqual(got.base.name, "base")
        self.assertEqual(got.regions, sent.regions)
        self.assertEqual(got.base.law, SurfaceRegion.ROUGH)
        self.assertTrue(self.client.set_surface_map(got).success)
        self.assertEqual(without_header(self.client.get_surface_map().map), without_header(got))

    def test_every_material_comes_back_as_it_was_sent(self):
        rubber, coulomb = SurfaceRegion.RUBBER, SurfaceRegion.COULOMB
        sent = surface(made_of(half_plane("mat", law=rubber), rolling_resistance=0.01, belt=(0.2, -0.1)),
                       made_of(circle("disc", (1, 2), 0.5, law=coulomb), friction=0.3, rolling_resistance=0.02,
                               spin_friction=0.03),
                       made_of(circle("table", (4, 0), 2), turntable=(3.0, (4, 0.25)), spin_friction=0.04),
                       base=made_of(SurfaceRegion(law=coulomb), friction=0.1, belt=(0, 1e-3)), livelock=SurfaceMap.STOP)
        answer = self.client.set_surface_map(sent)
        self.assertTrue(answer.success, answer.message)
        got = self.client.get_surface_map().map
        self.assertEqual(got.regions, sent.regions)
        self.assertEqual(got.base, changed(sent.base, ("name",), "base"))
        self.assertEqual(got.livelock, SurfaceMap.STOP)

    def test_friction_ends_the_slip(self):
        friction, speed = 0.2, 1.0
        ice = made_of(SurfaceRegion(law=SurfaceRegion.COULOMB), friction=friction)
        self.assertTrue(self.client.set_surface_map(surface(base=ice)).success)
        begin = self.client.start(initial_state((0, 0), (speed, 0)))
        event = self.client.switch_after(begin)
        self.assertEqual((event.kind, event.cause), (ConstraintSwitch.APPLIED, ConstraintSwitch.SLIP_ENDED))
        self.assertEqual((event.impulse.x, event.impulse.y), (0, 0))
        # Of a solid sphere: v - mu g t until the slip v - 7/2 mu g t has died.
        time = speed / (3.5 * friction * 9.81)
        self.assertAlmostEqual(event.time, time, delta=1e-9 * time)  # the accuracy of the scene
        self.assertAlmostEqual(event.twist_after.linear.x, 5 / 7 * speed, delta=1e-9)
        rolling = self.client.states.wait_for_one(lambda m: m.header.stamp > begin and m.time > time)
        slow = [s for s in self.client.states.messages if s.header.stamp > begin and 0 < s.time < time]
        self.assertEqual({s.mode for s in slow}, {"sliding"})
        self.assertAlmostEqual(slow[0].reaction.x, -friction * 2 * 9.81, delta=1e-12)
        self.assertEqual((rolling.mode, rolling.stage), ("rolling", 3))

    def test_a_set_state_keeps_time_index_and_initial_state(self):
        self.assertTrue(self.client.set_surface_map(surface(half_plane())).success)
        set_state = self.client.service("set_state", SetInitialState)
        get_state = self.client.service("get_state", GetState)
        begin = self.client.start(initial_state((-0.5, 0), (1, 0)))
        first = self.client.switch_after(begin)
        with self.client.standing() as stamp:
            before = get_state().state
            self.assertTrue(set_state(initial_state((-0.25, 1), (1, 0), (0, 0, 2))).success)
            after = get_state().state
        self.assertEqual((after.time, after.pose.position.x, after.pose.position.y), (before.time, -0.25, 1))
        self.assertGreater(after.header.stamp, stamp)
        second = self.client.switch_after(stamp, first.index + 1)
        self.assertAlmostEqual(second.time, before.time + 0.25, delta=1e-12)
        self.assertEqual(second.impulse, first.impulse)
        refused = set_state(initial_state((0, 0), (float("nan"), 0)))
        self.assertFalse(refused.success)
        self.assertIn("initial_state.velocity[0]: nan", refused.message)
        with self.client.standing():
            self.client.reset()
            self.assertEqual(get_state().state.pose.position.x, -0.5)

    def test_a_kick_is_an_impulse_with_a_direction(self):
        self.assertTrue(self.client.set_surface_map(surface()).success)
        kick = self.client.service("kick", Kick)
        self.client.start(initial_state((0, 0), (0.25, 0)))
        self.assertTrue(kick(impulse=Vector3(2.0, -1.0, 0)).success)
        twist = self.client.state().twist.linear
        self.assertEqual((twist.x, twist.y), (0.25 + 2.0 / 2, -1.0 / 2))
        for impulse, said in ((Vector3(0, 0, 1), "impulse.z: 1"), (Vector3(float("inf"), 0, 0), "impulse: [inf, 0, 0]"),
                              (Vector3(1e300, 0, 0), "impulse: [1e+300, 0, 0]")):
            with case(impulse=impulse):
                answer = kick(impulse=impulse)
                self.assertFalse(answer.success)
                self.assertIn(said, answer.message)
        self.assertEqual(self.client.state().twist.linear, twist, "nothing has changed")

    def test_a_clockwise_polygon_is_turned_round(self):
        corners = [(0, 0), (0, 4), (1, 1), (4, 0)]
        self.assertTrue(self.client.set_surface_map(surface(polygon("p", corners))).success)
        got = self.client.get_surface_map().map.regions[0].points
        self.assertEqual([(p.x, p.y) for p in got], corners[::-1])

    def test_a_new_map_is_published(self):
        maps = Listener("/hybrid_sphere/surface_map", SurfaceMap)
        maps.wait()
        self.assertTrue(self.client.set_surface_map(surface(circle("new", (9, 9), 1))).success)
        self.assertEqual(maps.wait_for_one(lambda m: m.regions[0].name == "new").header.frame_id, "world")

    def test_refused_maps(self):
        region = ("regions", 0)
        cases = [
            (("header", "frame_id"), "odom", "map.header.frame_id", '"odom"'),
            (("livelock",), 7, "map.livelock", "7"),
            (("base", "shape"), 1, "map.base.shape", "1"),
            (("base", "name"), "sea", "map.base.name", '"sea"'),
            (("base", "law"), 9, "map.base.law", "9"),
            (("base", "friction"), 0.5, "map.base.friction", "0.5"),
            (region + ("name",), "", "map.regions[0].name", '""'),
            (region + ("name",), "disc", "map.regions[1].name", '"disc"'),
            (region + ("name",), "base", "map.regions[0].name", '"base"'),
            (region + ("shape",), 0, "map.regions[0].shape", "EVERYWHERE"),
            (region + ("shape",), 4, "map.regions[0].shape", "4"),
            (region + ("law",), 4, "map.regions[0].law", "4"),
            (region + ("friction",), math.nan, "map.regions[0].friction", "nan"),
            (region + ("rolling_resistance",), -0.1, "map.regions[0].rolling_resistance", "-0.1"),
            (region + ("spin_friction",), math.inf, "map.regions[0].spin_friction", "inf"),
            (region + ("belt", "x"), math.nan, "map.regions[0].belt[0]", "nan"),
            (region + ("belt", "z"), 0.2, "map.regions[0].belt.z", "0.2"),
            (region + ("turntable_rate",), 1e300, "map.regions[0].turntable.rate", "1e+300"),
            (region + ("normal", "x"), 0, "map.regions[0].half_plane.normal", "[0, 0]"),
            (region + ("normal", "z"), 1, "map.regions[0].normal.z", "1"),
            (region + ("outside",), True, "map.regions[0].outside", "true"),
            (region + ("points",), [], "map.regions[0].points", "0 points"),
            (region + ("points", 0, "x"), math.inf, "map.regions[0].half_plane.point[0]", "inf"),
            (region + ("points", 0, "z"), 0.1, "map.regions[0].points[0].z", "0.1"),
            (("regions", 1, "radius"), -1, "map.regions[1].circle.radius", "-1"),
            (("regions", 1, "points"), [Point(), Point()], "map.regions[1].points", "2 points"),
            (("regions", 2, "points"), [Point(), Point(1, 0, 0)], "map.regions[2].polygon", "2 corners"),
            (("regions", 2, "points"), [Point(0, 0, 0), Point(1, 1, 0), Point(1, 0, 0), Point(0, 1, 0)],
             "map.regions[2].polygon"),
        ]
        for path, value, *words in cases:
            with case(path=path, value=value):
                self.assert_refused(lambda: self.client.set_surface_map(changed(self.map, path, value)), *words)

    def test_refused_initial_states(self):
        good = initial_state((1, 2), (3, 4), (5, 6, 7))
        cases = [
            (("pose", "position", "x"), math.nan, "initial_state.position[0]", "nan"),
            (("pose", "position", "y"), 1e300, "initial_state.position[1]", "1e+300"),
            (("pose", "position", "z"), 0.1, "initial_state.position[2]", "0.1", "0.25"),
            (("pose", "orientation", "w"), 0.5, "initial_state.orientation", "[0, 0, 0, 0.5]"),
            (("twist", "linear", "x"), math.inf, "initial_state.velocity[0]", "inf"),
            (("twist", "linear", "z"), -1, "initial_state.velocity[2]", "-1"),
            (("twist", "angular", "z"), math.nan, "initial_state.angular_velocity[2]", "nan"),
        ]
        for path, value, *words in cases:
            with case(path=path, value=value):
                self.assert_refused(lambda: self.client.set_initial_state(changed(good, path, value)), *words)

    def test_an_initial_state_is_taken_as_it_is(self):
        request = initial_state((-4, -4), (-0.5, 0.25), (0, 0, 2), (0, 0, 1, 0))
        request.pose.position.z = 0.25
        stamp = self.client.start(request)
        state = self.client.states.wait_for_one(lambda m: m.header.stamp > stamp and m.twist.angular.z == 2)
        self.assertLess(state.time, 5)
        self.assertAlmostEqual(state.pose.position.x, -4 - 0.5 * state.time, delta=1e-14)
        self.assertAlmostEqual(state.pose.position.y, -4 + 0.25 * state.time, delta=1e-14)
        # Half a turn before, and a turn by 2 rad/s about the same axis.
        self.assertAlmostEqual(state.pose.orientation.z, math.cos(state.time), delta=1e-14)
        self.assertAlmostEqual(state.pose.orientation.w, -math.sin(state.time), delta=1e-14)


if __name__ == "__main__":
    rospy.init_node("services_test")
    rostest.rosrun("hybrid_sphere", "services_test", Services)
