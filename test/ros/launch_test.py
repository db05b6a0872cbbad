#!/usr/bin/python3
"""sim.launch and its arguments; parameters that the node refuses."""
import os
import re
import resource
import shutil
import signal
import subprocess
import tempfile
import unittest
import xmlrpc.client

import rosgraph
import rospy
import rostest
import yaml
from geometry_msgs.msg import PoseStamped, WrenchStamped
from hybrid_sphere.msg import SceneView, SimulatorStatus, SphereState, SurfaceMap
from rosgraph_msgs.msg import Clock

from node_client import PATIENCE, Listener, case, program

NODE = "/hybrid_sphere"
SPHERE = {"mass": 1.0, "radius": 0.1, "body": "solid"}


class Launch(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.mkdtemp()
        self.launched = None

    def tearDown(self):
        if self.launched and self.launched.poll() is None:
            self.launched.send_signal(signal.SIGINT)
            self.launched.communicate(timeout=PATIENCE)
        shutil.rmtree(self.directory)

    def launch(self, *arguments, file="sim.launch", **variables):
        """PWD is what a shell sets it to."""
        environment = {key: value for key, value in os.environ.items() if key != "DISPLAY"}
        environment.update({"PWD": self.directory}, **variables)
        self.launched = subprocess.Popen(["roslaunch", "hybrid_sphere", file, *arguments], env=environment,
                                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, cwd=self.directory)

    def first_state(self):
        listener = Listener(NODE + "/state", SphereState)
        state = listener.wait()[0]
        listener.stop()
        return state

    def scene_file(self, scene, name="my scene.yaml"):
        path = os.path.join(self.directory, name)
        with open(path, "w") as file:
            yaml.safe_dump(scene, file)
        return path

    def test_the_default_is_the_papers_scene_without_rviz_where_there_is_no_display(self):
        self.launch()
        self.assertEqual(self.first_state().pose.position.z, 0.25)
        self.assertEqual(rospy.get_param(NODE + "/rate"), 100)
        self.assertNotIn("/rviz", [node for _, nodes in rosgraph.Master("/test").getSystemState()[1] for node in nodes])

    def test_scene_by_stem_and_rate(self):
        self.launch("scene:=archipelago", "rate:=50.5", "rviz:=false")
        state = self.first_state()
        self.assertEqual(state.pose.position.z, 0.15)
        self.assertEqual(state.time, round(state.time * 50.5) / 50.5)

    def test_name_frames_method_and_accuracy(self):
        self.launch("name:=ball", "world_frame:=map", "sphere_frame:=puck", "method:=dopri5", "accuracy:=1e-6",
                    "command_timeout:=0", "clock:=lead", "rviz:=false")
        status = Listener("/ball/status", SimulatorStatus)
        self.assertEqual(status.wait()[0].method, "dopri5")
        pose = Listener("/ball/pose", PoseStamped)
        self.assertEqual(pose.wait()[0].header.frame_id, "map")
        self.assertEqual((rospy.get_param("/ball/accuracy"), rospy.get_param("/ball/command_timeout")), (1e-6, 0))
        clock = Listener("/clock", Clock)
        clock.wait(2)
        view = yaml.safe_load(subprocess.run([program("rviz_scene"), "--node", "ball", "--print"], check=True,
                                             stdout=subprocess.PIPE, timeout=PATIENCE).stdout)["Visualization Manager"]
        self.assertEqual(view["Global Options"]["Fixed Frame"], "map")
        self.assertIn("/ball/markers", [d.get("Marker Topic") for d in view["Displays"]])
        self.assertIn("/initialpose", [t.get("Topic") for t in view["Tools"]])
        self.assertEqual(view["Views"]["Current"]["Target Frame"], "ball_view")
        for listener in (status, pose, clock):
            listener.stop()
        rospy.delete_param("/use_sim_time")

    def test_the_program_that_opens_rviz_becomes_rviz(self):
        """No process of Python stays beside rviz, and no file is left over at each start."""
        self.launch("rviz:=false")
        self.first_state()
        stand_in = os.path.join(self.directory, "rosrun")
        with open(stand_in, "w") as file:
            file.write("#!/bin/sh\necho $$ \"$@\"\n")
        os.chmod(stand_in, 0o755)
        environment = {**os.environ, "PATH": self.directory + ":" + os.environ["PATH"], "ROS_HOME": self.directory}
        for _ in range(2):
            opened = subprocess.Popen([program("rviz_scene"), "__name:=rviz"], env=environment, stdout=subprocess.PIPE)
            process, package, name, option, path, remap = opened.communicate(timeout=PATIENCE)[0].decode().split()
            self.assertEqual(int(process), opened.pid)
            self.assertEqual((package, name, option, remap), ("rviz", "rviz", "--display-config", "__name:=rviz"))
            with open(path) as file:
                self.assertIn("hybrid_sphere_view", file.read())
        self.assertEqual(os.listdir(os.path.dirname(path)), [os.path.basename(path)])
        self.assertNotIn("rviz_scene", " ".join(rosgraph.Master("/test").getSystemState()[1][0][1]))

    def test_the_view_of_rviz_is_that_of_the_node(self):
        self.launch("scene:=bowling", "rviz:=false")
        listener = Listener(NODE + "/view", SceneView)
        message = listener.wait()[0]
        listener.stop()
        views = yaml.safe_load(subprocess.run([program("rviz_scene"), "--print"], check=True, stdout=subprocess.PIPE,
                                              timeout=PATIENCE).stdout)["Visualization Manager"]["Views"]
        current = views["Current"]
        self.assertEqual((current["Target Frame"], current["Distance"]), ("hybrid_sphere_view", message.distance))
        self.assertEqual(current["Focal Point"], {"X": 0, "Y": 0, "Z": 0})
        whole = views["Saved"][0]
        self.assertEqual((whole["Name"], whole["Target Frame"], whole["Distance"]), ("whole", "world", message.whole_distance))
        self.assertGreater(message.whole_distance, 2 * message.distance, "the lane is much longer than the picture")

    def test_scene_by_path(self):
        self.launch("scene:=" + self.scene_file({"sphere": dict(SPHERE, radius=0.75)}), "rviz:=false")
        self.assertEqual(self.first_state().pose.position.z, 0.75)
        self.assertEqual(rospy.get_param(NODE + "/sphere/radius"), 0.75)

    def test_scene_by_a_path_from_where_roslaunch_is_typed_with_another_ending(self):
        self.scene_file({"sphere": dict(SPHERE, radius=0.5)}, "mine.yml")
        self.launch("scene:=mine.yml", "rviz:=false")
        self.assertEqual(self.first_state().pose.position.z, 0.5)

    def test_scene_by_a_path_from_the_home_directory_with_the_tilde_that_bash_leaves(self):
        self.scene_file({"sphere": dict(SPHERE, radius=0.625)})
        self.launch("scene:=~/my scene.yaml", "rviz:=false", HOME=self.directory, ROS_HOME=self.directory)
        self.assertEqual(self.first_state().pose.position.z, 0.625)

    def test_a_scene_that_is_not_there_is_refused_with_those_that_are(self):
        self.launch("scene:=papper", "rviz:=false")
        output = self.launched.communicate(timeout=PATIENCE)[0].decode()
        self.assertIn('scene_file: "papper" (there is no file %s/papper; did you mean paper?) is refused; allowed: the path of a '
                      "file, or a scene of the package: archipelago, bounce_back, " % self.directory, output)
        self.assertIn("exit code 3", output)

    def test_realtime_priority_is_that_of_the_loop_or_it_says_what_the_system_does_not_permit(self):
        allowed = subprocess.run(["chrt", "--fifo", "7", "true"], capture_output=True).returncode == 0
        self.launch("realtime_priority:=7", "rviz:=false")
        self.first_state()
        process = xmlrpc.client.ServerProxy(rosgraph.Master("/test").lookupNode(NODE)).getPid("/test")[2]
        with open("/proc/%d/status" % process) as file:
            locked = [int(line.split()[1]) for line in file if line.startswith("VmLck")][0]
        if allowed:
            self.assertEqual(os.sched_getscheduler(process) & ~os.SCHED_RESET_ON_FORK, os.SCHED_FIFO)
            self.assertEqual(os.sched_getparam(process).sched_priority, 7)
            tasks = [int(task) for task in os.listdir("/proc/%d/task" % process)]
            real_time = [t for t in tasks if os.sched_getscheduler(t) & ~os.SCHED_RESET_ON_FORK == os.SCHED_FIFO]
            self.assertEqual(len(real_time), 2)  # the loop and roscpp's sockets
        self.launched.send_signal(signal.SIGINT)
        output = self.launched.communicate(timeout=PATIENCE)[0].decode()
        self.assertEqual("realtime_priority: the system does not permit" in output, not allowed or locked == 0, output)

    def test_without_realtime_priority_nothing_is_real_time(self):
        self.launch("rviz:=false")
        self.first_state()
        process = xmlrpc.client.ServerProxy(rosgraph.Master("/test").lookupNode(NODE)).getPid("/test")[2]
        self.assertEqual({os.sched_getscheduler(int(t)) for t in os.listdir("/proc/%d/task" % process)}, {os.SCHED_OTHER})

    def test_the_controller_of_the_example_steers(self):
        self.launch("rviz:=false", "x:=5", "y:=0", file="steer.launch")
        commands = Listener(NODE + "/cmd_wrench", WrenchStamped)
        self.assertGreater(commands.wait()[0].wrench.force.x, 0)  # from x = -3 m with 1 m/s: 4 * 8 - 6 * 1 N
        commands.stop()

    def test_images_are_found_beside_the_scene(self):
        with open(os.path.join(self.directory, "cells.pgm"), "w") as file:
            file.write("P2 2 1 255\n0 255\n")
        image = {"file": "cells.pgm", "resolution": 1.0, "origin": [10, 10], "rough_above": 0.5}
        self.launch("scene:=" + self.scene_file({"sphere": SPHERE, "surface": {"image": image}}), "rviz:=false")
        maps = Listener(NODE + "/surface_map", SurfaceMap)
        self.assertEqual(maps.wait()[0].regions[0].name, "image_0")
        maps.stop()

    def test_a_refused_scene_ends_the_launch(self):
        bad = {"sphere": SPHERE, "surface": {"regions": [{"name": "a", "circle": {"center": [0, 0], "radius": -1},
                                                          "law": "rough"}]}}
        self.launch("scene:=" + self.scene_file(bad), "rviz:=false")
        output = self.launched.communicate(timeout=PATIENCE)[0].decode()
        self.assertIn("surface.regions[0].circle.radius: -1 is refused; allowed: ", output)
        self.assertIn("exit code 3", output)

    def test_nothing_is_left_on_the_parameter_server(self):
        rospy.set_param(NODE + "/of_another_scene", 1)
        self.launch("rviz:=false")
        self.first_state()
        self.assertFalse(rospy.has_param(NODE + "/of_another_scene"))


class Parameters(unittest.TestCase):
    def run_node(self, parameters):
        """Exit code and output of a node that is expected to refuse its parameters."""
        name = "/node_%d" % id(parameters)
        if parameters:
            rospy.set_param(name, parameters)
        result = subprocess.run([program("hybrid_sphere_node"), "__name:=" + name[1:]], stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, timeout=PATIENCE)
        return result.returncode, result.stdout.decode()

    def test_refused_parameters(self):
        cases = [
            ({}, "sphere: is missing", "type: roslaunch hybrid_sphere sim.launch"),
            ({"raet": 5}, "raet: an unknown key is refused (did you mean rate?); allowed: sphere, ", " rate, ", " paused, ", " kick"),
            ({"rate": -5}, "rate: -5 is refused; allowed: a number from 0.001 to 1e+06 [Hz]"),
            ({"rate": "fast"}, 'rate: "fast"'),
            ({"rate": float("nan")}, "rate: "),
            ({"world_frame": "//world"}, 'world_frame: "//world"'),
            ({"world_frame": ""}, 'world_frame: ""'),
            ({"sphere_frame": "my ball"}, 'sphere_frame: "my ball"'),
            ({"sphere_frame": 3}, "sphere_frame: 3"),
            ({"sphere_frame": "world"}, 'sphere_frame: "world"'),
            ({"paused": "perhaps"}, 'paused: "perhaps"'),
            ({"real_time_factor": -1}, "real_time_factor: -1 is refused; allowed: 0, or a number from 0.001 to 1000"),
            ({"clock_rate": -1}, "clock_rate: -1 is refused; allowed: 0, or a number from 0.001 to 10000 [Hz]"),
            ({"clock": "lag"}, 'clock: "lag" is refused; allowed: own, lead, follow'),
            ({"clock": "follow", "publish_clock": True}, "publish_clock: true is refused; allowed: false where clock is not lead"),
            ({"clock": "follow", "real_time_factor": 2}, "real_time_factor: 2 is refused; allowed: 1 with clock: follow"),
            ({"clock_jump_back": "stop"}, 'clock_jump_back: "stop"'), ({"wait_for_viewer": -1}, "wait_for_viewer: -1"),
            ({"publish_clock": 1}, "publish_clock: 1"),
            ({"diagnostics": "yes"}, 'diagnostics: "yes"'),
            ({"wrench": {"force": [1]}}, "wrench.force: [1]"),
            ({"command_timeout": -1}, "command_timeout: -1"),
            ({"command_timeout_clock": "sun"}, 'command_timeout_clock: "sun" is refused; allowed: simulated, wall'),
            ({"diagnostic_period": 0}, "diagnostic_period: 0 is refused"),
            ({"rviz_tools": 1}, "rviz_tools: 1"), ({"catch_up": "no"}, 'catch_up: "no"'),
            ({"grid_threshold": 0}, "grid_threshold: 0"),
            ({"realtime_priority": 100}, "realtime_priority: 100 is refused; allowed: a number from 0 to 99"),
            ({"realtime_priority": 0.5}, "realtime_priority: 0.5"),
            ({"trail_length": 1.5}, "trail_length: 1.5 is refused; allowed: a number from 0 to 100000 without a fractional part"),
            ({"sphere": dict(SPHERE, mass=-1)}, "sphere.mass: -1"),
            ({"initial_state": {"position": [0, 0, 0]}}, "initial_state.position: [0, 0, 0]"),
        ]
        for parameters, *words in cases:
            with case(parameters=parameters):
                given = dict({"sphere": SPHERE}, **parameters) if parameters else {}
                code, output = self.run_node(given)
                self.assertEqual(code, 3, output)
                for word in words:
                    self.assertIn(word, output)

    def test_an_argument_that_is_refused_does_not_stay_on_the_parameter_server(self):
        rospy.set_param("/refused", {"sphere": SPHERE})
        command = [program("hybrid_sphere_node"), "__name:=refused", "_rate:=0", "_paused:=true", "_:=x"]
        result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=PATIENCE)
        self.assertIn("rate: 0 is refused", result.stdout.decode())
        self.assertEqual(rospy.get_param("/refused"), {"sphere": SPHERE})

    def test_an_argument_that_is_no_name_is_a_usage_error(self):
        command = [program("hybrid_sphere_node"), "_~rate:=0"]
        result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=PATIENCE)
        self.assertEqual(result.returncode, 2)
        self.assertIn("~rate", result.stdout.decode())

    def test_an_accuracy_of_an_earlier_run_that_goes_before_the_scenes_is_said(self):
        rospy.set_param("/again", {"sphere": SPHERE, "accuracy": 1e-6, "solver": {"accuracy": 1e-4}})
        node = subprocess.Popen([program("hybrid_sphere_node"), "__name:=again"], stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT)
        listener = Listener("/again/state", SphereState)
        listener.wait()
        listener.stop()
        node.send_signal(signal.SIGINT)
        output = node.communicate(timeout=PATIENCE)[0].decode()
        self.assertIn("accuracy: 1e-06 overrides the scene's solver.accuracy: 0.0001", output)

    def test_without_the_permission_for_real_time_it_says_so_and_goes_on(self):
        """It says so at the end of its preparation, and stamps begin with the first tick after that."""
        rospy.set_param("/modest", {"sphere": SPHERE, "realtime_priority": 5})
        without = ["setpriv", "--bounding-set", "-sys_nice,-ipc_lock"] if os.geteuid() == 0 else []
        limits = lambda: [resource.setrlimit(r, (0, 0)) for r in (resource.RLIMIT_RTPRIO, resource.RLIMIT_MEMLOCK)]
        node = subprocess.Popen([*without, program("hybrid_sphere_node"), "__name:=modest"], stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, preexec_fn=limits)
        listener = Listener("/modest/state", SphereState)
        state = listener.wait(10)[-1]
        listener.stop()
        node.send_signal(signal.SIGINT)
        output = node.communicate(timeout=PATIENCE)[0].decode()
        self.assertEqual(node.returncode, 0)
        self.assertIn("realtime_priority: the system does not permit the priority (Operation not permitted; ", output)
        self.assertIn("CAP_SYS_NICE", output)
        self.assertIn("locked memory", output)
        said = float(re.search(r"\[([\d.]+)\]: realtime_priority", output).group(1))
        self.assertGreaterEqual(state.header.stamp.to_sec() - state.time, said - 1e-6)  # rounded

    def test_numbers_in_any_form_are_taken(self):
        name = "/forms"
        rospy.set_param(name, {"sphere": {"mass": 1, "radius": "1e-1", "body": "shell"}, "rate": "2e2",
                               "world_frame": "map", "sphere_frame": "robot/ball"})
        node = subprocess.Popen([program("hybrid_sphere_node"), "__name:=forms"])
        listener = Listener(name + "/state", SphereState)
        state = listener.wait()[0]
        listener.stop()
        node.send_signal(signal.SIGINT)
        self.assertEqual(node.wait(PATIENCE), 0)
        self.assertEqual((state.pose.position.z, state.header.frame_id), (0.1, "map"))


if __name__ == "__main__":
    rospy.init_node("launch_test")
    rostest.rosrun("hybrid_sphere", "launch_test", "__main__")
