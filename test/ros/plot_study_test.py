#!/usr/bin/python3
"""`plot` of the file of a study: the numbers that it draws, and what it refuses.

The environment says where things are: PLOT, SCENES (config/), STUDY (the program; empty where it is not built).
"""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np
import rosunit

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.environ["PLOT"]))

import plot_study  # noqa: E402
import plot_study_input  # noqa: E402
import plot_study_numbers  # noqa: E402
from matplotlib.path import Path  # noqa: E402
from plot_figure import plt  # noqa: E402
from plot_inputs import InputError  # noqa: E402
from plot_study_input import StudyFile  # noqa: E402
from plot_study_numbers import Density, Histogram  # noqa: E402
from study_file import INDICES, RUNS, columns, texts, write_study  # noqa: E402


class StudyTest(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.directory)
        self.addCleanup(plt.close, "all")
        self.files = 0
        self.columns = columns(np.random.default_rng(2005))
        self.sensitivity = {"end/position[1]": INDICES}

    def path(self, name):
        return os.path.join(self.directory, name)

    def made(self):
        """A file as `study` writes it."""
        self.files += 1
        path = self.path("made%d.h5" % self.files)
        write_study(path, self.columns, self.sensitivity)
        return path

    def study(self):
        return StudyFile(self.made())

    def plot(self, *arguments):
        return subprocess.run([sys.executable, "-B", os.environ["PLOT"], *arguments], capture_output=True, text=True,
                              cwd=self.directory)

    def in_slices_of(self, runs):
        self.addCleanup(setattr, plot_study_input, "SLICE", plot_study_input.SLICE)
        plot_study_input.SLICE = runs


class Reading(StudyTest):
    def test_the_numbers_are_those_of_the_file(self):
        self.in_slices_of(999)
        study = self.study()
        for name, expected in (("end/position[1]", self.columns["end/position"][:, 1]),
                               ("samples/surface.regions[a%2Fb].friction", np.ones(RUNS)),
                               ("entered[0]", self.columns["entered"][:, 0])):
            values, = study.sampled([study.named(name)], RUNS)
            self.assertTrue(np.array_equal(values, expected, equal_nan=True), name)

    def test_a_negative_code_is_missing(self):
        study = self.study()
        mode, = study.sampled([study.named("end/mode")], RUNS)
        self.assertTrue(np.array_equal(np.isnan(mode), np.arange(RUNS) % 10 == 3))
        self.assertEqual(study.named("end/mode").names, ["free", "rolling", "sliding"])

    def test_a_sample_is_even_and_of_the_same_runs_for_all_numbers(self):
        self.in_slices_of(777)
        study = self.study()
        x, y = study.sampled([study.named("samples/sphere.mass"), study.named("entered[0]")], 1234)
        chosen = np.arange(1234) * RUNS // 1234
        self.assertEqual(set(np.diff(chosen)), {4, 5})
        self.assertTrue(np.array_equal(x, self.columns["samples/sphere.mass"][chosen]))
        self.assertTrue(np.array_equal(y, self.columns["entered"][chosen, 0], equal_nan=True))

    def test_labels_have_units_and_names_of_regions(self):
        study = self.study()
        self.assertEqual(study.named("end/position[0]").label, "end/position[0] [m]")
        self.assertEqual(study.named("entered[0]").label, "enters \"goal\" at")
        self.assertEqual(study.ground.regions[0].name, "goal")

    def test_numbers_that_cannot_be_drawn_are_refused(self):
        self.columns["end/position"][7, 0] = np.inf
        study = self.study()
        with self.assertRaisesRegex(InputError, r"a number of end/position\[0\] is refused"):
            plot_study.draw(study, "infinite")


