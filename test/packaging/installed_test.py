#!/usr/bin/python3
"""The installed package, used as its users do: where nothing else of it is known, neither sources nor a devel space.

    test/packaging/installed_test.py PLACE [CASE...]

PLACE is an install space (with a setup.bash), the root of an unpacked Debian package, or / where that is installed.
"""
import csv
import os
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "support"))
from patience import PATIENCE, wait_for  # noqa: E402

PROGRAMS = {"hybrid_sphere_node": "Usage: hybrid_sphere_node", "three_stage_node": "Usage: three_stage_node",
            "simulate": "Usage: simulate", "record": "Usage: record", "three_stage": "Usage: three_stage",
            "study": "Usage: study", "plot": "rosrun hybrid_sphere plot",
            "steer_to_target": "Usage: steer_to_target", "catch_in_disc.py": "rosrun hybrid_sphere catch_in_disc.py",
            "log_switches.py": "rosrun hybrid_sphere log_switches.py", "catch_in_lock_step.py": "lock_step.launch"}
CMAKE = """cmake_minimum_required(VERSION 3.16)
project(downstream)
find_package(catkin REQUIRED COMPONENTS hybrid_sphere)
catkin_package()
add_executable(downstream main.cpp)
target_compile_features(downstream PRIVATE cxx_std_17)
target_include_directories(downstream PRIVATE ${catkin_INCLUDE_DIRS})
target_link_libraries(downstream PRIVATE ${catkin_LIBRARIES})
"""
MANIFEST = """<package format="2"><name>downstream</name><version>0.0.0</version><description>Built on it.</description>
<maintainer email="a@b.example">A</maintainer><license>BSD</license><buildtool_depend>catkin</buildtool_depend>
<depend>hybrid_sphere</depend></package>
"""
PROGRAM = r"""#include <cstdio>
#include "hybrid_sphere/SphereState.h"
#include "hybrid_sphere/scene/read_scene.hpp"
#include "hybrid_sphere/simulation/simulation.hpp"
int main(int, char** argv) {
  hybrid_sphere::Simulation simulation(hybrid_sphere::scene::read_scene_file(argv[1]));
  simulation.advance_to(5, [](const hybrid_sphere::Switch&) {});
  hybrid_sphere::SphereState message;
  message.pose.position.x = simulation.state().position.x();
  std::printf("%.17g\n", message.pose.position.x);
}
"""
PROGRAMS_OF_LAUNCH_FILES = """import sys, rospkg, roslaunch.config, roslib.packages
for file in sys.argv[1:]:
    config = roslaunch.config.load_config_default([file], None, verbose=False)
    for node in config.nodes + config.tests:
        if not roslib.packages.find_node(node.package, node.type, rospkg.RosPack()):
            sys.exit("%s: no %s in %s" % (file, node.type, node.package))
        print(node.type)
"""
RECONFIGURE = """import rospy, dynamic_reconfigure.client
rospy.init_node("operator")
print(dynamic_reconfigure.client.Client("/hybrid_sphere", timeout=100).update_configuration({"rate": 50})["rate"])
"""
place = "/"


