#!/usr/bin/python3
"""Whatever the node computes it answers, says that it is behind and why, its clock goes on, and it can be ended."""
import contextlib
import signal
import subprocess
import tempfile
import threading
import unittest

import rospy
import rostest
import std_srvs.srv
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseWithCovarianceStamped, WrenchStamped
from hybrid_sphere.msg import ConstraintSwitch, SimulatorStatus
from hybrid_sphere.srv import GetSurfaceMap, SetInitialState, Step
from rosgraph_msgs.msg import Clock

from node_client import PATIENCE, Client, Listener, initial_state, program, simulate, wait_for

NODE = "/hybrid_sphere"
ENDLESS = initial_state((100.05, 0), (1, 0), (0, 0, 0))
SLOW = initial_state((200.05, 0), (1, 0), (0, 0, 0))
USUAL = initial_state((0, 0), (1, 0), (0, 0, 1))


@contextlib.contextmanager
def other_node(**parameters):
    """A second node, with a sphere and these parameters."""
    rospy.set_param("/other", {"sphere": {"mass": 1.0, "radius": 0.1, "body": "solid"}, **parameters})
    node = subprocess.Popen([program("hybrid_sphere_node"), "__name:=other"], stdout=subprocess.DEVNULL)
    try:
        rospy.wait_for_service("/other/step", PATIENCE)
        yield node
    finally:
        node.kill()
        node.wait()
        rospy.delete_param("/other")


