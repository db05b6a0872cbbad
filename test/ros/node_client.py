"""What the rostests share: a client of the node, and the closed form of the impulse."""
import contextlib
import csv
import io
import os
import subprocess
import sys
import xmlrpc.client

import rosgraph
import roslib.packages
import rospy
import std_srvs.srv
from geometry_msgs.msg import Point, Vector3
from hybrid_sphere.msg import ConstraintSwitch, SphereState, SurfaceMap, SurfaceRegion
from hybrid_sphere.srv import GetSurfaceMap, SetInitialState, SetInitialStateRequest, SetSurfaceMap, Step
from rosgraph_msgs.msg import Log

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "support"))
from patience import PATIENCE, let_pass, lines_of, wait_for, wall_time  # noqa: E402, F401



def program(name):
    """Path of an executable of the package."""
    paths = roslib.packages.find_node("hybrid_sphere", name)
    assert paths, name + " is not built"
    return paths[0]


def simulate(*arguments):
    """The rows of the CSV that `simulate` writes to standard output."""
    output = subprocess.run([program("simulate"), "--quiet", *arguments], check=True, stdout=subprocess.PIPE)
    return list(csv.DictReader(io.StringIO(output.stdout.decode())))


def connected(node, master=None):
    """Whether a node receives something from another one's topics, those of ROS itself aside."""
    try:
        master = master or rosgraph.Master("/test")
        _, _, connections = xmlrpc.client.ServerProxy(master.lookupNode(node)).getBusInfo("/test")
    except (OSError, rosgraph.MasterException):  # not there yet, or not any more
        return False
    return any(c[2] == "i" and c[4] != "/clock" and c[5] for c in connections)


@contextlib.contextmanager
def case(**values):
    """Names the case in a failure's message; the XML of rostest loses failures in a subTest."""
    try:
        yield
    except AssertionError as error:
        raise AssertionError("%s: %s" % (values, error)) from error


class Listener:
    """Keeps every message of a topic."""

    def __init__(self, topic, message_class):
        self.messages = []  # grows in a thread of rospy
        self.subscriber = rospy.Subscriber(topic, message_class, self.messages.append, queue_size=10000)

    def is_connected(self):
        """Whether a publisher has answered; rospy counts a connection before it does."""
        return any(c.callerid_pub != "unknown" for c in self.subscriber.impl.connections)

    def wait(self, count=1):
        """Waits for so many messages in all and returns them."""
        wait_for(lambda: len(self.messages) >= count, "%d messages on %s" % (count, self.subscriber.name))
        return list(self.messages)

    def wait_for_one(self, condition):
        """Waits for a message for which the condition holds and returns it."""
        found = []
        wait_for(lambda: found.extend(m for m in list(self.messages) if condition(m)) or found,
                 "a certain message on " + self.subscriber.name)
        return found[0]

    def stop(self):
        self.subscriber.unregister()


def half_plane(name="rough_half", point=(0, 0), normal=(1, 0), law=SurfaceRegion.ROUGH):
    return SurfaceRegion(name=name, shape=SurfaceRegion.HALF_PLANE, points=[Point(*point, 0)],
                         normal=Vector3(*normal, 0), law=law)


def circle(name, center, radius, law=SurfaceRegion.ROUGH, outside=False):
    return SurfaceRegion(name=name, shape=SurfaceRegion.CIRCLE, points=[Point(*center, 0)], radius=radius, law=law,
                         outside=outside)


def polygon(name, corners, law=SurfaceRegion.ROUGH, outside=False):
    return SurfaceRegion(name=name, shape=SurfaceRegion.POLYGON, points=[Point(*corner, 0) for corner in corners],
                         law=law, outside=outside)


def surface(*regions, base=SurfaceRegion.SMOOTH, livelock=SurfaceMap.SLIDE):
    """A map; the base is a law or a region with all that belongs to a material."""
    base = base if isinstance(base, SurfaceRegion) else SurfaceRegion(law=base)
    return SurfaceMap(base=base, regions=list(regions), livelock=livelock)


def made_of(region, **material):
    """The region with fields of its material set: friction=0.3, belt=(1, 0), turntable=(rate, (x, y)), ..."""
    if "belt" in material:
        region.belt = Vector3(*material.pop("belt"), 0)
    if "turntable" in material:
        region.turntable_rate, center = material.pop("turntable")
        region.turntable_center = Point(*center, 0)
    for field, value in material.items():
        assert hasattr(region, field)
        setattr(region, field, value)
    return region


