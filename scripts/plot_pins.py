"""Planar bodies and their pins, as figures 5.2, 5.5 and 5.6 show them. Tables as experiments/pin_figures.hpp writes them."""

from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap
from plot_style import COLORS, read_table

TARGET, SOFT, STIFF = "#e4e4e4", "#9ecbe8", "#303030"


def corners_of(triangles):
    return list(zip(*(map(int, triangles[name]) for name in ("a", "b", "c"))))


def draw_body(axes, points, triangles, color, **style):
    """All triangles in one colour."""
    corners = corners_of(triangles)
    axes.tripcolor(points["x [m]"], points["y [m]"], corners, [0.0] * len(corners), cmap=ListedColormap([color]), **style)


def draw_materials(axes, points, triangles, **style):
    """Soft triangles light, stiff ones dark."""
    axes.tripcolor(points["x [m]"], points["y [m]"], corners_of(triangles), triangles["density"],
                   cmap=ListedColormap([SOFT, STIFF]), vmin=0, vmax=1, **style)


def draw_outline(axes, points, triangles, color, **style):
    """The edges of one triangle only."""
    edges = {}
    for corners in corners_of(triangles):
        for a, b in zip(corners, corners[1:] + corners[:1]):
            edges[frozenset((a, b))] = None if frozenset((a, b)) in edges else (a, b)
    x, y = points["x [m]"], points["y [m]"]
    axes.add_collection(LineCollection([[(x[a], y[a]), (x[b], y[b])] for a, b in filter(None, edges.values())],
                                       colors=color, **style))


def draw_pins(axes, pins, size=5):
    axes.plot(pins["x [m]"], pins["y [m]"], "o", color=COLORS[1], markeredgecolor="white", markeredgewidth=0.6,
              markersize=size, zorder=4)


def draw_stage(axes, results, pose, stage, has_materials=False):
    """A pose after a stage, its pins, and the target's outline over it."""
    triangles = read_table(results / "triangles.csv")
    points = read_table(results / f"{pose}_{stage}.csv")
    if has_materials:
        draw_materials(axes, points, triangles)
    else:
        draw_body(axes, points, triangles, SOFT)
    draw_outline(axes, read_table(results / f"{pose}_target.csv"), triangles, COLORS[1], linewidths=0.7)
    draw_pins(axes, read_table(results / f"{pose}_{stage}_pins.csv"))


def errors(metrics, pose, stage):
    """"max/mean mm" of a pose after a stage, from {metric: value}."""
    return f"{1e3 * metrics[f'max_error_{pose}_{stage}']:.1f} / {1e3 * metrics[f'mean_error_{pose}_{stage}']:.2f} mm"


def read_metrics(file):
    import csv
    with open(file, newline="", encoding="utf-8") as stream:
        return {row["metric"]: float(row["value"]) for row in csv.DictReader(stream)}
