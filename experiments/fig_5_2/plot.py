"""The tower's last pose with its actuators for growing k_sparse, and for the range of 4 to 6."""

import sys

sys.path.insert(0, "scripts")
from plot_pins import TARGET, draw_body
from plot_style import COLORS, plt, read_table, run


def draw(results):
    counts = read_table(results / "counts.csv")
    triangles = read_table(results / "triangles.csv")
    names = [(f"k_{k:g}", f"k = {k:g}: {int(n)}") for k, n in zip(counts["k_sparse [mm^2/N^(1/2)]"], counts["actuators"])]
    names.append(("requested", "4 to 6 requested"))
    figure, all_axes = plt.subplots(1, len(names), figsize=(1.5 * len(names), 3.1), sharex=True, sharey=True)
    target = read_table(results / "target_points.csv")
    for axes, (name, title) in zip(all_axes, names):
        draw_body(axes, target, triangles, TARGET)
        draw_body(axes, read_table(results / f"{name}_points.csv"), triangles, COLORS[5], alpha=0.7)
        forces = read_table(results / f"{name}_forces.csv")
        axes.quiver(forces["x [m]"], forces["y [m]"], forces["f_x [N]"], forces["f_y [N]"], angles="xy",
                    scale_units="xy", scale=150, width=0.02, color="black", zorder=3)
        axes.plot(forces["x [m]"], forces["y [m]"], "o", color=COLORS[1], markersize=3, zorder=4)
        axes.set_title(title, fontsize=8)
        axes.set_aspect("equal")
        axes.axis("off")
    return figure


run(draw)
