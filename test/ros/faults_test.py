#!/usr/bin/python3
"""What a running system does to a node: it survives, its stamps go on, and no switch is lost."""
import os
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import unittest

import rosgraph
import rospy
import rostest
from geometry_msgs.msg import WrenchStamped
from hybrid_sphere.msg import ConstraintSwitch, SphereState
from hybrid_sphere.srv import GetSurfaceMap, SetInitialState, Step
from rosgraph_msgs.msg import Clock
from std_srvs.srv import SetBool, Trigger

from node_client import PATIENCE, Listener, initial_state, lines_of, program, wait_for

FAKETIME = "/usr/lib/x86_64-linux-gnu/faketime/libfaketimeMT.so.1"
LOGGER = """
import rospy, sys, threading
from hybrid_sphere.msg import ConstraintSwitch
rospy.init_node("logger", disable_signals=True)
switches = rospy.Subscriber(sys.argv[1], ConstraintSwitch, lambda m: print(m.index, flush=True))
while all(c.callerid_pub == "unknown" for c in switches.impl.connections):  # before the node has answered
    threading.Event().wait(0.01)
print("connected", flush=True)
rospy.spin()
"""
CALLER = """
import rospy, sys, threading
from dynamic_reconfigure.msg import Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure
from hybrid_sphere.msg import SimulatorStatus
from std_srvs.srv import SetBool
def say(*words): print(*words, flush=True)
def call(name):
    calls[name]()
    say(name)
rospy.init_node("caller", disable_signals=True)
rospy.wait_for_service("/alone/pause")
pause = rospy.ServiceProxy("/alone/pause", SetBool, persistent=True)
adjust = rospy.ServiceProxy("/alone/set_parameters", Reconfigure, persistent=True)
calls = {"pause": lambda: pause(True), "go on": lambda: pause(False),
         "adjust": lambda: adjust(Config(doubles=[DoubleParameter("real_time_factor", 2)]))}
adjust(Config())
rospy.Subscriber("/alone/status", SimulatorStatus, lambda m: say("factor %g" % m.real_time_factor_target))
call("go on")
for line in sys.stdin:
    name = line.strip()
    threading.Thread(target=call, args=(name,), daemon=True).start() if name == "adjust" else call(name)
"""


def strips(count, speed):
    """Rough strips of 0.1 m, 0.2 m apart; every edge is a switch."""
    regions = [{"name": "strip_%d" % i, "law": "rough",
                "polygon": [[0.2 * i, -1], [0.2 * i + 0.1, -1], [0.2 * i + 0.1, 1], [0.2 * i, 1]]} for i in range(count)]
    return {"sphere": {"mass": 1.0, "radius": 0.1, "body": "solid"},
            "initial_state": {"position": [-0.01, 0], "velocity": [7 / 5 * speed, 0]}, "surface": {"regions": regions}}


