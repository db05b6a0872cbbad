#!/usr/bin/python3
"""Catches the sphere in a disc with a force on its centre: a proportional-derivative controller in the world frame,

    F = stiffness (target - r) - damping v, made shorter where it would be larger than the strongest force.

examples/steer_to_target.cpp is the same in C++.

    roslaunch hybrid_sphere steer.launch controller:=catch_in_disc.py x:=2.0 y:=1.0
or, beside a node that runs already,
    rosrun hybrid_sphere catch_in_disc.py _x:=2.0 _y:=1.0

Listens to hybrid_sphere/state, sends hybrid_sphere/cmd_wrench, once for each state: remap both for a node of another
name. When this program ends, the node drops the force after its ~command_timeout.

Parameters: ~x, ~y         centre of the disc in the world frame [m], 0
            ~radius        of the disc [m], > 0, default 0.2
            ~slow          speed below which a sphere in the disc counts as caught [m/s], > 0, default 0.05
            ~stiffness     [N/m], > 0, default 4
            ~damping       [N s/m], > 0, default 6
            ~strongest     largest force [N], > 0, default 20
"""
import math
import sys

import rospy
from geometry_msgs.msg import WrenchStamped
from hybrid_sphere.msg import SphereState


class Controller:
    def __init__(self, x, y, radius, slow, stiffness, damping, strongest):
        self.x, self.y = x, y
        self.radius, self.slow = radius, slow
        self.stiffness, self.damping, self.strongest = stiffness, damping, strongest
        self.caught = False
        self.commands = rospy.Publisher("hybrid_sphere/cmd_wrench", WrenchStamped, queue_size=1)
        rospy.Subscriber("hybrid_sphere/state", SphereState, self.steer, queue_size=1, tcp_nodelay=True)

    def steer(self, state):
        position, velocity = state.pose.position, state.twist.linear
        to_x, to_y = self.x - position.x, self.y - position.y
        force_x = self.stiffness * to_x - self.damping * velocity.x
        force_y = self.stiffness * to_y - self.damping * velocity.y
        size = math.hypot(force_x, force_y)
        shorter = self.strongest / size if size > self.strongest else 1.0
        command = WrenchStamped(header=state.header)  # the world frame: that of the force
        command.wrench.force.x, command.wrench.force.y = shorter * force_x, shorter * force_y
        self.commands.publish(command)

        caught = math.hypot(to_x, to_y) <= self.radius and math.hypot(velocity.x, velocity.y) < self.slow
        if caught != self.caught:
            rospy.loginfo("t = %.3f s: %s at x = %.3f m, y = %.3f m", state.time, "caught" if caught else "lost",
                          position.x, position.y)
        self.caught = caught


def read_parameters():
    defaults = {"x": 0, "y": 0, "radius": 0.2, "slow": 0.05, "stiffness": 4, "damping": 6, "strongest": 20}
    values = {name: rospy.get_param("~" + name, default) for name, default in defaults.items()}
    for name, value in values.items():
        number = isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)
        if not number or (name not in ("x", "y") and value <= 0):
            rospy.logfatal("~%s: %r is refused; x, y: finite numbers [m], all others: numbers > 0", name, value)
            sys.exit(1)
    return values


if __name__ == "__main__":
    if sys.argv[1:2] in (["-h"], ["--help"]):
        print(__doc__)
        sys.exit(0)
    rospy.init_node("catch_in_disc")
    Controller(**read_parameters())
    rospy.spin()
