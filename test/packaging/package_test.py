#!/usr/bin/python3
"""The Debian package that cpack makes of the build: what is in it, and that it works where it is unpacked.

The environment says where things are: SOURCE (the repository), BUILD (the build directory).
"""
import glob
import os
import re
import shutil
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

import rosunit

import installed_test

SOURCE, BUILD = os.environ["SOURCE"], os.environ["BUILD"]


def run(*command):
    result = subprocess.run(command, cwd=BUILD, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    assert result.returncode == 0, result.stdout.decode()
    return result.stdout.decode()


def setUpModule():
    global directory, package
    directory = tempfile.mkdtemp()
    run("cpack", "-B", directory)
    package, = glob.glob(os.path.join(directory, "*.deb"))
    installed_test.place = os.path.join(directory, "root")
    run("dpkg-deb", "-x", package, installed_test.place)


def tearDownModule():
    shutil.rmtree(directory)


class Package(unittest.TestCase):
    def setUp(self):
        root = installed_test.place
        self.paths = [os.path.join(folder, name) for folder, _, names in os.walk(root) for name in names]
        self.files = [os.path.relpath(path, root) for path in self.paths]

    @staticmethod
    def field(name):
        return run("dpkg-deb", "-f", package, name).strip()

    def test_it_has_the_version_of_the_manifest_and_depends_on_what_it_runs_with(self):
        manifest = ElementTree.parse(os.path.join(SOURCE, "package.xml"))
        self.assertEqual(self.field("Version"), manifest.findtext("version"))
        depends = re.split(r"[ ,]+", re.sub(r"\([^)]*\)", "", self.field("Depends")))
        listed = run(os.path.join(SOURCE, "scripts/install_dependencies"), "--list", "run").split()
        for name in ["libroscpp4d", "librosbag-storage4d", "libyaml-0-2", "libsundials-cvode6", *listed]:
            self.assertIn(name, depends)

    def test_it_tells_which_package_has_its_shared_libraries(self):
        libraries = [re.search(r"(libhybrid_sphere_\w+)\.so\.(\d+\.\d+)\.\d+$", name) for name in self.files]
        libraries = [match.groups() for match in libraries if match]
        self.assertEqual(sorted(name for name, _ in libraries), ["libhybrid_sphere_core", "libhybrid_sphere_mechanics"])
        told = run("dpkg-deb", "-I", package, "shlibs").splitlines()
        version = self.field("Version")
        self.assertEqual(sorted(told), ["%s %s hybrid-sphere (>= %s)" % (*each, version) for each in sorted(libraries)])

    def test_it_holds_every_file_that_users_use(self):
        for pattern, place in (("config/**/*.*", "usr/share/hybrid_sphere"), ("launch/*", "usr/share/hybrid_sphere"),
                               ("rviz/*", "usr/share/hybrid_sphere"), ("msg/*", "usr/share/hybrid_sphere"),
                               ("srv/*", "usr/share/hybrid_sphere"), ("examples/**/*.*", "usr/share/hybrid_sphere"),
                               ("include/**/*.hpp", "usr"), ("package.xml", "usr/share/hybrid_sphere"),
                               ("nodelet_plugins.xml", "usr/share/hybrid_sphere")):
            sources = glob.glob(pattern, root_dir=SOURCE, recursive=True)
            self.assertTrue(sources, pattern)
            for source in sources:
                self.assertIn(os.path.join(place, source), self.files)
        for source in glob.glob("[ms][sr][gv]/*", root_dir=SOURCE):
            folder, name = os.path.split(os.path.splitext(source)[0])
            self.assertIn("usr/include/hybrid_sphere/%s.h" % name, self.files)
            self.assertIn("usr/lib/python3/dist-packages/hybrid_sphere/%s/_%s.py" % (folder, name), self.files)

    def test_it_holds_nothing_that_is_not_its_own(self):
        own = r"usr/(include|lib|lib/python3/dist-packages|share|share/(common-lisp|roseus)/ros|lib/[^/]*/cmake)/hybrid_sphere/"
        for name in self.files:
            self.assertRegex(name, "^(%s|usr/share/doc/hybrid-sphere/|usr/lib/[^/]*/libhybrid_sphere_[a-z]*[.]|"
                             r"usr/lib/[^/]*/pkgconfig/hybrid_sphere\.pc|usr/\.catkin$)" % own)
            self.assertNotRegex(name, r"\.pyc$|_tests?$|~$")

    def test_no_file_names_the_place_where_it_was_built(self):
        self.assertGreater(len(self.paths), 100)
        for path in self.paths:
            with open(path, "rb") as file:
                content = file.read()
            for place in (SOURCE, BUILD):
                self.assertFalse(place.encode() in content, "%s names %s" % (path, place))
            if content.startswith(b"\x7fELF"):
                self.assertNotRegex(run("readelf", "-d", path), "RPATH|RUNPATH", path)


class Unpacked(installed_test.Installed):
    """What holds of every installed package."""


if __name__ == "__main__":
    rosunit.unitrun("hybrid_sphere", "package_test", "__main__")