def initial_state(position=(0, 0), velocity=(0, 0), omega=(0, 0, 0), orientation=(0, 0, 0, 0)):
    request = SetInitialStateRequest()
    request.pose.position.x, request.pose.position.y = position
    q = request.pose.orientation
    q.x, q.y, q.z, q.w = orientation
    request.twist.linear.x, request.twist.linear.y = velocity
    w = request.twist.angular
    w.x, w.y, w.z = omega
    return request


class Console:
    """What a node says on the console from now on, as it comes on /rosout, which is latched."""

    def __init__(self, node, is_there=True):
        """Of a node that has begun, or will begin later."""
        self.node = node
        self.begin = rospy.Time.from_sec(wall_time())
        self.lines = Listener("/rosout", Log)
        # Every node is on /rosout, this one, too.
        if is_there:
            wait_for(lambda: any(c.callerid_pub == node for c in self.lines.subscriber.impl.connections),
                     "%s on /rosout" % node)

    def said(self, level):
        """All messages of one level, oldest first."""
        return [m.msg for m in list(self.lines.messages)
                if m.name == self.node and m.level == level and m.header.stamp >= self.begin]

    def wait_for_next(self, level, count):
        """The message of a level that comes after so many."""
        return wait_for(lambda: self.said(level)[count:], "a message of %s on the console" % self.node)[0]


class Client:
    """The node's services, and its states and switches."""

    def __init__(self, node="/hybrid_sphere"):
        self.node = node
        self.sphere = rospy.get_param(node + "/sphere")
        self.states = Listener(node + "/state", SphereState)
        self.switches = Listener(node + "/constraint_switch", ConstraintSwitch)
        self.set_surface_map = self.service("set_surface_map", SetSurfaceMap)
        self.get_surface_map = self.service("get_surface_map", GetSurfaceMap)
        self.set_initial_state = self.service("set_initial_state", SetInitialState)
        self.reset = self.service("reset", std_srvs.srv.Trigger)
        self.pause = self.service("pause", std_srvs.srv.SetBool)
        self.step = self.service("step", Step)
        self.states.wait()

    def service(self, name, service_class):
        rospy.wait_for_service(self.node + "/" + name, PATIENCE)
        return rospy.ServiceProxy(self.node + "/" + name, service_class)

    def present(self):
        """The state that the node has reached: the answer to a step that it refuses. What is on its way is older."""
        answer = self.step(0)
        assert not answer.success
        return answer.state

    def state(self):
        """A state that was sent after this call."""
        before = self.present().header.stamp
        return self.states.wait_for_one(lambda m: m.header.stamp > before)

    @contextlib.contextmanager
    def standing(self):
        """Time stands meanwhile. Gives a stamp: no message of before is later, all of what is done then are."""
        runs = self.pause(True).message == "paused"
        yield self.present().header.stamp
        if runs:
            self.pause(False)

    def start(self, request=None):
        """Puts the sphere somewhere, or back to its last initial state; gives the stamp that tells before from after."""
        with self.standing() as stamp:
            answer = self.set_initial_state(request) if request else self.reset()
        assert answer.success, answer.message
        return stamp

    def states_until_now(self):
        """All states that the node has sent; to be called while time stands."""
        stamp = self.present().header.stamp
        wait_for(lambda: self.states.messages[-1].header.stamp == stamp, "the present state")
        return list(self.states.messages)

    def switch_after(self, stamp, index=0):
        """The switch of an index that is not older than a stamp."""
        return self.switches.wait_for_one(lambda m: m.header.stamp >= stamp and m.index == index)


class Impulse:
    """Impulse and velocities when a sphere on still ground stops slipping at once: (20), (22), corrected (23)."""

    def __init__(self, mass, radius, gyration_radius_squared, velocity, omega):
        k2 = gyration_radius_squared
        d = radius**2 + k2
        (vx, vy), (w1, w2, w3) = velocity, omega
        self.slip = (vx - radius * w2, vy + radius * w1)
        self.impulse = tuple(-mass * k2 / d * s for s in self.slip)
        self.velocity = ((radius**2 * vx + radius * k2 * w2) / d, (radius**2 * vy - radius * k2 * w1) / d)
        self.omega = ((-radius * vy + k2 * w1) / d, (radius * vx + k2 * w2) / d, w3)
        self.energy_lost = 0.5 * mass * k2 / d * sum(s * s for s in self.slip)
