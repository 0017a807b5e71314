"""Table 4.1 typeset: our times beside the thesis', and what the balloons became."""

import csv
import sys

sys.path.insert(0, "scripts")
from plot_style import plt, run

# Heading, column of table.csv, format; columns of one group share a heading above.
GROUPS = [
    ("", [("model", "model", "{}"), ("vertices", "vertices", "{:.0f}")]),
    ("ours", [("iterations", "iterations", "{:.0f}"), ("static step [ms]", "static step [ms]", "{:.0f}"),
              ("shape step [ms]", "shape step [ms]", "{:.0f}"), ("total [s]", "total [s]", "{:.1f}")]),
    ("thesis", [("iterations", "thesis iterations", "{:.0f}"), ("total [s]", "thesis total [s]", "{:.0f}"),
                ("over ours", "thesis total over ours", "{:.0f}")]),
    ("distance to the target, mean / max [mm]", [("optimised", "", ""), ("downscaled", "downscaled ", "")]),
]
LEFT = {"model"}


def name_of(row):
    return row["model"].capitalize().replace("_with_positions", "*")


def cell(row, column, text):
    if text:
        return text.format(name_of(row) if column == "model" else float(row[column]))
    mean, largest = (float(row[f"{column}{kind} distance [mm]"]) for kind in ("mean", "max"))
    return f"{mean:.2f} / {largest:.1f}"


def sum_row(rows):
    """The times of the thesis' models together."""
    rows = [row for row in rows if not row["model"].endswith("_with_positions")]
    ours, thesis = (sum(float(row[name]) for row in rows) for name in ("total [s]", "thesis total [s]"))
    return {"model": "all", "total [s]": f"{ours:.1f}", "thesis total [s]": f"{thesis:.0f}",
            "thesis total over ours": f"{thesis / ours:.0f}"}


def draw(results):
    with open(results / "table.csv", newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    widths = {"": 1.05, "ours": 1.15, "thesis": 1.0, GROUPS[3][0]: 1.8}
    width = sum(widths[group] * len(columns) for group, columns in GROUPS) + 0.1
    height = 0.3 * (len(rows) + 4.7)
    figure = plt.figure(figsize=(width, height), constrained_layout=False)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(0, width), ylim=(len(rows) + 4.7, 0))
    axes.axis("off")
    rule = lambda y, begin=0.15, end=width - 0.15, line=0.6: axes.plot([begin, end], [y, y], "k", linewidth=line)

    x = 0.0
    totals = sum_row(rows)
    for group, columns in GROUPS:
        begin, step = x, widths[group]
        if group:
            axes.text(begin + step * len(columns) / 2 + 0.1, 0.75, group, ha="center", va="center")
            rule(1.2, begin + 0.25, begin + step * len(columns) - 0.05)
        for heading, column, text in columns:
            place, align = (x + 0.2, "left") if heading in LEFT else (x + step - 0.1, "right")
            axes.text(place, 1.75, heading, ha=align, va="center", fontsize=9)
            for k, row in enumerate(rows):
                axes.text(place, 2.85 + k, cell(row, column, text), ha=align, va="center")
            axes.text(place, 3.35 + len(rows), totals.get(column, ""), ha=align, va="center")
            x += step
    for y, line in ((0.2, 1.2), (2.25, 0.6), (2.6 + len(rows), 0.6), (3.95 + len(rows), 1.2)):
        rule(y, line=line)
    if any(row["model"].endswith("_with_positions") for row in rows):
        axes.text(0.2, 4.35 + len(rows), "* with the aligned distance of vertices in the objective, which the thesis "
                  "has not; not in the sum", va="center", fontsize=9)
    return figure


run(draw)
