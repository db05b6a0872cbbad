#!/usr/bin/python3
"""Topics of the node: types, frames, stamps, rate, latching, listeners that come and go."""
import math
import unittest

import rosgraph
import rospy
import rostest
from geometry_msgs.msg import PoseStamped, TwistStamped
from hybrid_sphere.msg import ConstraintSwitch, SphereState, SurfaceMap
from nav_msgs.msg import Odometry
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

from node_client import Client, Listener, initial_state, wait_for

NODE = "/hybrid_sphere"
RADIUS = 0.25
RATE = 200.0


def rotated(q, v):
    """The vector v turned by the quaternion q."""
    u = (q.x, q.y, q.z)
    cross = lambda a, b: (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
    t = tuple(2 * c for c in cross(u, v))
    return tuple(v[i] + q.w * t[i] + cross(u, t)[i] for i in range(3))


def xyz(v):
    return (v.x, v.y, v.z)


class Topics(unittest.TestCase):
    def together(self, **classes):
        """Messages of several topics that have one stamp."""
        listeners = {name: Listener(name if name.startswith("/") else NODE + "/" + name, message_class)
                     for name, message_class in classes.items()}
        stamp_of = lambda m: m.transforms[0].header.stamp if isinstance(m, TFMessage) else m.header.stamp

        def find():
            by_stamp = {n: {stamp_of(m): m for m in list(l.messages)} for n, l in listeners.items()}
            common = set.intersection(*(set(each) for each in by_stamp.values()))
            return common and {n: each[max(common)] for n, each in by_stamp.items()}

        found = wait_for(find, "messages of one stamp")
        for listener in listeners.values():
            listener.stop()
        return found

    def test_types_are_those_of_the_contract(self):
        wanted = {"pose": "geometry_msgs/PoseStamped", "twist": "geometry_msgs/TwistStamped",
                  "odom": "nav_msgs/Odometry", "state": "hybrid_sphere/SphereState",
                  "constraint_switch": "hybrid_sphere/ConstraintSwitch", "surface_map": "hybrid_sphere/SurfaceMap",
                  "surface_markers": "visualization_msgs/MarkerArray", "markers": "visualization_msgs/MarkerArray"}
        Client()
        published = dict(rosgraph.Master("/test").getTopicTypes())
        for name, message_type in wanted.items():
            self.assertEqual(published.get(NODE + "/" + name), message_type)
        self.assertEqual(published.get("/tf"), "tf2_msgs/TFMessage")

    def test_frames_and_heights(self):
        m = self.together(pose=PoseStamped, twist=TwistStamped, odom=Odometry, state=SphereState, **{"/tf": TFMessage})
        transform = m["/tf"].transforms[0]
        for name in ("pose", "twist", "odom", "state"):
            self.assertEqual(m[name].header.frame_id, "ground")
        self.assertEqual(transform.header.frame_id, "ground")
        self.assertEqual((transform.child_frame_id, m["odom"].child_frame_id), ("ball", "ball"))
        self.assertEqual(m["pose"].pose, m["state"].pose)
        self.assertEqual(m["pose"].pose, m["odom"].pose.pose)
        self.assertEqual(m["twist"].twist, m["state"].twist)
        self.assertEqual(xyz(transform.transform.translation), xyz(m["pose"].pose.position))
        self.assertEqual(transform.transform.rotation, m["pose"].pose.orientation)
        self.assertEqual(m["pose"].pose.position.z, RADIUS)

    def test_twist_of_odom_is_in_the_child_frame(self):
        m = self.together(odom=Odometry, state=SphereState)
        q = m["state"].pose.orientation
        for part in ("linear", "angular"):
            child = getattr(m["odom"].twist.twist, part)
            world = getattr(m["state"].twist, part)
            self.assertNotEqual(xyz(world), (0, 0, 0))
            for turned, wanted in zip(rotated(q, xyz(child)), xyz(world)):
                # A rotation is some twenty roundings of numbers of the size of |w| < 5.
                self.assertAlmostEqual(turned, wanted, delta=20 * 5 * 2.3e-16)

    def test_state_is_consistent(self):
        client = Client()
        client.start(initial_state((-5, 0), (1, -0.5), (2, 1, 3)))
        state = client.state()
        self.assertEqual((state.stage, state.mode, state.region), (SphereState.HOLONOMIC, "free", "base"))
        self.assertEqual(xyz(state.slip), (1 - RADIUS * 1, -0.5 + RADIUS * 2, 0))
        self.assertEqual(xyz(state.reaction), (0, 0, 2.0 * 9.81))
        self.assertAlmostEqual(state.kinetic_energy, 0.5 * 2 * 1.25 + 0.5 * 2 * 0.4 * RADIUS**2 * 14, delta=1e-14)
        self.assertAlmostEqual(math.sqrt(sum(c * c for c in (state.pose.orientation.x, state.pose.orientation.y,
                                                             state.pose.orientation.z, state.pose.orientation.w))),
                               1, delta=1e-15)

    def test_times_are_ticks_and_stamps_keep_pace_with_them(self):
        client = Client()
        begin = client.state()
        end = client.states.wait_for_one(lambda m: m.header.stamp.to_sec() > begin.header.stamp.to_sec() + 2)
        for state in list(client.states.messages):
            self.assertEqual(state.time, round(state.time * RATE) / RATE)
        self.assertAlmostEqual((end.header.stamp - begin.header.stamp).to_sec(), end.time - begin.time, delta=3e-9)

    def test_tf_repeats_no_stamp_even_across_resets(self):
        client = Client()
        tf = Listener("/tf", TFMessage)
        for _ in range(4):
            tf.wait(len(tf.messages) + 20)
            client.reset()
        stamps = [t.header.stamp for m in tf.wait(len(tf.messages) + 20) for t in m.transforms if t.child_frame_id == "sphere"]
        self.assertTrue(all(a < b for a, b in zip(stamps, stamps[1:])))

    def test_late_listeners_get_what_is_latched(self):
        client = Client()
        begin = client.start(initial_state((-0.05, 0), (1, 0)))
        event = client.switch_after(begin)
        late = {name: Listener(NODE + "/" + name, message_class) for name, message_class in
                [("constraint_switch", ConstraintSwitch), ("surface_map", SurfaceMap), ("surface_markers", MarkerArray)]}
        self.assertEqual(late["constraint_switch"].wait()[0], event)
        self.assertEqual(late["surface_map"].wait()[0].regions[0].name, "rough_half")
        texts = [m.text for m in late["surface_markers"].wait()[0].markers if m.type == Marker.TEXT_VIEW_FACING]
        self.assertEqual(sorted(texts), ["base: smooth", "rough_half: rough"])

    def test_markers_show_sphere_trail_and_impulse(self):
        client = Client()
        client.switch_after(client.start(initial_state((-0.05, 0), (1, 0))))
        listener = Listener(NODE + "/markers", MarkerArray)
        listener.wait(3)
        markers = [m for array in listener.messages for m in array.markers]
        self.assertEqual({"sphere", "trail", "slip", "impulses", "impulse_sizes"}, {m.ns for m in markers})
        self.assertEqual({m.action for m in markers if m.ns == "slip"}, {Marker.DELETE})  # it rolls
        ball = [m for m in markers if m.ns == "sphere"]
        self.assertTrue(all(m.frame_locked and m.header.frame_id == "ball" for m in ball))
        # Of the solid sphere of 2 kg that slips with 1 m/s: m kappa = 4/7 kg.
        self.assertIn("|P| = 0.571 N s", [m.text for m in markers])
        count = len(listener.messages)
        client.reset()
        wait_for(lambda: [m for a in list(listener.messages)[count:] for m in a.markers
                          if (m.ns, m.action) == ("impulses", Marker.DELETE)], "the end of the impulses")

    def test_listeners_come_and_go(self):
        client = Client()
        for _ in range(5):
            listeners = [Listener(NODE + "/pose", PoseStamped), Listener("/tf", TFMessage),
                         Listener(NODE + "/markers", MarkerArray)]
            for listener in listeners:
                listener.wait()
                listener.stop()
        last = client.state()
        self.assertGreater(client.state().time, last.time)


if __name__ == "__main__":
    rospy.init_node("topics_test")
    rostest.rosrun("hybrid_sphere", "topics_test", Topics)
