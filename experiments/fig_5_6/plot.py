"""The worm's layout at rest with its pins, and its poses with it, each with the target's outline."""

import sys

sys.path.insert(0, "scripts")
from plot_pins import draw_materials, draw_pins, draw_stage, errors, read_metrics
from plot_style import plt, read_table, run

POSES = ("curl", "snake", "nod", "look_round")


def draw(results):
    metrics = read_metrics(results / "metrics.csv")
    figure, all_axes = plt.subplots(1, 1 + len(POSES), figsize=(10, 3.6), sharey=True)
    draw_materials(all_axes[0], read_table(results / "rest.csv"), read_table(results / "triangles.csv"))
    draw_pins(all_axes[0], read_table(results / "places.csv"))
    all_axes[0].set_title("at rest", fontsize=9)
    for axes, pose in zip(all_axes[1:], POSES):
        draw_stage(axes, results, pose, 3, has_materials=True)
        axes.set_title(f"{pose.replace('_', ' ')}\n{errors(metrics, pose, 3)}", fontsize=9)
    for axes in all_axes:
        axes.set_aspect("equal")
        axes.axis("off")
    return figure


run(draw)
