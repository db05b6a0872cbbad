#!/usr/bin/python3
"""The build of scripts/test serves scripts/sim and scripts/build: nothing is compiled twice.

The environment has SOURCE (the repository) and BUILD (a build directory of scripts/build).
"""
import os
import re
import subprocess
import unittest

import rosunit

SOURCE, BUILD = os.environ["SOURCE"], os.environ["BUILD"]


class OneConfiguration(unittest.TestCase):
    def setUp(self):
        stamp = os.path.join(BUILD, "configured_with")
        if not os.path.exists(stamp):
            self.skipTest("this directory was configured without scripts/build")
        with open(stamp) as file:
            arguments = file.read().split("\n")
        last = next(i for i, argument in enumerate(arguments) if argument.startswith("-DCATKIN_DEVEL_PREFIX"))
        self.environment = {**os.environ, "HYBRID_SPHERE_BUILD_DIR": os.path.relpath(BUILD, SOURCE),
                            "HYBRID_SPHERE_CMAKE_ARGS": " ".join(arguments[last + 1:]).strip()}

    def test_has_no_step_left_for_sim_package_and_tests(self):
        for target in ("sim", "package", "tests"):
            output = subprocess.run([os.path.join(SOURCE, "scripts", "build"), target], env=self.environment,
                                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=True).stdout
            # The checks of the messages' dependencies run each time.
            steps = [line for line in output.split("\n") if re.search("Building|Linking|Generating", line)]
            self.assertEqual(steps, [], target)


if __name__ == "__main__":
    rosunit.unitrun("hybrid_sphere", "build_test", "__main__")