class Histograms(StudyTest):
    def test_their_counts_are_those_of_numpy(self):
        self.in_slices_of(999)
        study = self.study()
        for name, values in (("entered[0]", self.columns["entered"][:, 0]),
                             ("end/position[1]", self.columns["end/position"][:, 1])):
            known = values[~np.isnan(values)]
            drawn = Histogram(study.named(name), [0.05, 0.5, 0.95])
            counts, edges = np.histogram(known, plot_study_numbers.BINS)
            self.assertTrue(np.array_equal(drawn.counts, counts), name)
            self.assertTrue(np.array_equal(drawn.edges, edges), name)
            self.assertEqual(drawn.missing, len(values) - len(known))
            # Sums of n numbers in another order.
            self.assertAlmostEqual(drawn.mean, known.mean(), delta=RUNS * 2.3e-16 * np.abs(known).max())

    def test_quantiles_are_as_exact_as_a_fine_bin_is_wide(self):
        study = self.study()
        values = self.columns["entered"][:, 0]
        known = np.sort(values[~np.isnan(values)])
        width = (known[-1] - known[0]) / plot_study_numbers.BINS / plot_study_numbers.FINE
        for p, value in Histogram(study.named("entered[0]"), [0.0, 0.01, 0.5, 0.9, 1.0]).quantiles:
            # Beside it there is a run below which a share p of the runs is.
            i = min(int(p * len(known)), len(known) - 1)
            self.assertLessEqual(known[max(0, i - 1)] - width, value)
            self.assertGreaterEqual(known[i] + width, value)

    def test_whole_numbers_have_a_bin_each(self):
        study = self.study()
        counts = self.columns["switches/count"]
        drawn = Histogram(study.named("switches/count"), [0.5])
        known = counts[counts >= 0]
        self.assertTrue(np.array_equal(drawn.counts, np.bincount(known)[known.min():]))
        self.assertEqual(drawn.edges[0], known.min() - 0.5)
        self.assertEqual(drawn.quantiles, [(0.5, np.sort(known)[(len(known) - 1) // 2])])

    def test_of_equal_numbers_or_of_none(self):
        for value in (0.0, -3.0, 1e15):
            self.columns["entered"][:] = value
            drawn = Histogram(self.study().named("entered[0]"), [0.5])
            self.assertEqual((drawn.counts.tolist(), drawn.mean, drawn.quantiles), ([RUNS], value, [(0.5, value)]))
        self.columns["entered"][:] = np.nan
        drawn = Histogram(self.study().named("entered[0]"), [0.5])
        self.assertEqual((drawn.count, drawn.missing_share), (0, 1))

    def test_one_of_each_kind_is_drawn_first_and_none_that_is_constant(self):
        kept = [h.number.name for h in plot_study_numbers.histograms_of(self.study(), 4)]
        self.assertEqual(kept, ["entered[0]", "end/speed", "switches/count", "end/position[0]"])
        self.columns["entered"][:] = 1
        kept = [h.number.name for h in plot_study_numbers.histograms_of(self.study(), 4)]
        self.assertEqual(kept, ["end/speed", "switches/count", "end/position[0]", "end/velocity[0]"])
        speed = Histogram(plot_study_numbers.kept_numbers(self.study(), 4)[1], [])
        self.assertAlmostEqual(speed.mean, np.nanmean(np.hypot(*self.columns["end/velocity"].T)), delta=1e-12)

    def test_the_picture_says_which_share_is_missing(self):
        axes = plt.figure().add_subplot()
        histogram = Histogram(self.study().named("entered[0]"), [0.05, 0.5])
        plot_study.draw_histogram(axes, histogram)
        self.assertTrue(axes.get_title(loc="left").endswith(", 25 % missing"))
        lines = [line.get_xdata()[0] for line in axes.get_lines()]
        self.assertEqual(lines, [histogram.mean] + [value for _, value in histogram.quantiles])
        for share, text in ((0, "0 %"), (1, "100 %"), (1e-9, "less than 0.001 %"), (0.35555, "35.6 %"),
                            (0.000467, "0.047 %"), (1 - 1e-9, "more than 99.999 %")):
            self.assertEqual(plot_study.percent(share), text)


class Maps(StudyTest):
    def density(self, places):
        center, half = plot_study_numbers.view_of(places)
        return Density(places, center - half, center + half)

    def test_contours_hold_their_share(self):
        random = np.random.default_rng(2005)
        one = random.normal((3, -2), (0.5, 0.2), (20000, 2))
        two = np.concatenate([one, random.normal((-1, 1), (0.3, 0.6), (10000, 2))])
        for places in (one.T, two.T):
            density = self.density(places)
            figure = plt.figure()
            for share, _ in plot_study.SHARES:
                lines = figure.add_subplot().contour(*density.centers, density.values.T, levels=[density.level(share)])
                inside = np.zeros(places.shape[1], bool)
                for outline in lines.allsegs[0]:
                    inside ^= Path(outline).contains_points(places.T)
                # The outline is straight in a cell, where the density that chose the level is bilinear: it errs by a few
                # hundredths of a cell in some 300 cells that it cuts, which have less than 5 % of the runs together.
                self.assertAlmostEqual(inside.mean(), share, delta=0.002)

    def test_contours_of_a_normal_distribution_are_its_ellipses(self):
        places = np.random.default_rng(2005).normal(0, (2, 1), (100000, 2)).T
        density = self.density(places)
        axes = plt.figure().add_subplot()
        outline, = axes.contour(*density.centers, density.values.T, levels=[density.level(0.5)]).allsegs[0]
        # Half of the places are within r^2 = 2 ln 2, however wide normal curves smooth them. The share within a radius has
        # the deviation sqrt(0.25 / n) = 0.0016, the radius that over its density r exp(-r^2/2) = 0.59: 0.0027, of which
        # there are seven.
        radius = np.hypot(outline[:, 0] / 2, outline[:, 1]).mean()
        self.assertAlmostEqual(radius, (2 * np.log(2))**0.5, delta=0.019)

    def test_smoothing_keeps_the_sum(self):
        counts = np.zeros((80, 80))
        counts[40, 30] = 25
        smooth = plot_study_numbers.smoothed(counts, (1, 4))
        self.assertAlmostEqual(smooth.sum(), 25, delta=25 * 80 * 2.3e-16)
        self.assertEqual(np.unravel_index(smooth.argmax(), smooth.shape), (40, 30))

    def test_places_that_are_one_have_a_line_round_them(self):
        density = self.density(np.full((2, 100), 7.0))
        self.assertLess(density.level(0.5), density.values.max())
        self.assertIsNone(self.density(np.full((2, 3), 7.0)).level(0.5), "too few")

    def test_all_runs_are_in_the_cells_or_said_to_be_outside(self):
        self.columns["end/position"][0] = (1000, 1000)
        study = self.study()
        places = plot_study.places_of(study)
        axes = plt.figure().add_subplot()
        plot_study.draw_map(axes, study, places)
        cells, = [c for c in axes.collections if hasattr(c, "get_array") and c.get_array() is not None and
                  len(c.get_array()) > 1]
        known = RUNS - RUNS // 10
        self.assertAlmostEqual(cells.get_array().sum(), known * (1 - places.outside_share), delta=1e-6)
        self.assertGreater(places.outside_share, 0)
        self.assertLess(places.half.max(), 10)
        self.assertIn("of 10 % the place is missing", plot_study.notes_on(study, places)[1])

    def test_panels_are_those_that_have_data(self):
        def panels():
            return [axes.get_label() for axes in plot_study.draw(self.study(), "made").axes]
        four = ["histogram %d" % i for i in range(4)]
        self.assertEqual(panels(), ["map"] + four + ["scatter", "sensitivity 0"])
        self.columns["end/position"][:] = np.nan
        self.sensitivity = {}
        self.assertEqual(panels(), four + ["scatter"])
        for name in ("end/position", "end/velocity", "end/mode", "entered", "switches/count"):
            del self.columns[name]
        self.assertEqual(panels(), ["histogram 0", "scatter"], "the samples")


class ScatterAndSensitivities(StudyTest):
    def pair(self):
        return [number.name for number in plot_study.pair_of_largest_index(self.study())]

    def test_without_names_it_is_of_the_largest_total_index(self):
        self.assertEqual(self.pair(), ["samples/surface.regions[a%2Fb].friction", "end/position[1]"])
        self.sensitivity = {}
        self.assertEqual(self.pair(), ["samples/sphere.mass", "end/position[0]"])

    def test_the_points_are_the_runs_that_have_both_numbers(self):
        study = self.study()
        axes = plt.figure().add_subplot()
        plot_study.draw_scatter(axes, study, [study.named("samples/sphere.mass"), study.named("entered[0]")])
        time = self.columns["entered"][:, 0]
        there = ~np.isnan(time)
        points, = axes.collections
        self.assertTrue(np.array_equal(points.get_offsets(),
                                       np.column_stack([self.columns["samples/sphere.mass"], time])[there]))
        labels = [text.get_text() for text in axes.get_legend().get_texts()]
        mode = self.columns["end/mode"][there]
        self.assertEqual(sorted(labels), sorted("%s: %s" % (name, plot_study.percent((mode == code).mean()))
                                                for code, name in ((-1, "missing"), (0, "free"), (1, "rolling"))))

    def test_where_all_have_one_mode_the_colour_tells_who_enters(self):
        self.columns["end/mode"][:] = 1
        study = self.study()
        axes = plt.figure().add_subplot()
        plot_study.draw_scatter(axes, study, [study.named("samples/sphere.mass")] * 2)
        labels = [text.get_text() for text in axes.get_legend().get_texts()]
        self.assertEqual(labels, ["enters \"goal\": 75 %", "does not: 25 %"])

    def test_codes_have_their_names_at_the_axis(self):
        study = self.study()
        axes = plt.figure().add_subplot()
        plot_study.draw_scatter(axes, study, [study.named("end/mode"), study.named("samples/sphere.mass")])
        self.assertEqual([text.get_text() for text in axes.get_xticklabels()], ["free", "rolling"])
        x = axes.collections[0].get_offsets()[:, 0]
        mode = self.columns["end/mode"]
        self.assertTrue(np.array_equal(np.round(x), mode[mode >= 0]))

    def test_bars_and_their_intervals_are_those_of_the_file(self):
        axes = plt.figure().add_subplot()
        plot_study.draw_bars(axes, [np.array(INDICES[kind]) for kind in ("first", "total")], ["a", "b"], "output")
        self.assertEqual([bar.get_width() for bar in axes.patches], [0.1, 0.6, 0.3, 0.8])
        ends = np.array([segment[:, 0] for lines in axes.collections for segment in lines.get_segments()])
        self.assertTrue(np.allclose(ends, [rows[1:] for kind in ("first", "total") for rows in INDICES[kind]], rtol=1e-12))

    def test_of_many_variables_the_most_important_ones_are_drawn(self):
        total = np.zeros((20, 3))
        total[7, 0], total[12, 0] = 0.5, 0.2
        self.assertEqual(plot_study.most_important({"x": (total, total)}, 3).tolist(), [7, 12, 0])

    def test_outputs_without_indices_are_left_out(self):
        self.sensitivity["entered[0]"] = {kind: np.full((2, 3), np.nan) for kind in INDICES}
        self.sensitivity["switches/count"] = INDICES
        self.assertEqual(list(plot_study.chosen_sensitivities(self.study())), ["end/position[1]", "switches/count"])
        self.assertEqual(self.pair()[1], "end/position[1]")


class Program(StudyTest):
    def assert_refused(self, code, words, *arguments):
        result = self.plot(*arguments)
        self.assertEqual((result.returncode, result.stdout), (code, ""), result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertIn(words, result.stderr)

    def test_a_picture_is_written(self):
        result = self.plot(self.made(), "-o", "a.png", "--scatter", "samples/sphere.mass", "end/mode", "--title", "$\\frac{")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual(result.stdout, "plot: wrote a.png (5000 runs)\n")
        with open(self.path("a.png"), "rb") as file:
            self.assertEqual(file.read(4), b"\x89PNG")

    def test_what_is_no_study_is_refused(self):
        with open(self.path("text.h5"), "w") as file:
            file.write("no HDF5")
        self.assert_refused(1, "text.h5: cannot be read as HDF5", self.path("text.h5"))
        with self.assertRaisesRegex(InputError, "missing.h5: cannot be read: No such file"):
            StudyFile(self.path("missing.h5"))
        other = self.path("other.h5")
        for form, words in (("another", "is no file of `study`"),
                            (plot_study_input.FORMAT, "is not the whole file of a study")):
            with h5py.File(other, "w") as file:
                file.attrs["format"] = form
            with self.assertRaisesRegex(InputError, words):
                StudyFile(other)

    def test_columns_of_another_length_and_scenes_that_are_none(self):
        for name, words in (("end/position", "end/position has not a row for each of 5000 runs"),
                            ("scene", "has no scene that can be read")):
            path = self.made()
            with h5py.File(path, "a") as file:
                del file[name]
                file[name] = texts("{a: [") if name == "scene" else np.zeros((3, 2))
            with self.assertRaisesRegex(InputError, words):
                StudyFile(path)

    def test_a_file_that_is_cut_off_is_refused(self):
        path = self.made()
        with open(path, "r+b") as file:
            file.truncate(os.path.getsize(path) // 2)
        with self.assertRaisesRegex(InputError, "cannot be read as HDF5"):
            StudyFile(path)

    def test_names_that_are_not_there(self):
        self.assert_refused(1, "\"end/positon[0]\" is no number of this study; the nearest one is end/position[0]",
                            self.made(), "--scatter", "entered[0]", "end/positon[0]")
        with self.assertRaises(InputError):
            self.study().named("end/position")

    def test_inputs_that_do_not_go_together(self):
        path = self.made()
        self.assert_refused(2, "a study alone", path, "other.h5")
        self.assert_refused(2, "a study alone", "some.bag", path)
        self.assert_refused(2, "a study alone", path, "--scene", "scene.yaml")
        self.assert_refused(2, "numbers of a study", "some.bag", "--scatter", "a", "b")
        self.assert_refused(2, "--scatter", path, "--scatter", "a")


@unittest.skipUnless(os.environ["STUDY"], "study is not built")
class FilesOfStudy(StudyTest):
    def computed(self, name):
        path = self.path(name + ".h5")
        subprocess.run([os.environ["STUDY"], os.path.join(os.environ["SCENES"], "studies", name + ".yaml"), "-o", path,
                        "--quiet", "--processes", "1"], check=True)
        return path

    def test_goal_has_the_quantiles_of_its_summary(self):
        path = self.computed("goal")
        study = StudyFile(path)
        drawn = Histogram(study.named("entered[0]"), study.probabilities())
        with h5py.File(path) as file:
            group = file["summary/entered[0]"]
            self.assertEqual([drawn.count, drawn.missing], group["count"][:].tolist())
            self.assertAlmostEqual(drawn.mean, group["mean"][()], delta=1e-9)
            width = (drawn.edges[1] - drawn.edges[0]) / plot_study_numbers.FINE
            for (_, value), exact in zip(drawn.quantiles, group["quantiles"]):
                self.assertAlmostEqual(value, exact, delta=2 * width)
            share = file["summary/entered"][0, 0]
        self.assertIn("\"goal\" is entered with the probability %.4g" % share, plot_study.notes_on(study, None)[0])

    def test_paper_has_a_map_and_sensitivities(self):
        figure = plot_study.draw(StudyFile(self.computed("paper")), "paper")
        self.assertEqual([axes.get_label() for axes in figure.axes if axes.get_label().startswith(("map", "sens"))],
                         ["map"] + ["sensitivity %d" % i for i in range(4)])


if __name__ == "__main__":
    rosunit.unitrun("hybrid_sphere", "plot_study_test", "__main__")
