#!/usr/bin/python3
"""What rviz's first view shows of every scene and system: computed from markers, frames and the camera of rviz_scene."""
import math
import os
import signal
import subprocess
import sys
import unittest

import numpy as np
import rospkg
import rospy
import rostest
import yaml
from hybrid_sphere.msg import SceneView
from hybrid_sphere.srv import Step
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

from node_client import PATIENCE, Listener, case, program, wait_for

sys.path.insert(0, os.path.dirname(os.path.realpath(program("rviz_scene"))))
PACKAGE = rospkg.RosPack().get_path("hybrid_sphere")
SCENES = sorted(name[:-5] for name in os.listdir(os.path.join(PACKAGE, "config")) if name.endswith(".yaml"))
TIMES = (1, 5, 12, 60)  # [s]
HEIGHT = 760  # of the picture in a window of 1600 x 900 [pixels]
NARROW = 1.25  # width over height of the picture of a narrow window
USUAL = 1.5  # of a window of 1600 x 900
LEAST_WIDTH = 25  # of a body [pixels]


class Camera:
    """An orbit view of rviz's configuration."""

    def __init__(self, view, target):
        """target: place of the frame that it looks at [m]."""
        pitch, yaw = view["Pitch"], view["Yaw"]
        self.distance = view["Distance"]
        self.focus = target + np.array([view["Focal Point"][axis] for axis in "XYZ"])
        self.to_camera = np.array([math.cos(yaw) * math.cos(pitch), math.sin(yaw) * math.cos(pitch), math.sin(pitch)])
        self.right = np.cross([0, 0, 1], self.to_camera) / math.cos(pitch)
        self.upward = np.cross(self.to_camera, self.right)
        self.half = math.tan(0.5 * math.radians(45))

    def depth(self, place):
        return self.distance - (place - self.focus) @ self.to_camera

    def seen(self, place, half=(0, 0)):
        """Middle of a rectangle that faces the camera, and half its width and height, in half heights of the picture."""
        scale = self.half * self.depth(place)
        offset = place - self.focus
        return np.array([offset @ self.right, offset @ self.upward]) / scale, np.array(half) / scale

    def on_ground(self, across, up):
        """The place on the ground that is seen at a point of the picture."""
        ray = -self.to_camera + self.half * (across * self.right + up * self.upward)
        eye = self.focus + self.distance * self.to_camera
        return (eye - eye[2] / ray[2] * ray)[:2]


def vector(v):
    return np.array([v.x, v.y, v.z])


def half_of(text):
    """Half the width and the height of a text [m]."""
    return 0.5 * text.scale.z * np.array([0.55 * len(text.text), 1])


class Watched:
    """A paused node with its markers, as rviz has them."""

    def __init__(self, executable, name, parameters):
        self.name = "/" + name
        rospy.set_param(self.name, dict(parameters, paused=True))
        self.markers = Listener(self.name + "/markers", MarkerArray)
        self.ground = Listener(self.name + "/surface_markers", MarkerArray)
        self.transforms = Listener("/tf", TFMessage)
        self.process = subprocess.Popen([program(executable), "__name:=" + name])
        view = Listener(self.name + "/view", SceneView)
        self.view = view.wait()[0]
        view.stop()
        printed = subprocess.run([program("rviz_scene"), "--node", self.name, "--print"], check=True, timeout=PATIENCE,
                                 stdout=subprocess.PIPE).stdout
        self.current = yaml.safe_load(printed)["Visualization Manager"]["Views"]["Current"]
        rospy.wait_for_service(self.name + "/step", PATIENCE)
        self.step = rospy.ServiceProxy(self.name + "/step", Step)
        self.time = 0
        self.applied = {self.markers: 0, self.ground: 0}
        self.shown = {self.markers: {}, self.ground: {}}

    def stop(self):
        for listener in (self.markers, self.ground, self.transforms):
            listener.stop()
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
            self.process.wait(PATIENCE)

    def go_to(self, time):
        """In steps of some seconds, so that whoever draws sees the way; up to where the motion ends."""
        while self.time < time:
            seen = len(self.markers.messages)
            duration = 1 if self.time < 12 else 4
            if not self.step(float(duration)).success:
                return
            self.time += duration
            wait_for(lambda: len(self.markers.messages) > seen, "markers")
        drawn = len(self.markers.messages)
        wait_for(lambda: len(self.markers.messages) >= drawn + 2, "markers of the last state")

    def shown_on(self, listener):
        """The markers of a topic that are shown now, by namespace and index."""
        shown = self.shown[listener]
        messages = list(listener.messages)
        for message in messages[self.applied[listener]:]:
            for marker in message.markers:
                if marker.action == Marker.DELETEALL:
                    shown.clear()
                elif marker.action == Marker.DELETE:
                    shown.pop((marker.ns, marker.id), None)
                else:
                    shown[marker.ns, marker.id] = marker
        self.applied[listener] = len(messages)
        return shown

    def places(self):
        """Where the frames are by the last message, the body's first: a dictionary keeps the order."""
        own = wait_for(lambda: [m for m in list(self.transforms.messages)
                                if m.transforms[-1].child_frame_id == self.view.view_frame], "transforms")
        return {t.child_frame_id: vector(t.transform.translation) for t in own[-1].transforms}

    def camera(self):
        target = self.places()[self.current["Target Frame"]]
        return Camera(self.current, target)

    def texts(self):
        """Names on the ground, and labels of impulses."""
        return [m for listener in (self.ground, self.markers) for m in self.shown_on(listener).values()
                if m.type == Marker.TEXT_VIEW_FACING]


