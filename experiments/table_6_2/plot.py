"""Table 6.2 typeset for the models that there are."""

import csv
import sys

sys.path.insert(0, "scripts")
from plot_style import plt, run


def draw(results):
    with open(results / "metrics.csv", newline="", encoding="utf-8") as stream:
        ours = {row["metric"]: float(row["value"]) for row in csv.DictReader(stream)}
    rows = [[name.capitalize()] + [f"{ours[kind + name]:.0f}" for kind in ("elements_", "panels_", "inner_panels_")]
            for name in ("sphere", "teddy")]
    figure, axes = plt.subplots(figsize=(5, 1.2))
    axes.axis("off")
    table = axes.table(cellText=rows, colLabels=["model", "elements", "panels", "inner panels"], loc="center",
                       edges="horizontal")
    table.scale(1, 1.4)
    return figure


run(draw)
