"""Runs the code of docs/python.md, compares its output with the page, and runs the scene of README.md."""
import contextlib
import io
import os
import re
import subprocess
import tempfile
import unittest

import hybrid_sphere
from common import CONFIG

BLOCK = re.compile(r"^```python\n(.*?)^```\n(?:```text\n(.*?)^```\n)?", re.MULTILINE | re.DOTALL)


class PageTest(unittest.TestCase):
    def test_prints_what_it_says(self):
        with open(os.path.join(os.path.dirname(CONFIG), "docs", "python.md")) as file:
            blocks = BLOCK.findall(file.read())
        self.assertGreater(len(blocks), 5)
        with tempfile.TemporaryDirectory() as directory:
            self.addCleanup(os.chdir, os.getcwd())
            os.chdir(directory)
            os.symlink(CONFIG, "config")
            study = os.environ.get("STUDY")
            if study:
                subprocess.run([study, "config/studies/goal.yaml", "-o", "goal.h5", "--quiet"], check=True,
                               stdout=subprocess.DEVNULL)
            names = {"__name__": "__main__"}
            for code, expected in blocks:
                if "goal.h5" in code and not study:
                    continue
                printed = io.StringIO()
                with contextlib.redirect_stdout(printed):
                    exec(compile(code, "docs/python.md", "exec"), names)
                self.assertEqual(printed.getvalue(), expected, code)
            self.assertGreater(os.path.getsize("path.png"), 5000)


class ReadmeTest(unittest.TestCase):
    def test_scene_runs(self):
        with open(os.path.join(os.path.dirname(CONFIG), "README.md")) as file:
            scenes = re.findall(r"^```yaml\n(.*?)^```", file.read(), re.MULTILINE | re.DOTALL)
        self.assertEqual(len(scenes), 1)
        self.assertEqual(len(scenes[0].splitlines()), 8)
        sphere = hybrid_sphere.Simulation(scenes[0])
        sphere.run([5])
        entered = [switch.to_region for switch in sphere.switches]
        self.assertEqual(entered[:2], ["carpet", "base"])


if __name__ == "__main__":
    unittest.main()
