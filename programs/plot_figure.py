"""The picture of `plot`: the paths over the ground, and what they do against time."""
import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PathCollection
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.path import Path

from plot_ground import clipped, signed_area

GROUND_COLORS = {"smooth": "#eef3f8", "rough": "#e6d3b3", "rubber": "#c9b8d8"}
FRICTION_COLORS = LinearSegmentedColormap.from_list("friction", ["#e4f1dc", "#8fbf7f"])  # from the least mu to the greatest
EDGE_COLOR = "#8d8577"
RUN_COLORS = ["#1f5fa8", "#c8402b", "#2c8a4b", "#8a4bb0", "#c98a12", "#3b9aa8", "#b0447c", "#5b5b5b"]
STYLES = ["-", "--", ":"]
IMPULSE_COLOR = "#d0021b"
GUIDE_COLOR = "#b8b8b8"
MOST_GUIDES = 60     # vertical lines, one at each switch
MOST_EDGES = 40      # of regions that are outlined
RASTER = 90          # points along a side of the view, for the places of names
MOST_NAMES = 15      # of regions in view
MOST_ARROWS = 200    # of impulses on the path
ARROW = 0.12         # the longest of them, in widths of the view
MOST_FRICTIONS = 6   # told apart in the legend
MOST_UNNAMED = 6     # regions without room for their name, in the legend
BELT_ARROWS = "\u2192\u2197\u2191\u2196\u2190\u2199\u2193\u2198"  # anticlockwise
CHARACTER = 0.0115   # width of one in a name, in widths of the view
FAR = 50             # what has no end goes so many sizes of the view beyond it

plt.rcParams.update({
    "font.size": 9.5, "axes.edgecolor": "#555555", "axes.linewidth": 0.8, "axes.titlesize": 11,
    "legend.frameon": False, "legend.fontsize": 9, "lines.linewidth": 1.5, "path.simplify": True,
    "svg.hashsalt": "hybrid_sphere",
})


def plain(text):
    """A text in which $ begins no formula."""
    return text.replace("$", r"\$")


def in_legend(name):
    """Short enough for a legend; matplotlib leaves out what begins with an underscore."""
    short = name if len(name) <= 24 else name[:23] + "\u2026"
    return plain("\u200b" + short if short.startswith("_") else short)


def history(run, quantity):
    """Times, and v, omega or the energy (k, n): the states and, exactly, both sides of each switch."""
    times, values = [], []
    if run.switches is not None:
        for suffix in ("1", "2"):
            v, w = run.velocities("switches", suffix)
            energy = run.switches["energy" + suffix][None]
            times.append(run.switches["t"])
            values.append({"v": v, "omega": w, "energy": energy}[quantity])
    if times and len(times[0]):
        # Before and after, before and after ...
        times = [np.column_stack(times).ravel()]
        values = [np.stack(values, axis=2).reshape(values[0].shape[0], -1)]
    if run.states is not None:
        v, w = run.velocities()
        energy = None if run.energy is None else run.energy[None]
        value = {"v": v, "omega": w, "energy": energy}[quantity]
        if value is not None:
            times.append(run.states["t"])
            values.append(value)
    if not times:
        return np.empty(0), np.empty((1, 0))
    t, value = np.concatenate(times), np.concatenate(values, axis=1)
    order = np.argsort(t, kind="stable")  # at the instant of a switch the state is the one after it
    return t[order], value[:, order]


def closed(outline):
    codes = np.full(len(outline) + 1, Path.LINETO)
    codes[0], codes[-1] = Path.MOVETO, Path.CLOSEPOLY
    return Path(np.vstack([outline, outline[:1]]), codes)


def path_of(region, box):
    """What a region covers of a rectangle (4, 2) that runs anticlockwise."""
    if region.edge is not None:
        part = clipped(region.edge, box)
        return closed(part) if len(part) else None
    if not region.outside:
        return closed(region.outline)
    hole = region.outline[::-1] if signed_area(region.outline) > 0 else region.outline
    return Path.make_compound_path(closed(box), closed(hole))


def impulses_of(run):
    """Places [m] and impulses [N s] of the switches that have one, (2, n) each."""
    s = run.switches
    hit = np.hypot(s["Px"], s["Py"]) > 0
    return np.array([s["x"][hit], s["y"][hit]]), np.array([s["Px"][hit], s["Py"][hit]])


def largest_impulse(runs):
    sizes = [np.hypot(*impulses_of(run)[1]) for run in runs if run.switches is not None and len(run.switches["t"])]
    return max((size.max() for size in sizes if len(size)), default=0)


