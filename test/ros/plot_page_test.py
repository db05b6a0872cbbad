#!/usr/bin/python3
"""`plot --html` without a roscore: the motion that it gives to the module hybrid_sphere, and what it refuses.

The environment says where things are: SIMULATE, PLOT, SCENES (config/).
"""
import sys
import unittest

import hybrid_sphere
import numpy as np
import rosbag
import rospy
import rosunit
import yaml

sys.dont_write_bytecode = True

from plot_test import PlotTest, scene  # noqa: E402  which finds the modules beside plot
import plot_page  # noqa: E402


class Pages(PlotTest):
    """What --html gives to the module hybrid_sphere."""

    def test_a_bag_and_the_tables_with_the_scene_are_the_same_motion(self):
        for name in ("paper", "conveyor"):
            bag, states, switches = self.recorded(name)
            of_bag, before = plot_page.read_bag(bag)
            of_tables = plot_page.read_tables([states, switches], scene(name))
            self.assertEqual(before, 0)
            for key in plot_page.STATE_NUMBERS + plot_page.STATE_TEXTS:
                self.assertEqual(of_bag.states[key], of_tables.states[key], key)
            for key in plot_page.SWITCH_NUMBERS + plot_page.SWITCH_TEXTS[:3]:
                self.assertEqual(of_bag.switches[key], of_tables.switches[key], key)
            with open(scene(name)) as file:
                body = yaml.safe_load(file)["sphere"]
            self.assertEqual(of_bag.scene["sphere"]["radius"], body["radius"])
            self.assertEqual(len(hybrid_sphere.Simulation(of_bag.scene).run([0])), 1)
            energies = Body(of_bag.scene["sphere"]).kinetic_energy(of_bag.states)
            self.assertTrue(np.allclose(energies, Body(body).kinetic_energy(of_tables.states), rtol=1e-9))

    def test_the_ground_of_a_bag_is_that_of_its_scene(self):
        motion, _ = plot_page.read_bag(self.recorded("conveyor")[0])
        with open(scene("conveyor")) as file:
            keys = {**yaml.safe_load(file), "surface": motion.scene["surface"]}
        self.assertEqual(hybrid_sphere.Simulation(keys).run([0, 2, 5]).tobytes(),
                         hybrid_sphere.Simulation(scene("conveyor")).run([0, 2, 5]).tobytes())

    def test_the_last_of_several_motions_is_shown(self):
        path = self.file("twice.bag")
        with rosbag.Bag(self.recorded("paper")[0]) as part, rosbag.Bag(path, "w") as bag:
            messages = list(part.read_messages())
            for again in (0, 1):
                for topic, m, stamp in messages[: len(messages) // (2 - again)]:
                    bag.write(topic, m, stamp + rospy.Duration(100 * again))
        motion, before = plot_page.read_bag(path)
        self.assertEqual(before, 1)
        self.assertTrue(np.all(np.diff(motion.states["t"]) > 0))
        self.assertEqual(len(motion.switches["t"]), 1)
        result = self.plot(path, "--html", "twice.html")
        self.assertEqual(result.stderr, "plot: %s: the last of 2 motions is shown\n" % path)
        self.assertEqual(result.stdout, "plot: wrote twice.html (%d states, 1 switch)\n" % len(motion.states["t"]))

    def test_a_page_is_written(self):
        bag, states, switches = self.recorded("paper")
        for arguments in ([bag], [states, switches, "--scene", scene("paper")], [states, "--scene", scene("paper")]):
            result = self.plot(*arguments, "--html", "page.html", "--title", "<A & B>")
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            with open(self.file("page.html")) as file:
                self.assertTrue("<title>&#60;A &#38; B&#62;</title>" in file.read())

    def test_what_is_no_motion_is_refused(self):
        bag, states, switches = self.recorded("paper")
        without = self.file("without.csv", "t,x,y,vx,vy,wx,wy,wz\n0,0,0,0,0,0,0,0\n")
        for arguments, words in (([bag, bag], "2 inputs are refused"), ([without], "the column qx is missing"), ([switches], "tables of switches are refused"),
                                 ([states], "--scene is missing"), ([states, "--scene", states], "before the first value"),
                                 ([bag, "--html", "no/where.html"], "No such file")):
            result = self.plot("--html", "page.html", *arguments)
            self.assertEqual(result.returncode, 1)
            self.assertIn(words, result.stderr)
        for arguments in (["--html", "page.png"], ["--html", "page.html", "-o", "page.png"]):
            self.assertEqual(self.plot(bag, *arguments).returncode, 2)


class Body:
    """The sphere of a scene, and its kinetic energy."""

    def __init__(self, keys):
        squared = {"solid": 2 / 5, "shell": 2 / 3}.get(keys.get("body"), 0) * keys["radius"]**2
        self.mass, self.squared = keys["mass"], squared or keys["gyration_radius"]**2

    def kinetic_energy(self, states):
        square = [np.square(states[name]) for name in ("vx", "vy", "wx", "wy", "wz")]
        return self.mass / 2 * (sum(square[:2]) + self.squared * sum(square[2:]))


if __name__ == "__main__":
    rosunit.unitrun("hybrid_sphere", "plot_page_test", "__main__")
