#!/usr/bin/python3
"""Catches the sphere in a disc, in lock-step: the controller lets the plant go on, period by period, by ~step. However busy
the machine is, the plant waits for the controller, and every run is the same to the bit.

    roslaunch hybrid_sphere lock_step.launch x:=2.0 y:=1.0

The plant has to be started with paused:=true and ~command_timeout 0, which holds a command until the next one; a timeout
counts wall time and would let the machine's load into the motion. With sim_time:=true, as in that launch file, rospy's own
time is the plant's, and stands between two steps: in a loop like this one nothing may wait by rospy.sleep or rospy.Rate.

Calls hybrid_sphere/{pause,reset,step}, sends hybrid_sphere/cmd_wrench: remap them for a node of another name.
Exit code 0: caught, 1: not caught in time, a parameter is refused, or a service failed.

Parameters: ~x, ~y         centre of the disc in the world frame [m], 0
            ~radius        of the disc [m], > 0, default 0.2
            ~slow          speed below which a sphere in the disc counts as caught [m/s], > 0, default 0.05
            ~stiffness     [N/m], > 0, default 4
            ~damping       [N s/m], > 0, default 6
            ~period        of the controller [s], > 0, default 0.02
            ~longest       after which it gives up [s], > 0, default 60
"""
import math
import sys
import warnings

import rospy
from geometry_msgs.msg import WrenchStamped
from hybrid_sphere.srv import Step
from std_srvs.srv import SetBool, Trigger


class Plant:
    """The simulator, driven by its services."""

    def __init__(self):
        def service(name, kind):
            rospy.wait_for_service("hybrid_sphere/" + name)
            return rospy.ServiceProxy("hybrid_sphere/" + name, kind, persistent=True)

        self.pause = service("pause", SetBool)
        self.reset = service("reset", Trigger)
        self.step_service = service("step", Step)
        # Without a queue publish() returns when the message is on its way, and not before; rospy warns of that.
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SyntaxWarning)
            self.commands = rospy.Publisher("hybrid_sphere/cmd_wrench", WrenchStamped, queue_size=None)

    def begin(self):
        """Puts the sphere where it started, and lets no time pass."""
        self.pause(True)
        while self.commands.get_num_connections() == 0 and not rospy.is_shutdown():
            rospy.rostime.wallsleep(0.01)
        self.reset()

    def step(self, duration, force=(0.0, 0.0)):
        """Goes on for a duration [s] under a force [N]; the state at the end, and the number of switches on the way."""
        command = WrenchStamped()
        command.wrench.force.x, command.wrench.force.y = force
        self.commands.publish(command)
        self.pause(True)  # the node handles what comes in order: when it answers this, it has taken the command
        answer = self.step_service(duration)
        if not answer.success:
            raise rospy.ServiceException(answer.message)
        return answer.state, answer.switches


def catch(plant, x, y, radius, slow, stiffness, damping, period, longest):
    """Steers until the sphere is caught; that state, or None, and all switches."""
    plant.begin()
    state, switches = plant.step(period)
    while state.time < longest:
        position, velocity = state.pose.position, state.twist.linear
        to_x, to_y = x - position.x, y - position.y
        if math.hypot(to_x, to_y) <= radius and math.hypot(velocity.x, velocity.y) < slow:
            return state, switches
        state, more = plant.step(period, (stiffness * to_x - damping * velocity.x,
                                          stiffness * to_y - damping * velocity.y))
        switches += more
    return None, switches


def read_parameters():
    """Throws ValueError."""
    defaults = {"x": 0, "y": 0, "radius": 0.2, "slow": 0.05, "stiffness": 4, "damping": 6, "period": 0.02, "longest": 60}
    values = {name: rospy.get_param("~" + name, default) for name, default in defaults.items()}
    for name, value in values.items():
        number = isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)
        if not number or (name not in ("x", "y") and value <= 0):
            raise ValueError("~%s: %r is refused; x, y: finite numbers [m], all others: numbers > 0" % (name, value))
    return values


def main():
    rospy.init_node("catch_in_lock_step")
    parameters = read_parameters()
    state, switches = catch(Plant(), **parameters)
    if state is None:
        print("not caught, %d switches on the way" % switches)
        return 1
    position = state.pose.position  # repr gives every bit
    print("caught at t = %r s, x = %r m, y = %r m, %d switches on the way"
          % (state.time, position.x, position.y, switches), flush=True)
    return 0


if __name__ == "__main__":
    if sys.argv[1:2] in (["-h"], ["--help"]):
        print(__doc__)
        sys.exit(0)
    try:
        sys.exit(main())
    except ValueError as error:
        print(error, file=sys.stderr)
        sys.exit(1)
    except rospy.ServiceException as error:
        print("the plant does not go on: %s" % error, file=sys.stderr)
        sys.exit(1)
