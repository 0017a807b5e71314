"""An edge of the target, the same edge on the simulated balloon, and the forces on one of its vertices."""

import csv
import sys

sys.path.insert(0, "scripts")
import numpy as np
from plot_style import COLORS, plt, read_table, run
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

FACE, FLAP = "#dfe3e8", "#a9c7e0"


def columns(table, names):
    keys = {name.split(" ")[0]: values for name, values in table.items()}
    return np.array([keys[name] for name in names]).T


def frame(triangles):
    """Axes along the first edge and outwards, in mm."""
    a, b = triangles[0][0], triangles[0][1]
    normal = sum(np.cross(t[1] - t[0], t[2] - t[0]) / np.linalg.norm(np.cross(t[1] - t[0], t[2] - t[0])) for t in triangles[:2])
    x = (b - a) / np.linalg.norm(b - a)
    z = normal - x * (normal @ x)
    z /= np.linalg.norm(z)
    return (a + b) / 2, 1e3 * np.array([x, np.cross(z, x), z])


def show(axes, triangles, kinds, title, limits):
    for triangle, kind in zip(triangles, kinds):
        axes.add_collection3d(Poly3DCollection([triangle], facecolor=FLAP if kind else FACE, edgecolor="#40454d",
                                               linewidth=0.8, alpha=0.95))
    axes.set(xlim=limits, ylim=limits, zlim=limits)
    axes.set_box_aspect((1, 1, 1), zoom=1.6)
    axes.view_init(elev=24, azim=-58)
    axes.set_axis_off()
    axes.set_title(title, y=1.02)


def draw_edge(axes, table, title, metrics, names, limits):
    kinds = np.array(table["kind"]).reshape(-1, 3)[:, 0]
    triangles = columns(table, "xyz").reshape(-1, 3, 3)
    centre, basis = frame(triangles)
    local = (triangles - centre) @ basis.T
    show(axes, local, kinds, title, limits)
    a, b = local[0][0], local[0][1]
    axes.plot(*np.array([a, b]).T, color=COLORS[1], linewidth=3, zorder=10)
    length, angle = 1e3 * metrics[names[0]], np.degrees(metrics[names[1]])
    suffix = "^0" if names[0].startswith("target") else ""
    axes.text2D(0.5, 0.06, f"$l_e{suffix}$ = {length:.2f} mm,  $\\theta_e{suffix}$ = {angle:.1f}°", transform=axes.transAxes,
                ha="center")
    # The normals of the two triangles: the angle between them is theta.
    for triangle in local[:2]:
        normal = np.cross(triangle[1] - triangle[0], triangle[2] - triangle[0])
        normal *= 0.35 * np.ptp(limits) / np.linalg.norm(normal) / 2
        axes.quiver(*triangle.mean(axis=0), *normal, color=COLORS[0], arrow_length_ratio=0.25, linewidth=1.6)


def draw_forces(axes, table, limits, frame_of):
    kinds = np.array(table["kind"])
    corners = columns(table, [p + c for p in "abc" for c in "xyz"]).reshape(-1, 3, 3)
    forces = columns(table, ["fx", "fy", "fz"])
    vertex = corners[-1][0]
    _, basis = frame_of
    local = (corners - vertex) @ basis.T
    turned = forces @ (basis / 1e3).T
    show(axes, local[:-1], kinds[:-1], "forces on a vertex", limits)
    scale = 0.45 * np.ptp(limits) / np.linalg.norm(turned, axis=1).max()
    for force, kind in zip(turned, kinds):
        axes.quiver(0, 0, 0, *(scale * force), color=COLORS[1] if kind else COLORS[0], arrow_length_ratio=0.18,
                    linewidth=2.4 if kind else 1.4, zorder=10)
    axes.text2D(0.5, 0.06, "membrane (blue) + pressure (orange) = 0", transform=axes.transAxes, ha="center")


def draw(results):
    with open(results / "metrics.csv", newline="", encoding="utf-8") as stream:
        metrics = {row["metric"]: float(row["value"]) for row in csv.DictReader(stream)}
    target, simulation = read_table(results / "target.csv"), read_table(results / "simulation.csv")
    extent = 2.2e3 * metrics["target_length"]
    limits = (-extent, extent)
    figure, axes = plt.subplots(1, 3, subplot_kw={"projection": "3d", "computed_zorder": False}, figsize=(9.6, 3.6))
    draw_edge(axes[0], target, "target", metrics, ["target_length", "target_angle"], limits)
    draw_edge(axes[1], simulation, "simulation", metrics, ["length", "angle"], limits)
    draw_forces(axes[2], read_table(results / "forces.csv"), limits, frame(columns(simulation, "xyz").reshape(-1, 3, 3)))
    return figure


run(draw)