class Busy(unittest.TestCase):
    def setUp(self):
        self.client = Client(NODE)
        self.client.pause(False)
        self.status = Listener(NODE + "/status", SimulatorStatus)

    def tearDown(self):
        self.client.set_initial_state(USUAL)
        self.status.stop()

    def begin_endless(self):
        """The stamp of a state after which nothing but the endless computation is under way."""
        self.assertTrue(self.client.set_initial_state(ENDLESS).success)
        self.wait_for_behind()
        return self.client.states.messages[-1].header.stamp

    def wait_for_behind(self):
        count = len(self.status.messages)
        return wait_for(lambda: [m for m in self.status.messages[count:] if m.behind > 0.5], "a node that is behind")[0]

    def persistent(self, name, service_class):
        return rospy.ServiceProxy(NODE + "/" + name, service_class, persistent=True)

    def test_services_answer_before_the_computation_ends(self):
        self.begin_endless()
        calls = {"step": (Step, [0.01]), "get_surface_map": (GetSurfaceMap, []), "pause": (std_srvs.srv.SetBool, [False]),
                 "reset": (std_srvs.srv.Trigger, []), "set_initial_state": (SetInitialState, [ENDLESS])}
        for name, (service_class, arguments) in calls.items():
            service = self.persistent(name, service_class)
            for _ in range(20):
                service(*arguments)
            self.assertLess(self.client.state().time, 0.01, name)  # the first tick
            service.close()

    def test_the_status_and_the_diagnostics_say_that_it_is_behind_and_why(self):
        diagnostics = Listener("/diagnostics", DiagnosticArray)
        self.begin_endless()
        status = self.wait_for_behind()
        self.assertIn("behind: t = ", status.message)
        self.assertRegex(status.message, r"turns at [1-9][.0-9]*e\+1[01] rad/s")
        self.assertLess(status.real_time_factor, 0.1)
        late = status.late_ticks
        self.status.wait_for_one(lambda m: m.late_ticks > late)

        def warnings():
            return [s for m in list(diagnostics.messages) for s in m.status
                    if s.level == DiagnosticStatus.WARN and s.message.startswith("behind: t = ")]

        wait_for(warnings, "the diagnostics")
        diagnostics.stop()

    def test_the_clock_and_the_stamps_go_on_and_the_state_is_held(self):
        clock = Listener("/clock", Clock)
        self.begin_endless()
        states, ticks = len(self.client.states.messages), len(clock.messages)
        self.client.states.wait(states + 100)
        wait_for(lambda: len(clock.messages) >= ticks + 100, "the clock")
        passed = (clock.messages[-1].clock - clock.messages[ticks].clock).to_sec()
        self.assertGreater(passed, 0.9)  # a hundred at 100 Hz
        stamps = [m.header.stamp for m in list(self.client.states.messages)]
        self.assertTrue(all(a < b for a, b in zip(stamps, stamps[1:])))
        self.assertEqual(len({m.time for m in self.client.states.messages[states:]}), 1)
        clock.stop()

    def test_it_goes_on_with_another_initial_state(self):
        before = self.begin_endless()
        self.assertTrue(self.client.set_initial_state(USUAL).success)
        after = self.client.states.wait_for_one(lambda m: m.header.stamp > before and m.twist.angular.z == 1 and m.time > 1)
        self.assertLess(after.time, 20)
        wait_for(lambda: self.status.messages[-1].message == "" and self.status.messages[-1].behind == 0, "a status")

    def test_paused_it_stands_and_a_step_is_ended_by_a_pause(self):
        self.begin_endless()
        self.assertEqual(self.client.pause(True).message, "paused")
        stamp = self.client.present().header.stamp
        self.assertEqual(self.client.present().header.stamp, stamp)
        answers = []
        step = self.client.service("step", Step)
        caller = threading.Thread(target=lambda: answers.append(step(1e8)))
        caller.start()
        self.wait_for_behind()
        self.assertEqual(answers, [])
        self.assertIn("another step", self.client.step(1).message)
        self.client.pause(True)
        caller.join(PATIENCE)
        self.assertEqual([(a.success, a.message) for a in answers], [(False, "the step was ended by ~pause")])
        self.client.pause(False)

    def test_what_comes_by_topics_is_taken(self):
        before = self.begin_endless()
        poses = rospy.Publisher("/initialpose", PoseWithCovarianceStamped, queue_size=1)
        wrenches = rospy.Publisher(NODE + "/cmd_wrench", WrenchStamped, queue_size=10)
        wait_for(poses.get_num_connections, "the node on /initialpose")
        wait_for(wrenches.get_num_connections, "the node on ~cmd_wrench")
        for _ in range(100):
            wrenches.publish(WrenchStamped())
        pose = PoseWithCovarianceStamped()
        pose.pose.pose.position.x = 7
        pose.pose.pose.orientation.w = 1
        poses.publish(pose)
        self.client.states.wait_for_one(lambda m: m.header.stamp > before and m.pose.position.x == 7 and m.time > 0.1)
        poses.unregister()
        wrenches.unregister()

    def test_slow_motions_come_to_the_same_states_as_simulate(self):
        """A tick takes some ten thousand steps: it is computed beside the loop, to the same bits."""
        begin = self.client.start(SLOW)
        late = self.client.states.wait_for_one(lambda m: m.header.stamp > begin and m.time >= 0.03)
        scene = "sphere: {mass: 1.0, radius: 0.1, body: solid}\n" \
                "surface: {base: {law: rough, turntable: {rate: 4.0e+6, center: [200, 0]}}}\n" \
                "drag: {translational: 0.1}\n" \
                "initial_state: {position: [200.05, 0], velocity: [1, 0]}\n"
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
            file.write(scene)
            file.flush()
            rows = simulate(file.name, "--times", "%.17g" % late.time, "--states", "-")
        row = rows[0]
        q = late.pose.orientation
        self.assertEqual([float(row[key]) for key in ("x", "y", "qx", "qy", "qz", "qw")],
                         [late.pose.position.x, late.pose.position.y, q.x, q.y, q.z, q.w])

    def test_sigint_ends_it(self):
        table = {"law": "rough", "turntable": {"rate": 1e12, "center": [100, 0]}}
        with other_node(surface={"base": table}, drag={"translational": 0.1}) as node:
            rospy.ServiceProxy("/other/set_initial_state", SetInitialState)(ENDLESS)
            status = Listener("/other/status", SimulatorStatus)
            status.wait_for_one(lambda m: m.behind > 0.5)
            status.stop()
            node.send_signal(signal.SIGINT)
            self.assertEqual(node.wait(PATIENCE), 0)

    def test_stamps_of_switches_go_on_after_a_reset_of_what_is_under_way(self):
        """In a tick of 1000 s, of a hundred million steps, a spring draws the sphere over an edge again and again."""
        rough = {"name": "rough", "half_plane": {"point": [0, 0], "normal": [1, 0]}, "law": "rough"}
        with other_node(initial_state={"position": [1, 0], "velocity": [0, 0.2]}, spring={"stiffness": 10.0, "center": [0, 0]},
                        surface={"base": {"law": "smooth"}, "regions": [rough]}, solver={"method": "rk4", "step": 1e-5},
                        rate=0.001, real_time_factor=0):
            switches = Listener("/other/constraint_switch", ConstraintSwitch)
            switches.wait_for_one(lambda m: m.index >= 8)
            count = len(switches.messages)
            self.assertTrue(rospy.ServiceProxy("/other/reset", std_srvs.srv.Trigger)().success)
            wait_for(lambda: any(m.index == 0 for m in switches.messages[count:]), "a switch after the reset")
            stamps = [m.header.stamp for m in list(switches.messages)]
            self.assertEqual(stamps, sorted(stamps))
            switches.stop()

    def test_stamps_may_go_on_by_more_than_a_duration_holds_between_two_statuses(self):
        with other_node(paused=True, rate=0.001):
            status = Listener("/other/status", SimulatorStatus)
            status.wait()
            step = rospy.ServiceProxy("/other/step", Step)
            for _ in range(3):
                self.assertTrue(step(8e8).success)
            later = status.wait_for_one(lambda m: m.time == 2.4e9)
            status.wait(len(status.messages) + 1)
            self.assertEqual([later.message, status.messages[-1].message], ["", ""])
            status.stop()


if __name__ == "__main__":
    rospy.init_node("busy_test")
    rostest.rosrun("hybrid_sphere", "busy_test", Busy)
