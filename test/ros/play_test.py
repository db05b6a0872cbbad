#!/usr/bin/python3
"""The tools of rviz: 2D Pose Estimate, Publish Point and the handle that drags the sphere; what is refused."""
import math
import re
import unittest

import rosgraph
import rospy
import rostest
from geometry_msgs.msg import PointStamped, PoseWithCovarianceStamped
from hybrid_sphere.msg import ConstraintSwitch, SurfaceMap, SurfaceRegion
from rosgraph_msgs.msg import Log
from visualization_msgs.msg import InteractiveMarkerFeedback, InteractiveMarkerInit, InteractiveMarkerUpdate

from node_client import Client, Console, Listener, case, half_plane, initial_state, let_pass, made_of, surface, wait_for

KICK = 1.5  # m/s, of the node hybrid_sphere
KAPPA = 2 / 7  # of a solid sphere
HANDLE = "/hybrid_sphere/handle"


def pose(x=0.0, y=0.0, z=0.0, q=(0, 0, 0, 1), frame="world"):
    message = PoseWithCovarianceStamped()
    message.header.frame_id = frame
    p = message.pose.pose.position
    p.x, p.y, p.z = x, y, z
    o = message.pose.pose.orientation
    o.x, o.y, o.z, o.w = q
    return message


def point(x=0.0, y=0.0, z=0.0, frame="world"):
    message = PointStamped()
    message.header.frame_id = frame
    message.point.x, message.point.y, message.point.z = x, y, z
    return message


def drag(x, y, z=0.2500001, frame="world"):
    """As rviz sends it: the height is of single precision."""
    message = InteractiveMarkerFeedback(client_id="play_test", marker_name="sphere", control_name="move",
                                        event_type=InteractiveMarkerFeedback.POSE_UPDATE)
    message.header.frame_id = frame
    p = message.pose.position
    p.x, p.y, p.z = x, y, z
    message.pose.orientation.w = 1
    return message


def place(state):
    return state.pose.position.x, state.pose.position.y


def velocities(state):
    v, w = state.twist.linear, state.twist.angular
    return v.x, v.y, w.x, w.y, w.z


