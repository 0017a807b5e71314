"""Table 6.1 typeset for the models that there are: our iterations, remeshings and times beside the thesis'."""

import csv
import sys

sys.path.insert(0, "scripts")
from plot_style import plt, run

THESIS = {"sphere": (5, 128, 4, 21), "teddy": (2, 193, 17, 258)}
HEADINGS = ["model", "remeshings", "thesis", "iterations", "thesis", "preview [s]", "thesis [s]", "end [s]", "thesis [s]"]


def draw(results):
    with open(results / "metrics.csv", newline="", encoding="utf-8") as stream:
        ours = {row["metric"]: float(row["value"]) for row in csv.DictReader(stream)}
    rows = []
    for name, (remeshings, iterations, preview, end) in THESIS.items():
        rows.append([name.capitalize(), f"{ours['remeshings_' + name]:.0f}", remeshings,
                     f"{ours['iterations_' + name]:.0f}", iterations, f"{ours['time_preview_' + name]:.1f}", preview,
                     f"{ours['time_' + name]:.1f}", end])
    figure, axes = plt.subplots(figsize=(8, 1.2))
    axes.axis("off")
    table = axes.table(cellText=rows, colLabels=HEADINGS, loc="center", edges="horizontal")
    table.scale(1, 1.4)
    return figure


run(draw)