def view_of(runs, largest):
    """The square that paths and arrows need, its corners (4, 2) [m]."""
    places = [np.array([table["x"], table["y"]]) for run in runs for table in (run.states, run.switches)
              if table is not None and len(table["x"])]
    if not places:
        return rectangle(np.zeros(2), np.ones(2))
    places = np.concatenate(places, axis=1)
    places = places[:, np.isfinite(places).all(axis=0)]
    center, half = square_around(places)
    # The arrows are as long as the view has it, and may make it a little larger.
    tips = [at + 2 * half * ARROW * impulse / largest for at, impulse in
            (impulses_of(run) for run in runs if run.switches is not None and largest > 0)]
    center, with_tips = square_around(np.concatenate([places, *tips], axis=1))
    return rectangle(center, np.full(2, 1.12 * max(half, with_tips)))


def rectangle(center, half):
    return np.array([center + half * corner for corner in ((-1, -1), (1, -1), (1, 1), (-1, 1))])


def square_around(places):
    low, high = places.min(axis=1), places.max(axis=1)
    center, half = (low + high) / 2, max(high - low) / 2
    return center, max(half or 0.5, 1e-9 * max(abs(center)))


def moving_mark(region):
    """How the ground itself moves."""
    if region.turntable[0] != 0:
        return " \u21ba" if region.turntable[0] > 0 else " \u21bb"
    if any(region.belt):
        return " " + BELT_ARROWS[round(np.arctan2(region.belt[1], region.belt[0]) / (np.pi / 4)) % 8]
    return ""


def covers(region, path, points):
    """Which points lie in a region; of a path with a hole matplotlib says that all do."""
    if region.outline is not None and region.outside:
        return ~closed(region.outline).contains_points(points)
    return path.contains_points(points)


def name_places(texts, regions, paths, visible):
    """For each region where its name goes, near the top of what later regions leave of it, or None; and whether it is seen."""
    low, size = visible[0], visible[2] - visible[0]
    x, y = (low[i] + size[i] * (np.arange(RASTER) + 0.5) / RASTER for i in (0, 1))
    points = np.column_stack([values.ravel() for values in np.meshgrid(x, y)])
    top = np.full(len(points), -1)
    for i, (region, path) in enumerate(zip(regions, paths)):
        top[covers(region, path, points)] = i
    top = top.reshape(RASTER, RASTER)
    places = []
    for i, text in enumerate(texts):
        width = math.ceil(CHARACTER * RASTER * (len(text) + 1))
        # Two rows above each other are as high as the text.
        room = (top[1:] == i) & (top[:-1] == i)
        free = np.lib.stride_tricks.sliding_window_view(room, min(width, RASTER), axis=1).all(axis=2)
        rows = np.flatnonzero(free.any(axis=1))
        if not len(rows):
            places.append((None, bool((top == i).any())))
            continue
        row = rows[-2] if len(rows) > 1 else rows[-1]
        columns = np.flatnonzero(free[row])
        # The middle of the widest gap in which it fits.
        gap = max(np.split(columns, np.flatnonzero(np.diff(columns) > 1) + 1), key=len)
        places.append(((low[0] + size[0] * ((gap[0] + gap[-1] + width) / 2) / RASTER, (y[row] + y[row + 1]) / 2), True))
    return places


def regions_in(ground, visible):
    """The regions that may be seen, and what they cover."""
    low, high = visible[0], visible[2]
    box = rectangle(visible.mean(axis=0), FAR * (high - low))
    seen, paths = [], []
    for region in ground.regions:
        if region.outline is not None and not region.outside and (
                np.any(region.outline.max(axis=0) < low) or np.any(region.outline.min(axis=0) > high)):
            continue
        path = path_of(region, box)
        if path is not None:
            seen.append(region)
            paths.append(path)
    return seen, paths


def colors_of_grounds(regions):
    """By law and mu, in the order of the legend."""
    laws = {region.law for region in regions}
    colors = {(law, 0.0): color for law, color in GROUND_COLORS.items() if law in laws}
    frictions = sorted({region.friction for region in regions if region.law == "coulomb"})
    for i, friction in enumerate(frictions):
        colors["coulomb", friction] = FRICTION_COLORS((i + 1) / (len(frictions) + 1))
    return colors


def ground_key(region):
    return region.law, region.friction if region.law == "coulomb" else 0.0


