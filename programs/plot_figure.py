"""The picture of `plot`: the paths over the ground, and what they do against time."""
import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PathCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.path import Path

GROUND_COLORS = {"smooth": "#eef3f8", "rough": "#e6d3b3", "rubber": "#c9b8d8", "coulomb": "#cfe3c4"}
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


def clipped(edge, box):
    """The part of a rectangle (4, 2) on the side of a line to which its normal points."""
    point, normal = (np.array(part, dtype=float) for part in edge)
    depth = (box - point) @ (normal / np.hypot(*normal))
    corners = []
    for i in range(len(box)):
        j = (i + 1) % len(box)
        if depth[i] >= 0:
            corners.append(box[i])
        if (depth[i] >= 0) != (depth[j] >= 0):
            corners.append(box[i] + (box[j] - box[i]) * depth[i] / (depth[i] - depth[j]))
    return np.array(corners).reshape(-1, 2)


def signed_area(outline):
    x, y = outline.T
    return 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))


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


def view_of(runs):
    """Centre and half the sides of what the paths need [m]."""
    places = [np.array([table["x"], table["y"]]) for run in runs for table in (run.states, run.switches)
              if table is not None and len(table["x"])]
    if not places:
        return np.zeros(2), np.ones(2)
    places = np.concatenate(places, axis=1)
    places = places[:, np.isfinite(places).all(axis=0)]
    low, high = places.min(axis=1), places.max(axis=1)
    size = max(high - low) or 1.0
    return (low + high) / 2, np.maximum((high - low) / 2, size / 8) + 0.12 * size


def rectangle(center, half):
    return np.array([center + half * corner for corner in ((-1, -1), (1, -1), (1, 1), (-1, 1))])


def moving_mark(region):
    """How the ground itself moves."""
    if region.turntable[0] != 0:
        return " \u21ba" if region.turntable[0] > 0 else " \u21bb"
    if any(region.belt):
        return " " + BELT_ARROWS[round(np.arctan2(region.belt[1], region.belt[0]) / (np.pi / 4)) % 8]
    return ""


def name_places(texts, paths, visible):
    """For each region where its name goes: near the top of what later regions leave of it, or nowhere."""
    low, size = visible[0], visible[2] - visible[0]
    x, y = (low[i] + size[i] * (np.arange(RASTER) + 0.5) / RASTER for i in (0, 1))
    points = np.column_stack([values.ravel() for values in np.meshgrid(x, y)])
    top = np.full(len(points), -1)
    for i, path in enumerate(paths):
        top[path.contains_points(points)] = i
    top = top.reshape(RASTER, RASTER)
    places = []
    for i, text in enumerate(texts):
        width = math.ceil(CHARACTER * RASTER * (len(text) + 1))
        # Two rows above each other are as high as the text.
        room = (top[1:] == i) & (top[:-1] == i)
        free = np.lib.stride_tricks.sliding_window_view(room, min(width, RASTER), axis=1).all(axis=2)
        rows = np.flatnonzero(free.any(axis=1))
        if not len(rows):
            places.append(None)
            continue
        row = rows[-2] if len(rows) > 1 else rows[-1]
        columns = np.flatnonzero(free[row])
        # The middle of the widest gap in which it fits.
        gap = max(np.split(columns, np.flatnonzero(np.diff(columns) > 1) + 1), key=len)
        places.append((low[0] + size[0] * ((gap[0] + gap[-1] + width) / 2) / RASTER, (y[row] + y[row + 1]) / 2))
    return places


def draw_ground(axes, ground, visible):
    """Regions in their order; returns what the legend says of them."""
    center = visible.mean(axis=0)
    box = rectangle(center, FAR * (visible[2] - visible[0]))
    axes.set_facecolor(GROUND_COLORS[ground.base.law])
    low, high = visible[0], visible[2]
    seen, paths = [], []
    for region in ground.regions:
        if region.outline is not None and not region.outside and (
                np.any(region.outline.max(axis=0) < low) or np.any(region.outline.min(axis=0) > high)):
            continue
        path = path_of(region, box)
        if path is not None:
            seen.append(region)
            paths.append(path)
    edges = EDGE_COLOR if len(seen) <= MOST_EDGES else "face"
    axes.add_collection(PathCollection(paths, facecolors=[GROUND_COLORS[region.law] for region in seen],
                                       edgecolors=edges, linewidths=0.6, zorder=0.5), autolim=False)
    if len(seen) <= MOST_NAMES:
        texts = [region.name + moving_mark(region) for region in seen]
        for text, place in zip(texts, name_places(texts, paths, visible)):
            if place is not None:
                axes.text(*place, plain(text), ha="center", va="center", color="#6f675a", fontsize=8, zorder=0.6)
    laws = [ground.base.law] + [region.law for region in seen]
    return [Patch(facecolor=GROUND_COLORS[law], edgecolor=EDGE_COLOR, linewidth=0.6, label=law)
            for law in GROUND_COLORS if law in laws]


