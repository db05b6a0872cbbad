#!/usr/bin/python3
"""Any system as a node: switches to the bit those of `three_stage run`, joint states, input, time, a plugin."""
import csv
import io
import math
import os
import signal
import subprocess
import tempfile
import threading
import unittest
import warnings
import xmlrpc.client

import rosbag
import rosgraph
import rospy
import rostest
from hybrid_sphere.msg import SimulatorStatus, SystemState, SystemSwitch
from hybrid_sphere.srv import GetState, Step
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import SetBool, Trigger
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

from node_client import PATIENCE, Console, Listener, case, program, wait_for


def three_stage(system, *arguments):
    """The rows of the CSV that `three_stage run` writes to standard output, without their names."""
    output = subprocess.run([program("three_stage"), "run", system, "--quiet", *arguments], check=True,
                            stdout=subprocess.PIPE)
    return list(csv.reader(io.StringIO(output.stdout.decode())))[1:]


def switch_row(m):
    """A switch as a row of three_stage: the same numbers in the same order."""
    numbers = [*m.q, *m.v_before, *m.v_after, *m.multipliers, *m.impulse, m.rank, m.energy_before, m.energy_after,
               m.kinetic_energy_before, m.kinetic_energy_after]
    return [m.index, m.time, ";".join(m.applied), ";".join(m.released), *numbers]


def parsed(row):
    return [int(row[0]), float(row[1]), row[2], row[3], *map(float, row[4:])]


def received_by(node):
    """The topics on which a node is connected."""
    try:
        _, _, connections = xmlrpc.client.ServerProxy(rosgraph.Master("/test").lookupNode(node)).getBusInfo("/test")
    except (OSError, rosgraph.MasterException):  # not there yet
        return set()
    return {c[4] for c in connections if c[2] == "i" and c[5]}


class Node:
    def __init__(self, name):
        self.name = "/" + name
        self.switches = Listener(self.name + "/switch", SystemSwitch)
        self.joints = Listener(self.name + "/joint_states", JointState)
        self.pause = self.service("pause", SetBool)
        self.step = self.service("step", Step)
        self.reset = self.service("reset", Trigger)
        self.get_state = self.service("get_state", GetState)
        with warnings.catch_warnings():  # rospy warns of what lock-step needs: publish() returns when all is sent
            warnings.simplefilter("ignore")
            self.input = rospy.Publisher(self.name + "/input", Float64MultiArray, queue_size=None)
        wait_for(lambda: self.switches.is_connected() and self.joints.is_connected()
                 and self.input.get_num_connections(), "the topics of " + self.name)

    def service(self, name, kind):
        rospy.wait_for_service(self.name + "/" + name, PATIENCE)
        return rospy.ServiceProxy(self.name + "/" + name, kind)

    def start(self):
        """Back to the initial state, paused; all that comes later is from then on."""
        assert self.pause(True).success
        self.begin = self.step(1e-3).system[0].header.stamp
        assert self.reset().success

    def advance(self, duration):
        answer = self.step(duration)
        assert answer.success, answer.message
        return answer

    def since_start(self, listener):
        return [m for m in list(listener.messages) if m.header.stamp > self.begin]

    def all_switches(self, count):
        wait_for(lambda: len(self.since_start(self.switches)) >= count, "%d switches of %s" % (count, self.name))
        return self.since_start(self.switches)

    def command(self, *values):
        """Sends an input that the node has taken when this returns, as it takes what comes in order."""
        self.input.publish(Float64MultiArray(data=values))
        assert self.pause(True).message == "already paused"


