"""Where rviz has to look from to show a scene: the map, or the path of the next seconds, or the sphere as it travels."""
import math

FIELD_OF_VIEW = math.radians(45)  # of rviz's camera, from the top to the bottom of its picture
PITCH = 0.95  # of the first view, down onto the ground [rad]
MARGIN = 1.15
TRAVELS = 3  # times the size of the map, or of a hundred radii where it has none: a path that long is followed


class Box:
    """The smallest box of axes that holds points."""

    def __init__(self):
        self.low = [math.inf, math.inf]
        self.high = [-math.inf, -math.inf]

    def add(self, x, y, reach=0.0):
        for i, value in enumerate((x, y)):
            self.low[i] = min(self.low[i], value - reach)
            self.high[i] = max(self.high[i], value + reach)

    def is_empty(self):
        return self.low[0] > self.high[0]

    def size(self):
        return 0.0 if self.is_empty() else max(h - l for h, l in zip(self.high, self.low))

    def middle(self):
        return [0.5 * (l + h) for l, h in zip(self.low, self.high)]


def box_of_map(surface_map):
    """Of what has an end on a SurfaceMap: not of half-planes."""
    box = Box()
    for region in surface_map.regions:
        if region.shape == region.HALF_PLANE:
            continue
        reach = region.radius if region.shape == region.CIRCLE else 0.0
        for point in region.points:
            box.add(point.x, point.y, reach)
    return box


def view_of(surface_map, path, radius, aspect, contact_frame):
    """rviz's view of a map and of places on the path, the first one where the sphere begins, as its configuration has it.

    aspect: width over height of the picture; contact_frame: goes with the sphere and does not turn."""
    bounded = box_of_map(surface_map)
    of_path = Box()
    for x, y in path:
        of_path.add(x, y, 2 * radius)
    longest = TRAVELS * (bounded.size() if not bounded.is_empty() else 100 * radius)
    if of_path.size() > longest or (of_path.is_empty() and bounded.is_empty()):
        return following_view(radius, contact_frame)
    shown = Box()
    for box in (bounded, of_path):
        if not box.is_empty():
            shown.add(*box.low)
            shown.add(*box.high)
    return framing_view(shown, radius, aspect)


def following_view(radius, contact_frame):
    return {"Class": "rviz/Orbit", "Name": "Current View", "Near Clip Distance": 0.01 * radius, "Distance": 25 * radius,
            "Focal Point": {"X": 0, "Y": 0, "Z": 0}, "Yaw": -0.5 * math.pi, "Pitch": 0.6, "Target Frame": contact_frame}


def framing_view(box, radius, aspect):
    """All of a box on the ground, seen from the south."""
    middle = box.middle()
    width, height = (max(h - l, 8 * radius) for l, h in zip(box.low, box.high))
    half = math.tan(0.5 * FIELD_OF_VIEW)
    far = max(0.5 * width / (half * aspect), 0.5 * height * math.sin(PITCH) / half)
    distance = MARGIN * (far + 0.5 * height * math.cos(PITCH))  # its southern edge is that much nearer
    return {"Class": "rviz/Orbit", "Name": "Current View", "Near Clip Distance": 0.01 * distance, "Distance": distance,
            "Focal Point": {"X": middle[0], "Y": middle[1], "Z": 0}, "Yaw": -0.5 * math.pi, "Pitch": PITCH,
            "Target Frame": "<Fixed Frame>"}
