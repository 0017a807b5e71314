"""The objective of every method's iterates, against factorisations and CPU time."""

import csv
import sys

sys.path.insert(0, "scripts")
from plot_style import COLORS, plt, read_table, run

LINES = ["-", "--", ":"]


def draw(results):
    with open(results / "outcomes.csv", newline="", encoding="utf-8") as stream:
        methods = [row["method"] for row in csv.DictReader(stream)]
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.8), sharey=True)
    for number, method in enumerate(methods):
        trace = read_table(results / f"trace_bar_{method}_reduced.csv")
        look = {"color": COLORS[number % len(COLORS)], "linestyle": LINES[number // len(COLORS)]}
        axes[0].plot([max(1, n) for n in trace["linear_solves"]], trace["objective"], label=method, **look)
        axes[1].plot([max(1e-3, t) for t in trace["elapsed [s]"]], trace["objective"], **look)
    for panel, label in zip(axes, ("factorisations", "CPU time [s]")):
        panel.set(xscale="log", yscale="log", xlabel=label)
    axes[0].set_ylabel("objective [1]")
    axes[0].legend(fontsize=8)
    return figure


run(draw, vectors=True)
