"""What `plot` reads of a file of `study`: the numbers of the runs, a slice after another, and what is known of them."""
import difflib
import itertools

import h5py
import numpy as np
import yaml

import plot_ground
from plot_inputs import LARGEST, InputError

FORMAT = "hybrid_sphere study 1"
SLICE = 1 << 17  # runs that are in memory at once
GROUPS = ("samples", "end", "at", "entered", "switches", "extremes", "outcome", "stop", "stopped_at")


def text_of(value):
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)


def texts_of(dataset):
    return [text_of(value) for value in np.asarray(dataset).ravel()]


class Number:
    """A number that each run has, or of which it is missing: NaN."""

    def __init__(self, file, name, dataset, index):
        self.file = file
        self.name = name
        self.unit = text_of(dataset.attrs.get("unit", ""))
        self.is_whole = dataset.dtype.kind in "iu"
        self.names = file.names_of_codes(dataset) if self.is_whole else []
        self._dataset = dataset
        self._index = index
        self.title = name
        if dataset.name == "/entered":
            self.title = "enters \"%s\" at" % file.regions_that_are_entered()[index[0]]

    @property
    def label(self):
        return self.title + (" [%s]" % self.unit if self.unit else "")

    @property
    def kind(self):
        """The dataset: components of one quantity have it in common."""
        return self._dataset.name.lstrip("/")

    def read(self, begin, end):
        """Of the runs begin .. end - 1. Throws InputError."""
        with self.file.reading():
            values = self._dataset[(slice(begin, end), *self._index)]
        if self.is_whole:
            return np.where(values < 0, np.nan, values)
        if (np.abs(values) > LARGEST).any():
            raise InputError("%s: a number of %s is refused; allowed: -%g to %g" % (
                self.file.path, self.name, LARGEST, LARGEST))
        return values


class Speed:
    """Of the centre, at the end of each run."""

    title, name, kind, unit, names, is_whole = "speed at the end", "end/speed", "end/speed", "m/s", [], False
    label = "speed at the end [m/s]"

    def __init__(self, components):
        self._components = components
        self.file = components[0].file

    def read(self, begin, end):
        return np.hypot(*(component.read(begin, end) for component in self._components))


def opened(path):
    """Throws InputError."""
    try:
        with open(path, "rb"):  # it has plainer words for what is not there
            pass
    except OSError as error:
        raise InputError("%s: cannot be read: %s" % (path, error.strerror or error)) from error
    try:
        return h5py.File(path, "r")
    except OSError as error:
        raise InputError("%s: cannot be read as HDF5: %s" % (path, " ".join(str(error).split()))) from error