class Faults(unittest.TestCase):
    def setUp(self):
        self.processes = []

    def tearDown(self):
        for process in self.processes:
            if process.poll() is None:
                process.send_signal(signal.SIGCONT)
                process.kill()
            process.wait(PATIENCE)

    def start(self, command, **more):
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, **more)
        self.processes.append(process)
        return process

    def node(self, name, parameters=None, environment=None, **more):
        """A node of that name; its parameters are those given or those of its last start."""
        if parameters is not None:
            rospy.set_param("/" + name, dict(parameters, **more))
        return self.start([program("hybrid_sphere_node"), "__name:=" + name], env=dict(os.environ, **(environment or {})))

    def service(self, name, service_class):
        rospy.wait_for_service(name, PATIENCE)
        return rospy.ServiceProxy(name, service_class)

    def assert_goes_on(self, states):
        """New states come, and of all of them no stamp is repeated or earlier."""
        count = len(states.messages)
        states.wait(count + 50)
        stamps = [m.header.stamp for m in states.messages]
        self.assertTrue(all(a < b for a, b in zip(stamps, stamps[1:])))

    def test_services_hammered_from_eight_clients(self):
        self.node("hammered", strips(50, 1.0))
        states = Listener("/hammered/state", SphereState)
        states.wait()
        failures = []
        dropped = []

        # roscpp's server now and then drops a connection that is made while another is closed (ros_comm #1976), one
        # in 1e4 to 1e5, whatever the service does. Who calls again is answered.
        def call(proxy, arguments):
            try:
                proxy(*arguments)
            except rospy.ServiceException as error:
                if not str(error).startswith(("unable to connect to service", "transport error")):
                    raise
                dropped.append(error)
                proxy(*arguments)

        def hammer(number):
            calls = [(self.service("/hammered/get_surface_map", GetSurfaceMap), ()),
                     (self.service("/hammered/reset", Trigger), ()),
                     (self.service("/hammered/set_initial_state", SetInitialState), (initial_state((number, 0), (1, 0)),)),
                     (self.service("/hammered/pause", SetBool), (number % 2 == 0,)),
                     (self.service("/hammered/step", Step), (0.01,))]
            try:
                for i in range(100):
                    call(*calls[(i + number) % len(calls)])
            except rospy.ServiceException as error:
                failures.append(error)

        threads = [threading.Thread(target=hammer, args=(number,)) for number in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(PATIENCE)
            self.assertFalse(thread.is_alive())
        self.assertEqual(failures, [])
        self.assertLess(len(dropped), 8)  # of 800
        self.service("/hammered/pause", SetBool)(False)
        self.assert_goes_on(states)

    def test_killed_and_started_again(self):
        first = self.node("respawned", strips(50, 1.0))
        states = Listener("/respawned/state", SphereState)
        last = states.wait(20)[-1]
        first.kill()
        first.wait(PATIENCE)
        self.node("respawned")
        again = states.wait_for_one(lambda m: m.header.stamp > last.header.stamp and m.time < last.time)
        self.assertGreater(again.header.stamp, last.header.stamp)
        self.assert_goes_on(states)
        self.assertTrue(self.service("/respawned/reset", Trigger)().success)

    def test_interrupted_it_ends_also_while_paused_or_flat_out(self):
        for name, more in (("running", {}), ("paused", {"paused": True}), ("flat", {"real_time_factor": 0})):
            node = self.node(name, strips(5, 1.0), **more)
            self.service("/" + name + "/pause", SetBool)
            node.send_signal(signal.SIGINT)
            self.assertEqual(node.wait(PATIENCE), 0)

    def test_a_long_step_is_interrupted(self):
        node = self.node("stepping", strips(5, 1.0), paused=True, rate=1e6)
        step = self.service("/stepping/step", Step)
        failures = []

        def call():
            try:
                step(1e9)
            except rospy.ServiceException as error:
                failures.append(error)

        states = Listener("/stepping/state", SphereState)
        thread = threading.Thread(target=call)
        thread.start()
        states.wait_for_one(lambda m: m.time > 0)  # it steps
        node.send_signal(signal.SIGINT)
        self.assertEqual(node.wait(PATIENCE), 0)
        thread.join(PATIENCE)
        self.assertEqual(len(failures), 1)

    def test_a_listener_that_hangs_loses_no_switch_and_holds_up_nobody(self):
        count = 500
        self.node("hung", strips(count, 40.0), paused=True, rate=1000)
        script = self.start([sys.executable, "-c", LOGGER, "/hung/constraint_switch"])
        states = Listener("/hung/state", SphereState)
        mine = Listener("/hung/constraint_switch", ConstraintSwitch)
        lines = lines_of(script.stdout)
        wait_for(lambda: lines == ["connected"], "the script")
        script.send_signal(signal.SIGSTOP)
        self.service("/hung/pause", SetBool)(False)
        self.assertEqual([m.index for m in mine.wait(2 * count)], list(range(2 * count)))
        self.assert_goes_on(states)
        script.send_signal(signal.SIGCONT)
        wait_for(lambda: len(lines) > 2 * count, "the switches")
        self.assertEqual([int(line) for line in lines[1:]], list(range(2 * count)))

    def test_the_master_restarts_and_who_is_connected_loses_nothing(self):
        count = 400
        environment, other = self.other_master()
        other.setParam("/alone", dict(strips(count, 40.0), paused=True))
        node = self.node("alone", environment=environment)
        logger = self.start([sys.executable, "-c", LOGGER, "/alone/constraint_switch"], env=environment)
        lines = lines_of(logger.stdout)
        wait_for(lambda: lines == ["connected"], "the logger")
        call = ["rosservice", "call", "/alone/pause", "false"]
        subprocess.run(call, env=environment, check=True, stdout=subprocess.DEVNULL, timeout=PATIENCE)
        self.end_master()
        self.start_master(environment)
        wait_for(lambda: len(lines) > 2 * count, "the switches")
        self.assertEqual([int(line) for line in lines[1:]], list(range(2 * count)))
        self.assertIsNone(node.poll())

    def test_without_a_master_the_first_pause_and_reconfigure_hold_up_nobody(self):
        environment, other = self.other_master()
        node, ask, said = self.asked_without_a_master(environment, other)
        # A factor between two pauses, each answered by the simulation's thread; the parameter cannot be written yet.
        ask("pause", "go on", "pause", "go on", "adjust")
        wait_for(lambda: said.count("go on") == 3, "the answers")
        wait_for(lambda: "factor 2" in said, "the new factor")
        ask("pause", "go on", "pause")
        wait_for(lambda: said.count("pause") == 4, "the answers")
        self.assertNotIn("adjust", said)
        self.start_master(environment)
        wait_for(lambda: "adjust" in said, "the answer of dynamic_reconfigure")
        self.assertEqual(other.getParam("/alone/real_time_factor"), 2)
        wait_for(lambda: "/alone/handle/update" in dict(other.getSystemState()[0]), "the handle")
        self.assertIsNone(node.poll())

    def test_without_a_master_it_is_interrupted_also_where_it_waits_for_one(self):
        environment, other = self.other_master()
        node, ask, said = self.asked_without_a_master(environment, other)
        ask("adjust", "pause")
        wait_for(lambda: "pause" in said and "factor 2" in said, "the answers")
        node.send_signal(signal.SIGINT)
        self.assertEqual(node.wait(PATIENCE), 0)  # nor is it aborted

    def asked_without_a_master(self, environment, other):
        """A node whose master has gone, a function that has it asked by connections of before, and the answers."""
        other.setParam("/alone", strips(5, 1.0))
        node = self.node("alone", environment=environment)
        caller = self.start([sys.executable, "-c", CALLER], env=environment, stdin=subprocess.PIPE)
        said = lines_of(caller.stdout)
        wait_for(lambda: "factor 1" in said and "go on" in said, "the caller")
        self.end_master()

        def ask(*names):
            caller.stdin.write("".join(name + "\n" for name in names).encode())
            caller.stdin.flush()

        return node, ask, said

    def other_master(self):
        """A master beside that of the test: what its nodes have to know, and itself."""
        with socket.socket() as free:
            free.bind(("", 0))
            port = free.getsockname()[1]
        environment = dict(os.environ, ROS_MASTER_URI="http://localhost:%d" % port)
        self.start_master(environment)
        return environment, rosgraph.Master("/test", environment["ROS_MASTER_URI"])

    def start_master(self, environment):
        uri = environment["ROS_MASTER_URI"]
        self.master = self.start(["rosmaster", "--core", "-p", uri.rpartition(":")[2]])
        wait_for(rosgraph.Master("/test", uri).is_online, "the second master")

    def end_master(self):
        self.master.kill()
        self.master.wait(PATIENCE)

    def test_a_command_flood(self):
        self.node("flooded", strips(50, 1.0), rate=200)
        states = Listener("/flooded/state", SphereState)
        commands = rospy.Publisher("/flooded/cmd_wrench", WrenchStamped, queue_size=1000)
        wait_for(commands.get_num_connections, "the node")
        message = WrenchStamped()
        count = len(states.messages)

        def flood():
            message.wrench.force.y = 1e-5 * len(states.messages)
            for _ in range(100):
                commands.publish(message)
            return len(states.messages) > count + 400

        wait_for(flood, "states under the commands")
        self.assert_goes_on(states)

    def test_somebody_elses_clock_that_jumps_back(self):
        rospy.set_param("/use_sim_time", True)
        clock = rospy.Publisher("/clock", Clock, queue_size=10)
        stops = threading.Event()

        def publish():
            for i in range(100000):
                clock.publish(Clock(rospy.Time(1000 + (i % 7))))
                if stops.wait(0.02):
                    return

        thread = threading.Thread(target=publish)
        thread.start()
        try:
            self.node("other_clock", strips(50, 1.0))
            states = Listener("/other_clock/state", SphereState)
            first = states.wait()[0].header.stamp.to_sec()
            self.assertGreaterEqual(first, 1000)
            self.assertLess(first, 2000)
            self.assert_goes_on(states)
        finally:
            rospy.set_param("/use_sim_time", False)
            stops.set()
            thread.join()

    def test_a_system_clock_that_steps(self):
        with tempfile.NamedTemporaryFile("w") as offset:
            def step(text):
                offset.seek(0)
                offset.truncate()
                offset.write(text + "\n")
                offset.flush()
            step("+0")
            self.node("stepped_clock", strips(50, 1.0), environment={
                "LD_PRELOAD": FAKETIME, "FAKETIME_TIMESTAMP_FILE": offset.name, "FAKETIME_NO_CACHE": "1",
                "DONT_FAKE_MONOTONIC": "1"})
            states = Listener("/stepped_clock/state", SphereState)
            states.wait(20)
            for text in ("+3600", "-7200", "+0"):
                step(text)
                before = states.messages[-1]
                self.assert_goes_on(states)
                passed = (states.messages[-1].header.stamp - before.header.stamp).to_sec()
                self.assertLess(passed, 1800)  # half of the smallest step


if __name__ == "__main__":
    rospy.init_node("faults_test")
    rostest.rosrun("hybrid_sphere", "faults_test", Faults)