def draw_paths(axes, runs):
    center, half = view_of(runs)
    # The panel is square: what it shows of the ground beyond the paths is known beforehand.
    visible = rectangle(center, np.full(2, max(half)))
    axes.set_xlim(visible[0][0], visible[2][0])
    axes.set_ylim(visible[0][1], visible[2][1])
    axes.set_aspect("equal")
    ground = next((run.ground for run in runs if run.ground is not None), None)
    handles = draw_ground(axes, ground, visible) if ground is not None else []
    largest = max((np.hypot(run.switches["Px"], run.switches["Py"]).max() for run in runs
                   if run.switches is not None and len(run.switches["t"])), default=0)
    for run, color in zip(runs, colors_of(runs)):
        if run.states is not None:
            axes.plot(run.states["x"], run.states["y"], color=color, zorder=2)
            begin = [run.states[name][:1] for name in ("x", "y")]
            axes.plot(*begin, "o", color=color, markersize=6, zorder=3)
        if run.switches is None or not len(run.switches["t"]):
            continue
        s = run.switches
        axes.plot(s["x"], s["y"], "o", color=color, markersize=4.5, markerfacecolor="white", zorder=3,
                  linestyle="none")
        hit = np.hypot(s["Px"], s["Py"]) > 0
        if largest > 0 and len(s["t"]) <= MOST_ARROWS:
            axes.quiver(s["x"][hit], s["y"][hit], s["Px"][hit], s["Py"][hit], angles="xy", scale_units="width",
                        scale=8 * largest, width=0.006, color=IMPULSE_COLOR, zorder=4)
    handles.append(Line2D([], [], color="#333333", marker="o", markersize=6, label="path, from its start"))
    handles.append(Line2D([], [], color="#333333", marker="o", markerfacecolor="white", linestyle="none",
                          label="switch"))
    if largest > 0:
        handles.append(Line2D([], [], color=IMPULSE_COLOR, marker=r"$\rightarrow$", markersize=11, linestyle="none",
                              label="impulse"))
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    axes.legend(handles=handles, loc="lower center", bbox_to_anchor=(0.5, 1.0), columnspacing=1.4, handlelength=1.6,
                ncol=len(handles) if len(handles) < 6 else (len(handles) + 1) // 2)


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
        drawn = True
        s = run.switches
        size = np.hypot(s["Px"], s["Py"])
        axes.vlines(s["t"], 0, size, color=color, linewidth=1.3)
        axes.plot(s["t"], size, "o", color=color, markersize=3.5)
    axes.set_ylabel("impulse [N s]")
    return drawn


def draw_times(panels, runs):
    drawn = [draw_components(panels[0], runs, "v", ["$v_x$", "$v_y$"], "velocity [m/s]"),
             draw_components(panels[1], runs, "omega", [r"$\omega_1$", r"$\omega_2$", r"$\omega_3$"], "spin [rad/s]"),
             draw_slip(panels[2], runs),
             draw_components(panels[3], runs, "energy", ["T"], "kinetic energy [J]"),
             draw_impulses(panels[4], runs)]
    times = np.unique(np.concatenate([run.switches["t"] for run in runs if run.switches is not None] or [[]]))
    for axes, any_line in zip(panels, drawn):
        axes.grid(True, color="#e8e8e8", linewidth=0.6)
        axes.set_axisbelow(True)
        axes.margins(x=0.01, y=0.12)
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)
        if not any_line:
            axes.text(0.5, 0.5, "not in this input", transform=axes.transAxes, ha="center", va="center",
                      color="#888888")
            axes.set_yticks([])
        if len(times) <= MOST_GUIDES:
            for time in times:
                axes.axvline(time, color=GUIDE_COLOR, linewidth=0.8, linestyle=(0, (4, 3)), zorder=0.5)
    for axes in panels[2:]:
        if axes.lines or axes.collections:
            axes.set_ylim(bottom=0)
    panels[-1].set_xlabel("t [s]")


def draw(runs, title):
    figure = plt.figure(figsize=(13, 7.8))
    grid = figure.add_gridspec(5, 2, width_ratios=[1.18, 1], left=0.055, right=0.935, top=0.91, bottom=0.075,
                               wspace=0.16, hspace=0.22)
    draw_paths(figure.add_subplot(grid[:, 0]), runs)
    panels = [figure.add_subplot(grid[0, 1])]
    panels += [figure.add_subplot(grid[row, 1], sharex=panels[0]) for row in range(1, 5)]
    draw_times(panels, runs)
    for axes in panels[:-1]:
        axes.tick_params(labelbottom=False)
    figure.align_ylabels(panels)
    figure.suptitle(plain(title), x=0.055, y=0.975, ha="left", fontsize=13, weight="bold")
    if len(runs) > 1:
        figure.legend(handles=[Line2D([], [], color=color, label=plain(run.name)) for run, color in
                               zip(runs, colors_of(runs))], loc="upper right", bbox_to_anchor=(0.94, 0.985),
                      ncol=min(4, len(runs)))
    return figure


def save(figure, path):
    """The same bytes for the same picture. Throws OSError."""
    undated = {"png": {"Software": None}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}
    form = path.rpartition(".")[2].lower()
    figure.savefig(path, format=form, dpi=110, metadata=undated[form])
