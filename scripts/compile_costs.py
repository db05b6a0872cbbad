"""What the package costs to compile: `scripts/measure build` prints it."""
import collections
import os
import re
import shutil
import subprocess
import sys
import time

SIM = ["hybrid_sphere_node", "hybrid_sphere_generate_messages", "hybrid_sphere_gencfg"]  # as scripts/build has them
STAGES = [("what scripts/sim compiles", SIM, 25), ("the package", ["all"], 75), ("the package and all tests", ["tests"], 140)]
MAX_UNITS_OF_A_FILE = 1
# A changed file, and the time until core_tests is linked [s].
CHANGES = [("src/motion/attitude.cpp", 5), ("src/motion/motion.hpp", 30)]
SHOWN = 10  # dearest files
SHOWN_OF_A_FAILURE = 4000  # characters of a build that failed


class CompileCosts:
    """Compiles everything anew in `directory` and reads the processor time of each compiler."""

    def __init__(self, repository, directory):
        self.repository = repository
        self.directory = directory
        self.log = directory / "compile_log"
        self.environment = {**os.environ, "HYBRID_SPHERE_COMPILE_LOG": str(self.log)}
        self.units = []

    def run(self, *command):
        subprocess.run(command, cwd=self.repository, env=self.environment, check=True, stdout=subprocess.DEVNULL)

    def ninja(self, targets):
        built = subprocess.run(["cmake", "--build", str(self.directory), "--parallel", str(os.cpu_count()), "--target", *targets],
                               cwd=self.repository, env=self.environment, stdout=subprocess.PIPE, text=True)
        if built.returncode != 0:
            print(built.stdout[-SHOWN_OF_A_FAILURE:], file=sys.stderr)
            built.check_returncode()

    def measure_unit(self):
        """Processor time of the unit now [s]: the machine's speed changes."""
        before = os.times().children_user
        self.run("g++", "-O2", "-c", "-I/usr/include/eigen3", "benchmark/compile_unit.cpp", "-o", os.devnull)
        self.units.append(os.times().children_user - before)

    def costs(self):
        """Processor time of each object so far, in units."""
        unit = sum(self.units) / len(self.units)
        found = {}
        for line in self.log.read_text().splitlines():
            user, system, path = line.split(" ", 2)
            found[path] = (float(user) + float(system)) / unit
        return found

    def measure(self):
        shutil.rmtree(self.directory, ignore_errors=True)
        self.directory.mkdir(parents=True)
        self.run("cmake", "-G", "Ninja", "-S", ".", "-B", str(self.directory), "-DCMAKE_BUILD_TYPE=Release",
                 "-DPYTHON_EXECUTABLE=/usr/bin/python3", "-DCMAKE_INSTALL_PREFIX=/usr", "-DCATKIN_ENABLE_TESTING=ON",
                 "-DCATKIN_DEVEL_PREFIX=%s" % (self.directory / "devel"),
                 "-DCMAKE_CXX_COMPILER_LAUNCHER=%s" % (self.repository / "scripts" / "time_compiler"))
        self.measure_unit()
        print("%-40s %8s %8s %8s" % ("", "objects", "units", "at most"))
        for what, targets, limit in STAGES:
            self.ninja(targets)
            self.measure_unit()
            costs = self.costs()
            print("%-40s %8d %8.1f %8d" % (what, len(costs), sum(costs.values()), limit))
        costs = self.costs()
        dearest = max(cost / self.files_of(path) for path, cost in costs.items())
        print("%-40s %8s %8.2f %8d" % ("the dearest file (mean of its batch)", "", dearest, MAX_UNITS_OF_A_FILE))
        for path, limit in CHANGES:
            print("%-40s %8s %6.0f s %6d s" % (path + " changed", "", self.time_of_change(path), limit))
        self.print_details(costs)

    def time_of_change(self, path):
        (self.repository / path).touch()
        start = time.monotonic()
        self.ninja(["core_tests"])
        return time.monotonic() - start

    def print_details(self, costs):
        folders = collections.Counter()
        for path, cost in costs.items():
            folders[folder_of(path)] += cost
        print("\nby folder, in units of %.1f s" % (sum(self.units) / len(self.units)))
        for folder, cost in folders.most_common():
            print("%8.1f  %s" % (cost, folder))
        print("\nthe dearest compilations, and how many files they compile together")
        for path, cost in sorted(costs.items(), key=lambda item: -item[1])[:SHOWN]:
            print("%8.2f %4d  %s" % (cost, self.files_of(path), path.replace("CMakeFiles/", "")))

    def files_of(self, path):
        """How many source files an object has: CMake writes those of a batch into one file that includes them."""
        batch = self.directory / path.removesuffix(".o")
        return batch.read_text().count("#include") if "/Unity/" in path else 1


def folder_of(path):
    """The folder of an object: of a batch it stands in its name, unity_FOLDER_NUMBER_cxx.cxx.o; of files of several folders
    the target."""
    if path.endswith(".gch"):
        return "precompiled headers"
    tests = "test/" if path.startswith("test/") else ""
    batch = re.search(r"/unity_(?!mixed_)(\w+)_\d+_cxx", path) or re.search(r"(\w+)\.dir/Unity/", path)
    return tests + (batch.group(1) if batch else path.split("/")[-2])
