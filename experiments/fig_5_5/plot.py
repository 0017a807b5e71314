"""Rows: the palm's poses. Columns: target, sparse pins, pins moved, two materials; each with the target's outline."""

import sys

sys.path.insert(0, "scripts")
from plot_pins import TARGET, draw_body, draw_stage, errors, read_metrics
from plot_style import plt, read_table, run

POSES = ("wind", "wilted", "cheer")
STAGES = ("(b) sparse pins", "(c) pins moved", "(d) two materials")


def draw(results):
    metrics = read_metrics(results / "metrics.csv")
    triangles = read_table(results / "triangles.csv")
    figure, rows = plt.subplots(len(POSES), 4, figsize=(8.4, 6.6), sharex=True, sharey=True)
    for row, pose in zip(rows, POSES):
        draw_body(row[0], read_table(results / f"{pose}_target.csv"), triangles, TARGET)
        row[0].set_title("(a) target" if pose == POSES[0] else "", fontsize=9)
        for stage, (axes, title) in enumerate(zip(row[1:], STAGES), start=1):
            draw_stage(axes, results, pose, stage, has_materials=stage == 3)
            axes.set_title((title + "\n" if pose == POSES[0] else "") + errors(metrics, pose, stage), fontsize=9)
        for axes in row:
            axes.set_aspect("equal")
            axes.axis("off")
    return figure


run(draw)
