#!/usr/bin/python3
"""~cmd_wrench: what it does to the sphere, when it is dropped, what is refused; the example controller."""
import math
import re
import signal
import subprocess
import unittest

import rospy
import rostest
from geometry_msgs.msg import Vector3, WrenchStamped
from hybrid_sphere.msg import SimulatorStatus, SphereState
from rosgraph_msgs.msg import Log

from node_client import PATIENCE, Client, Console, Listener, case, half_plane, initial_state, let_pass, program, surface, wait_for

MASS = 2.0
TIMEOUT = 0.4  # s, of the node hybrid_sphere; the node holding has none


def wrench(force=(0, 0, 0), torque=(0, 0, 0), frame="world"):
    message = WrenchStamped()
    message.header.frame_id = frame
    message.wrench.force = Vector3(*force)
    message.wrench.torque = Vector3(*torque)
    return message


class Command(unittest.TestCase):
    def use(self, node):
        """A client of a node whose sphere rests on smooth ground, and a publisher of commands to it."""
        self.client = Client(node)
        self.assertTrue(self.client.set_surface_map(surface()).success)
        self.begin = self.client.start(initial_state())
        self.publisher = rospy.Publisher(node + "/cmd_wrench", WrenchStamped, queue_size=10)
        wait_for(self.publisher.get_num_connections, "the node on cmd_wrench")

    def tearDown(self):
        self.publisher.unregister()

    def state_after(self, stamp, condition):
        return self.client.states.wait_for_one(lambda m: m.header.stamp > stamp and condition(m))

    def test_a_force_accelerates_the_centre_and_a_torque_the_spin(self):
        self.use("/hybrid_sphere")
        self.publisher.publish(wrench((2, -1, 0), (0.02, 0, -0.04)))
        inertia = MASS * 0.4 * 0.25**2

        def states_under_the_force():
            states = [m for m in list(self.client.states.messages) if m.header.stamp > self.begin and m.twist.linear.x > 0]
            return states[:10] if len(states) >= 10 else None

        moving = wait_for(states_under_the_force, "ten states under the force")
        a, b = moving[0], moving[-1]
        dt = b.time - a.time
        # Ten roundings of speeds below 1 m/s and 2 rad/s.
        self.assertAlmostEqual(b.twist.linear.x - a.twist.linear.x, 2 / MASS * dt, delta=1e-14)
        self.assertAlmostEqual(b.twist.linear.y - a.twist.linear.y, -1 / MASS * dt, delta=1e-14)
        self.assertAlmostEqual(b.twist.angular.x - a.twist.angular.x, 0.02 / inertia * dt, delta=1e-14)
        self.assertAlmostEqual(b.twist.angular.z - a.twist.angular.z, -0.04 / inertia * dt, delta=1e-14)

    def test_a_command_is_dropped_after_the_timeout(self):
        self.use("/hybrid_sphere")
        self.publisher.publish(wrench((2, 0, 0), frame=""))

        def speed_stands():
            speeds = [m.twist.linear.x for m in list(self.client.states.messages) if m.header.stamp > self.begin][-40:]
            return len(speeds) == 40 and speeds[-1] > 0 and len(set(speeds)) == 1

        wait_for(speed_stands, "the force to end")
        acted = self.client.states.messages[-1].twist.linear.x * MASS / 2
        self.assertLess(acted, TIMEOUT + 1.0)

    def test_a_command_acts_for_a_tick_that_is_longer_than_the_timeout(self):
        """A controller that answers each state with one command; each tick of 0.2 s then adds 0.2 m/s."""
        self.use("/slow")
        controller = rospy.Subscriber("/slow/state", SphereState, lambda _: self.publisher.publish(wrench((MASS, 0, 0))))
        status = Listener("/slow/status", SimulatorStatus)

        def gains():
            speeds = [m.twist.linear.x for m in list(self.client.states.messages) if m.header.stamp > self.begin][-5:]
            return [b - a for a, b in zip(speeds, speeds[1:])]

        # A busy machine leaves out a tick now and then.
        wait_for(lambda: len(gains()) == 4 and max(abs(gain - 0.2) for gain in gains()) < 1e-12, "each command to act")
        before = status.wait()[-1].dropped_inputs
        controller.unregister()
        wait_for(lambda: set(gains()) == {0}, "the last command to be dropped")
        self.assertEqual(status.wait_for_one(lambda m: m.dropped_inputs > before).dropped_inputs, before + 1)
        status.stop()

    def test_a_command_does_not_age_while_time_stands(self):
        self.use("/hybrid_sphere")
        self.client.pause(True)
        self.publisher.publish(wrench((MASS, 0, 0)))
        let_pass(TIMEOUT + 0.3)  # of a controller that thinks
        self.client.pause(True)
        begin = self.client.present()
        end = self.client.step(0.25).state
        self.client.pause(False)
        self.assertAlmostEqual(end.twist.linear.x - begin.twist.linear.x, 0.25, delta=1e-12)

    def test_without_a_timeout_a_command_is_held_until_the_reset(self):
        self.use("/holding")
        self.publisher.publish(wrench((2, 0, 0)))
        # Longer than the default of the timeout.
        self.state_after(self.begin, lambda m: m.twist.linear.x > 2 / MASS * 1.5)
        with self.client.standing() as reset:
            self.assertTrue(self.client.reset().success)
        self.state_after(reset, lambda m: m.time > 0.3)
        self.assertEqual({m.twist.linear.x for m in list(self.client.states.messages) if m.header.stamp > reset}, {0})

    def test_bad_commands_are_dropped_and_counted(self):
        self.use("/hybrid_sphere")
        console = Console("/hybrid_sphere")
        cases = [
            (wrench((math.nan, 0, 0)), "cmd_wrench.force[0]: nan is refused"),
            (wrench((0, math.inf, 0)), "cmd_wrench.force[1]: inf is refused"),
            (wrench((1, 0, 1)), "cmd_wrench.force[2]: 1 is refused; allowed: 0"),
            (wrench((1e300, 0, 0)), "cmd_wrench.force[0]: 1e+300 is refused"),
            (wrench(torque=(0, 0, math.nan)), "cmd_wrench.torque[2]: nan is refused"),
            (wrench((1, 0, 0), frame="odom"), 'cmd_wrench.header.frame_id: "odom" is refused'),
        ]
        counts = []
        for message, words in cases:
            with case(words=words):
                said = len(console.said(Log.WARN))
                let_pass(1.1)  # one warning a second
                self.publisher.publish(message)
                warning = console.wait_for_next(Log.WARN, said)
                self.assertIn(words, warning)
                counts.append(int(re.search(r"message dropped \((\d+) so far\)", warning).group(1)))
        self.assertEqual(counts, list(range(counts[0], counts[0] + len(cases))))
        states = [m for m in list(self.client.states.messages) if m.header.stamp > self.begin]
        self.assertEqual({(m.twist.linear.x, m.twist.linear.y, m.twist.angular.z) for m in states}, {(0, 0, 0)})

    def test_the_example_steers_to_its_target(self):
        self.use("/hybrid_sphere")
        self.assertTrue(self.client.set_surface_map(surface(half_plane("rough_half"))).success)
        begin = self.client.start(initial_state((-2, 0.5)))
        controller = subprocess.Popen([program("steer_to_target"), "_x:=1.0", "_y:=-0.5"])
        try:
            self.state_after(begin, lambda m: math.hypot(m.pose.position.x - 1, m.pose.position.y + 0.5) < 0.02 and
                             math.hypot(m.twist.linear.x, m.twist.linear.y) < 0.02)
        finally:
            controller.send_signal(signal.SIGINT)
            self.assertEqual(controller.wait(PATIENCE), 0)
        self.assertEqual(self.client.switch_after(begin).to_region, "rough_half")


if __name__ == "__main__":
    rospy.init_node("command_test")
    rostest.rosrun("hybrid_sphere", "command_test", Command)
