"""The tower in its five poses with its ring and strings, tensions in newtons, slack ones dotted; targets as outlines."""

import sys

sys.path.insert(0, "scripts")
from plot_style import COLORS, plt, read_table, run

POSES = ("sway_left", "sway_right", "bow", "swing", "dance")
TAUT = 1e-6  # [N]


def draw_body(axes, table, triangles):
    corners = list(zip(*(map(int, triangles[name]) for name in ("a", "b", "c"))))
    axes.tripcolor(table["x [m]"], table["y [m]"], corners, [0.0] * len(corners),
                   cmap=plt.matplotlib.colors.ListedColormap([COLORS[5]]))


def draw_outline(axes, table, edges):
    for a, b in zip(*(map(int, edges[name]) for name in ("a", "b"))):
        axes.plot([table["x [m]"][k] for k in (a, b)], [table["y [m]"][k] for k in (a, b)], color="black", linewidth=0.7)


def draw(results):
    triangles, edges = read_table(results / "triangles.csv"), read_table(results / "outline.csv")
    ring, ends = read_table(results / "ring.csv"), read_table(results / "strings.csv")
    figure, all_axes = plt.subplots(1, len(POSES), figsize=(2.6 * len(POSES), 3.0))
    for axes, pose in zip(all_axes, POSES):
        draw_body(axes, read_table(results / f"pose_{pose}.csv"), triangles)
        draw_outline(axes, read_table(results / f"target_{pose}.csv"), edges)
        axes.add_patch(plt.Circle((ring["x [m]"][0], ring["y [m]"][0]), ring["radius [m]"][0], fill=False, color="0.6"))
        lines = read_table(results / f"strings_{pose}.csv")
        columns = (lines["x [m]"], lines["y [m]"], lines["tension [N]"], ends["ring_x [m]"], ends["ring_y [m]"])
        for j, (x, y, tension, end_x, end_y) in enumerate(zip(*columns)):
            is_taut = tension > TAUT
            axes.plot([x, end_x], [y, end_y], color=COLORS[1] if is_taut else "0.6", linewidth=1.2 if is_taut else 0.8,
                      linestyle="-" if is_taut else ":", zorder=3)
            axes.plot(end_x, end_y, "o", color="0.3", markersize=3, zorder=4)
            if is_taut:  # its tension, at a part of its length where no other string's stands
                part = 0.35 + 0.12 * j
                axes.annotate(f"{tension:.2f}", (x + part * (end_x - x), y + part * (end_y - y)), fontsize=6,
                              ha="center", va="center", zorder=5, bbox={"facecolor": "white", "edgecolor": "none",
                                                                        "pad": 0.4, "alpha": 0.8})
        axes.set_title(pose.replace("_", " "), fontsize=9)
        axes.set_aspect("equal")
        axes.margins(0.12)
        axes.axis("off")
    return figure


run(draw)