def legend_of_grounds(colors):
    frictions = [friction for law, friction in colors if law == "coulomb"]
    handles = {}
    for (law, friction), color in colors.items():
        if law == "coulomb" and len(frictions) > MOST_FRICTIONS and friction not in (frictions[0], frictions[-1]):
            continue
        label = r"coulomb, $\mu$ = %.3g" % friction if law == "coulomb" else law
        handles[label] = Patch(facecolor=color, edgecolor=EDGE_COLOR, linewidth=0.6, label=label)
    return list(handles.values())


def draw_ground(axes, ground, visible):
    """Regions in their order; returns what the legend says of them."""
    seen, paths = regions_in(ground, visible)
    colors = colors_of_grounds([ground.base] + seen)
    axes.set_facecolor(colors[ground_key(ground.base)])
    edges = EDGE_COLOR if len(seen) <= MOST_EDGES else "face"
    axes.add_collection(PathCollection(paths, facecolors=[colors[ground_key(region)] for region in seen],
                                       edgecolors=edges, linewidths=0.6, zorder=0.5), autolim=False)
    handles = legend_of_grounds(colors)
    if len(seen) > MOST_NAMES:
        return handles
    texts = [region.name + moving_mark(region) for region in seen]
    unnamed = []
    for text, (place, is_seen), region in zip(texts, name_places(texts, seen, paths, visible), seen):
        if place is not None:
            axes.text(*place, plain(text), ha="center", va="center", color="#6f675a", fontsize=8, zorder=0.6)
        elif is_seen:
            unnamed.append(Patch(facecolor=colors[ground_key(region)], edgecolor=EDGE_COLOR, linewidth=0.6,
                                 label=in_legend(text)))
    return handles + unnamed[:MOST_UNNAMED]


def draw_run(axes, run, color, width, largest, arrow_color):
    """A path with its start, its end, its switches and their impulses."""
    if run.states is not None and len(run.states["t"]):
        axes.plot(run.states["x"], run.states["y"], color=color, linewidth=width, zorder=2)
        for place, marker in ((slice(0, 1), "o"), (slice(-1, None), "s")):
            axes.plot(run.states["x"][place], run.states["y"][place], marker, color=color, markersize=6, zorder=3)
    if run.switches is None or not len(run.switches["t"]):
        return
    axes.plot(run.switches["x"], run.switches["y"], "o", color=color, markersize=4.5, markerfacecolor="white", zorder=3,
              linestyle="none")
    at, impulse = impulses_of(run)
    if largest > 1e-300 and len(run.switches["t"]) <= MOST_ARROWS:
        axes.quiver(*at, *(impulse / largest), scale_units="width", scale=1 / ARROW, width=0.0035, headwidth=4.5,
                    headlength=6, headaxislength=5.5, color=arrow_color, zorder=1.8)


def draw_paths(axes, runs):
    largest = largest_impulse(runs)
    visible = view_of(runs, largest)
    axes.set_xlim(visible[0][0], visible[2][0])
    axes.set_ylim(visible[0][1], visible[2][1])
    axes.set_aspect("equal")
    ground = next((run.ground for run in runs if run.ground is not None), None)
    handles = draw_ground(axes, ground, visible) if ground is not None else []
    for i, (run, color) in enumerate(zip(runs, colors_of(runs))):
        # Where paths lie over each other, the earlier ones look out on both sides.
        width = 1.5 + 1.6 * (len(runs) - 1 - i) / max(1, len(runs) - 1)
        draw_run(axes, run, color, width, largest, color if len(runs) > 1 else IMPULSE_COLOR)
    for marker, label in (("o", "path, from its start"), ("s", "to its end")):
        handles.append(Line2D([], [], color="#333333", marker=marker, markersize=6, label=label))
    handles.append(Line2D([], [], color="#333333", marker="o", markerfacecolor="white", linestyle="none",
                          label="switch"))
    if largest > 0:
        handles.append(Line2D([], [], color=IMPULSE_COLOR if len(runs) == 1 else "#333333", marker=r"$\rightarrow$",
                              markersize=11, linestyle="none", label="impulse"))
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    rows = math.ceil(len(handles) / 5)
    axes.legend(handles=handles, loc="lower center", bbox_to_anchor=(0.5, 1.0), columnspacing=1.4, handlelength=1.6,
                ncol=math.ceil(len(handles) / rows))


def colors_of(runs):
    return [RUN_COLORS[i % len(RUN_COLORS)] for i in range(len(runs))]


