"""The look of all plots, and the frame of an experiment's plot.py:

    import sys; sys.path.insert(0, "scripts")          # plot.py runs in the root of the source tree
    from plot_style import plt, read_table, run

    def draw(results):                                  # the folder of the results; returns the figure
        table = read_table(results / "curve.csv")
        figure, axes = plt.subplots()
        axes.plot(table["stretch"], table["pressure [Pa]"])
        return figure

    run(draw)
"""

import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

# Okabe and Ito's colours: told apart by everyone and in grey.
COLORS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"]

plt.rcParams.update({
    "figure.figsize": (6.4, 4.2),
    "figure.constrained_layout.use": True,
    "savefig.dpi": 250,
    "font.size": 10,
    "axes.prop_cycle": matplotlib.cycler(color=COLORS),
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e6e6e6",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.6,
    "lines.markersize": 4,
    "legend.frameon": False,
})


def read_table(file):
    """{column: [numbers]} of a CSV that Run wrote; the unit is part of the column's name."""
    with open(file, newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    return {name: [float(row[name]) for row in rows] for name in rows[0]} if rows else {}


def run(draw, vectors=False):
    """plot.py RESULTS PICTURE: draws the results folder into the picture, and as vectors into a PDF beside it."""
    results, picture = map(Path, sys.argv[1:3])
    figure = draw(results)
    # No dates in the files: the same results give the same bytes.
    figure.savefig(picture, metadata={"Software": None})
    if vectors:
        figure.savefig(picture.with_suffix(".pdf"), metadata={"CreationDate": None})
