#!/usr/bin/python3
"""Time as the user sets it: pause, step, status; the trajectory is the same to the bit, however it is run."""
import math
import os
import signal
import unittest
import xmlrpc.client

import rosgraph
import rosnode
import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import PoseStamped, TwistStamped
from hybrid_sphere.msg import SimulatorStatus
from hybrid_sphere.srv import SetInitialState
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from tf2_msgs.msg import TFMessage

from csv_rows import parsed, state_row, switch_row
from node_client import Client, Console, Listener, case, initial_state, let_pass, simulate, wait_for

NODE = "/hybrid_sphere"
RATE = 100


class Time(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scene = rospy.get_param("~scene")
        cls.client = Client(NODE)
        cls.client.set_state = cls.client.service("set_state", SetInitialState)

    def setUp(self):
        self.assertTrue(self.client.pause(True).success)
        self.reset()

    def reset(self):
        """The initial state of the scene; what is later than `begin` comes after it."""
        self.begin = self.step(1e-3).state.header.stamp
        state = rospy.get_param(NODE + "/initial_state")
        request = initial_state(state["position"], state["velocity"], state.get("angular_velocity", (0, 0, 0)))
        self.assertTrue(self.client.set_initial_state(request).success)
        return self.client.states.wait_for_one(lambda m: m.header.stamp > self.begin and m.time == 0)

    def since_reset(self, listener):
        return [m for m in list(listener.messages) if m.header.stamp > self.begin]

    def step(self, duration):
        answer = self.client.step(duration)
        self.assertTrue(answer.success, answer.message)
        return answer

    def test_it_starts_paused_with_the_initial_state(self):
        first = self.client.states.messages[0]
        self.assertEqual(first.time, 0)
        self.assertEqual(first.pose.position.x, rospy.get_param(NODE + "/initial_state/position")[0])

    def test_while_paused_time_and_stamps_stand_and_services_answer(self):
        self.client.pause(False)
        self.client.states.wait_for_one(lambda m: m.header.stamp > self.begin and m.time > 0.1)
        self.client.pause(True)
        last = self.client.step(1e-3).state
        status = Listener(NODE + "/status", SimulatorStatus)
        first, second = status.wait(2)
        self.assertTrue(first.paused)
        self.assertEqual((first.time, first.header.stamp), (last.time, last.header.stamp))
        self.assertEqual((second.time, second.header.stamp), (last.time, last.header.stamp))
        self.assertEqual(self.client.states.messages[-1].time, last.time)
        self.assertTrue(self.client.get_surface_map().map.regions)

    def test_who_comes_while_time_stands_gets_the_present_state_once(self):
        last = self.step(0.123).state
        topics = {"pose": PoseStamped, "twist": TwistStamped, "odom": Odometry}
        late = {name: Listener(NODE + "/" + name, kind) for name, kind in topics.items()}
        for name, listener in late.items():
            with case(topic=name):
                self.assertEqual(listener.wait()[0].header.stamp, last.header.stamp)
        tf = Listener("/tf", TFMessage)
        self.assertEqual(tf.wait()[0].transforms[0].header.stamp, last.header.stamp)
        again = self.step(0.01).state
        for name, listener in late.items():
            with case(topic=name):
                stamps = [m.header.stamp for m in listener.wait(2)]
                self.assertEqual(stamps[0], last.header.stamp)
                self.assertTrue(all(a < b for a, b in zip(stamps, stamps[1:])))
                wait_for(lambda: listener.messages[-1].header.stamp == again.header.stamp, "the end of the step")

    def test_a_step_takes_exactly_its_duration_and_every_tick_on_the_way(self):
        answer = self.step(0.0537)
        self.assertEqual(answer.state.time, 0.0537)
        wait_for(lambda: self.client.states.messages[-1].time == 0.0537, "the end of the step")
        times = [m.time for m in self.since_reset(self.client.states)]
        self.assertEqual(times, [n / RATE for n in range(6)] + [0.0537])
        stamps = [m.header.stamp for m in self.since_reset(self.client.states)]
        self.assertEqual((stamps[-1] - stamps[0]).to_nsec(), 53700000)

    def test_a_step_counts_its_switches(self):
        rows = [parsed(row) for row in simulate(self.scene, "--duration", "3", "--switches", "-")]
        self.assertEqual(self.step(1.5).switches + self.step(1.5).switches, len(rows))

    def test_stepwise_or_free_the_trajectory_is_the_same_to_the_bit(self):
        ends = [self.step(duration).state for duration in (0.1, 0.037, 1.0, 1 / 3, 0.002, 1e-9, 2.0, 0.25)]
        self.client.pause(False)
        self.client.states.wait_for_one(lambda m: m.header.stamp > self.begin and m.time > 4)
        self.client.pause(True)
        self.client.states_until_now()
        states = self.since_reset(self.client.states)
        self.assertTrue(all(a.header.stamp < b.header.stamp for a, b in zip(states, states[1:])))
        chosen = states[::7] + ends
        chosen.sort(key=lambda m: m.time)
        times = ",".join(repr(m.time) for m in chosen)
        for state, row in zip(chosen, simulate(self.scene, "--times", times, "--states", "-")):
            self.assertEqual(state_row(state), parsed(row))
        rows = [parsed(row) for row in simulate(self.scene, "--duration", repr(states[-1].time), "--switches", "-")]
        wait_for(lambda: len(self.since_reset(self.client.switches)) >= len(rows), "all switches")
        self.assertEqual([switch_row(m) for m in self.since_reset(self.client.switches)], rows)

    def test_steps_of_a_tick_are_the_ticks(self):
        for n in range(1, 40):
            self.assertEqual(self.step(1 / RATE).state.time, n / RATE)

    def test_refused_steps_change_nothing(self):
        before = self.step(0.1).state
        for duration in (0, -1, math.nan, math.inf, 2e9):
            with case(duration=duration):
                answer = self.client.step(duration)
                self.assertFalse(answer.success)
                self.assertIn("is refused; allowed: a number greater than 0, up to 1e9 [s]", answer.message)
                self.assertEqual(answer.state.time, before.time)
        self.client.pause(False)
        answer = self.client.step(1)
        self.client.pause(True)
        self.assertFalse(answer.success)
        self.assertIn("only a paused one takes steps", answer.message)

    def test_stamps_never_repeat_also_where_the_sphere_is_put_while_time_stands(self):
        tf = Listener("/tf", TFMessage)
        for x in range(5):
            self.assertTrue(self.client.set_initial_state(initial_state((x, 0))).success)
            self.client.reset()
        self.client.pause(False)
        tf.wait(len(tf.messages) + 20)
        tf.stop()
        stamps = [t.header.stamp for m in list(tf.messages) for t in m.transforms if t.child_frame_id == "sphere"]
        self.assertTrue(all(a < b for a, b in zip(stamps, stamps[1:])), stamps)

    def test_a_reset_while_time_passes_sends_the_initial_state(self):
        self.client.pause(False)
        self.client.states.wait_for_one(lambda m: m.header.stamp > self.begin and m.time > 0.05)
        before = len(self.client.states.messages)
        self.assertTrue(self.client.reset().success)
        first = self.client.states.wait_for_one(lambda m: m in self.client.states.messages[before:] and m.time == 0)
        self.client.pause(True)
        stamps = [m.header.stamp for m in self.client.states_until_now()]
        self.assertTrue(all(a < b for a, b in zip(stamps, stamps[1:])))
        self.assertEqual(first.pose.position.x, rospy.get_param(NODE + "/initial_state/position")[0])

    def test_tf2_in_python_has_each_state_while_time_stands(self):
        """It holds stamps as doubles."""
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)
        wait_for(lambda: buffer.can_transform("world", "sphere", rospy.Time()), "a transform")

        def place():
            return buffer.lookup_transform("world", "sphere", rospy.Time()).transform.translation.x

        console = Console(rospy.get_name(), is_there=False)
        for x in range(30):
            with case(x=x):
                state = self.client.set_initial_state if x % 2 else self.client.set_state
                self.assertTrue(state(initial_state((x + 0.5, 0))).success)
                wait_for(lambda: place() == x + 0.5, "the place where it was put")
                if x % 3 == 0:
                    end = self.step(0.003).state.pose.position.x
                    wait_for(lambda: place() == end, "the end of the step")
        self.assertEqual([text for text in console.said(Log.WARN) if "REPEATED" in text], [])
        listener.unregister()

    def stop_the_process_for(self, seconds):
        process = rosnode.get_api_uri(rosgraph.Master("/test"), NODE)
        pid = xmlrpc.client.ServerProxy(process).getPid("/test")[2]
        os.kill(pid, signal.SIGSTOP)
        let_pass(seconds)
        os.kill(pid, signal.SIGCONT)

    def test_ticks_that_are_left_out_while_time_keeps_up_are_in_the_status(self):
        status = Listener(NODE + "/status", SimulatorStatus)
        self.client.pause(False)

        def told():
            self.stop_the_process_for(0.15)  # 15 ticks, which time makes up for
            return [m for m in list(status.messages) if "ticks were left out in the last second" in m.message
                    and m.real_time_factor > 0.95]

        wait_for(told, "a status with ticks left out")
        status.stop()

    def test_what_a_stop_of_the_process_has_cost_is_in_the_status(self):
        status = Listener(NODE + "/status", SimulatorStatus)
        self.client.pause(False)
        status.wait_for_one(lambda m: not m.paused and m.real_time_factor > 0)
        begin = len(status.messages)
        self.stop_the_process_for(1.5)
        lag = status.wait_for_one(lambda m: m in status.messages[begin:] and m.lag > 1).lag
        self.assertLess(lag, 60)
        self.client.pause(True)
        self.client.pause(False)
        status.wait_for_one(lambda m: m in status.messages[begin:] and not m.paused and m.lag < 1)
        status.stop()

    def test_time_goes_on_after_a_pause_without_a_sprint(self):
        """The first state after a pause is the next tick; a busy machine may leave it out now and then."""
        def first_time():
            self.client.pause(True)
            self.reset()
            let_pass(0.2)
            self.client.pause(False)
            return self.client.states.wait_for_one(lambda m: m.header.stamp > self.begin and m.time > 0).time

        wait_for(lambda: first_time() == 1 / RATE, "the tick after a pause")

    def test_the_status_tells_how_it_goes(self):
        status = Listener(NODE + "/status", SimulatorStatus)
        self.client.pause(False)
        running = status.wait_for_one(lambda m: not m.paused and m.real_time_factor > 0)
        self.assertEqual(running.real_time_factor_target, 1)
        self.assertGreater(running.estimated_error, 0)
        self.assertLess(running.estimated_error, 1e-9)
        self.assertGreater(running.ticks, 10)
        self.assertEqual((running.method, running.rhs_evaluations), ("auto", 0))
        self.client.pause(True)
        paused = status.wait_for_one(lambda m: m.paused and m.header.stamp >= running.header.stamp)
        self.assertEqual(paused.real_time_factor, 0)
        wait_for(lambda: len(self.since_reset(self.client.switches)) == paused.switches, "as many switches")

    def test_steps_do_not_count_in_the_real_time_factor(self):
        status = Listener(NODE + "/status", SimulatorStatus)
        self.client.pause(False)
        status.wait_for_one(lambda m: not m.paused and m.real_time_factor > 0)
        self.client.pause(True)
        stamp = self.step(100).state.header.stamp
        self.client.pause(False)
        running = status.wait_for_one(lambda m: m.header.stamp > stamp and m.real_time_factor > 0)
        self.assertLess(running.real_time_factor, 10)


if __name__ == "__main__":
    rospy.init_node("time_test")
    rostest.rosrun("hybrid_sphere", "time_test", Time)
