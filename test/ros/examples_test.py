#!/usr/bin/python3
"""The programs of examples/ do what their first lines say."""
import math
import re
import signal
import subprocess
import unittest

import rospy
import rostest
from hybrid_sphere.msg import ConstraintSwitch
from rosgraph_msgs.msg import Log
from std_msgs.msg import Header

from node_client import PATIENCE, Client, Console, case, circle, connected, initial_state, program, surface, wait_for

NODE = "/hybrid_sphere"
TARGET = {"_x": 2.0, "_y": 1.0, "_radius": 0.2, "_strongest": 20.0}  # all: parameters outlive a node


class Examples(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = Client(NODE)
        cls.map = cls.client.get_surface_map().map

    def setUp(self):
        self.running = []
        self.client.pause(True)
        self.assertTrue(self.client.set_surface_map(self.map).success)
        self.begin = self.client.step(0.01).state.header.stamp
        self.assertTrue(self.client.reset().success)

    def tearDown(self):
        self.client.pause(True)
        for process in self.running:
            if process.poll() is None:
                process.kill()
            process.communicate()

    def start(self, name, *arguments, **parameters):
        words = ["%s:=%s" % item for item in parameters.items()]
        process = subprocess.Popen([program(name), *arguments, *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.running.append(process)
        return process

    def listens(self, topic, node):
        """Waits until a node has the topic."""
        def connected():
            from_master = rospy.get_master().getSystemState()[2]
            return any(t == topic and "/" + node in nodes for t, nodes in from_master[1])
        wait_for(connected, "%s on %s" % (node, topic))

    def read_until(self, process, enough):
        """Reads what it prints, line by line, until there is enough."""
        output = ""
        while not enough(output):
            line = process.stdout.readline().decode()
            self.assertTrue(line, "ended after:\n" + output)
            output += line

    def end(self, process, code=0):
        """Exit code as expected after Ctrl-C; the output."""
        process.send_signal(signal.SIGINT)
        output = process.communicate(timeout=PATIENCE)[0].decode()
        self.assertEqual(process.returncode, code, output)
        return output

    def test_the_controllers_catch_the_sphere_in_the_disc_also_from_another_ground(self):
        for name in ("steer_to_target", "catch_in_disc.py"):
            with case(name=name):
                self.setUp()
                console = Console("/" + name.partition(".")[0], is_there=False)
                controller = self.start(name, **TARGET)
                self.listens(NODE + "/state", name.partition(".")[0])
                self.client.pause(False)
                caught = self.client.states.wait_for_one(
                    lambda m: m.header.stamp > self.begin and m.time > 1 and
                    math.hypot(m.pose.position.x - 2, m.pose.position.y - 1) < 0.1 and
                    math.hypot(m.twist.linear.x, m.twist.linear.y) < 0.04)
                self.assertEqual(self.client.switch_after(self.begin).to_region, "rough_half")
                said = wait_for(lambda: [m for m in console.said(Log.INFO) if "caught at x = " in m], "what it says")
                self.assertLessEqual(float(re.search(r"t = ([\d.]+) s: caught", said[0]).group(1)), caught.time + 1e-3)
                self.end(controller)

    def test_every_program_tells_its_usage_and_there_is_one_of_its_name(self):
        for name in ("hybrid_sphere_node", "three_stage_node", "record", "simulate", "three_stage", "steer_to_target",
                     "catch_in_disc.py", "catch_in_lock_step.py", "log_switches.py"):
            with case(name=name):
                result = subprocess.run(["rosrun", "hybrid_sphere", name, "--help"], stdin=subprocess.DEVNULL,
                                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=PATIENCE)
                output = result.stdout.decode()
                self.assertEqual(result.returncode, 0, output)
                self.assertRegex(output, "Usage: " + name if "." not in name else "rosrun hybrid_sphere " + name
                                 if "lock" not in name else "roslaunch hybrid_sphere lock_step.launch")

    def test_the_strongest_force_bounds_the_acceleration(self):
        mass = self.client.sphere["mass"]
        for name in ("steer_to_target", "catch_in_disc.py"):
            with case(name=name):
                self.setUp()
                self.client.set_surface_map(surface())
                self.client.set_initial_state(initial_state((-100, 0)))
                controller = self.start(name, **dict(TARGET, _strongest=4.0))
                self.listens(NODE + "/state", name.partition(".")[0])
                self.client.pause(False)
                moving = self.client.states.wait_for_one(lambda m: m.header.stamp > self.begin and m.twist.linear.x > 1)
                self.client.pause(True)
                # All of the time up to then under 4 N, but for the tick or more before the first command.
                self.assertLessEqual(math.hypot(moving.twist.linear.x, moving.twist.linear.y),
                                     4 / mass * moving.time * (1 + 1e-12))
                self.end(controller)

    def test_the_controllers_refuse_what_is_out_of_range(self):
        refused = {"_radius": -1.5, "_strongest": 0, "_stiffness": "inf", "_x": "nan", "_damping": "much", "_slow": "true"}
        for name in ("steer_to_target", "catch_in_disc.py"):
            self.addCleanup(rospy.delete_param, "/" + name.partition(".")[0])  # a later node would take them
            for key, value in refused.items():
                with case(name=name, key=key, value=value):
                    allowed = dict(TARGET, _stiffness=4.0, _damping=6.0, _slow=0.05)
                    controller = self.start(name, **dict(allowed, **{key: value}))
                    output = controller.communicate(timeout=PATIENCE)[0].decode()
                    self.assertEqual(controller.returncode, 1, output)
                    self.assertRegex(output, "(?i)~%s: '?%s'? is refused" % (key[1:], re.escape(str(value))))

    def test_in_lock_step_what_is_out_of_range_is_refused_by_its_name(self):
        for name, value in (("_x", "nowhere"), ("_radius", 0.0), ("_period", -1.0)):
            with case(name=name):
                controller = self.start("catch_in_lock_step.py", **dict(TARGET, _period=0.02) | {name: value})
                output = controller.communicate(timeout=PATIENCE)[0].decode()
                self.assertEqual(controller.returncode, 1)
                self.assertIn("~%s: %r is refused" % (name[1:], value), output)

    def test_in_lock_step_every_run_is_the_same_to_the_bit(self):
        runs = []
        for _ in range(2):
            process = self.start("catch_in_lock_step.py", _period=0.02, **TARGET)
            output = process.communicate(timeout=PATIENCE)[0].decode()
            self.assertEqual(process.returncode, 0, output)
            states = [m for m in list(self.client.states.messages) if m.header.stamp > self.begin]
            first = max(i for i, m in enumerate(states) if m.time == 0)
            runs.append((output, [(m.time, m.pose, m.twist, m.mode, m.region) for m in states[first:]]))
        self.assertIn("caught at t = ", runs[0][0])
        self.assertEqual(runs[0][0], runs[1][0])
        self.assertGreater(len(runs[0][1]), 100)
        self.assertEqual(runs[0][1], runs[1][1])

    def test_in_lock_step_each_command_acts_in_its_own_period(self):
        """The stepped plant under the same forces, computed anew from the states."""
        self.client.set_surface_map(surface())
        process = self.start("catch_in_lock_step.py", _period=0.05, **TARGET)
        output = process.communicate(timeout=PATIENCE)[0].decode()
        self.assertEqual(process.returncode, 0, output)
        states = [m for m in list(self.client.states.messages) if m.header.stamp > self.begin]
        states = states[max(i for i, m in enumerate(states) if m.time == 0):]
        ends = states[5::5]  # 100 Hz, periods of 0.05 s
        self.assertGreater(len(ends), 50)
        mass = self.client.sphere["mass"]
        for a, b in zip(ends, ends[1:]):
            force = 4 * (2 - a.pose.position.x) - 6 * a.twist.linear.x
            gained = b.twist.linear.x - a.twist.linear.x
            # Roundings of speeds below 4 m/s, five ticks with a few each.
            self.assertAlmostEqual(gained, force / mass * 0.05, delta=1e-13)

    def test_the_logger_has_every_switch_and_says_so(self):
        logger = self.start("log_switches.py")
        self.listens(NODE + "/constraint_switch", "log_switches")
        wait_for(lambda: connected("/log_switches"), "the connection of the logger")
        self.client.set_surface_map(surface(circle("pond", (0, 0), 1), circle("lake", (5, 0), 2)))
        for _ in range(2):
            self.client.set_initial_state(initial_state((-2, 0), (1, 0)))
            self.assertEqual(self.client.step(20).switches, 4)
        both = ["0", "1", "2", "3"] * 2
        self.read_until(logger, lambda output: re.findall(r"index (\d+)", output)[-8:] == both)
        self.assertTrue(self.end(logger).strip().endswith("none lost"))

    def test_the_logger_says_what_is_missing(self):
        publisher = rospy.Publisher("/other/constraint_switch", ConstraintSwitch, queue_size=20)
        logger = self.start("log_switches.py", **{"hybrid_sphere/constraint_switch": "/other/constraint_switch"})
        wait_for(publisher.get_num_connections, "the logger")
        # 2 is missing; a new run; then each 1 is a new one without its 0.
        for second, index in enumerate((0, 1, 3, 0, 1, 1, 1)):
            publisher.publish(ConstraintSwitch(header=Header(stamp=rospy.Time(second + 1)), index=index, kind=1))
        self.read_until(logger, lambda output: output.count("index") == 7)
        self.assertIn("7 switches since 4 initial states, 3 LOST", self.end(logger, code=1))


if __name__ == "__main__":
    rospy.init_node("examples_test")
    rostest.rosrun("hybrid_sphere", "examples_test", Examples)
