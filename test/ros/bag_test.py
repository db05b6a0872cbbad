#!/usr/bin/python3
"""`simulate --bag` without a roscore: what the bag holds beside the tables of the same run.

The environment says where things are: SIMULATE, SCENES (config/), TEST_SCENES (test/ros/).
"""
import csv
import os
import resource
import shutil
import signal
import subprocess
import tempfile
import unittest

import rosbag
import rosunit

from csv_rows import parsed, state_row, switch_row
from node_client import PATIENCE, wait_for

NODE = "/hybrid_sphere"
FIRST_STAMP = 10**9  # ns, of t = 0
TYPES = {NODE + "/pose": "geometry_msgs/PoseStamped", NODE + "/twist": "geometry_msgs/TwistStamped",
         NODE + "/odom": "nav_msgs/Odometry", NODE + "/state": "hybrid_sphere/SphereState",
         NODE + "/constraint_switch": "hybrid_sphere/ConstraintSwitch", "/tf": "tf2_msgs/TFMessage",
         NODE + "/surface_map": "hybrid_sphere/SurfaceMap"}
HALTS = """
sphere: {mass: 2.0, radius: 0.25, body: solid}
initial_state: {position: [0.0, -0.1]}
surface:
  base: {law: rough, belt: [0.0, 1.0]}
  regions:
    - {name: upper, half_plane: {point: [0, 0], normal: [0, 1]}, law: rough, belt: [0.0, -1.0]}
  livelock: stop
"""


def scene(name):
    folder = "TEST_SCENES" if name == "every_ground" else "SCENES"
    return os.path.join(os.environ[folder], name + ".yaml")


def numbers(message):
    """All fields of a message in their order; a bag brings classes of its own for each connection."""
    values = [getattr(message, name) for name in message.__slots__]
    return [number for value in values for number in (numbers(value) if hasattr(value, "__slots__") else [value])]


def stamp_of(message):
    header = message.transforms[0].header if hasattr(message, "transforms") else message.header
    return header.stamp


