"""A CSV typeset as a table."""

import csv

from plot_style import plt


def read_rows(file):
    with open(file, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def typeset(rows, columns, width=1.2, breaks=()):
    """rows: dicts of text. columns: (heading, key, align). A rule is drawn before the rows numbered in `breaks`."""
    height = 0.3 * (len(rows) + 2.6)
    total = width * len(columns) + 0.3
    figure = plt.figure(figsize=(total, height), constrained_layout=False)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(0, total), ylim=(len(rows) + 2.6, 0))
    axes.axis("off")
    for k, (heading, key, align) in enumerate(columns):
        place = 0.25 + width * k if align == "left" else 0.05 + width * (k + 1)
        axes.text(place, 0.95, heading, ha=align, va="center", fontsize=9)
        for i, row in enumerate(rows):
            axes.text(place, 2.2 + i, row[key], ha=align, va="center", fontsize=9.5)
    for y, line in [(0.3, 1.2), (1.6, 0.6), (2.1 + len(rows), 1.2)] + [(1.7 + b, 0.4) for b in breaks]:
        axes.plot([0.15, total - 0.15], [y, y], "k", linewidth=line)
    return figure
