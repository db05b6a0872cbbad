#!/usr/bin/python3
"""`plot` without a roscore: what it reads, the numbers that it draws, and what it refuses.

The environment says where things are: SIMULATE, PLOT, SCENES (config/).
"""
import io
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

import matplotlib
import numpy as np
import rosbag
import rospy
import rosunit
from hybrid_sphere.msg import SphereState

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.environ["PLOT"]))

import plot_figure  # noqa: E402
import plot_ground  # noqa: E402
import plot_inputs  # noqa: E402
from matplotlib.colors import to_rgba  # noqa: E402
from matplotlib.quiver import Quiver  # noqa: E402
from plot_figure import plt  # noqa: E402

SQUARE = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], dtype=float)


def scene(name):
    return os.path.join(os.environ["SCENES"], name + ".yaml")


class PlotTest(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.mkdtemp()

    def tearDown(self):
        shutil.rmtree(self.directory)

    def file(self, name, text=None):
        path = os.path.join(self.directory, name)
        if text is not None:
            with open(path, "w") as file:
                file.write(text)
        return path

    def simulate(self, name, *arguments):
        subprocess.run([os.environ["SIMULATE"], scene(name), "--quiet", *arguments], check=True)

    def plot(self, *arguments):
        return subprocess.run([sys.executable, "-B", os.environ["PLOT"], *arguments], capture_output=True, text=True,
                              cwd=self.directory)

    def recorded(self, name):
        """The bag and the two tables of one run."""
        files = [self.file(name + suffix) for suffix in (".bag", "_states.csv", "_switches.csv")]
        self.simulate(name, *(part for pair in zip(("--bag", "--states", "--switches"), files) for part in pair))
        return files


class Reading(PlotTest):
    def test_a_bag_and_the_tables_with_the_scene_give_the_same_numbers(self):
        for name in ("paper", "turntable", "incline"):
            bag, states, switches = self.recorded(name)
            with open(scene(name)) as file:
                import yaml
                ground = plot_ground.from_scene(yaml.safe_load(file))
            one, = plot_inputs.read([bag])
            other, = plot_inputs.read([states, switches], ground)
            for column in plot_inputs.STATE_COLUMNS[1:]:
                self.assertTrue(np.array_equal(one.states[column], other.states[column]), (name, column))
            for column in plot_inputs.SWITCH_COLUMNS[1:]:
                self.assertTrue(np.array_equal(one.switches[column], other.switches[column]), (name, column))
            # Stamps are of whole nanoseconds, and those of a double at 10 s are finer.
            self.assertLess(np.abs(one.states["t"] - other.states["t"]).max(), 1e-9, name)
            # Sums of a few products of numbers up to the largest velocity, in another order.
            scale = max(np.abs(other.states[c]).max() for c in ("vx", "vy")) + 1
            self.assertLess(np.abs(one.slip - other.slip).max(), 32 * 2.3e-16 * scale * 10, name)
            self.assertLess(np.abs(one.energy - other.energy).max(), 32 * 2.3e-16 * one.energy.max(), name)
            self.assertEqual([r.name for r in one.ground.regions], [r.name for r in other.ground.regions])

    def test_both_sides_of_a_switch_are_drawn_at_its_instant(self):
        run, = plot_inputs.read([self.recorded("paper")[0]])
        t, v = plot_figure.history(run, "v")
        instant = run.switches["t"][0]
        here = np.flatnonzero(t == instant)
        self.assertGreaterEqual(len(here), 2)
        self.assertEqual(v[0][here[0]], run.switches["vx1"][0])
        self.assertEqual(v[0][here[1]], run.switches["vx2"][0])
        self.assertTrue(np.all(np.diff(t) >= 0))

    def test_each_namespace_of_a_bag_is_a_sphere(self):
        first, second = self.recorded("paper")[0], self.recorded("checkerboard")[0]
        both = self.file("both.bag")
        with rosbag.Bag(both, "w") as bag:
            for namespace, path in (("/left/ball", first), ("/right/ball", second)):
                with rosbag.Bag(path) as part:
                    for topic, message, time in part.read_messages():
                        bag.write(namespace + "/" + topic.rpartition("/")[2], message, time)
        left, right = plot_inputs.read([both])
        self.assertEqual([left.name, right.name], ["both.bag /left/ball", "both.bag /right/ball"])
        self.assertEqual(left.ground.regions[0].name, "rough_half")
        self.assertEqual(len(right.switches["t"]), len(plot_inputs.read([second])[0].switches["t"]))

    def test_switches_that_were_not_recorded_are_counted(self):
        path = self.file("gaps.bag")
        with rosbag.Bag(self.recorded("conveyor")[0]) as part, rosbag.Bag(path, "w") as bag:
            messages = [m for _, m, _ in part.read_messages(topics=["/hybrid_sphere/constraint_switch"])]
            for again in (0, 100):  # s; the second time they begin at 0 again
                for index in (1, 2, 5) if again == 0 else (0, 1, 3):
                    m = messages[index]
                    m.header.stamp += rospy.Duration(again)
                    bag.write("/hybrid_sphere/constraint_switch", m, m.header.stamp)
        run, = plot_inputs.read([path])
        self.assertEqual(run.missing, 1 + 2 + 1)
        result = self.plot(path, "-o", "a.png")
        self.assertEqual(result.stderr, "plot: gaps.bag: by their index 4 switches were not recorded\n")
        self.assertEqual(result.returncode, 0)

    def test_a_new_initial_state_does_not_go_back_in_time(self):
        path = self.file("twice.bag")
        with rosbag.Bag(self.recorded("paper")[0]) as part, rosbag.Bag(path, "w") as bag:
            messages = [m for _, m, _ in part.read_messages(topics=["/hybrid_sphere/state"])][:10]
            for again in (0, 1):
                for m in messages:
                    m.header.stamp += rospy.Duration(again)
                    bag.write("/hybrid_sphere/state", m, m.header.stamp)
        run, = plot_inputs.read([path])
        self.assertTrue(np.all(np.diff(run.states["t"]) > 0))
        self.assertAlmostEqual(run.states["t"][10], 1, delta=1e-9)
        self.assertTrue(np.isnan(run.states["x"][10]))


def evil(text):
    """A definition that writes a file where a class is made of it."""
    return "int32 open('RUN','w').write('x');b=1\n" + text


class Definitions(PlotTest):
    """What a bag says of its messages is not run."""

    def bag_with(self, definition, md5sum, data=None, name="hybrid_sphere/SphereState"):
        class Recorded(SphereState):
            _type, _md5sum, _full_text = name, md5sum, definition

        path = self.file("evil.bag")
        if data is None:
            buffer = io.BytesIO()
            SphereState(time=1.0, mode="free").serialize(buffer)
            data = buffer.getvalue()
        with rosbag.Bag(path, "w") as bag:
            bag.write("/ball/state", (name, data, md5sum, (b"", 0), Recorded), rospy.Time(1), raw=True)
        return path

    def assert_nothing_was_run(self):
        self.assertFalse(os.path.exists(self.file("RUN")))

    def test_the_test_would_run_in_a_reader_that_makes_classes(self):
        path = self.bag_with(evil("int32 x\n"), "0" * 32)
        subprocess.run([sys.executable, "-c", "import rosbag, sys\nfor m in rosbag.Bag(sys.argv[1]): pass", path],
                       cwd=self.directory, capture_output=True)
        self.assertTrue(os.path.exists(self.file("RUN")))

    def test_of_another_version_are_refused_with_words(self):
        for definition in (evil("int32 x\n"), "int32 x\n", SphereState._full_text):
            result = self.plot(self.bag_with(definition, "0" * 32))
            self.assertEqual((result.returncode, result.stdout), (1, ""))
            self.assertEqual(result.stderr, "plot: %s: hybrid_sphere/SphereState of /ball/state is of another version of "
                             "hybrid_sphere: its md5sum is %s, not %s\n" % (self.file("evil.bag"), "0" * 32,
                                                                           SphereState._md5sum))
            self.assert_nothing_was_run()

    def test_of_this_version_are_read_with_the_own_classes(self):
        result = self.plot(self.bag_with(evil(SphereState._full_text), SphereState._md5sum), "-o", "a.png")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assert_nothing_was_run()

    def test_of_other_messages_are_not_read(self):
        result = self.plot(self.bag_with(evil("int32 x\n"), "1" * 32, name="other/Message"))
        self.assertIn("has neither hybrid_sphere/SphereState nor", result.stderr)
        self.assertEqual(result.returncode, 1)
        self.assert_nothing_was_run()

    def test_of_two_connections_of_one_topic_only_the_own_are_read(self):
        class Other(SphereState):
            _type, _md5sum, _full_text = "other/Message", "1" * 32, evil("int32 x\n")

        path = self.file("two.bag")
        with rosbag.Bag(path, "w") as bag:
            bag.write("/ball/state", SphereState(mode="free"), rospy.Time(1))
            bag._topic_connections.clear()  # as a recorder of two senders writes: a connection for each
            bag.write("/ball/state", (Other._type, b"\0" * 4, Other._md5sum, (b"", 0), Other), rospy.Time(2), raw=True)
        result = self.plot(path, "-o", "a.png")
        self.assertEqual(result.stdout, "plot: wrote a.png (1 run, 1 state, 0 switches)\n", result.stderr)
        self.assert_nothing_was_run()

    def test_of_messages_that_are_cut_are_refused(self):
        result = self.plot(self.bag_with(SphereState._full_text, SphereState._md5sum, data=b"\0" * 4))
        self.assertEqual(result.returncode, 1)
        self.assertIn("evil.bag: is no bag that can be read: ", result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)


class Ground(unittest.TestCase):
    def test_half_planes_are_cut_at_their_edge(self):
        part = plot_ground.clipped(((0.25, 7), (2, 0)), SQUARE)
        self.assertEqual(part[:, 0].min(), 0.25)
        self.assertEqual(plot_ground.signed_area(part), 1.5)
        self.assertEqual(len(plot_ground.clipped(((2, 0), (1, 0)), SQUARE)), 0)
        self.assertEqual(plot_ground.signed_area(plot_ground.clipped(((-2, 0), (1, 0)), SQUARE)), 4)

    def test_outside_leaves_a_hole(self):
        colors = {law: matplotlib.colors.to_rgba_array(color)[0] for law, color in plot_figure.GROUND_COLORS.items()}
        for outline in (SQUARE / 2, SQUARE[::-1] / 2):
            region = plot_ground.Region("r", "rough", outline=outline, outside=True)
            figure = plt.figure(figsize=(1, 1), dpi=100)
            axes = figure.add_axes((0, 0, 1, 1), xlim=(-1, 1), ylim=(-1, 1))
            plot_figure.draw_ground(axes, plot_ground.Ground(plot_ground.Region("base", "smooth"), [region]), SQUARE)
            figure.canvas.draw()
            pixels = np.asarray(figure.canvas.buffer_rgba()) / 255
            plt.close(figure)
            self.assertLess(np.abs(pixels[50, 50] - colors["smooth"]).max(), 1 / 255)
            self.assertLess(np.abs(pixels[10, 50] - colors["rough"]).max(), 1 / 255)

    def test_a_turntable_moves_anticlockwise(self):
        region = plot_ground.Region("r", "rough", turntable=(2.0, (1.0, 0.0)))
        velocity = region.ground_velocity(np.array([2.0]), np.array([3.0]))
        self.assertEqual(velocity.tolist(), [[-6.0], [2.0]])


class Pictures(PlotTest):
    def test_png_svg_and_pdf(self):
        bag, states, switches = self.recorded("conveyor")
        for name, begin in (("a.png", b"\x89PNG"), ("a.svg", b"<?xml"), ("a.PDF", b"%PDF")):
            result = self.plot(bag, states, switches, "--scene", scene("conveyor"), "-o", name)
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assertEqual(result.stdout, "plot: wrote %s (2 runs, 2002 states, 16 switches)\n" % name)
            with open(self.file(name), "rb") as file:
                self.assertEqual(file.read(len(begin)), begin)

    def test_without_an_output_it_goes_into_the_working_directory(self):
        os.mkdir(self.file("elsewhere"))
        bag = shutil.move(self.recorded("paper")[0], self.file("elsewhere/paper.bag"))
        self.assertEqual(self.plot(bag).stdout, "plot: wrote paper.png (1 run, 1001 states, 1 switch)\n")
        self.assertTrue(os.path.exists(self.file("paper.png")))

    def test_a_table_alone_and_a_table_without_rows(self):
        _, states, switches = self.recorded("paper")
        self.simulate("paper", "--duration", "0", "--switches", self.file("none.csv"))
        for path, what in ((states, "1001 states, 0 switches"), (switches, "0 states, 1 switch"),
                           (self.file("none.csv"), "0 states, 0 switches")):
            result = self.plot(path, "-o", "a.png")
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assertIn(what, result.stdout)

    def test_panels_are_of_what_there_is(self):
        def panels(name):
            figure = plot_figure.draw(plot_inputs.read([self.recorded(name)[0]]), name)
            labels = [axes.get_ylabel() for axes in figure.axes[1:]]
            plt.close(figure)
            return labels
        usual = ["velocity [m/s]", "spin [rad/s]", "slip [m/s]", "kinetic energy [J]"]
        self.assertEqual(panels("paper"), usual + ["impulse [N s]"])
        self.assertEqual(panels("bowling"), usual, "no switch has an impulse")

    def test_the_legend_tells_frictions_and_names_without_room_apart(self):
        def legend(name):
            figure = plot_figure.draw(plot_inputs.read([self.recorded(name)[0]]), name)
            labels = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
            plt.close(figure)
            return labels
        self.assertEqual(legend("bowling")[:4], ["smooth"] + [r"coulomb, $\mu$ = " + mu for mu in ("0.04", "0.2", "0.8")])
        self.assertEqual(legend("paper"), ["smooth", "rough", "path, from its start", "to its end", "switch", "impulse"])

    def test_arrows_of_impulses_stay_in_the_picture(self):
        for name in ("conveyor", "bounce_back", "turntable"):
            run, = plot_inputs.read([self.recorded(name)[0]])
            largest = plot_figure.largest_impulse([run])
            visible = plot_figure.view_of([run], largest)
            at, impulse = plot_figure.impulses_of(run)
            tips = at.T + (visible[2] - visible[0]) * plot_figure.ARROW * impulse.T / largest
            self.assertTrue(np.all((visible[0] < tips) & (tips < visible[2])), name)

    def test_a_name_stands_on_its_region_and_not_in_its_hole(self):
        around = plot_ground.Region("around", "rough", outline=0.5 * SQUARE, outside=True)
        inside = plot_ground.Region("inside", "rubber", outline=0.4 * SQUARE)
        box = plot_figure.rectangle(np.zeros(2), np.full(2, 50.0))
        paths = [plot_figure.path_of(region, box) for region in (inside, around)]
        (inner, _), (outer, _) = plot_figure.name_places(["inside", "around"], [inside, around], paths, SQUARE)
        self.assertLess(np.abs(inner).max(), 0.4)
        self.assertGreater(np.abs(outer).max(), 0.5)

    def test_a_switch_alone_is_in_the_middle_of_its_picture(self):
        run, = plot_inputs.read([self.recorded("paper")[2]])
        visible = plot_figure.view_of([run], plot_figure.largest_impulse([run]))
        self.assertGreater((visible[2] - visible[0])[0], 1)

    def test_each_of_two_runs_has_its_colour_impulses_too(self):
        first, second = self.recorded("paper")[0], self.recorded("conveyor")[0]
        figure = plot_figure.draw(plot_inputs.read([first, second]), "two")
        arrows = [child for child in figure.axes[0].get_children() if isinstance(child, Quiver)]
        colors = {tuple(np.round(child.get_facecolor()[0], 6)) for child in arrows}
        self.assertEqual(colors, {tuple(np.round(to_rgba(color), 6)) for color in plot_figure.RUN_COLORS[:2]})
        plt.close(figure)

    def test_equal_inputs_give_equal_pictures(self):
        bag = self.recorded("paper")[0]
        contents = []
        for name in ("a.svg", "b.svg"):
            self.plot(bag, "-o", name)
            with open(self.file(name)) as file:
                contents.append(file.read())
        self.assertEqual(*contents)


class Refusals(PlotTest):
    def assert_refused(self, code, words, *arguments):
        result = self.plot(*arguments)
        self.assertEqual((result.returncode, result.stdout), (code, ""), result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertIn(words, result.stderr)

    def test_usage(self):
        self.assert_refused(2, "BAG_OR_CSV")
        self.assert_refused(2, '--output: "a.gif" is refused; allowed: a file that ends in .png, .svg or .pdf', "a.bag",
                            "-o", "a.gif")
        self.assert_refused(2, "a file other than the inputs", "a.png", "-o", "a.png")
        self.assert_refused(2, "--nonsense", "a.bag", "--nonsense")

    def test_what_cannot_be_read(self):
        self.assert_refused(1, "none.bag: cannot be read: No such file", "none.bag")
        self.assert_refused(1, "none.csv: cannot be read: No such file", "none.csv")
        self.assert_refused(1, "is no bag that can be read", self.file("text.bag", "text\n"))
        self.assert_refused(1, "its first line is neither", self.file("other.csv", "a,b\n1,2\n"))
        header = "t,x,y,qx,qy,qz,qw,vx,vy,wx,wy,wz,stage,mode,region\n"
        self.assert_refused(1, "bad.csv: line 2: t: one is refused; allowed: a number from -1e+100 to 1e+100",
                            self.file("bad.csv", header + "one,0,0,0,0,0,1,0,0,0,0,0,1,free,base\n"))
        self.assert_refused(1, "short.csv: line 2: ", self.file("short.csv", header + "1,0,0\n"))

    def test_numbers_that_cannot_be_drawn(self):
        table = "t,x,y,vx,vy,wx,wy,wz\n0,0,0,1,0,0,0,0\n"
        for row, words in (("1,nan,0,1,0,0,0,0", "line 3: x: nan is refused; allowed: a number from -1e+100 to 1e+100"),
                           ("inf,1,0,1,0,0,0,0", "line 3: t: inf is refused"),
                           ("1,1,1e308,1,0,0,0,0", "line 3: y: 1e308 is refused"),
                           ("1,1,0,fast,0,0,0,0", "line 3: vx: fast is refused"),
                           ("1,1,0", "line 3: vx: nothing is refused")):
            self.assert_refused(1, words, self.file("strange.csv", table + row + "\n"), "-o", self.file("strange.png"))
        message = SphereState(time=1.0, kinetic_energy=1.0)
        message.twist.angular.y = float("nan")
        with rosbag.Bag(self.file("strange.bag"), "w") as bag:
            bag.write("/ball/state", message)
        self.assert_refused(1, "a number of SphereState is refused; allowed: -1e+100 to 1e+100",
                            self.file("strange.bag"), "-o", self.file("strange.png"))

    def test_a_name_is_no_formula(self):
        states = self.file(r"$\frac{$.csv")
        self.simulate("paper", "--states", states)
        result = self.plot(states, states, "-o", self.file("formula.svg"))  # it is in the title and in the legend
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_a_bag_without_a_sphere(self):
        path = self.file("clock.bag")
        with rosbag.Bag(self.recorded("paper")[0]) as part, rosbag.Bag(path, "w") as bag:
            for topic, message, time in part.read_messages(topics=["/tf"]):
                bag.write(topic, message, time)
        self.assert_refused(1, "has neither hybrid_sphere/SphereState nor hybrid_sphere/ConstraintSwitch", path)

    def test_scenes_and_pictures_that_are_none(self):
        states = self.recorded("paper")[1]
        self.assert_refused(1, "bad.yaml: is no scene", states, "--scene", self.file("bad.yaml", "sphere: {mass: 1}\n"))
        self.assert_refused(1, "list.yaml: is no scene", states, "--scene", self.file("list.yaml", "[1]\n"))
        self.assert_refused(1, "bad.yaml: cannot be read", states, "--scene", self.file("bad.yaml", "{a: [\n"))
        self.assert_refused(1, "no/a.png: cannot be written: No such file", states, "-o", "no/a.png")

    def test_help_is_a_manual_page(self):
        result = self.plot("--help")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        for section in ("NAME", "SYNOPSIS", "OPTIONS", "EXIT STATUS", "EXAMPLES"):
            self.assertIn(section + "\n", result.stdout)


if __name__ == "__main__":
    rosunit.unitrun("hybrid_sphere", "plot_test", "__main__")