class BagTest(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.mkdtemp()
        self.bag = self.file("run.bag")

    def tearDown(self):
        shutil.rmtree(self.directory)

    def file(self, name):
        return os.path.join(self.directory, name)

    def simulate(self, *arguments, **options):
        return subprocess.run([os.environ["SIMULATE"], *arguments], capture_output=True, text=True, **options)

    def done(self, *arguments):
        result = self.simulate(*arguments, "--quiet")
        self.assertEqual((result.returncode, result.stdout), (0, ""), result.stderr)

    def run_with_tables(self, name, *arguments):
        """The rows of the two tables, and the messages by topic."""
        states, switches = self.file("states.csv"), self.file("switches.csv")
        self.done(scene(name), "--bag", self.bag, "--states", states, "--switches", switches, *arguments)
        return self.rows(states), self.rows(switches), self.messages()

    @staticmethod
    def rows(path):
        with open(path, newline="") as file:
            return [parsed(row) for row in csv.DictReader(file)]

    def messages(self):
        messages = {topic: [] for topic in TYPES}
        with rosbag.Bag(self.bag) as bag:
            for topic, message, time in bag.read_messages():
                self.assertEqual(time, stamp_of(message), topic)
                messages[topic].append(message)
        return messages


class Contents(BagTest):
    def test_states_and_switches_are_those_of_the_tables_to_the_bit(self):
        for name in ("paper", "bounce_back", "conveyor", "every_ground"):
            states, switches, messages = self.run_with_tables(name, "--rate", "333")
            self.assertGreater(len(switches), 0, name)
            self.assertEqual([state_row(m) for m in messages[NODE + "/state"]], states, name)
            self.assertEqual([switch_row(m) for m in messages[NODE + "/constraint_switch"]], switches, name)

    def test_all_topics_of_a_tick_say_the_same(self):
        _, _, messages = self.run_with_tables("checkerboard")
        states = messages[NODE + "/state"]
        poses = [numbers(m.pose) for m in states]
        self.assertEqual([numbers(m.pose) for m in messages[NODE + "/pose"]], poses)
        self.assertEqual([numbers(m.pose.pose) for m in messages[NODE + "/odom"]], poses)
        self.assertEqual([numbers(m.transforms[0].transform) for m in messages["/tf"]], poses)
        self.assertEqual([numbers(m.twist) for m in messages[NODE + "/twist"]], [numbers(m.twist) for m in states])

    def test_stamps_count_from_one_second(self):
        _, _, messages = self.run_with_tables("bounce_back", "--times", "0,0.25,1.5,4000000000")
        stamps = [stamp_of(m).to_nsec() for m in messages[NODE + "/state"]]
        self.assertEqual(stamps, [FIRST_STAMP + round(t * 10**9) for t in (0, 0.25, 1.5, 4000000000)])
        for m in messages[NODE + "/constraint_switch"]:
            self.assertAlmostEqual(m.header.stamp.to_nsec() - FIRST_STAMP, m.time * 1e9, delta=1)

    def test_frames_are_those_of_the_node(self):
        _, _, messages = self.run_with_tables("paper")
        for topic in TYPES:
            for m in messages[topic][:1]:
                header = m.transforms[0].header if topic == "/tf" else m.header
                self.assertEqual(header.frame_id, "world", topic)
        self.assertEqual(messages["/tf"][0].transforms[0].child_frame_id, "sphere")
        self.assertEqual(messages[NODE + "/odom"][0].child_frame_id, "sphere")

    def test_the_ground_comes_once_and_first(self):
        self.done(scene("conveyor"), "--bag", self.bag)
        with rosbag.Bag(self.bag) as bag:
            topic, ground, time = next(bag.read_messages())
            self.assertEqual((topic, time.to_nsec()), (NODE + "/surface_map", FIRST_STAMP))
            self.assertEqual(bag.get_message_count(NODE + "/surface_map"), 1)
        self.assertEqual([region.name for region in ground.regions], ["north", "south", "back", "onward", "against"])
        self.assertEqual(ground.regions[3].belt.y, 0.3)

    def test_the_reaction_is_what_accelerates_the_sphere(self):
        _, _, messages = self.run_with_tables("incline")
        on_grass = [m for m in messages[NODE + "/state"] if m.region == "grass"]
        first, last = on_grass[0], on_grass[-1]
        duration = last.time - first.time
        self.assertGreater(duration, 0.5)
        mass, gravity = self.mass_and_gravity("incline")
        for axis, component in enumerate("xy"):
            v1, v2 = (getattr(m.twist.linear, component) for m in (first, last))
            force = mass * gravity[axis] + getattr(first.reaction, component)
            # Two velocities, each right to some ulps.
            bound = mass * 16 * 2.3e-16 * max(abs(v1), abs(v2), 1) / duration + 16 * 2.3e-16 * mass * 10
            self.assertAlmostEqual(mass * (v2 - v1) / duration, force, delta=bound)
        self.assertEqual(first.reaction.z, -mass * gravity[2])

    def mass_and_gravity(self, name):
        import yaml
        with open(scene(name)) as file:
            keys = yaml.safe_load(file)
        return float(keys["sphere"]["mass"]), [float(g) for g in keys["gravity"]]


class Files(BagTest):
    def test_rosbag_knows_the_topics_and_their_types(self):
        self.done(scene("checkerboard"), "--bag", self.bag)
        with rosbag.Bag(self.bag) as bag:
            topics = bag.get_type_and_topic_info().topics
            self.assertEqual({topic: info.msg_type for topic, info in topics.items()}, TYPES)
            latched = {c.topic for c in bag._get_connections() if c.header.get("latching") in ("1", b"1")}
        self.assertEqual(latched, {NODE + "/surface_map", NODE + "/constraint_switch"})
        for command in ("info", "check"):
            result = subprocess.run(["rosbag", command, self.bag], capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_equal_runs_give_equal_files(self):
        other = self.file("other.bag")
        for path in (self.bag, other):
            self.done(scene("every_ground"), "--bag", path)
        with open(self.bag, "rb") as one, open(other, "rb") as two:
            self.assertEqual(one.read(), two.read())

    def test_all_up_to_a_halt_is_in_a_whole_bag(self):
        path = self.file("halts.yaml")
        with open(path, "w") as file:
            file.write(HALTS)
        states, switches = self.file("states.csv"), self.file("switches.csv")
        result = self.simulate(path, "--bag", self.bag, "--states", states, "--switches", switches)
        self.assertEqual(result.returncode, 4)
        self.assertIn("stopped at t = ", result.stderr)
        messages = self.messages()
        self.assertEqual([state_row(m) for m in messages[NODE + "/state"]], self.rows(states))
        self.assertEqual([switch_row(m) for m in messages[NODE + "/constraint_switch"]], self.rows(switches))
        self.assertGreater(len(messages[NODE + "/constraint_switch"]), 0)


class Signals(BagTest):
    def test_all_up_to_the_signal_is_in_a_whole_bag_and_in_the_tables(self):
        states, switches = self.file("states.csv"), self.file("switches.csv")
        for number, name in ((signal.SIGINT, "Interrupt"), (signal.SIGTERM, "Terminated")):
            process = subprocess.Popen([os.environ["SIMULATE"], scene("checkerboard"), "--duration", "1e6", "--rate", "1000",
                                        "--bag", self.bag, "--states", states, "--switches", switches, "--quiet"],
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            wait_for(lambda: os.path.exists(self.bag) and os.path.getsize(self.bag) > 10**7, "the bag")
            process.send_signal(number)
            _, err = process.communicate(timeout=PATIENCE)
            self.assertEqual(process.returncode, 128 + number, err)
            self.assertRegex(err, r"^simulate: ended by signal %d \(%s\) at t = .* s: everything up to there is written\n$"
                             % (number, name))
            messages = self.messages()
            self.assertEqual([state_row(m) for m in messages[NODE + "/state"]], self.rows(states), name)
            self.assertEqual([switch_row(m) for m in messages[NODE + "/constraint_switch"]], self.rows(switches), name)
            self.assertGreater(len(messages[NODE + "/state"]), 4096, name)
            os.remove(self.bag)


class Refusals(BagTest):
    def assert_refused(self, code, words, *arguments, **options):
        result = self.simulate(*arguments, **options)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertIn(words, result.stderr)
        return result

    def test_usage(self):
        self.assert_refused(2, "--bag: \"\" is refused; allowed: a file", scene("paper"), "--bag", "")
        self.assert_refused(2, "--bag: \"-\" is refused; allowed: a file", scene("paper"), "--bag", "-")
        self.assert_refused(2, "a file other than that of --states", scene("paper"), "--states", self.bag, "--bag", self.bag)
        self.assert_refused(2, "--duration: 5e+09 s is refused; allowed: at most 4294967293 s with --bag",
                            scene("paper"), "--duration", "5e9", "--rate", "1e-9", "--bag", self.bag)
        self.assertFalse(os.path.exists(self.bag))

    def test_the_scene_is_not_overwritten(self):
        path = shutil.copy(scene("paper"), self.file("scene.yaml"))
        self.assert_refused(2, "a file other than the scene", path, "--bag", path)
        self.done(path, "--bag", self.bag)

    def test_a_bag_that_cannot_be_opened(self):
        self.assert_refused(4, "no/such.bag\" cannot be written: No such file or directory", scene("paper"), "--bag",
                            self.file("no/such.bag"))
        self.assert_refused(4, "\"/dev/full\" cannot be written: ", scene("paper"), "--bag", "/dev/full")

    def test_a_disk_that_becomes_full(self):
        largest = 3 * 10**6  # bytes of a file; the bag would have several times as many
        switches = self.file("switches.csv")
        self.assert_refused(4, "run.bag\" cannot be written: File too large", scene("paper"), "--rate", "1000", "--bag",
                            self.bag, "--switches", switches, restore_signals=False,
                            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (largest, largest)))
        self.assertEqual(len(self.rows(switches)), 1)
        with self.assertRaises(rosbag.ROSBagUnindexedException):
            rosbag.Bag(self.bag)
        subprocess.run(["rosbag", "reindex", "-q", self.bag], check=True, capture_output=True)
        with rosbag.Bag(self.bag) as bag:
            self.assertGreater(bag.get_message_count(NODE + "/state"), 1000)


if __name__ == "__main__":
    rosunit.unitrun("hybrid_sphere", "bag_test", "__main__")
