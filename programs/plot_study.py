"""The picture of `plot` of a study: where the spheres end, how numbers are distributed, what they depend on."""
import math
import textwrap

import numpy as np
from matplotlib import patheffects
from matplotlib.collections import PathCollection
from matplotlib.colors import LinearSegmentedColormap, LogNorm
from matplotlib.lines import Line2D
from matplotlib.ticker import EngFormatter, MaxNLocator
from matplotlib.transforms import offset_copy

from plot_figure import MOST_EDGES, draw_ground, in_legend, plain, plt, rectangle, regions_in
from plot_study_numbers import LOWEST, Density, histograms_of, kept_numbers, view_of

MOST_SAMPLED = 200000    # runs in the map and in the scatter
MOST_HISTOGRAMS = 4
MOST_OUTPUTS = 4         # with bars
MOST_ENTERED = 4         # regions of which the share of the runs is told
MOST_VARIABLES = 10      # of an output
MOST_NAMED = 12          # codes at an axis
MOST_CODES = 4           # in the legend of the points
SHARES = ((0.5, "-"), (0.95, (0, (4, 2))))  # of the runs, inside of a line
DENSITY_COLORS = LinearSegmentedColormap.from_list("density", plt.get_cmap("magma_r")(np.linspace(0.12, 0.95, 256)))
# M. Okabe and K. Ito: told apart with any colour vision.
CODE_COLORS = ["#0072b2", "#e69f00", "#009e73", "#d55e00", "#cc79a7", "#56b4e9", "#5b5b5b"]
BAR_COLOR = "#7d93b2"
FIRST_COLOR, TOTAL_COLOR = "#0072b2", "#e69f00"
LINE_COLOR = "#2b2b2b"
REGION_COLOR = "#56b4e9"
HALO = [patheffects.withStroke(linewidth=3, foreground="white")]
LEFT = 0.062
WIDTH = 12.5             # of the figure [in], as the heights below
GAP, FOOTER = 1.25, 0.65
UPPER, LOWER = 5.0, 3.7  # rows of panels; a view that is as high as wide has the upper one
TITLE, LINE = 0.5, 0.2   # of the figure, and a line below it
LEGEND = 0.62            # above the panels
MOST_LETTERS = 150       # in a line


def percent(share):
    """With two or three digits, but neither 0 nor 100 where it is not all."""
    text = ("%.3g" if share >= 0.01 else "%.2g") % (100 * share)
    if (text == "0") != (share == 0) or (text == "100") != (share == 1):
        return "less than 0.001 %" if share < 0.5 else "more than 99.999 %"
    return text + " %" if 0 == share or share >= 1e-5 else "less than 0.001 %"


def counted(number, one, many):
    return "{:,} {}".format(number, one if number == 1 else many)


def in_two_lines(path):
    """The path of a number in a scene, broken where it is long."""
    head, point, tail = path.rpartition(".")
    lines = [head + point, tail] if len(path) > 20 and head else [path]
    return plain("\n".join(line if len(line) <= 24 else "\u2026" + line[-23:] for line in lines))


def legend_above(axes, handles, points, **options):
    """In one row, so far above the upper left corner [1/72 in]."""
    axes.legend(handles=handles, loc="lower left", bbox_to_anchor=(0, 1), ncol=max(1, len(handles)), borderaxespad=0,
                bbox_transform=offset_copy(axes.transAxes, axes.figure, 0, points, "points"), borderpad=0, **options)


class Places:
    """Where the spheres end, and the rectangle that is drawn of it."""

    def __init__(self, file):
        values = file.sampled([file.named("end/position[0]"), file.named("end/position[1]")], MOST_SAMPLED)
        self.known = values[:, ~np.isnan(values).any(axis=0)]
        self.missing_share = 1 - self.known.shape[1] / max(1, values.shape[1])
        if self.known.shape[1]:
            self.center, self.half = view_of(self.known)
            outside = (np.abs(self.known.T - self.center) > self.half).any(axis=1)
            self.outside_share = outside.mean()


def places_of(file):
    places = Places(file) if "end/position[0]" in file else None
    return places if places and places.known.shape[1] else None


def draw_cells(axes, places, low, high):
    """Regular hexagons in the colour of the number of runs that end in each."""
    inside = places.known[:, (np.abs(places.known.T - places.center) <= places.half).all(axis=1)]
    columns = int(np.clip(math.sqrt(places.known.shape[1]) / 2, 12, 50))
    rows = max(1, round(columns * places.half[1] / places.half[0] / math.sqrt(3)))
    dots = axes.hexbin(*inside, gridsize=(columns, rows), extent=(low[0], high[0], low[1], high[1]), mincnt=1,
                       norm=LogNorm(vmin=1), cmap=DENSITY_COLORS, linewidths=0.1, zorder=2)
    axes.figure.colorbar(dots, cax=axes.inset_axes([1.025, 0, 0.03, 1]), label="runs in a cell")