def overlap(a, b):
    """By how much of their heights two rectangles (middle, half) overlap, 0 if they do not."""
    apart = np.abs(a[0] - b[0])
    gap = a[1] + b[1] - apart
    return 0 if np.min(gap) <= 0 else min(gap) / (2 * min(a[1][1], b[1][1]))


class Pictures(unittest.TestCase):
    def expect_body(self, watched, half_width):
        camera = watched.camera()
        frame, body = next(iter(watched.places().items()))
        drawn = [m for m in watched.shown_on(watched.markers).values() if m.header.frame_id == frame and m.frame_locked]
        self.assertTrue(drawn, "a fast body does not lag behind the view if both are frames")
        middle, half = camera.seen(body, (half_width, half_width))
        self.assertLessEqual(abs(middle[0]) + half[0], NARROW)
        self.assertLessEqual(abs(middle[1]) + half[1], 1)
        self.assertGreaterEqual(half[0] * HEIGHT, LEAST_WIDTH)

    def expect_ground(self, watched):
        """Ground is drawn wherever the picture shows it."""
        def is_drawn():
            camera = watched.camera()
            fills = [m for m in watched.shown_on(watched.ground).values() if m.ns == "regions"]
            points = np.array([(p.x, p.y) for m in fills for p in m.points])
            corners = [camera.on_ground(x, y) for x in (-USUAL, USUAL) for y in (-1, 1)]
            return all(np.all(points.min(0) <= c) and np.all(c <= points.max(0)) for c in corners)

        wait_for(is_drawn, "ground in the whole picture")

    def faults_of_texts(self, watched):
        """Texts in the picture that overlap each other or the body."""
        camera = watched.camera()
        body = next(iter(watched.places().values()))
        seen = [(t.text, camera.seen(vector(t.pose.position), half_of(t))) for t in watched.texts()
                if camera.depth(vector(t.pose.position)) > 0.2 * camera.distance]
        seen = [(text, box) for text, box in seen if np.all(np.abs(box[0]) < (USUAL, 1))]
        faults = [(a, b) for i, (a, box) in enumerate(seen) for b, other in seen[:i] if overlap(box, other) > 0.1]
        radius = watched.half_width
        ball = camera.seen(body, (0.7 * radius, 0.7 * radius))  # the square in the disc that is seen of a ball
        labels = {t.text for t in watched.texts() if t.ns.startswith("impulse")}
        return faults + [(text, "body") for text, box in seen if text in labels and overlap(box, ball) > 0.1]

    def expect_whole_names(self, watched):
        """The edge of the picture cuts no name in the first view."""
        watched.ground.wait()
        camera = watched.camera()
        for text in watched.texts():
            middle, half = camera.seen(vector(text.pose.position), half_of(text))
            is_whole = np.all(np.abs(middle) + half <= (USUAL, 1))
            self.assertTrue(is_whole or np.any(np.abs(middle) - half >= (USUAL, 1)), text.text)

    def expect_texts(self, watched):
        last = []

        def none():
            last[:] = self.faults_of_texts(watched)
            return not last

        try:
            wait_for(none, "texts that do not overlap")
        except AssertionError as error:
            raise AssertionError("%s: %s" % (error, last)) from error

    def test_scenes(self):
        for scene in SCENES:
            with open(os.path.join(PACKAGE, "config", scene + ".yaml")) as file:
                parameters = dict(yaml.safe_load(file), scene_directory=os.path.join(PACKAGE, "config"))
            watched = Watched("hybrid_sphere_node", scene, parameters)
            self.addCleanup(watched.stop)
            watched.half_width = parameters["sphere"]["radius"]
            names = {}
            with case(scene=scene):
                watched.step(1e-3)  # a message on /tf is sent
                self.expect_whole_names(watched)
            for time in TIMES:
                with case(scene=scene, time=time):
                    watched.go_to(time)
                    self.expect_ground(watched)
                    self.expect_body(watched, watched.half_width)
                    self.expect_texts(watched)
                    now = {(t.text, t.pose.position.x, t.pose.position.y): t.scale.z for t in watched.texts()
                           if t.ns == "names"}
                    self.assertTrue(now)
                    self.assertEqual({name: now.get(name) for name in names}, names, "a name stays where it is")
                    names = now
            watched.stop()

    def test_systems(self):
        listed = subprocess.run([program("three_stage"), "list"], check=True, stdout=subprocess.PIPE).stdout.decode()
        systems = [line.split()[0] for line in listed.splitlines() if line.strip()]
        self.assertGreaterEqual(len(systems), 13)
        for system in systems:
            watched = Watched("three_stage_node", system, {"system": system})
            self.addCleanup(watched.stop)
            shape = watched.markers.wait()[0].markers[0]
            watched.half_width = 0.5 * sorted((shape.scale.x, shape.scale.y, shape.scale.z))[1]
            for time in TIMES:
                with case(system=system, time=time):
                    watched.go_to(time)
                    self.expect_body(watched, watched.half_width)
                    self.expect_texts(watched)
                    self.assertIn(("constraints", 0), watched.shown_on(watched.markers))
            watched.stop()


if __name__ == "__main__":
    rospy.init_node("picture_test")
    rostest.rosrun("hybrid_sphere", "picture_test", "__main__")
