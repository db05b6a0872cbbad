#!/usr/bin/python3
"""sim.launch with record:=, until Ctrl-C, and the program `record` alone: the bag that is left."""
import contextlib
import os
import resource
import shutil
import signal
import subprocess
import tempfile
import unittest
import xmlrpc.client

import rosbag
import rosgraph
import rospy
import rostest
import std_srvs.srv
from hybrid_sphere.msg import ConstraintSwitch, SimulatorStatus, SphereState
from hybrid_sphere.srv import SetInitialState, SetSurfaceMap
from std_msgs.msg import String

import lossless_test
from csv_rows import parsed, switch_row
from node_client import PATIENCE, Listener, case, initial_state, polygon, program, simulate, surface, wait_for

NODE = "/hybrid_sphere"
OWN = {"state", "pose", "twist", "odom", "constraint_switch", "surface_map", "status"}
SWITCHES = 6
TWO = """<launch>
  <group ns="left">
    <include file="$(find hybrid_sphere)/launch/sim.launch">
      <arg name="rviz" value="false"/>
      <arg name="record" value="left.bag"/>
    </include>
  </group>
  <group ns="right">
    <include file="$(find hybrid_sphere)/launch/sim.launch">
      <arg name="rviz" value="false"/>
      <arg name="scene" value="checkerboard"/>
      <arg name="record" value="right.bag"/>
    </include>
  </group>
</launch>
"""


def topics(node=NODE):
    return {node + "/" + name for name in OWN} | {"/tf"}


class Bag:
    """Messages by topic, topics of latched connections, and the times of reception."""

    def __init__(self, path):
        self.messages, self.times = {}, []
        with rosbag.Bag(path) as bag:
            for topic, message, time in bag.read_messages():
                self.messages.setdefault(topic, []).append(message)
                self.times.append(time)
            self.latched = {c.topic for c in bag._get_connections() if c.header.get("latching") in ("1", b"1")}

    def __getitem__(self, topic):
        return self.messages.get(topic, [])