def draw_edges(axes, ground, visible):
    """Of the regions and their names, again over the cells."""
    plt.setp(axes.texts, zorder=4, color=LINE_COLOR, path_effects=HALO)
    seen, paths = regions_in(ground, visible)
    if len(seen) <= MOST_EDGES:
        axes.add_collection(PathCollection(paths, facecolors="none", edgecolors=REGION_COLOR, linewidths=1.8,
                                           zorder=2.5), autolim=False)


def draw_map(axes, file, places):
    """The ground, how many runs end in each cell over it, and the lines that half and nearly all end in."""
    visible = rectangle(places.center, places.half)
    low, high = visible[0], visible[2]
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_aspect("equal")
    handles = draw_ground(axes, file.ground, visible)
    draw_cells(axes, places, low, high)
    draw_edges(axes, file.ground, visible)
    density = Density(places.known, low, high)
    for share, style in SHARES:
        level = density.level(share)
        if level is None:
            continue
        lines = axes.contour(*density.centers, density.values.T, levels=[level], colors=[LINE_COLOR], linewidths=1.4,
                             linestyles=[style], zorder=3)
        plt.setp(lines.collections, path_effects=HALO)
        handles.append(Line2D([], [], color=LINE_COLOR, linestyle=style, linewidth=1.4,
                              label="%g %% of the runs" % (100 * share)))
    axes.set_xlabel("x [m], where the spheres end")
    axes.set_ylabel("y [m]")
    axes.legend(handles=handles, loc="lower center", bbox_to_anchor=(0.5, 1.0), columnspacing=1.4, handlelength=1.9,
                ncol=math.ceil(len(handles) / math.ceil(len(handles) / 4)))


def draw_histogram(axes, histogram):
    """Of all runs, with the mean and the quantiles as lines."""
    said = ["mean %.4g" % histogram.mean] if histogram.count else []
    said += ["%s missing" % percent(histogram.missing_share)] if histogram.missing else []
    axes.set_title(", ".join(said), loc="left", fontsize=9)
    axes.set_xlabel(plain(histogram.number.label))
    axes.set_ylabel("runs")
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    if not histogram.count:
        axes.set_xticks([])
        axes.set_yticks([])
        return
    axes.stairs(histogram.counts, histogram.edges, fill=True, color=BAR_COLOR, label="_counts")
    axes.axvline(histogram.mean, color=LINE_COLOR, linewidth=1.5, label="_mean")
    for _, value in histogram.quantiles:
        axes.axvline(value, color=CODE_COLORS[3], linewidth=1.3, linestyle=(0, (4, 2)), label="_quantile")
    if is_peaked(histogram.counts):
        axes.set_yscale("log")
        axes.set_ylim(bottom=0.5)
    else:
        axes.yaxis.set_major_locator(MaxNLocator(4, integer=True))
        axes.yaxis.set_major_formatter(EngFormatter(sep=" "))
    axes.set_xlim(histogram.edges[0], histogram.edges[-1])
    axes.xaxis.set_major_locator(MaxNLocator(5, integer=histogram.number.is_whole))


def is_peaked(counts):
    """Whether most bins would not be seen beside the highest one."""
    there = counts[counts > 0]
    return len(there) > 1 and counts.max() > 100 * np.median(there)


def legend_of_histograms(axes, histograms):
    probabilities = [p for p, _ in next((h.quantiles for h in histograms if h.count), [])]
    names = ", ".join("%g %%" % (100 * p) for p in probabilities[:7]) + (" ..." if len(probabilities) > 7 else "")
    handles = [Line2D([], [], color=LINE_COLOR, label="mean")]
    if probabilities:
        handles.append(Line2D([], [], color=CODE_COLORS[3], linestyle=(0, (4, 2)), linewidth=1.3,
                              label="quantiles: " + names))
    legend_above(axes, handles, 20)


