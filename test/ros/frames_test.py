#!/usr/bin/python3
"""What is given in another frame does what it does in the world frame, to rounding; frames without a transform are refused."""
import math
import unittest

import numpy as np
import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import PointStamped, PoseWithCovarianceStamped, Vector3, WrenchStamped
from hybrid_sphere.msg import SceneView
from hybrid_sphere.srv import GetState, Kick, SetInitialState
from nav_msgs.msg import OccupancyGrid
from rosgraph_msgs.msg import Log
from std_msgs.msg import Header

from node_client import Client, Console, Listener, case, circle, half_plane, initial_state, made_of, polygon, surface, wait_for

NODE = "/hybrid_sphere"
MASS = 2.0
ROUNDING = 1e-14  # of a turn of numbers below 10


class Frame:
    """A frame on the ground: angle about z, and origin, in the world frame."""

    def __init__(self, name, x, y, angle):
        self.name = name
        self.angle = angle
        self.origin = np.array([x, y])
        c, s = math.cos(angle), math.sin(angle)
        self.axes = np.array([[c, -s], [s, c]])

    def point(self, world):
        """Coordinates in this frame of a place in the world."""
        return self.axes.T @ (np.array(world) - self.origin)

    def direction(self, world):
        return self.axes.T @ np.array(world)


def inverse(name, x, y, angle):
    """A frame above the world: the world lies at x, y in it, turned by an angle."""
    c, s = math.cos(angle), math.sin(angle)
    return Frame(name, *(-np.array([[c, s], [-s, c]]) @ np.array([x, y])), -angle)


FRAMES = [Frame("shifted", 3, -2, 0), Frame("turned", 3, -2, 0.7), inverse("odom", -1, 4, 1.9)]


