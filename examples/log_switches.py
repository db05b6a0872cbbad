#!/usr/bin/python3
"""Logs every switch of the constraint, and proves that none was lost: their index counts 0, 1, 2 ... from each initial
state on.

    rosrun hybrid_sphere log_switches.py

Listens to hybrid_sphere/constraint_switch: remap it for a node of another name. Start it before the simulator moves
(paused:=true in sim.launch) to have all from the first one on. On Ctrl-C it says how many came and how many are missing;
exit code 0: none is missing between the first and the last of each run, 1: some are.
"""
import sys

import rospy
from hybrid_sphere.msg import ConstraintSwitch

KINDS = {ConstraintSwitch.APPLIED: "applied", ConstraintSwitch.RELEASED: "released",
         ConstraintSwitch.EXCHANGED: "exchanged"}


class Log:
    def __init__(self):
        self.received = 0
        self.missing = 0
        self.runs = 0     # initial states
        self.last = None  # the switch before
        # No queue_size: rospy keeps what has not been handled yet, however much it is.
        rospy.Subscriber("hybrid_sphere/constraint_switch", ConstraintSwitch, self.add)

    def add(self, switch):
        if self.last and (switch.header.stamp, switch.index) == (self.last.header.stamp, self.last.index):
            return  # the topic is latched: who connects again gets the last one again
        if self.last is None:  # who comes late gets the last one of those before
            expected = switch.index
        elif switch.index <= self.last.index:
            expected = 0
        else:
            expected = self.last.index + 1
        self.missing += switch.index - expected
        self.received += 1
        if self.last is None or expected == 0:
            self.runs += 1
        self.last = switch
        impulse = switch.impulse
        print("%d.%09d  index %d  t = %.9f s  %s: %s -> %s  impulse (%.6g, %.6g) N s"
              % (switch.header.stamp.secs, switch.header.stamp.nsecs, switch.index, switch.time, KINDS[switch.kind],
                 switch.from_region or "-", switch.to_region, impulse.x, impulse.y), flush=True)

    def report(self):
        print("%d switches since %d initial state%s, %s" % (self.received, self.runs, "" if self.runs == 1 else "s",
              "%d LOST" % self.missing if self.missing else "none lost"), flush=True)


if __name__ == "__main__":
    if sys.argv[1:2] in (["-h"], ["--help"]):
        print(__doc__)
        sys.exit(0)
    rospy.init_node("log_switches")
    log = Log()
    rospy.spin()
    log.report()
    sys.exit(1 if log.missing else 0)
