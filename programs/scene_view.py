"""The views of rviz that show a simulation, by the message on the topic ~view of its node."""


def orbit_view(name, target, center, distance, view):
    """A view of rviz's configuration that looks at a point of a frame, from the direction of a SceneView.

    target: name of the frame; center: in it [m]; distance: of the camera from there [m]."""
    return {"Class": "rviz/Orbit", "Name": name, "Near Clip Distance": 0.01 * distance, "Distance": distance,
            "Focal Point": dict(zip("XYZ", center)), "Yaw": view.yaw, "Pitch": view.pitch, "Target Frame": target}


def first_view(view, name="Current View"):
    """Keeps the body in the picture."""
    return orbit_view(name, view.view_frame, (0, 0, 0), view.distance, view)


def whole_view(view):
    """Shows the whole map."""
    center = view.whole_center
    return orbit_view("whole", view.header.frame_id, (center.x, center.y, center.z), view.whole_distance, view)


def top_view(view):
    """The first view from above."""
    pixels_per_metre = 900 / view.distance  # as many as in the middle of the first view in a window of 1600 x 900
    return {"Class": "rviz/TopDownOrtho", "Name": "top", "Near Clip Distance": 0.01, "Angle": 0, "Scale": pixels_per_metre,
            "X": 0, "Y": 0, "Target Frame": view.view_frame}