class StudyFile:
    """@param path  Throws InputError where it is not what `study` has written."""

    def __init__(self, path):
        self.path = path
        with self.reading():
            self._h5 = opened(path)
            form = text_of(self._h5.attrs.get("format", ""))
            if form != FORMAT:
                raise InputError("%s: is no file of `study`: its format is \"%s\", not \"%s\"" % (path, form, FORMAT))
            self.runs = int(self._h5.attrs["runs"])
            self.outcomes = [int(count) for count in self._h5["outcomes"]]
            self.variables = ["samples/" + name.replace("/", "%2F") for name in texts_of(self._h5["variables"])]
            self._places = dict(self._find_places())
            self.ground, self.has_image = self._ground()

    def reading(self):
        return Reading(self.path)

    def names_of_codes(self, dataset):
        table = "names/" + dataset.name.rpartition("/")[2]
        return texts_of(self._h5[table]) if table in self._h5 else []

    def _find_places(self):
        """The name of each number, and its place: a dataset and indices behind that of the run."""
        for group in GROUPS:
            for name in self._datasets_in(group):
                shape = self._h5[name].shape
                if not shape or shape[0] != self.runs:
                    raise InputError("%s: is not the whole file of a study: %s has not a row for each of %d runs" % (
                        self.path, name, self.runs))
                for index in itertools.product(*(range(size) for size in shape[1:])):
                    yield name + "".join("[%d]" % i for i in index), (name, index)

    def _datasets_in(self, group):
        if group not in self._h5:
            return []
        if group == "samples":
            return self.variables
        if isinstance(self._h5[group], h5py.Dataset):
            return [group]
        return ["%s/%s" % (group, name) for name in self._h5[group]]

    def _ground(self):
        try:
            scene = yaml.safe_load(texts_of(self._h5["scene"])[0])
            return plot_ground.from_scene(scene)[0], "image" in (scene.get("surface") or {})
        except (AttributeError, IndexError, TypeError, KeyError, ValueError, yaml.YAMLError) as error:
            raise InputError("%s: has no scene that can be read: %s" % (self.path, " ".join(str(error).split())))

    def __contains__(self, name):
        return name in self._places

    def named(self, name):
        """Throws InputError where it is not there."""
        if name not in self._places:
            near = difflib.get_close_matches(name, self._places, 1, 0)
            raise InputError("%s: \"%s\" is no number of this study%s" % (
                self.path, name, "; the nearest one is %s" % near[0] if near else ""))
        dataset, index = self._places[name]
        return Number(self, name, self._h5[dataset], index)

    def of(self, dataset):
        """The numbers of a dataset, or of a group of datasets."""
        return [self.named(name) for name, (where, _) in self._places.items()
                if where == dataset or where.startswith(dataset + "/")]

    def slices(self, numbers):
        """The values of numbers, (len(numbers), n), a slice of the runs after another."""
        for begin in range(0, self.runs, SLICE):
            end = min(begin + SLICE, self.runs)
            yield np.array([number.read(begin, end) for number in numbers], dtype=float)

    def sampled(self, numbers, most):
        """The values of numbers, (len(numbers), n), for at most so many runs, evenly among all."""
        count = min(most, self.runs)
        chosen = np.arange(count, dtype=np.int64) * self.runs // count if count else np.empty(0, np.int64)
        parts, begin = [np.empty((len(numbers), 0))], 0
        for values in self.slices(numbers):
            low, high = np.searchsorted(chosen, (begin, begin + values.shape[1]))
            parts.append(values[:, chosen[low:high] - begin])
            begin += values.shape[1]
        return np.concatenate(parts, axis=1)

    def probabilities(self):
        """Of the quantiles that the study has asked for, or usual ones."""
        if "summary/probabilities" not in self._h5:
            return [0.05, 0.5, 0.95]
        with self.reading():
            return sorted({float(p) for p in self._h5["summary/probabilities"]})

    def regions_that_are_entered(self):
        with self.reading():
            return texts_of(self._h5["entered_regions"])

    def entered(self):
        """(region, (probability, low, high)) of each region, where the study has looked."""
        if "entered" not in self._h5 or "summary/entered" not in self._h5:
            return []
        with self.reading():
            return list(zip(self.regions_that_are_entered(), np.asarray(self._h5["summary/entered"]).tolist()))

    def sensitivities(self):
        """Of each number: first and total indices, (variables, 3) each: value, low, high."""
        found = {}
        for name in self._places:
            group = "sensitivity/" + name
            if group not in self._h5:
                continue
            with self.reading():
                indices = [np.asarray(self._h5[group][kind], dtype=float) for kind in ("first", "total")]
            if any(part.shape != (len(self.variables), 3) for part in indices):
                raise InputError("%s: %s has not three numbers for each of %d variables" % (
                    self.path, group, len(self.variables)))
            found[name] = indices
        return found


class Reading:
    """Within it what HDF5 cannot read becomes an InputError."""

    def __init__(self, path):
        self._path = path

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        if isinstance(error, (OSError, LookupError, ValueError, TypeError, AttributeError, RuntimeError)):
            raise InputError("%s: is not the whole file of a study: %s" % (
                self._path, " ".join(str(error).split()))) from error