class Record(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.mkdtemp()
        # Like a shell that has gone there.
        environment = {key: value for key, value in os.environ.items() if key != "DISPLAY"}
        self.options = {"cwd": self.directory, "env": dict(environment, PWD=self.directory), "stdout": subprocess.PIPE,
                        "stderr": subprocess.STDOUT}
        self.launched = None

    def tearDown(self):
        if self.launched and self.launched.poll() is None:
            self.end()
        if rospy.has_param("/use_sim_time"):
            rospy.delete_param("/use_sim_time")
        shutil.rmtree(self.directory)

    def file(self, name):
        return os.path.join(self.directory, name)

    def end(self):
        self.launched.send_signal(signal.SIGINT)
        return self.launched.communicate(timeout=PATIENCE)[0].decode()

    def launch(self, *arguments, files=("hybrid_sphere", "sim.launch", "rviz:=false")):
        self.launched = subprocess.Popen(["roslaunch", *files, *arguments], **self.options)

    @staticmethod
    def recorded_topics(node=NODE, recorder="/record"):
        """Topics with a connection from a node to a recorder."""
        try:
            api = xmlrpc.client.ServerProxy(rosgraph.Master("/test").lookupNode(node))
            return {info[4] for info in api.getBusInfo("/test")[2] if info[1] == recorder}
        except (rosgraph.MasterException, OSError):
            return set()

    def wait_for_recorder(self, wanted=topics()):
        wait_for(lambda: wanted <= self.recorded_topics(), "the recorder")

    def test_a_relative_path_and_every_switch_of_a_run_that_began_paused(self):
        self.launch("scene:=checkerboard", "paused:=true", "record:=a run.bag", "real_time_factor:=4")
        self.wait_for_recorder()
        switches = Listener(NODE + "/constraint_switch", ConstraintSwitch)
        wait_for(switches.is_connected, "a connection of our own")
        rospy.ServiceProxy(NODE + "/pause", std_srvs.srv.SetBool)(False)
        switches.wait(SWITCHES)
        switches.stop()
        output = self.end()
        path = self.file("a run.bag")
        self.assertEqual(os.listdir(self.directory), ["a run.bag"], output)
        bag = Bag(path)
        for topic in topics():
            self.assertGreater(len(bag[topic]), 0, topic)
            self.assertIn("  %s: %d\n" % (topic, len(bag[topic])), output)
        self.assertIn("record: \"%s\": %d messages\n" % (path, len(bag.times)), output)
        self.assertEqual(bag.latched, {NODE + "/surface_map", NODE + "/constraint_switch"})
        self.assertEqual(bag.times, sorted(bag.times))
        info = subprocess.run(["rosbag", "info", path], capture_output=True, text=True)
        self.assertEqual(info.returncode, 0, info.stdout + info.stderr)
        recorded = [switch_row(m) for m in bag[NODE + "/constraint_switch"]]
        self.assertGreaterEqual(len(recorded), SWITCHES)
        scene = os.path.join(rospy.get_param("~config"), "checkerboard.yaml")
        expected = simulate(scene, "--duration", str(recorded[-1][1] + 1), "--switches", "-")
        self.assertEqual(recorded, [parsed(row) for row in expected[:len(recorded)]])
        result = subprocess.run([program("plot"), path, "-o", os.path.join(self.directory, "run.svg")],
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("%d switches" % len(recorded), result.stdout)

    def test_all_of_10000_switches_as_fast_as_it_can(self):
        self.launch("paused:=true", "real_time_factor:=0", "rate:=1", "record:=flood.bag")
        self.wait_for_recorder()
        strips = [polygon(r["name"], r["polygon"]) for r in lossless_test.scene()["surface"]["regions"]]
        start = lossless_test.scene()["initial_state"]
        self.assertTrue(rospy.ServiceProxy(NODE + "/set_surface_map", SetSurfaceMap)(surface(*strips)).success)
        self.assertTrue(rospy.ServiceProxy(NODE + "/set_initial_state", SetInitialState)(
            initial_state(start["position"], start["velocity"])).success)
        switches = Listener(NODE + "/constraint_switch", ConstraintSwitch)
        wait_for(switches.is_connected, "a connection of our own")
        pause = rospy.ServiceProxy(NODE + "/pause", std_srvs.srv.SetBool)
        pause(False)
        switches.wait(2 * lossless_test.STRIPS)
        pause(True)
        switches.stop()
        output = self.end()
        recorded = Bag(self.file("flood.bag"))[NODE + "/constraint_switch"]
        self.assertEqual(len(recorded), 2 * lossless_test.STRIPS, output)
        self.assertEqual([m.index for m in recorded], list(range(2 * lossless_test.STRIPS)))
        self.assertTrue(all(a.header.stamp < b.header.stamp for a, b in zip(recorded, recorded[1:])))

    def test_two_in_namespaces_have_a_bag_each(self):
        with open(self.file("two.launch"), "w") as file:
            file.write(TWO)
        self.launch(files=["two.launch"])
        for name in ("left", "right"):
            node = "/%s/hybrid_sphere" % name
            wait_for(lambda: topics(node) <= self.recorded_topics(node, "/%s/record" % name), "the recorder of " + name)
            states = Listener(node + "/status", rospy.AnyMsg)
            states.wait(2)
            states.stop()
        output = self.end()
        for name, radius in (("left", 0.25), ("right", 0.1)):
            with case(name=name, output=output):
                bag = Bag(self.file(name + ".bag"))
                node = "/%s/hybrid_sphere" % name
                self.assertEqual(set(bag.messages) - {node + "/constraint_switch"},
                                 topics(node) - {node + "/constraint_switch"})
                self.assertEqual({m.pose.position.z for m in bag[node + "/state"]}, {radius})

    def test_with_sim_time_messages_have_the_time_of_the_clock(self):
        self.launch("sim_time:=true", "paused:=true", "real_time_factor:=10", "record:=clock.bag")
        wanted = topics()
        self.wait_for_recorder(wanted)
        states, statuses = Listener(NODE + "/state", SphereState), Listener(NODE + "/status", SimulatorStatus)
        states.wait()
        pause = rospy.ServiceProxy(NODE + "/pause", std_srvs.srv.SetBool)
        pause(False)
        states.wait_for_one(lambda m: m.time > 5)
        statuses.wait_for_one(lambda m: m.time > 10)  # one a second of the wall's: not the first that is recorded
        states.stop()
        statuses.stop()
        pause(True)  # what is on its way to the recorder is not more and more
        self.end()
        bag = Bag(self.file("clock.bag"))
        for topic in wanted:
            self.assertGreater(len(bag[topic]), 0, topic)
        begin, end = (bag[NODE + "/state"][i].header.stamp for i in (0, -1))
        self.assertGreater((end - begin).to_sec(), 5)
        # A message is received at the time that /clock has told last, a tick. How long it has been on its way, and how
        # much of simulated time that is, depends on what else the machine does.
        self.assertGreaterEqual(min(bag.times), begin)
        self.assertLessEqual(max(bag.times), max(m.header.stamp for m in bag[NODE + "/state"]) + rospy.Duration(600))
        self.assertGreater(len(set(bag.times)), 10)
        self.assertNotIn("/clock", bag.messages, "`rosbag play --clock` has one of its own")

    def test_a_bag_that_cannot_be_written_is_said_and_the_simulator_goes_on(self):
        self.launch("record:=no/such.bag")
        said = []
        while "process has died" not in "".join(said):
            said.append(self.launched.stdout.readline().decode())
            self.assertNotEqual(said[-1], "", said)
        states = Listener(NODE + "/state", SphereState)
        states.wait(3)
        states.stop()
        self.assertIn("record: \"%s/no/such.bag.active\" cannot be written: No such file or directory" % self.directory,
                      "".join(said) + self.end())

    def test_without_the_argument_nothing_is_recorded(self):
        self.launch()
        wait_for(lambda: rosgraph.Master("/test").getSystemState()[0] and rospy.has_param(NODE + "/rate"), "the node")
        Listener(NODE + "/state", SphereState).wait()
        self.assertNotIn("/record", {node for _, nodes in rosgraph.Master("/test").getSystemState()[1] for node in nodes})
        self.end()
        self.assertEqual(os.listdir(self.directory), [])


class Alone(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.mkdtemp()
        self.bag = os.path.join(self.directory, "words.bag")

    def tearDown(self):
        shutil.rmtree(self.directory)

    @contextlib.contextmanager
    def recorder(self, *arguments, **options):
        """The program, when it has begun."""
        process = subprocess.Popen([program("record"), "__name:=recorder", self.bag, *arguments], stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True, **options)
        try:
            self.assertEqual(process.stdout.readline(), "record: writing \"%s.active\" until Ctrl-C\n" % self.bag)
            yield process
        finally:
            process.kill()
            process.communicate()

    @staticmethod
    def words(name="words", **options):
        words = rospy.Publisher("/" + name, String, queue_size=1000, **options)
        wait_for(words.get_num_connections, "the recorder on " + name)
        return words

    def end(self, process, end):
        """Exit code and output."""
        end(process)
        out, err = process.communicate(timeout=PATIENCE)
        return process.returncode, out + err

    def assert_in_bag(self, count):
        self.assertEqual([m.data for m in Bag(self.bag)["/words"]], ["word %d" % i for i in range(count)])

    def test_it_waits_for_who_comes_later_and_ends_by_signal_or_with_its_node(self):
        ends = {"SIGINT": lambda p: p.send_signal(signal.SIGINT), "SIGTERM": lambda p: p.terminate(),
                "rosnode kill": lambda _: subprocess.run(["rosnode", "kill", "/recorder"], capture_output=True)}
        for name, end in ends.items():
            with case(name=name), self.recorder("words") as process:
                words = self.words(latch=True)
                for i in range(500):
                    words.publish("word %d" % i)
                # What has been sent is on its way while the recorder is told to end.
                code, output = self.end(process, end)
                words.unregister()
                self.assertEqual(code, 0, output)
                self.assertIn("  /words: 500\n", output)
                self.assert_in_bag(500)
                self.assertEqual(Bag(self.bag).latched, {"/words"})
                os.remove(self.bag)

    def test_a_second_signal_of_the_same_kind_closes_the_bag_at_once(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with case(signal=number), self.recorder("words") as process:
                process.send_signal(number)
                process.send_signal(number)
                output = "".join(process.communicate(timeout=PATIENCE))
                self.assertIn(process.returncode, (0, 4), output)  # nothing was sent; the first may have been enough
                self.assertEqual(len(Bag(self.bag)["/words"]), 0)
                os.remove(self.bag)

    def test_who_connects_late_has_the_latched_message(self):
        words = rospy.Publisher("/words", String, queue_size=10, latch=True)
        words.publish("word 0")
        with self.recorder("words") as process:
            wait_for(words.get_num_connections, "the recorder")
            code, output = self.end(process, lambda p: p.send_signal(signal.SIGINT))
        words.unregister()
        self.assertEqual(code, 0, output)
        self.assert_in_bag(1)

    def test_another_name_of_the_simulator(self):
        with self.recorder("--node", "plants/ball") as process:
            words = self.words("plants/ball/state")
            words.publish("word 0")
            code, output = self.end(process, lambda p: p.send_signal(signal.SIGINT))
            words.unregister()
        self.assertEqual(code, 0, output)
        self.assertIn("  /plants/ball/state: 1\n", output)

    def test_a_full_disk_ends_it_and_what_was_written_can_be_read(self):
        with open(self.bag, "w") as file:
            file.write("an earlier bag")
        largest = 3 * 10**6  # bytes of a file
        with self.recorder("words", restore_signals=False,
                           preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (largest, largest))) as process:
            words = self.words()
            text = "w" * 10**5
            wait_for(lambda: words.publish(text) or process.poll() is not None, "the end of the recorder")
            out, err = process.communicate(timeout=PATIENCE)
            words.unregister()
        self.assertEqual((process.returncode, out), (4, ""), err)
        self.assertEqual(err, "record: \"%s.active\" cannot be written: File too large\n" % self.bag)
        with open(self.bag) as file:
            self.assertEqual(file.read(), "an earlier bag")
        subprocess.run(["rosbag", "reindex", "-q", self.bag + ".active"], check=True, capture_output=True)
        recovered = Bag(self.bag + ".active")["/words"]
        self.assertGreater(len(recovered), 10)
        self.assertEqual({m.data for m in recovered}, {text})

    def test_a_second_recorder_of_one_file_is_refused(self):
        with self.recorder("words") as process:
            second = subprocess.run([program("record"), self.bag], capture_output=True, text=True, timeout=PATIENCE)
            self.assertEqual((second.returncode, second.stderr),
                             (4, "record: \"%s.active\" is being written by another process\n" % self.bag))
            words = self.words()
            words.publish("word 0")
            code, output = self.end(process, lambda p: p.send_signal(signal.SIGINT))
            words.unregister()
        self.assertEqual(code, 0, output)
        self.assert_in_bag(1)

    def test_it_ends_by_sigint_also_in_the_background_of_a_script(self):
        """A shell has what it starts with `&` ignore SIGINT."""
        with self.recorder(preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_IGN)) as process:
            code, output = self.end(process, lambda p: p.send_signal(signal.SIGINT))
        self.assertEqual(code, 0, output)

    def test_usage(self):
        for arguments in ([], ["--what", self.bag], [self.bag, "a b"], [self.bag, "_~x:=0"], [self.bag, "__name:=a/b"]):
            result = subprocess.run([program("record"), *arguments], capture_output=True, text=True)
            self.assertEqual(result.returncode, 2, result.stderr)


if __name__ == "__main__":
    rospy.init_node("record_test")
    rostest.rosrun("hybrid_sphere", "record_test", "__main__")