def draw_components(axes, runs, quantity, names, label):
    """Components in colours where there is one run, else in line styles."""
    drawn = False
    for run, color in zip(runs, colors_of(runs)):
        t, values = history(run, quantity)
        for i, value in enumerate(values):
            if len(t):
                axes.plot(t, value, color=color if len(runs) > 1 or len(names) == 1 else RUN_COLORS[i],
                          linestyle=STYLES[i] if len(runs) > 1 else "-")
                drawn = True
    axes.set_ylabel(label)
    if len(names) > 1:
        handles = [Line2D([], [], color="#555555" if len(runs) > 1 else RUN_COLORS[i],
                          linestyle=STYLES[i] if len(runs) > 1 else "-", label=name) for i, name in enumerate(names)]
        axes.legend(handles=handles, loc="center left", bbox_to_anchor=(1.0, 0.5), handlelength=1.6)
    return drawn


def draw_slip(axes, runs):
    drawn = False
    for run, color in zip(runs, colors_of(runs)):
        if run.slip is not None:
            axes.plot(run.states["t"], np.hypot(*run.slip), color=color)
            drawn = True
    axes.set_ylabel("slip [m/s]")
    return drawn


def draw_impulses(axes, runs):
    drawn = False
    for run, color in zip(runs, colors_of(runs)):
        if run.switches is None:
            continue
        s = run.switches
        size = np.hypot(s["Px"], s["Py"])
        drawn = drawn or bool(np.any(size > 0))
        axes.vlines(s["t"], 0, size, color=color, linewidth=1.3)
        axes.plot(s["t"], size, "o", color=color, markersize=3.5)
    axes.set_ylabel("impulse [N s]")
    return drawn


# What draws a panel, and whether its values begin at 0.
PANELS = [
    (lambda axes, runs: draw_components(axes, runs, "v", ["$v_x$", "$v_y$"], "velocity [m/s]"), False),
    (lambda axes, runs: draw_components(axes, runs, "omega", [r"$\omega_1$", r"$\omega_2$", r"$\omega_3$"], "spin [rad/s]"),
     False),
    (draw_slip, True),
    (lambda axes, runs: draw_components(axes, runs, "energy", ["T"], "kinetic energy [J]"), True),
    (draw_impulses, True),
]


def draw_times(figure, column, runs):
    """One panel under the other, of what the runs have."""
    panels = []
    for i, (draw_panel, begins_at_0) in enumerate(PANELS):
        axes = figure.add_subplot(column, label=str(i))
        if draw_panel(axes, runs):
            panels.append((axes, begins_at_0))
        else:
            axes.remove()
    rows = column.subgridspec(max(1, len(panels)), 1, hspace=0.22)
    times = np.unique(np.concatenate([run.switches["t"] for run in runs if run.switches is not None] or [[]]))
    for i, (axes, begins_at_0) in enumerate(panels):
        axes.set_subplotspec(rows[i, 0])
        if i > 0:
            axes.sharex(panels[0][0])
        axes.grid(True, color="#e8e8e8", linewidth=0.6)
        axes.set_axisbelow(True)
        axes.margins(x=0.01, y=0.12)
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)
        if len(times) <= MOST_GUIDES:
            for time in times:
                axes.axvline(time, color=GUIDE_COLOR, linewidth=0.8, linestyle=(0, (4, 3)), zorder=0.5)
        if begins_at_0:
            axes.set_ylim(bottom=0)
        axes.tick_params(labelbottom=i + 1 == len(panels))
    if panels:
        panels[-1][0].set_xlabel("t [s]")
        figure.align_ylabels([axes for axes, _ in panels])


def draw(runs, title):
    figure = plt.figure(figsize=(13, 7.8))
    grid = figure.add_gridspec(1, 2, width_ratios=[1.18, 1], left=0.055, right=0.935, top=0.89, bottom=0.075, wspace=0.16)
    draw_paths(figure.add_subplot(grid[0, 0]), runs)
    draw_times(figure, grid[0, 1], runs)
    figure.suptitle(plain(title), x=0.055, y=0.985, ha="left", fontsize=13, weight="bold")
    if len(runs) > 1:
        figure.legend(handles=[Line2D([], [], color=color, label=in_legend(run.name)) for run, color in
                               zip(runs, colors_of(runs))], loc="upper right", bbox_to_anchor=(0.94, 0.985),
                      ncol=min(4, len(runs)))
    return figure


def save(figure, path):
    """The same bytes for the same picture. Throws OSError."""
    undated = {"png": {"Software": None}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}
    form = path.rpartition(".")[2].lower()
    figure.savefig(path, format=form, dpi=110, metadata=undated[form])