class Play(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = Client()
        cls.poses = cls.publisher("/initialpose", PoseWithCovarianceStamped)
        cls.points = cls.publisher("/clicked_point", PointStamped)

    @staticmethod
    def publisher(topic, kind):
        publisher = rospy.Publisher(topic, kind, queue_size=10)
        wait_for(publisher.get_num_connections, "the node on " + topic)
        return publisher

    def setUp(self):
        self.put_on(SurfaceRegion(law=SurfaceRegion.SMOOTH))

    def put_on(self, ground, **state):
        """What is later than `begin` comes after the new initial state."""
        self.client.pause(True)
        self.assertTrue(self.client.set_surface_map(surface(base=ground)).success)
        self.begin = self.client.step(1e-3).state.header.stamp
        self.assertTrue(self.client.set_initial_state(initial_state(**state)).success)
        self.client.pause(False)
        self.client.states.wait_for_one(lambda m: m.header.stamp > self.begin)

    def state_with(self, condition):
        return self.client.states.wait_for_one(lambda m: m.header.stamp > self.begin and condition(m))

    def assert_refused(self, publisher, cases):
        """Each is dropped with its words and counted; place and velocities stay."""
        console = Console("/hybrid_sphere")
        before = self.client.states.messages[-1]
        counts = []
        for message, words in cases:
            with case(words=words):
                said = len(console.said(Log.WARN))
                let_pass(1.1)  # one warning a second
                publisher.publish(message)
                warning = console.wait_for_next(Log.WARN, said)
                self.assertIn(words, warning)
                counts.append(int(re.search(r"message dropped \((\d+) so far\)", warning).group(1)))
        self.assertEqual(counts, list(range(counts[0], counts[0] + len(cases))))
        later = [m for m in list(self.client.states.messages) if m.header.stamp > before.header.stamp]
        self.assertEqual({(place(m), velocities(m)) for m in later} | {(place(before), velocities(before))},
                         {(place(before), velocities(before))})

    def test_a_pose_estimate_puts_the_sphere_there_at_rest(self):
        self.put_on(SurfaceRegion(law=SurfaceRegion.SMOOTH), velocity=(1, 0.5), omega=(1, 2, 3))
        turn = (0, 0, math.sin(0.3), math.cos(0.3))
        self.poses.publish(pose(3, -2, q=turn))
        state = self.state_with(lambda m: place(m) == (3, -2))
        self.assertEqual(velocities(state), (0, 0, 0, 0, 0))
        self.assertEqual(state.pose.position.z, self.client.sphere["radius"])
        q = state.pose.orientation
        for got, sent in zip((q.x, q.y, q.z, q.w), turn):
            self.assertAlmostEqual(got, sent, delta=1e-15)
        self.assertLess(state.time, 5)  # it has started again

    def test_a_pose_estimate_on_rough_ground_has_its_constraint_applied(self):
        self.put_on(SurfaceRegion(law=SurfaceRegion.ROUGH))
        self.poses.publish(pose(3, -2, frame=""))
        event = self.client.switches.wait_for_one(
            lambda m: m.header.stamp > self.begin and (m.position.x, m.position.y) == (3, -2))
        self.assertEqual((event.kind, event.cause, event.index),
                         (ConstraintSwitch.APPLIED, ConstraintSwitch.PLACED, 0))

    def test_bad_pose_estimates_are_dropped_and_counted(self):
        self.assert_refused(self.poses, [
            (pose(1, frame="map"), 'initialpose.header.frame_id: "map" is refused; allowed: "world"'),
            (pose(math.nan), "initial_state.position[0]: nan is refused"),
            (pose(0, 1e300), "initial_state.position[1]: 1e+300 is refused"),
            (pose(1, z=0.5), "initial_state.position[2]: 0.5 is refused"),
            (pose(1, q=(0, 0, 0, 0.5)), "initial_state.orientation"),
        ])

    def test_a_point_kicks_towards_itself(self):
        self.points.publish(point(3, 4, 0.7))
        state = self.state_with(lambda m: m.twist.linear.x != 0)
        self.assertAlmostEqual(state.twist.linear.x, 0.6 * KICK, delta=1e-15)
        self.assertAlmostEqual(state.twist.linear.y, 0.8 * KICK, delta=1e-15)
        self.assertEqual(velocities(state)[2:], (0, 0, 0))

    def test_a_sphere_that_rolls_goes_on_rolling_after_a_kick(self):
        self.put_on(SurfaceRegion(law=SurfaceRegion.ROUGH))
        self.client.switch_after(self.begin)
        self.points.publish(point(0, -2))
        state = self.state_with(lambda m: m.twist.linear.y != 0)
        speed = (1 - KAPPA) * KICK  # J/m R^2/(R^2 + k^2)
        self.assertAlmostEqual(state.twist.linear.y, -speed, delta=1e-15)
        self.assertAlmostEqual(state.twist.angular.x, speed / self.client.sphere["radius"], delta=1e-14)
        self.assertEqual(state.mode, "rolling")
        self.assertEqual([m.index for m in list(self.client.switches.messages) if m.header.stamp > self.begin], [0])

    def test_friction_lets_the_sphere_slip_after_a_kick(self):
        ice = made_of(SurfaceRegion(law=SurfaceRegion.COULOMB), friction=0.2)
        self.put_on(ice)
        self.client.switch_after(self.begin)
        self.points.publish(point(5, 0))
        released = self.client.switch_after(self.begin, 1)
        self.assertEqual((released.kind, released.cause), (ConstraintSwitch.RELEASED, ConstraintSwitch.KICKED))
        applied = self.client.switch_after(self.begin, 2)
        self.assertEqual(applied.cause, ConstraintSwitch.SLIP_ENDED)
        self.assertAlmostEqual(applied.time - released.time, KAPPA * KICK / (0.2 * 9.81), delta=1e-9)
        self.assertAlmostEqual(applied.twist_after.linear.x, (1 - KAPPA) * KICK, delta=1e-9)

    def test_a_kick_while_paused_is_shown_at_once(self):
        self.client.pause(True)
        last = self.client.step(0.125).state
        self.points.publish(point(-7, place(last)[1]))
        state = self.state_with(lambda m: m.twist.linear.x != 0)
        self.assertEqual((state.time, place(state)), (last.time, place(last)))
        self.assertGreater(state.header.stamp, last.header.stamp)
        self.assertEqual(state.twist.linear.x, -KICK)
        moved = self.client.step(0.5).state
        self.assertAlmostEqual(place(moved)[0], place(last)[0] - 0.5 * KICK, delta=1e-15)

    def test_bad_points_are_dropped_and_counted(self):
        self.assert_refused(self.points, [
            (point(1, frame="map"), 'clicked_point.header.frame_id: "map" is refused; allowed: "world"'),
            (point(math.nan), "clicked_point.point.x: nan is refused"),
            (point(0, math.inf), "clicked_point.point.y: inf is refused"),
            (point(1, z=math.nan), "clicked_point.point.z: nan is refused"),
            (point(0, 0), "clicked_point.point: [0, 0] is refused; allowed: a point other than the centre"),
        ])

    def test_where_the_computation_has_halted_a_kick_is_dropped_and_a_pose_starts_anew(self):
        belts = [made_of(half_plane("left", normal=(-1, 0)), belt=(1, 0)),
                 made_of(half_plane("right"), belt=(-1, 0))]
        self.assertTrue(self.client.set_surface_map(surface(*belts, livelock=SurfaceMap.STOP)).success)
        self.state_with(lambda m: m.mode == "rolling")
        self.assert_refused(self.points, [(point(1), "halted at t = ")])
        self.poses.publish(pose(-3, 1))
        moving = self.state_with(lambda m: m.pose.position.y == 1 and m.time > 0.1)
        self.assertEqual((moving.region, moving.mode), ("left", "rolling"))

    def test_each_node_listens_in_its_own_namespace(self):
        other = Client("/other/hybrid_sphere")
        stamp = other.start(initial_state((-5, 0)))
        mine = place(self.client.state())
        poses = self.publisher("/other/initialpose", PoseWithCovarianceStamped)
        poses.publish(pose(-6, 1))
        other.states.wait_for_one(lambda m: m.header.stamp > stamp and place(m) == (-6, 1))
        self.assertEqual(place(self.client.state()), mine)
        listened_to = [topic for topic, _ in rosgraph.Master("/play_test").getSystemState()[1]]
        self.assertIn("/other/initialpose", listened_to)
        self.assertNotIn("/other/clicked_point", listened_to)  # its ~kick is 0

    def start_dragging(self):
        """While paused: listeners to the handle, which is there."""
        self.client.pause(True)
        self.updates = Listener(HANDLE + "/update", InteractiveMarkerUpdate)
        handles = Listener(HANDLE + "/update_full", InteractiveMarkerInit)
        handle = handles.wait_for_one(lambda m: m.markers).markers[0]
        self.assertEqual((handle.name, handle.header.frame_id), ("sphere", "world"))
        handles.stop()
        return handle, self.publisher(HANDLE + "/feedback", InteractiveMarkerFeedback)

    def test_the_handle_drags_the_sphere_while_paused(self):
        self.put_on(SurfaceRegion(law=SurfaceRegion.SMOOTH), velocity=(1, 0), omega=(0, 0, 3))
        handle, feedback = self.start_dragging()
        before = self.client.step(0.25).state
        self.assertLess(math.hypot(handle.pose.position.x, handle.pose.position.y), 100)
        feedback.publish(drag(2, -3))
        state = self.state_with(lambda m: place(m) == (2, -3))
        self.assertEqual(velocities(state), (0, 0, 0, 0, 0))
        for axis in "xyzw":  # made a unit quaternion anew: a few roundings
            self.assertAlmostEqual(getattr(state.pose.orientation, axis), getattr(before.pose.orientation, axis), delta=1e-15)
        self.assertEqual(state.time, 0)
        self.assertGreater(state.header.stamp, before.header.stamp)
        self.client.pause(False)
        feedback.publish(drag(7, 7))  # too late
        self.updates.wait_for_one(lambda m: "sphere" in m.erases)
        later = [self.client.state() for _ in range(20)]
        self.assertEqual({place(m) for m in later}, {(2, -3)})

    def test_the_handle_follows_the_sphere(self):
        self.start_dragging()
        self.poses.publish(pose(4, 5))
        self.updates.wait_for_one(
            lambda m: any((p.pose.position.x, p.pose.position.y) == (4, 5) for p in m.poses))

    def test_a_drag_that_is_refused_is_counted_and_the_handle_goes_back(self):
        _, feedback = self.start_dragging()
        here = place(self.client.step(1e-3).state)
        self.updates.messages.clear()
        self.assert_refused(feedback, [
            (drag(math.nan, 0), "initial_state.position[0]: nan is refused"),
            (drag(1, 1, frame="map"), 'handle.header.frame_id: "map" is refused; allowed: "world"'),
        ])
        self.updates.wait_for_one(
            lambda m: any((p.pose.position.x, p.pose.position.y) == here for p in m.poses))


if __name__ == "__main__":
    rospy.init_node("play_test")
    rostest.rosrun("hybrid_sphere", "play_test", Play)