class AnyFrame(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = Client(NODE)
        cls.console = Console(NODE)

    def setUp(self):
        self.assertTrue(self.client.set_surface_map(surface()).success)
        self.client.start(initial_state())

    def publish(self, topic, message):
        publisher = rospy.Publisher(topic, type(message), queue_size=1)
        wait_for(publisher.get_num_connections, "the node on " + topic)
        publisher.publish(message)
        return publisher

    def test_a_wrench_acts_along_the_axes_of_its_frame(self):
        for frame in FRAMES:
            with case(frame=frame.name):
                self.client.start(initial_state())
                message = WrenchStamped()
                message.header.frame_id = frame.name
                message.wrench.force = Vector3(*frame.direction((2, -1)), 0)
                message.wrench.torque = Vector3(*frame.direction((0.02, 0.01)), -0.04)
                publisher = self.publish(NODE + "/cmd_wrench", message)
                self.client.pause(True)  # answers when the wrench is taken, also if its transform is waited for
                twist = self.client.step(1).state.twist
                self.assertAlmostEqual(twist.linear.x, 2 / MASS, delta=ROUNDING)
                inertia = MASS * 0.4 * 0.25**2
                self.assertAlmostEqual(twist.linear.y / twist.linear.x, -0.5, delta=ROUNDING)
                self.assertAlmostEqual(twist.angular.x / twist.linear.x, 0.02 / inertia / (2 / MASS), delta=10 * ROUNDING)
                self.assertAlmostEqual(twist.angular.y / twist.angular.x, 0.5, delta=ROUNDING)
                self.assertAlmostEqual(twist.angular.z / twist.angular.x, -2, delta=ROUNDING)
                publisher.unregister()

    def test_a_wrench_out_of_the_plane_is_dropped(self):
        message = WrenchStamped()
        message.header.frame_id = "tilted"
        message.wrench.force.x = 1
        self.expect_a_warning("/cmd_wrench", message, "cmd_wrench.force[2]")

    def test_a_pose_estimate_puts_the_sphere_at_the_same_place(self):
        for frame in FRAMES:
            with case(frame=frame.name):
                self.client.start(initial_state())
                message = PoseWithCovarianceStamped()
                message.header.frame_id = frame.name
                message.pose.pose.position.x, message.pose.pose.position.y = frame.point((1.25, 0.5))
                message.pose.pose.orientation.z = math.sin(0.5 * (0.3 - frame.angle))
                message.pose.pose.orientation.w = math.cos(0.5 * (0.3 - frame.angle))
                publisher = self.publish("/initialpose", message)
                pose = wait_for(lambda: (p := self.client.present().pose).position.x != 0 and p, "the sphere there")
                self.assertAlmostEqual(pose.position.x, 1.25, delta=ROUNDING)
                self.assertAlmostEqual(pose.position.y, 0.5, delta=ROUNDING)
                self.assertAlmostEqual(abs(pose.orientation.z), math.sin(0.15), delta=ROUNDING)
                publisher.unregister()

    def test_a_clicked_point_kicks_towards_the_same_place(self):
        for frame in FRAMES:
            with case(frame=frame.name):
                self.client.start(initial_state())
                message = PointStamped()
                message.header.frame_id = frame.name
                message.point.x, message.point.y = frame.point((3, 4))
                publisher = self.publish("/clicked_point", message)
                twist = wait_for(lambda: (t := self.client.present().twist).linear.x != 0 and t, "the kick")
                self.assertAlmostEqual(twist.linear.x, 0.6, delta=ROUNDING)
                self.assertAlmostEqual(twist.linear.y, 0.8, delta=ROUNDING)
                publisher.unregister()

    def state_in(self, frame, position, velocity, omega):
        """A request with a state of the world, in a frame."""
        request = initial_state(frame.point(position), frame.direction(velocity), (*frame.direction(omega[:2]), omega[2]),
                                (0, 0, math.sin(0.5 * (0.3 - frame.angle)), math.cos(0.5 * (0.3 - frame.angle))))
        request.header.frame_id = frame.name
        return request

    def test_an_initial_state_and_a_state_are_taken_in_any_frame(self):
        for service in ("set_initial_state", "set_state"):
            put = self.client.service(service, SetInitialState)
            for frame in FRAMES:
                with case(service=service, frame=frame.name), self.client.standing():
                    answer = put(self.state_in(frame, (1.25, 0.5), (2, -1), (0.5, 3, 4)))
                    self.assertTrue(answer.success, answer.message)
                    state = self.client.service("get_state", GetState)().state
                    pose, twist = state.pose, state.twist
                    np.testing.assert_allclose((pose.position.x, pose.position.y), (1.25, 0.5), atol=ROUNDING)
                    self.assertAlmostEqual(abs(pose.orientation.z), math.sin(0.15), delta=ROUNDING)
                    np.testing.assert_allclose((twist.linear.x, twist.linear.y), (2, -1), atol=ROUNDING)
                    w = twist.angular
                    np.testing.assert_allclose((w.x, w.y, w.z), (0.5, 3, 4), atol=ROUNDING)

    def test_a_kick_is_taken_in_any_frame(self):
        kick = self.client.service("kick", Kick)
        for frame in FRAMES:
            with case(frame=frame.name):
                self.client.start(initial_state())
                answer = kick(header=Header(frame_id=frame.name), impulse=Vector3(*frame.direction((3, 4)), 0))
                self.assertTrue(answer.success, answer.message)
                twist = self.client.present().twist
                np.testing.assert_allclose((twist.linear.x, twist.linear.y), (3 / MASS, 4 / MASS), atol=ROUNDING)

    def test_a_request_in_a_frame_without_a_transform_is_refused_and_time_goes_on_meanwhile(self):
        kick = self.client.service("kick", Kick)
        put = self.client.service("set_state", SetInitialState)
        self.client.start(initial_state(velocity=(1, 0)))
        self.client.pause(False)
        begin = self.client.present().time
        header = Header(frame_id="nowhere")
        words = 'header.frame_id: "nowhere" is refused; allowed: "world", empty, or a frame that tf2 connects with it'
        answer = kick(header=header, impulse=Vector3(1, 0, 0))
        self.assertEqual((answer.success, answer.message), (False, words))
        answer = put(header=header)
        self.assertEqual((answer.success, answer.message), (False, words))
        state = self.client.present()
        self.client.pause(True)
        self.assertGreater(state.time - begin, 1, "the loop has not waited")
        self.assertEqual(state.twist.linear.x, 1)
        header.frame_id = "tilted"
        self.assertIn("impulse.z: ", kick(header=header, impulse=Vector3(1, 0, 0)).message)

    def test_a_map_lies_where_its_frame_lies(self):
        def map_in(frame):
            there = frame.point if frame else np.array
            way = frame.direction if frame else np.array
            regions = [half_plane("edge", there((1, 2)), way((1, 0.5))),
                       made_of(circle("disc", there((-1, 1)), 0.5), turntable=(0.5, tuple(there((-1, 1.5))))),
                       made_of(polygon("box", [there(p) for p in ((0, 0), (2, 0), (2, 1))]), belt=tuple(way((0.25, -0.5))))]
            request = surface(*regions)
            request.header.frame_id = frame.name if frame else ""
            return request

        def numbers(regions):
            return [[*((p.x, p.y) for p in r.points), (r.normal.x, r.normal.y), (r.belt.x, r.belt.y),
                     (r.turntable_center.x, r.turntable_center.y)] for r in regions]

        self.assertTrue(self.client.set_surface_map(map_in(None)).success)
        expected = numbers(self.client.get_surface_map().map.regions)
        for frame in FRAMES:
            with case(frame=frame.name):
                answer = self.client.set_surface_map(map_in(frame))
                self.assertTrue(answer.success, answer.message)
                got = self.client.get_surface_map().map
                self.assertEqual(got.header.frame_id, "world")
                for mine, theirs in zip(numbers(got.regions), expected):
                    np.testing.assert_allclose(mine, theirs, atol=10 * ROUNDING)

    def test_a_grid_lies_where_its_frame_and_its_origin_lie(self):
        for frame in FRAMES:
            with case(frame=frame.name):
                self.assertTrue(self.client.set_surface_map(surface()).success)
                grid = OccupancyGrid()
                grid.header.frame_id = frame.name
                grid.info.width, grid.info.height, grid.info.resolution = 2, 1, 0.5
                grid.info.origin.position.x, grid.info.origin.position.y = frame.point((1, 1))
                grid.info.origin.orientation.z = math.sin(0.25 * math.pi - 0.5 * frame.angle)
                grid.info.origin.orientation.w = math.cos(0.25 * math.pi - 0.5 * frame.angle)
                grid.data = [100, 100]
                publisher = self.publish(NODE + "/surface_grid", grid)
                regions = wait_for(lambda: self.client.get_surface_map().map.regions, "the grid")
                corners = sorted((round(p.x, 12), round(p.y, 12)) for p in regions[0].points)
                self.assertEqual(corners, [(0.5, 1), (0.5, 2), (1, 1), (1, 2)], "a quarter turn to the left")
                publisher.unregister()

    def test_a_frame_without_a_transform_is_refused_with_both_names(self):
        request = surface()
        for name in ("beach", "nowhere"):  # in another tree, and in none
            with case(frame=name):
                request.header.frame_id = name
                answer = self.client.set_surface_map(request)
                self.assertFalse(answer.success)
                self.assertEqual(answer.message, 'map.header.frame_id: "%s" is refused; allowed: "world", empty, or a frame '
                                                 'that tf2 connects with it' % name)
        request.header.frame_id = "tilted"
        self.assertIn("vertical z axis", self.client.set_surface_map(request).message)
        message = PointStamped()
        message.header.frame_id = "nowhere"
        self.expect_a_warning("/clicked_point", message, 'clicked_point.header.frame_id: "nowhere"')

    def expect_a_warning(self, topic, message, words):
        publisher = self.publish(NODE + topic if topic == "/cmd_wrench" else topic, message)
        wait_for(lambda: [w for w in self.console.said(Log.WARN) if words in w], "a warning of " + words)
        publisher.unregister()

    def test_the_frame_of_the_view_has_the_sphere_in_its_dead_zone_and_does_not_turn(self):
        view = Listener(NODE + "/view", SceneView)
        distance = view.wait()[0].distance
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)
        self.client.start(initial_state(position=(1, 2), velocity=(5, 3), omega=(1, 2, 3)))
        places = []
        for _ in range(20):
            state = self.client.step(0.5).state

            def there():
                try:
                    return buffer.lookup_transform("hybrid_sphere_view", "sphere_contact", state.header.stamp).transform
                except tf2_ros.TransformException:
                    return None

            transform = wait_for(there, "the frame of the view")
            offset = transform.translation
            self.assertLessEqual(abs(offset.x), 0.34 * distance * (1 + 1e-9))
            self.assertLessEqual(abs(offset.y), 0.26 * distance * (1 + 1e-9))
            self.assertEqual((offset.z, transform.rotation.w), (0, 1))
            places.append(state.pose.position.x - offset.x)
        self.assertGreater(places[-1] - places[0], 20, "it follows")
        view.stop()
        listener.unregister()

    def test_the_frame_at_the_contact_goes_with_the_sphere_and_does_not_turn(self):
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)
        self.client.start(initial_state(position=(1, 2), velocity=(0.5, 0), omega=(1, 2, 3)))
        state = self.client.step(0.5).state

        def there():
            try:
                found = buffer.lookup_transform("world", "sphere_contact", state.header.stamp).transform
            except tf2_ros.TransformException:
                return None
            return found

        transform = wait_for(there, "the frame at the contact")
        self.assertEqual((transform.translation.x, transform.translation.y, transform.translation.z), (1.25, 2, 0))
        q = transform.rotation
        self.assertEqual((q.x, q.y, q.z, q.w), (0, 0, 0, 1))
        listener.unregister()


if __name__ == "__main__":
    rospy.init_node("frames_test")
    rostest.rosrun("hybrid_sphere", "frames_test", AnyFrame)