def environment(root, home):
    """Of a shell in which the package is installed at `root`, and of which nothing else is known."""
    clean = {"HOME": home, "LANG": "C.UTF-8", "PATH": "/usr/bin:/bin", "MPLBACKEND": "Agg"}
    if os.path.exists(os.path.join(root, "setup.bash")):
        command = ["bash", "-c", ". '%s/setup.bash' && env -0" % root]
        lines = subprocess.run(command, env=clean, check=True, capture_output=True, text=True).stdout
        return dict(line.partition("=")[::2] for line in lines.split("\0") if line)
    if os.path.realpath(root) == "/":
        return clean
    # What Debian's tools know of /usr without being told has to be told of another place.
    usr = os.path.join(root, "usr")
    architecture = subprocess.run(["gcc", "-print-multiarch"], check=True, capture_output=True, text=True).stdout.strip()
    libraries = os.path.join(usr, "lib", architecture)
    plugins = os.path.join(home, "plugins")  # pluginlib looks in lib/ of each prefix
    os.mkdir(plugins)
    os.symlink(libraries, os.path.join(plugins, "lib"))
    open(os.path.join(usr, ".catkin"), "w").close()
    return dict(clean, CMAKE_PREFIX_PATH=usr + ":" + plugins, ROS_PACKAGE_PATH=os.path.join(usr, "share"),
                LD_LIBRARY_PATH=libraries, PYTHONPATH=os.path.join(usr, "lib/python3/dist-packages"),
                CPATH=os.path.join(usr, "include"))


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.home = tempfile.mkdtemp()
        cls.environment = environment(place, cls.home)
        cls.port = str(free_port())
        cls.environment.update(ROS_MASTER_URI="http://localhost:" + cls.port, ROS_HOME=os.path.join(cls.home, "ros"),
                               ROS_HOSTNAME="localhost")
        cls.share = cls.call("rospack", "find", "hybrid_sphere").stdout.strip()

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.home)

    @classmethod
    def call(cls, *command, **options):
        return subprocess.run(command, env=cls.environment, cwd=cls.home, capture_output=True, text=True,
                              timeout=PATIENCE, stdin=subprocess.DEVNULL, **options)

    def done(self, *command):
        """The output of a command that has to succeed."""
        result = self.call(*command)
        self.assertEqual(result.returncode, 0, "%s\n%s%s" % (" ".join(command), result.stdout, result.stderr))
        return result.stdout

    def comes(self, *command):
        """The output of a command, tried until it succeeds."""
        def answer():
            result = self.call(*command)
            return result if result.returncode == 0 else None

        return wait_for(answer, " ".join(command)).stdout

    def file(self, name):
        return os.path.join(self.home, name)

    def scene(self, name):
        return os.path.join(self.share, "config", name + ".yaml")

    def start(self, *command):
        process = subprocess.Popen(command, env=self.environment, cwd=self.home, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL)
        self.addCleanup(self.end, process)

    @staticmethod
    def end(process):
        process.terminate()
        try:
            process.wait(timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()

    def test_it_is_found_at_its_place(self):
        self.assertTrue(os.path.realpath(self.share).startswith(os.path.realpath(place)), self.share)

    def test_every_program_tells_its_usage(self):
        for name, usage in PROGRAMS.items():
            with self.subTest(name=name):
                result = self.call("rosrun", "hybrid_sphere", name, "--help")
                self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
                self.assertIn(usage, result.stdout)
        self.assertIn("reached_end", self.done("rosrun", "hybrid_sphere", "pursuit"))

    def test_a_bag_of_simulate_is_read_by_rosbag_and_by_plot(self):
        self.done("rosrun", "hybrid_sphere", "simulate", self.scene("bounce_back"), "--duration", "5", "--quiet",
                  "--bag", "run.bag", "--switches", "switches.csv")
        with open(self.file("switches.csv"), newline="") as file:
            switches = [float(row["t"]) for row in csv.DictReader(file)]
        self.assertGreater(len(switches), 1)
        read = ("import rosbag\nfor _, m, _ in rosbag.Bag('run.bag').read_messages('/hybrid_sphere/constraint_switch'):"
                "\n  print(repr(m.time))")
        self.assertEqual([float(line) for line in self.done("/usr/bin/python3", "-c", read).split()], switches)
        self.done("rosrun", "hybrid_sphere", "plot", "run.bag", "-o", "run.svg")
        self.assertGreater(os.path.getsize(self.file("run.svg")), 10000)

    def test_python_finds_messages_services_and_the_configuration(self):
        output = self.done("/usr/bin/python3", "-c", "from hybrid_sphere.msg import ConstraintSwitch\n"
                           "from hybrid_sphere.srv import Step\nfrom hybrid_sphere.cfg import SimulatorConfig\n"
                           "print(Step._request_class.__name__, len(SimulatorConfig.defaults) > 3)\n"
                           "print(ConstraintSwitch.__module__, SimulatorConfig.__file__)")
        self.assertRegex(output, "StepRequest True\nhybrid_sphere.msg._ConstraintSwitch ")
        self.assertTrue(os.path.realpath(output.split()[-1]).startswith(os.path.realpath(place)), output)

    def test_python_computes_a_scene(self):
        output = self.done("/usr/bin/python3", "-c", "import sys, hybrid_sphere\n"
                           "state = hybrid_sphere.Simulation(sys.argv[1]).run([5])[0]\n"
                           "print(state.mode, '%.17g' % state.x, hybrid_sphere.__file__)",
                           os.path.join(self.share, "config", "paper.yaml"))
        mode, x, file = output.split()
        self.assertEqual((mode, x), ("rolling", "1.6428571428571428"))
        self.assertTrue(os.path.realpath(file).startswith(os.path.realpath(place)), output)

    def test_a_run_and_its_bag_become_pages(self):
        self.done("rosrun", "hybrid_sphere", "simulate", self.scene("conveyor"), "--html", "run.html", "--bag", "page.bag",
                  "--quiet")
        self.done("rosrun", "hybrid_sphere", "plot", "page.bag", "--html", "bag.html")
        for name in ("run.html", "bag.html"):
            with open(os.path.join(self.home, name)) as page:
                text = page.read()
            self.assertTrue("OrbitControls" in text and "against" in text and len(text) < 2e6, name)

    def test_every_launch_file_names_programs_that_are_there(self):
        launch_files = sorted(name for name in os.listdir(os.path.join(self.share, "launch")))
        launch_files.remove("one_of_many.launch")  # has no scene of its own
        self.assertGreater(len(launch_files), 3)
        paths = [os.path.join(self.share, "launch", name) for name in launch_files]
        paths.append(os.path.join(self.share, "examples/controller_test/controller.test"))
        programs = self.done("/usr/bin/python3", "-c", PROGRAMS_OF_LAUNCH_FILES, *paths).split()
        for name in ("hybrid_sphere_node", "steer_to_target", "catch_in_lock_step.py", "static_transform_publisher",
                     "catch_in_disc.py", "controller_test.py"):
            self.assertIn(name, programs)

    def test_node_and_nodelet_run(self):
        self.start("roslaunch", "-p", self.port, "hybrid_sphere", "sim.launch", "scene:=ice_patches", "rviz:=false")
        self.assertIn("mode:", self.comes("timeout", "60", "rostopic", "echo", "-n1", "/hybrid_sphere/state"))
        self.assertEqual(float(self.done("/usr/bin/python3", "-c", RECONFIGURE)), 50)

        self.done("rosparam", "load", self.scene("turntable"), "/as_nodelet")
        self.start("rosrun", "nodelet", "nodelet", "standalone", "hybrid_sphere/SimulatorNodelet", "__name:=as_nodelet")
        self.assertIn("mode:", self.comes("timeout", "60", "rostopic", "echo", "-n1", "/as_nodelet/state"))

    def test_a_package_is_built_on_it(self):
        for name, text in (("CMakeLists.txt", CMAKE), ("package.xml", MANIFEST), ("main.cpp", PROGRAM)):
            with open(self.file(name), "w") as file:
                file.write(text)
        self.done("cmake", "-G", "Ninja", "-S", ".", "-B", "build", "-DPYTHON_EXECUTABLE=/usr/bin/python3")
        self.done("cmake", "--build", "build")
        x = self.done("build/devel/lib/downstream/downstream", self.scene("paper"))
        states = self.done("rosrun", "hybrid_sphere", "simulate", self.scene("paper"), "--times", "5", "--states", "-")
        row = next(csv.DictReader(states.splitlines()))
        self.assertEqual(float(x), float(row["x"]))
        libraries = self.done("ldd", "build/devel/lib/downstream/downstream")
        found = re.search(r"libhybrid_sphere_core\.so\S* => (\S+)", libraries).group(1)
        self.assertTrue(os.path.realpath(found).startswith(os.path.realpath(place)), libraries)


if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    place = os.path.abspath(sys.argv.pop(1))
    unittest.main(verbosity=2)
