"""What the parts of a MultibodySystem are described by. Vectors are arrays (3,), poses are arrays (4, 4)."""
from typing import NamedTuple

import numpy as np


class Twist(NamedTuple):
    """A velocity of a body, in the world.

    velocity          of the centre of mass [m/s]
    angular_velocity  [rad/s]
    """

    velocity: np.ndarray = (0.0, 0.0, 0.0)
    angular_velocity: np.ndarray = (0.0, 0.0, 0.0)


class Wrench(NamedTuple):
    """A force and a torque on a body, in the world.

    force   [N]
    torque  about the centre of mass [N m]
    """

    force: np.ndarray = (0.0, 0.0, 0.0)
    torque: np.ndarray = (0.0, 0.0, 0.0)


class BodyState(NamedTuple):
    """Where a body is and how it moves.

    pose   (4, 4), from the body's axes, with the centre of mass as their origin, to the world [m]
    twist  a Twist
    """

    pose: np.ndarray
    twist: Twist


class Plane(NamedTuple):
    """A plane that stands still: by default z = 0, with the bodies above it.

    point   on it [m]
    normal  to the side of the bodies, of any length > 0
    """

    point: np.ndarray = (0.0, 0.0, 0.0)
    normal: np.ndarray = (0.0, 0.0, 1.0)


class ContactShape(NamedTuple):
    """The part of a body that touches a plane: a sphere, or the edge of a disk.

    radius  > 0 [m]
    axle    of a disk, of any length > 0, in the world, with the body at its placement; None: it is a sphere
    center  in the world, with the body at its placement [m]; None: the centre of mass
    """

    radius: float = 1.0
    axle: np.ndarray = None
    center: np.ndarray = None

    @staticmethod
    def sphere(radius, center=None):
        """A sphere."""
        return ContactShape(radius, None, center)

    @staticmethod
    def disk(radius, axle, center=None):
        """The edge of a disk. It rolls along axle x normal where it turns about the axle."""
        return ContactShape(radius, axle, center)


def force_at(force, point, body):
    """A force at a point of a body, as a Wrench.

    force  in the world [N]
    point  where it acts, in the world [m]
    body   a BodyState
    """
    arm = np.asarray(point, float) - body.pose[:3, 3]
    return Wrench(np.asarray(force, float), np.cross(arm, force))
