#!/usr/bin/python3
"""Types docs/tutorial.md and compares what is printed: `$ ` is a command, the lines below it are its output, `...` stands
for anything. A command that ends in & goes on until a ^C, the last one first. A block of yaml is the file that its first
line names."""
import os
import re
import shutil
import signal
import subprocess
import tempfile
import unittest

import rosgraph
import rospy
import rostest

from node_client import PATIENCE, case, connected, wait_for


def blocks(page):
    """Kind and lines of each fenced block."""
    return [(kind, text.splitlines()) for kind, text in re.findall(r"^```(\w+)\n(.*?)^```$", page, re.M | re.S)]


def commands(lines):
    """Commands, and the output of each."""
    for index, line in enumerate(lines):
        if line == "^C" or line.startswith("$ "):
            rest = lines[index + 1:]
            end = next((i for i, other in enumerate(rest) if other == "^C" or other.startswith("$ ")), len(rest))
            yield line[2:] if line != "^C" else line, rest[:end]


class Terminal:
    """What is typed, in a directory of its own."""

    def __init__(self):
        self.directory = tempfile.mkdtemp()
        self.environment = {key: value for key, value in os.environ.items() if key != "DISPLAY"}
        self.background = []

    def popen(self, command, **streams):
        return subprocess.Popen(["bash", "-c", command], cwd=self.directory, env=self.environment,
                                start_new_session=True, **streams)

    def run(self, command):
        """All that is printed."""
        process = self.popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        try:
            return process.communicate(timeout=PATIENCE)[0].decode()
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            raise

    def start(self, command):
        before = self.names()
        self.background.append(self.popen("exec " + command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL))
        if command.startswith("roslaunch"):
            many = ("/first", "/second", "/third") if "many" in command else ("",)
            wait_for(lambda: all(name + "/hybrid_sphere/step" in self.names() for name in many), command)
        else:
            def listens():
                new = {name.split(" ")[0] for name in self.names() - before if " " in name}
                return any(connected(node) for node in new if not node.endswith("/hybrid_sphere"))
            wait_for(listens, "the connection of " + command)

    @staticmethod
    def names():
        """Services, and 'NODE TOPIC' for each topic of a simulator that a node listens to."""
        _, subscribers, services = rosgraph.Master("/test").getSystemState()
        return {name for name, _ in services} | {node + " " + topic for topic, nodes in subscribers for node in nodes
                                                 if topic.startswith("/hybrid_sphere/")}

    def interrupt(self):
        process = self.background.pop()
        process.send_signal(signal.SIGINT)
        return process.wait(PATIENCE)

    def close(self):
        while self.background:  # roslaunch ends what it has started
            self.interrupt()
        shutil.rmtree(self.directory)


class Tutorial(unittest.TestCase):
    def compare(self, printed, expected):
        pattern = "".join(r"(?:.*\n)*" if line == "..." else re.escape(line).replace(r"\.\.\.", ".*") + r"\n"
                          for line in expected)
        self.assertIsNotNone(re.fullmatch(pattern, printed), "printed:\n%s\nexpected:\n%s" % (printed, "\n".join(expected)))

    def test_what_it_says_is_what_happens(self):
        with open(rospy.get_param("~page")) as file:
            page = blocks(file.read())
        self.assertGreater(len(page), 10)
        terminal = Terminal()
        self.addCleanup(terminal.close)
        for kind, lines in page:
            if kind == "yaml":
                with open(os.path.join(terminal.directory, lines[0][2:]), "w") as file:
                    file.write("\n".join(lines) + "\n")
            for command, expected in commands(lines) if kind == "console" else ():
                with case(command=command):
                    if command == "^C":
                        self.assertIn(terminal.interrupt(), (0, -signal.SIGINT))
                    elif command.endswith(" &"):
                        terminal.start(command[:-2])
                    else:
                        self.compare(terminal.run(command), expected)
                    if not terminal.background and rospy.has_param("/use_sim_time"):
                        rospy.delete_param("/use_sim_time")  # a user's master ends with roslaunch
        self.assertEqual(terminal.background, [])


if __name__ == "__main__":
    rospy.init_node("tutorial_test")
    rostest.rosrun("hybrid_sphere", "tutorial_test", Tutorial)