class System(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.nodes = {name: Node(name) for name in ("sleigh", "particle", "ball", "sledge")}

    def started(self, name):
        node = self.nodes[name]
        node.start()
        return node

    def test_stepwise_every_switch_is_that_of_three_stage_to_the_bit_with_its_own_stamp(self):
        for name, system, duration, numbers in (
                ("sleigh", "chaplygin_sleigh", 4, ()),
                ("particle", "visiting_particle", 6, ()),
                ("ball", "paper_sphere_quasi", 3, ("--set", "R=0.5", "--set", "m=3"))):
            with case(system=system):
                rows = [parsed(row) for row in three_stage(system, *numbers, "--duration", str(duration), "--switches", "-")]
                self.assertTrue(rows)
                node = self.started(name)
                start = node.get_state().system[0].header.stamp
                steps = [duration * part for part in (0.3, 0.01, 0.44)]
                counted = sum(node.advance(step).switches for step in steps)
                left = duration - node.get_state().system[0].time
                counted += node.advance(left).switches
                self.assertEqual(counted, len(rows))
                switches = node.all_switches(len(rows))
                self.assertEqual([switch_row(m) for m in switches], rows)
                for message in switches:
                    self.assertAlmostEqual((message.header.stamp - start).to_sec(), message.time, delta=2e-9)

    def test_running_freely_no_switch_is_lost(self):
        for name, system, numbers in (("particle", "visiting_particle", ()),
                                      ("ball", "paper_sphere_quasi", ("--set", "R=0.5", "--set", "m=3", "--duration", "3"))):
            with case(system=system):
                node = self.started(name)
                start = node.get_state().system[0].header.stamp
                node.pause(False)
                node.all_switches(1)
                wait_for(lambda: node.get_state().system[0].time > 2.5, "the time 2.5 s")
                node.pause(True)
                end = node.get_state().system[0]
                rows = [row for row in map(parsed, three_stage(system, *numbers, "--switches", "-")) if row[1] <= end.time]
                self.assertTrue(rows)
                switches = node.all_switches(len(rows))
                # As fast as it can it has come further than the table.
                self.assertEqual([switch_row(m) for m in switches[:len(rows)]], rows)
                self.assertEqual([m.index for m in switches], list(range(len(switches))))
                # Stamps go on while time is held up by a machine that is busy.
                self.assertTrue(all((m.header.stamp - start).to_sec() > m.time - 2e-9 for m in switches))
                self.assertTrue(all(a.header.stamp < b.header.stamp for a, b in zip(switches, switches[1:])))

    def test_of_many_switches_none_is_lost(self):
        node = self.started("particle")
        many = node.advance(1000).switches
        self.assertGreater(many, 1000)
        switches = node.all_switches(many)
        self.assertEqual([m.index for m in switches], list(range(many)))
        self.assertTrue(all(a.header.stamp < b.header.stamp for a, b in zip(switches, switches[1:])))
        self.assertEqual([(m.applied, m.released) for m in switches[-2:]], [(["slope"], []), ([], ["slope"])]
                         if switches[-1].released else [([], ["slope"]), (["slope"], [])])

    def test_plant_launch_records(self):
        with tempfile.TemporaryDirectory() as folder:
            bag = os.path.join(folder, "run.bag")
            launched = subprocess.Popen(["roslaunch", "hybrid_sphere", "plant.launch", "name:=recorded", "paused:=true",
                                         "rviz:=false", "rate:=50", "record:=" + bag], stdout=subprocess.DEVNULL)
            try:
                node = Node("recorded")
                topics = {"/recorded/joint_states", "/recorded/switch"}
                wait_for(lambda: topics <= received_by("/record"), "the recorder")
                state = node.advance(1).system[0]
                self.assertEqual(state.active, ["blade"])
                node.switches.wait(1)
            finally:
                launched.send_signal(signal.SIGINT)
                launched.wait(PATIENCE)
            with rosbag.Bag(bag) as recorded:
                count = {topic: info.message_count for topic, info in recorded.get_type_and_topic_info().topics.items()}
        self.assertEqual(count["/recorded/switch"], 1)
        self.assertGreaterEqual(count["/recorded/joint_states"], 50)

    def test_the_last_switch_is_latched(self):
        node = self.started("sleigh")
        node.advance(1)
        last = node.all_switches(1)[-1]
        late = Listener(node.name + "/switch", SystemSwitch)
        self.assertEqual(late.wait()[0], last)

    def test_joint_states_are_q_v_and_the_forces_of_the_constraints(self):
        node = self.started("sleigh")
        for time in (0.25, 0.5, 1.25):
            state = node.advance(time - node.get_state().system[0].time).system[0]
            joints = wait_for(lambda: [m for m in node.since_start(node.joints)
                                       if m.header.stamp == state.header.stamp], "the joint state")[0]
            row = [float(x) for x in three_stage("chaplygin_sleigh", "--times", "%r,4" % time, "--states", "-")[0]]
            with case(time=time):
                self.assertEqual(joints.name, ["x", "y", "theta"])
                self.assertEqual([state.time, state.stage, *joints.position, *joints.velocity], row[:8])
                force = row[8]
                self.assertEqual(list(state.multipliers), [force])
                expected = [-force * math.sin(row[4]), force * math.cos(row[4]), 0]
                for mine, theirs in zip(joints.effort, expected):
                    self.assertAlmostEqual(mine, theirs, delta=1e-12)

    def test_quasi_velocities_have_entries_of_their_own(self):
        node = self.started("ball")
        state = node.advance(0.01).system[0]
        joints = wait_for(lambda: [m for m in node.since_start(node.joints)
                                   if m.header.stamp == state.header.stamp], "the joint state")[0]
        self.assertEqual(joints.name, ["x", "y", "qw", "qx", "qy", "qz", "x_dot", "y_dot", "w1", "w2", "w3"])
        self.assertEqual((len(joints.position), len(joints.velocity), len(joints.effort)), (11, 11, 11))
        self.assertEqual(tuple(joints.position[:6]), state.q)
        self.assertEqual(tuple(joints.velocity[6:]), state.v)
        self.assertEqual(tuple(joints.effort[6:]), state.constraint_forces)

    def test_time_as_of_the_sphere(self):
        node = self.started("sleigh")
        answer = node.advance(0.0537)
        self.assertEqual((answer.system[0].time, answer.state.time, answer.switches), (0.0537, 0.0537, 0))
        times = [(m.header.stamp - node.since_start(node.joints)[0].header.stamp).to_nsec()
                 for m in wait_for(lambda: node.since_start(node.joints)[6:] and node.since_start(node.joints), "ticks")]
        self.assertEqual(times, [n * 10000000 for n in range(6)] + [53700000])
        status = Listener(node.name + "/status", SimulatorStatus).wait_for_one(lambda m: m.paused)
        self.assertEqual((status.time, status.switches, status.message), (0.0537, 0, ""))
        refused = node.step(-1)
        self.assertFalse(refused.success)
        self.assertIn("is refused; allowed: a number greater than 0", refused.message)
        node.pause(False)
        self.assertIn("only a paused one takes steps", node.step(1).message)

    def test_a_controller_in_lock_step(self):
        """Heads the sleigh, driven along its blade, at the direction 1 by a torque; twice, to the same bits."""
        def run():
            node = self.started("sleigh")
            state, seen = node.get_state().system[0], []
            for _ in range(150):
                force = 2 * (1 - state.v[0] * math.cos(state.q[2]) - state.v[1] * math.sin(state.q[2]))
                torque = 6 * (1 - state.q[2]) - 4 * state.v[2]
                command = (force * math.cos(state.q[2]), force * math.sin(state.q[2]), torque)
                node.command(*command)
                state = node.advance(0.04).system[0]
                self.assertEqual(state.input, command)
                seen.append((state.time, state.q, state.v, state.multipliers))
            return seen

        first = run()
        self.assertAlmostEqual(first[-1][0], 6, delta=1e-9)
        self.assertAlmostEqual(first[-1][1][2], 1, delta=0.05)
        self.assertEqual(run(), first)
        self.assertEqual(self.started("sleigh").get_state().system[0].input, (0, 0, 0))

    def test_what_is_no_input_is_dropped_with_a_reason(self):
        node = self.started("sleigh")
        console = Console(node.name)
        node.command(1, 2, 3)
        before = node.advance(0.1).system[0]
        for wrong in ((1, 2), (math.nan, 0, 0), (0, 0, math.inf), ()):
            with case(input=wrong):
                node.command(*wrong)
                self.assertEqual(node.advance(1e-3).system[0].input, before.input)
        self.assertIn("input: message dropped (1 so far): data: 2 numbers is refused; allowed: 3 finite numbers",
                      console.wait_for_next(4, 0))

    def test_a_step_that_takes_for_ever_is_answered_meanwhile_and_ended_by_a_pause(self):
        """A force of 1e16 N turns the sleigh many million times."""
        node = self.started("sleigh")
        node.command(1e16, 0, 0)
        answers = []
        step = threading.Thread(target=lambda: answers.append(node.step(0.5)))
        step.start()
        status = Listener(node.name + "/status", SimulatorStatus)
        status.wait_for_one(lambda m: m.behind > 0)
        self.assertTrue(node.get_state().success)
        self.assertEqual(answers, [])
        self.assertTrue(node.pause(True).success)
        step.join(PATIENCE)
        self.assertEqual((answers[0].success, answers[0].message), (False, "the step was ended by ~pause"))
        self.assertLess(answers[0].system[0].time, 0.5)
        self.assertTrue(node.reset().success)

    def test_poses_are_transforms_and_markers(self):
        node = self.started("sleigh")
        transforms, markers = Listener("/tf", TFMessage), Listener(node.name + "/markers", MarkerArray)
        state = node.advance(0.7).system[0]
        transform = transforms.wait_for_one(
            lambda m: m.transforms[0].header.stamp == state.header.stamp).transforms[0]
        self.assertEqual((transform.header.frame_id, transform.child_frame_id), ("world", "chaplygin_sleigh"))
        self.assertEqual((transform.transform.translation.x, transform.transform.translation.y), state.q[:2])
        self.assertAlmostEqual(transform.transform.rotation.z, math.sin(state.q[2] / 2), delta=1e-15)
        marker = markers.wait()[0].markers[0]
        self.assertEqual((marker.header.frame_id, marker.frame_locked, marker.type), ("chaplygin_sleigh", True, Marker.CUBE))
        self.assertEqual((marker.pose.position.x, marker.pose.position.y, marker.pose.orientation.w), (0, 0, 1))

    def test_the_trail_has_a_colour_of_its_own_where_a_constraint_holds(self):
        node = self.started("sleigh")
        markers = Listener(node.name + "/markers", MarkerArray)
        places = []
        for duration in (0.2, 0.2, 0.2):  # the blade comes at 0.5 s
            places.append(tuple(node.advance(duration).system[0].q[:2]))
            drawn = len(markers.messages)
            wait_for(lambda: len(markers.messages) >= drawn + 2, "markers of this state")
        trail = markers.wait_for_one(lambda m: m.markers[1].ns == "trail" and len(m.markers[1].points) >= 3
                                     and m.markers[1].points[-1].x == places[-1][0]).markers[1]
        self.assertEqual((trail.type, len(trail.colors)), (Marker.LINE_STRIP, len(trail.points)))
        self.assertEqual([(p.x, p.y) for p in trail.points[-3:]], places)
        self.assertEqual(trail.colors[-2], trail.colors[-3])
        self.assertNotEqual(trail.colors[-1], trail.colors[-2])

    def test_frames_have_a_prefix(self):
        node = self.started("ball")
        transforms = Listener("/tf", TFMessage)
        node.advance(0.1)
        transforms.wait_for_one(lambda m: m.transforms[0].child_frame_id == "second_paper_sphere_quasi")

    def test_a_system_of_another_package(self):
        """The sledge's formulas: straight and turning evenly until the snow at x = 1 takes its sideways velocity."""
        node = self.started("sledge")
        state = node.advance(1.5).system[0]
        self.assertEqual(state.active, ["runner"])
        switch = node.all_switches(1)[0]
        self.assertAlmostEqual(switch.time, 1, delta=1e-9)
        direction = (math.cos(0.5), math.sin(0.5))
        along = direction[0] + 0.4 * direction[1]
        for mine, theirs in zip(switch.v_after, (along * direction[0], along * direction[1], 0.3)):
            self.assertAlmostEqual(mine, theirs, delta=1e-8)
        self.assertAlmostEqual(switch.multipliers[0], -30 * (0.4 * direction[0] - direction[1]), delta=1e-7)
        self.assertAlmostEqual(switch.kinetic_energy_before, 15 * 1.16 + 3 * 0.09, delta=1e-7)

    def test_the_input_of_a_plugin_drives_it(self):
        node = self.started("sledge")
        node.command(0, 12)
        self.assertAlmostEqual(node.advance(0.5).system[0].v[2], 0.3 + 12 / 6 * 0.5, delta=1e-9)
        states = Listener(node.name + "/state", SystemState)
        self.assertEqual(states.wait()[0].input, (0, 12))

    def test_what_is_refused_ends_the_node_with_the_reason(self):
        for arguments, reason in (
                (["_system:=no_such"], 'system: "no_such" is refused; allowed: nonholonomic_particle'),
                ([], "system: is missing; allowed: the name of a system"),
                (["_system:=chaplygin_sleigh", "_accuracy:=2"], "accuracy: 2 is refused; allowed: "),
                (["_system:=chaplygin_sleigh", "_no_such:=2"], "no_such: 2 is refused; allowed: system, values"),
                (["_system:=chaplygin_sleigh", "_values/m:=-1"], "values: m = -1 is refused; allowed: "),
                (["_system:=chaplygin_sleigh", "_values:=3"], "values: 3 is refused; allowed: a map of numbers"),
                (["_system:=chaplygin_sleigh", "_values/no_such:=1"], 'values: there is no parameter "no_such"'),
                (["_system:=chaplygin_sleigh", "_frame_prefix:=//a"], 'frame_prefix: "//a" is refused; allowed: the name'),
                (["_system:=chaplygin_sleigh", "_rate:=-1"], "rate: -1 is refused")):
            with case(arguments=arguments):
                done = subprocess.run([program("three_stage_node"), "__name:=refused", *arguments],
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=PATIENCE)
                text = done.stdout.decode()
                self.assertEqual(done.returncode, 3, text)
                self.assertIn("system refused: ", text)
                self.assertIn(reason, text)
                if rospy.has_param("/refused"):
                    rospy.delete_param("/refused")


if __name__ == "__main__":
    rospy.init_node("system_test")
    rostest.rosrun("hybrid_sphere", "system_test", System)
