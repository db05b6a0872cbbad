#!/usr/bin/python3
"""The node drives /clock: it never jumps back, it is never 0, and it stands where the stamps stand."""
import subprocess
import unittest

import rosgraph
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from hybrid_sphere.msg import SimulatorStatus, SphereState
from rosgraph_msgs.msg import Clock

from node_client import Client, Listener, program, wait_for

NODE = "/hybrid_sphere"


class SimulatedTime(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.clock = Listener("/clock", Clock)
        cls.client = Client(NODE)

    def setUp(self):
        self.client.pause(False)

    def test_others_have_the_time_of_the_simulation(self):
        self.assertTrue(rospy.get_param("/use_sim_time"))
        self.assertEqual([nodes for topic, nodes in rosgraph.Master("/test").getSystemState()[0] if topic == "/clock"],
                         [[NODE]])
        now = rospy.Time.now()
        self.assertLessEqual(now, self.client.state().header.stamp)
        wait_for(lambda: rospy.Time.now() in [m.clock for m in list(self.clock.messages)[-10:]], "the time of the clock")

    def test_the_clock_increases_also_across_pauses_steps_and_resets(self):
        for _ in range(3):
            self.clock.wait(len(self.clock.messages) + 10)
            self.client.pause(True)
            self.client.step(0.0123)
            self.client.reset()
            self.client.step(0.5)
            self.client.pause(False)
            self.client.reset()
        times = [m.clock for m in self.clock.messages]
        self.assertTrue(all(a < b for a, b in zip(times, times[1:])))
        self.assertGreater(times[0].to_sec(), 1e9)

    def test_while_time_stands_the_clock_is_the_stamp_and_a_late_listener_gets_it(self):
        self.client.pause(True)
        state = self.client.step(0.0123).state
        wait_for(lambda: self.clock.messages[-1].clock == state.header.stamp, "the clock at the end of the step")
        late = Listener("/clock", Clock)
        self.assertEqual(late.wait()[-1].clock, state.header.stamp)
        late.stop()

    def test_the_clock_has_a_rate_and_a_factor_of_its_own(self):
        """50 messages and 4 s of the clock in a second of the wall's: 0.08 s from one message to the next."""
        def usual_step():
            times = [m.clock.to_sec() for m in self.clock.wait(len(self.clock.messages) + 50)[-50:]]
            return sorted(b - a for a, b in zip(times, times[1:]))[24]

        # A busy machine leaves out messages.
        wait_for(lambda: abs(usual_step() - 0.08) < 0.02, "messages at the rate of the clock")
        status = Listener(NODE + "/status", SimulatorStatus)
        self.assertEqual(status.wait()[0].real_time_factor_target, 4)
        status.stop()

    def test_by_default_the_clock_tells_each_tick(self):
        states, ticks = Listener("/ticking/state", SphereState), Listener("/ticking_clock", Clock)
        stamps = {m.header.stamp for m in states.wait(100)[-50:]}
        wait_for(lambda: stamps <= {m.clock for m in list(ticks.messages)}, "the stamp of each state on the clock")
        states.stop()
        ticks.stop()

    def test_a_second_node_that_publishes_the_clock_says_so(self):
        rospy.set_param("/second", {**rospy.get_param("/ticking"), "diagnostics": False})
        second = subprocess.Popen([program("hybrid_sphere_node"), "__name:=second", "/clock:=/ticking_clock"],
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        said = []
        while not said or ("/clock is published by /ticking, too" not in said[-1] and said[-1]):
            said.append(second.stdout.readline())
        second.kill()
        second.communicate()
        self.assertNotEqual(said[-1], "", said)

    def test_diagnostics_tell_time_and_solver(self):
        diagnostics = Listener("/diagnostics", DiagnosticArray)
        def find(name):
            return [s for m in list(diagnostics.messages) for s in m.status if s.name == "hybrid_sphere: " + name]
        for name in ("time", "solver"):
            found = wait_for(lambda: find(name), "diagnostics of the " + name)
            self.assertIn(found[-1].level, (DiagnosticStatus.OK, DiagnosticStatus.WARN))
        solver = {v.key: v.value for v in find("solver")[-1].values}
        self.assertEqual((solver["method"], float(solver["accuracy asked for"])), ("auto", 1e-9))

    def test_diagnostics_do_not_call_slow_what_has_just_begun(self):
        """In the second in which it goes on, the factor reached is not known yet."""
        reports = Listener("/diagnostics", DiagnosticArray)
        def last_time():
            found = [s for m in list(reports.messages) for s in m.status if s.name == "hybrid_sphere: time"]
            return found[-1].message if found else ""
        self.client.pause(True)
        wait_for(lambda: last_time() == "paused", "diagnostics of the pause")
        self.client.pause(False)
        first = wait_for(lambda: {last_time()} - {"paused"}, "diagnostics of what goes on")
        self.assertLessEqual(first, {"on time", "late ticks"})


if __name__ == "__main__":
    rospy.init_node("clock_test")
    rostest.rosrun("hybrid_sphere", "clock_test", SimulatedTime)
