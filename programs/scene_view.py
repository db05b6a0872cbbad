"""Where rviz has to look from to show a scene: the map, or the path of the next seconds, or the sphere as it travels."""
import math

FIELD_OF_VIEW = math.radians(45)  # of rviz's camera, from the top to the bottom of its picture
PITCH = 0.95  # of the first view, down onto the ground [rad]
MARGIN = 1.15
LETTER_WIDTH = 0.55  # of a name on the ground, over its height
WIDEST = 1.8  # aspect of a picture in a window as wide as screens are
MOST_FOR_NAMES = 1.6  # by which the camera moves away at most, so that names are whole
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


class Name:
    """A text that faces the camera: at (x, y) on the ground, of a height [m]."""

    def __init__(self, text, x, y, height):
        self.x, self.y = x, y
        self.half = [0.5 * LETTER_WIDTH * height * len(text), 0.5 * height]


def names_on(markers):
    """The names that a MarkerArray draws."""
    return [Name(m.text, m.pose.position.x, m.pose.position.y, m.scale.z) for m in markers if m.type == m.TEXT_VIEW_FACING]


def view_of(surface_map, path, names, radius, aspect, contact_frame):
    """rviz's view of a map and of places on the path, the first one where the sphere begins, as its configuration has it.

    names: of regions, which the edge of the picture should not cut.
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
    return view_of_whole_names(shown, names, radius, aspect)


def view_of_whole_names(shown, names, radius, aspect):
    """The view of a box from so far away, up to a limit, that the fewest names are cut by the edge of its picture."""
    view = framing_view(shown, radius, aspect)
    steps = 24
    views = [moved_away(view, MOST_FOR_NAMES ** (i / steps)) for i in range(steps + 1)]
    return min(views, key=lambda v: sum(is_cut(name, v, aspect) for name in names))


def moved_away(view, factor):
    return dict(view, **{key: factor * view[key] for key in ("Distance", "Near Clip Distance")})


def is_cut(name, view, aspect):
    """Whether the edge of the picture of a framing view goes through a name; a picture may be wider than told."""
    x, y = (value - view["Focal Point"][axis] for value, axis in ((name.x, "X"), (name.y, "Y")))
    depth = view["Distance"] + y * math.cos(PITCH)
    if depth <= 0:
        return False
    half = math.tan(0.5 * FIELD_OF_VIEW) * depth
    across, wide = abs(x) / (half * aspect), name.half[0] / (half * aspect)
    upward, high = abs(y) * math.sin(PITCH) / half, name.half[1] / half
    is_seen = across - wide < WIDEST / aspect and upward - high < 1
    return is_seen and (across + wide > 1 or upward + high > 1)


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