def draw_histograms(figure, part, histograms, columns):
    rows = math.ceil(len(histograms) / columns)
    grid = part.subgridspec(rows, columns, hspace=0.62, wspace=0.28)
    for i, histogram in enumerate(histograms):
        axes = figure.add_subplot(grid[i // columns, i % columns], label="histogram %d" % i)
        draw_histogram(axes, histogram)
        if i == 0:
            legend_of_histograms(axes, histograms)


def pair_of_largest_index(file):
    """The variable and the output with the largest total index; else the first ones."""
    best, pair = -np.inf, None
    for name, (_, total) in file.sensitivities().items():
        for variable, index in zip(file.variables, total[:, 0]):
            if index > best:
                best, pair = index, (variable, name)
    if pair is None:
        end = file.of("end")
        outputs = file.of("end/position") + [n for n in end if not n.names] + kept_numbers(file, 2)
        outputs = [n.name for n in outputs if n.name in file and n.name not in file.variables] + [n.name for n in end]
        pair = file.variables[0], (outputs + file.variables[::-1])[0]
    return [file.named(name) for name in pair]


def placed(values, number, step):
    """Of codes those that there are stand side by side: the runs of each are spread over a part of the room that it has.
    @param step  irrational, another one for each axis"""
    if not number.names:
        return values
    _, ranks = np.unique(values, return_inverse=True)
    return np.where(np.isnan(values), np.nan, ranks + 0.6 * (np.arange(len(values)) * step % 1 - 0.5))


def label_axis(axis, number, values):
    """Codes have their names, but not more of them than there is room for."""
    axis.set_label_text(plain(number.label))
    if not number.names:
        return
    codes, counts = np.unique(values[~np.isnan(values)].astype(int), return_counts=True)
    ranks = np.sort(np.argsort(-counts, kind="stable")[:MOST_NAMED])
    names = [in_legend(number.names[code]) if code < len(number.names) else str(code) for code in codes[ranks]]
    axis.set_ticks(ranks, names)
    if axis.axis_name == "x" and max(map(len, names), default=0) * len(names) > 60:
        plt.setp(axis.get_ticklabels(), rotation=12, ha="right", fontsize=8)


def legend_of_codes(codes, names, colors):
    """The most frequent ones and their shares."""
    found, counts = np.unique(codes, return_counts=True)
    order = np.argsort(-counts, kind="stable")[:MOST_CODES]
    return [Line2D([], [], color=colors[code], marker="o", linestyle="none", markersize=5, label="%s: %s" % (
        in_legend(names[code]) if 0 <= code < len(names) else "missing", percent(count / len(codes))))
        for code, count in zip(found[order], counts[order])]


def first_that_differs(file, groups, columns):
    """Names and codes of the first number that is not the same in all runs; -1: it is missing. Of the times of entry there
    are two codes."""
    for group, values in zip(groups, columns):
        names, codes = group.names, np.where(np.isnan(values), -1, values).astype(int)
        if not names:
            region = in_legend(file.regions_that_are_entered()[0])
            names, codes = ["enters \"%s\"" % region, "does not"], np.isnan(values).astype(int)
        if len(np.unique(codes)) > 1:
            break
    return names, codes


def draw_scatter(axes, file, pair):
    """Two numbers of each run, in the colour of what it belongs to."""
    groups = [file.named(name) for name in ("end/mode", "end/region", "entered[0]", "outcome") if name in file]
    x, y, *columns = file.sampled([*pair, *groups], MOST_SAMPLED)
    drawn = ~np.isnan(x) & ~np.isnan(y)
    names, codes = first_that_differs(file, groups, [values[drawn] for values in columns])
    count = max(1, len(codes))
    colors = np.array([CODE_COLORS[i % len(CODE_COLORS)] for i in range(len(names) + 1)])
    axes.scatter(placed(x, pair[0], math.sqrt(5))[drawn], placed(y, pair[1], math.sqrt(2))[drawn], c=colors[codes],
                 s=np.clip(60000 / count, 2, 16), alpha=np.clip(8000 / count, 0.25, 0.9), rasterized=True, linewidths=0)
    for axis, number, values in ((axes.xaxis, pair[0], x), (axes.yaxis, pair[1], y)):
        label_axis(axis, number, values)
    if not len(codes):
        axes.set_title("no run has both numbers", loc="left", fontsize=9)
    legend_above(axes, legend_of_codes(codes, names, colors), 5, columnspacing=1.2, handletextpad=0.2)
    axes.margins(0.02)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def draw_bars(axes, indices, variables, label):
    """First and total indices of an output, variables from the top down."""
    place = -np.arange(len(variables))
    for shift, part, color in ((0.2, indices[0], FIRST_COLOR), (-0.2, indices[1], TOTAL_COLOR)):
        value, low, high = part.T
        axes.barh(place + shift, value, 0.38, color=color)
        errors = np.maximum([value - low, high - value], 0)
        axes.errorbar(value, place + shift, xerr=errors, fmt="none", ecolor=LINE_COLOR, elinewidth=1, capsize=2)
    axes.axvline(0, color="#555555", linewidth=0.8)
    axes.set_title(plain(label), loc="left", fontsize=9)
    axes.set_yticks(place, [in_two_lines(name) for name in variables])
    axes.set_xlim(min(0, 1.05 * np.nanmin([indices[0][:, 1], indices[1][:, 1], np.zeros(len(place))])),
                  max(1, 1.05 * np.nanmax([indices[0][:, 2], indices[1][:, 2], np.ones(len(place))])))
    for side in ("top", "right", "left"):
        axes.spines[side].set_visible(False)
    axes.tick_params(axis="y", length=0)


def most_important(sensitivities, most):
    """The variables with the largest total indices of any output."""
    largest = np.nanmax([total[:, 0] for _, total in sensitivities.values()], axis=0)
    return np.argsort(-largest, kind="stable")[:most]


def draw_sensitivities(figure, part, file, sensitivities):
    chosen = most_important(sensitivities, MOST_VARIABLES)
    names = [file.variables[i].partition("/")[2].replace("%2F", "/") for i in chosen]
    columns = 1 if len(sensitivities) == 1 else 2
    grid = part.subgridspec(math.ceil(len(sensitivities) / columns), columns, hspace=0.45, wspace=0.12)
    for i, (name, indices) in enumerate(sensitivities.items()):
        axes = figure.add_subplot(grid[i // columns, i % columns], label="sensitivity %d" % i)
        draw_bars(axes, [index[chosen] for index in indices], names, name)
        axes.tick_params(labelleft=i % columns == 0, labelbottom=i >= len(sensitivities) - columns)
        if i == 0:
            handles = [Line2D([], [], color=color, linewidth=6, label=label) for color, label in
                       ((FIRST_COLOR, "first Sobol' index"), (TOTAL_COLOR, "total, with 95 % intervals"))]
            legend_above(axes, handles, 20, handlelength=1)


def chosen_sensitivities(file):
    """Of the outputs of which most is known to be asked: positions first."""
    found = {name: indices for name, indices in file.sensitivities().items()
             if np.isfinite(indices[0][:, 0]).any() and np.isfinite(indices[1][:, 0]).any()}
    order = [number.name for number in file.of("end/position") + file.of("entered") + file.of("extremes")]
    names = [name for name in order if name in found] + [name for name in found if name not in order]
    return {name: found[name] for name in names[:MOST_OUTPUTS]}


def notes_on(file, places):
    """What holds of the whole picture, in lines."""
    done, halted, refused = file.outcomes
    first = ["%s: %s done, %s halted, %s refused" % (
        counted(file.runs, "run", "runs"), *("{:,}".format(n) for n in (done, halted, refused)))]
    for region, (probability, low, high) in file.entered()[:MOST_ENTERED]:
        first.append("\"%s\" is entered with the probability %.4g (%.4g to %.4g with 95 %%)" % (
            in_legend(region), probability, low, high))
    second = []
    if file.runs > MOST_SAMPLED:
        second.append("%s runs, evenly among all, are in the map and the points" % "{:,}".format(MOST_SAMPLED))
    if places and places.missing_share:
        second.append("of %s the place is missing" % percent(places.missing_share))
    if places and places.outside_share:
        second.append("%s end outside of the map" % percent(places.outside_share))
    return [line for part in (first, second) for line in textwrap.wrap("; ".join(part), MOST_LETTERS)]


def split(part, shares):
    """The places of panels beside each other: those with a share."""
    kept = [share for share in shares if share]
    grid = iter(part.subgridspec(1, len(kept), width_ratios=kept, wspace=0.3))
    return [next(grid) if share else None for share in shares]


def frame(places, notes, title):
    """The figure with its texts, and the places of the two rows of panels."""
    upper = UPPER * (places.half[1] / places.half[0] if places else LOWEST)
    header = TITLE + LINE * len(notes) + LEGEND
    height = header + upper + GAP + LOWER + FOOTER
    figure = plt.figure(figsize=(WIDTH, height))
    figure.text(LEFT, 1 - 0.17 / height, plain(title), ha="left", va="top", fontsize=13, weight="bold")
    figure.text(LEFT, 1 - TITLE / height, plain("\n".join(notes)), ha="left", va="top", fontsize=9.5, color="#444444")
    rows = figure.add_gridspec(2, 1, height_ratios=(upper, LOWER), left=LEFT, right=0.985, bottom=FOOTER / height,
                               top=1 - header / height, hspace=2 * GAP / (upper + LOWER))
    return figure, rows


def draw(file, title, scatter=None):
    """@param scatter  two names, or None  Throws InputError."""
    pair = [file.named(name) for name in scatter] if scatter else pair_of_largest_index(file)
    histograms = histograms_of(file, MOST_HISTOGRAMS)
    places, sensitivities = places_of(file), chosen_sensitivities(file)
    figure, rows = frame(places, notes_on(file, places), title)
    left, right = split(rows[0], (1.0 if places else 0, 1.0))
    if places:
        draw_map(figure.add_subplot(left, label="map"), file, places)
    draw_histograms(figure, right, histograms, 2 if places else len(histograms))
    left, right = split(rows[1], (1.0, 1.0 if sensitivities else 0))
    draw_scatter(figure.add_subplot(left, label="scatter"), file, pair)
    if sensitivities:
        draw_sensitivities(figure, right, file, sensitivities)
    return figure
