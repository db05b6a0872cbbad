"""What `plot` computes from the numbers of a study: histograms and quantiles of all runs, and densities of places."""
import itertools

import numpy as np

from plot_study_input import Speed

BINS = 48
FINE = 128           # of them in a bin; a quantile is as exact as one is wide
MOST_WHOLE = 60      # whole numbers that have a bin each
CELLS = 140          # along a side of a view, for densities
FEWEST = 20          # places that have a density
LOWEST = 0.75        # height of a view by its width


class Histogram:
    """The count of runs in each bin, and the moments and quantiles of one number."""

    def __init__(self, number, probabilities):
        self.number = number
        self.count, self.missing, self.mean = 0, 0, np.nan
        self.edges, self.counts, self.quantiles = np.empty(0), np.empty(0, int), []
        low, high = self._look()
        if self.count:
            self._fill(low, high, probabilities)

    @property
    def missing_share(self):
        return self.missing / max(1, self.count + self.missing)

    @property
    def varies(self):
        return np.count_nonzero(self.counts) > 1

    def _look(self):
        low, high, total = np.inf, -np.inf, 0.0
        for value, in self.number.file.slices([self.number]):
            known = value[~np.isnan(value)]
            self.missing += len(value) - len(known)
            if len(known):
                self.count += len(known)
                total += known.sum()
                low, high = min(low, known.min()), max(high, known.max())
        self.mean = total / max(1, self.count)
        return low, high

    def _fill(self, low, high, probabilities):
        self.edges = edges_of(low, high, self.number.is_whole)
        bins, span = len(self.edges) - 1, (self.edges[0], self.edges[-1])
        self.counts, fine = np.zeros(bins, np.int64), np.zeros(bins * FINE, np.int64)
        for value, in self.number.file.slices([self.number]):
            known = value[~np.isnan(value)]
            self.counts += np.histogram(known, bins, span)[0]
            fine += np.histogram(known, bins * FINE, span)[0]
        if self.number.is_whole and bins == round(high - low) + 1:
            self.quantiles = [(p, whole_quantile(self.counts, low, p)) for p in probabilities]
        else:
            self.quantiles = [(p, min(max(quantile(fine, span, p), low), high)) for p in probabilities]


def edges_of(low, high, is_whole):
    """Those of equal bins. Whole numbers are in the middle of theirs."""
    if is_whole and high - low < MOST_WHOLE:
        return np.arange(low - 0.5, high + 1)
    if high - low <= 1e-10 * max(abs(low), abs(high)):  # fewer binary64 numbers than bins
        half = 0.1 * abs(low) or 0.5
        return np.array([low - half, low + half])
    return np.linspace(low, high, BINS + 1)


def quantile(counts, span, probability):
    """Between the edges of equal bins the runs are taken to be even."""
    target = probability * counts.sum()
    below = np.cumsum(counts)
    i = min(int(np.searchsorted(below, target)), len(counts) - 1)
    part = (target - (below[i] - counts[i])) / counts[i] if counts[i] else 0
    return span[0] + (span[1] - span[0]) * (i + part) / len(counts)


def whole_quantile(counts, low, probability):
    return low + float(np.searchsorted(np.cumsum(counts), probability * counts.sum()))


def smoothed(counts, deviations):
    """By normal curves, with their deviations along the axes [cells]; the sum is kept but for what leaves the grid."""
    for axis, deviation in enumerate(deviations):
        reach = int(np.ceil(4 * deviation))
        weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) / deviation)**2)
        weights /= weights.sum()
        counts = np.apply_along_axis(lambda row: np.convolve(row, weights)[reach:reach + len(row)], axis, counts)
    return counts


class Density:
    """Of places (2, n) over a square: its centres of cells, and the smoothed number of places in each."""

    def __init__(self, places, low, high):
        self.places = places
        sides = [np.linspace(low[i], high[i], CELLS + 1) for i in (0, 1)]
        counts = np.histogram2d(*places, bins=sides)[0]
        cell = (np.asarray(high) - low) / CELLS
        inside = places[:, ((places.T >= low) & (places.T <= high)).all(axis=1)]
        # The width for one normal distribution (Scott), but no more than what leaves several apart.
        spread = inside.std(axis=1) if inside.shape[1] else np.zeros(2)
        width = spread * max(1, inside.shape[1])**(-1 / 6) / cell
        self.values = smoothed(counts, np.clip(width, 1, 4))
        self.centers = [(side[1:] + side[:-1]) / 2 for side in sides]

    def at(self, places):
        """Linear between the centres of cells, 0 outside of them."""
        steps = [np.interp(place, center, np.arange(CELLS), -1, -1) for place, center in zip(places, self.centers)]
        inside = (steps[0] >= 0) & (steps[1] >= 0)
        i, j = (np.clip(step.astype(int), 0, CELLS - 2) for step in steps)
        s, t = steps[0] - i, steps[1] - j
        d = self.values
        value = (1 - s) * ((1 - t) * d[i, j] + t * d[i, j + 1]) + s * ((1 - t) * d[i + 1, j] + t * d[i + 1, j + 1])
        return np.where(inside, value, 0)

    def level(self, share):
        """Where the density is higher, this share of the places is; None where there is no such line."""
        if self.places.shape[1] < FEWEST:
            return None
        # Where a great many are at one place, the line is round it and not on it.
        level = min(np.quantile(self.at(self.places), 1 - share), 0.9 * self.values.max())
        return level if level > 0 else None


def view_of(places):
    """The centre and half the sides of a rectangle around nearly all places (2, n): but for a thousandth on each side.
    It is at most as high as wide, and at least LOWEST times that."""
    low, high = np.quantile(places, (0.001, 0.999), axis=1)
    center, half = (low + high) / 2, (high - low) / 2
    width = 1.12 * max(max(half) or 0.5, 1e-9 * max(abs(center)))
    return center, np.array([width, max(1.12 * half[1], LOWEST * width)])


def histograms_of(file, most):
    """Of at most so many kept numbers that are not the same in all runs, if there are such numbers; else of others."""
    probabilities = file.probabilities()
    made = (Histogram(number, probabilities) for number in kept_numbers(file, 3 * most))
    varying = list(itertools.islice((histogram for histogram in made if histogram.varies), most))
    return varying or [Histogram(number, probabilities) for number in kept_numbers(file, 1)]


def kept_numbers(file, most):
    """Those whose histograms tell most: one of each kind first, then their other components; else the samples."""
    velocity = file.of("end/velocity")
    speed = Speed(velocity) if len(velocity) == 2 else None
    groups = [file.of("entered"), [speed] if speed else [], file.of("extremes"), file.of("switches/count"),
              file.of("end/energy"), file.of("end/position"), file.of("end/velocity"), file.of("end/angular_velocity"),
              file.of("end/slip"), file.of("at"), file.of("switches/time")]
    chosen = [group[0] for group in groups if group]
    chosen += [number for group in groups for number in group[1:]]
    chosen = [number for number in chosen if not number.names][:most]
    return chosen or [file.named(name) for name in file.variables[:most]]
