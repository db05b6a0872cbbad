"""hybrid_sphere.write_html: which states and switches it takes, and what it refuses. The page itself is tested in a browser
by test/core/html/."""
import os
import re
import tempfile
import unittest

import numpy as np

from common import CONFIG, PAIR
from hybrid_sphere import SceneError, Simulation, write_html


class WriteHtmlTest(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.TemporaryDirectory()
        self.addCleanup(self.directory.cleanup)
        self.file = os.path.join(self.directory.name, "page.html")
        simulation = Simulation(PAIR)
        self.states = simulation.run(np.linspace(0, 3, 31))
        self.switches = simulation.switches

    def page(self, *arguments, **named):
        left_out = write_html(self.file, PAIR, *arguments, **named)
        with open(self.file, encoding="utf-8") as file:
            return left_out, file.read()

    def test_takes_arrays_and_columns_alike(self):
        left_out, page = self.page(self.states, self.switches, title="A run")
        self.assertEqual(left_out, [])
        self.assertTrue("<title>A run</title>" in page)
        columns = [{name: array[name].tolist() for name in array.dtype.names} for array in (self.states, self.switches)]
        self.assertTrue(self.page(*columns, title="A run")[1] == page)
        del columns[1]["cause"]
        self.assertTrue(self.page(*columns, title="A run")[1] != page)

    def test_says_what_it_leaves_out_and_why_the_run_ended(self):
        states = Simulation(PAIR).run(np.linspace(0, 3, 20001))
        left_out, page = self.page(states, ended="it was late")
        self.assertTrue(left_out and "20001" in left_out[0], left_out)
        self.assertTrue("it was late" in page)
        self.assertLess(os.path.getsize(self.file), 2e6)

    def test_is_made_of_any_names(self):
        name = "</script><b>\u7c97 & 'x'"
        scene = {**PAIR, "surface": {"regions": [{**PAIR["surface"]["regions"][0], "name": name}]}}
        states = Simulation(scene).run([0, 2])
        write_html(self.file, scene, states, title=name)
        with open(self.file, encoding="utf-8") as file:
            self.assertEqual(len(re.findall("<b>\u7c97", file.read())), 0)

    def test_refuses_what_is_no_run(self):
        def refusal(states, switches=None):
            with self.assertRaises(SceneError) as caught:
                self.page(states, switches)
            return caught.exception.key
        for field, value, key in (("x", np.nan, "states.x[3]"), ("stage", 2, "states.stage[3]"), ("t", 0, "states.t[3]"),
                                  ("mode", "flying", "states.mode")):
            states = self.states.copy()
            states[field][3] = value
            self.assertEqual(refusal(states), key)
        self.assertEqual(refusal({"t": [0]}), "states.x")
        self.assertEqual(refusal(5), "states.t")
        self.assertEqual(refusal(self.states, self.states), "switches.Px")
        columns = {name: self.states[name].tolist() for name in self.states.dtype.names}
        self.assertEqual(refusal({**columns, "region": [None] * 31}), "states.region")
        self.assertEqual(refusal({**columns, "region": ["\ud800"] * 31}), "states.region")
        self.assertEqual(refusal({**columns, "x": [1]}), "states.x")
        self.assertFalse(os.path.exists(self.file))
        with self.assertRaises(OSError):
            write_html(os.path.join(self.directory.name, "no", "page.html"), PAIR, self.states)
        with self.assertRaises(SceneError):
            write_html(self.file, os.path.join(CONFIG, "no_such_file.yaml"), self.states)


if __name__ == "__main__":
    unittest.main()
