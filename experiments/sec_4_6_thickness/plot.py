"""Mean deviation of the inflated bunny for each kind of uneven coat, with 95 % confidence intervals."""

import csv
import sys

sys.path.insert(0, "scripts")
from plot_style import COLORS, plt, run

COATS = {
    "independent": "independent",
    "correlated_5mm": "0.5 cm",
    "correlated_10mm": "1 cm",
    "correlated_20mm": "2 cm",
    "correlated_40mm": "4 cm",
    "uniform": "whole\nballoon",
    "brushed": "strokes\nand troughs",
    "troughs": "troughs",
}
THESIS = {10: 0.22, 20: 0.52}  # [cm]


def draw(results):
    with open(results / "metrics.csv", newline="", encoding="utf-8") as stream:
        metrics = {row["metric"]: float(row["value"]) for row in csv.DictReader(stream)}
    coats = [coat for coat in COATS if f"deviation_{coat}_20" in metrics]
    figure, axes = plt.subplots(figsize=(7.2, 4.2))
    for percent, color, shift in ((10, COLORS[0], -0.08), (20, COLORS[1], 0.08)):
        if f"deviation_{coats[0]}_{percent}" not in metrics:
            continue
        places = [place + shift for place in range(len(coats))]
        means = [100 * metrics[f"deviation_{coat}_{percent}"] for coat in coats]
        widths = [100 * metrics.get(f"deviation_{coat}_{percent}_half_width", 0) for coat in coats]
        axes.errorbar(places, means, yerr=widths, fmt="o", color=color, capsize=3, label=f"{percent} %")
        axes.axhline(THESIS[percent], color=color, linewidth=1, linestyle="--", label=f"thesis, {percent} %")
    axes.set_xticks(range(len(coats)), [COATS[coat] for coat in coats])
    axes.set_xlabel("how the thickness varies: correlation length, or cause")
    axes.set_ylabel("mean deviation of the inflated shape [cm]")
    axes.set_ylim(0, 0.66)
    axes.grid(axis="x", visible=False)
    axes.legend(loc="upper left", ncols=2)
    return figure


run(draw)
