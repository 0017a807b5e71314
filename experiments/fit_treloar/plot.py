"""Stress against stretch of the five models fitted to all three tests; below, what a fit to one mode says of the others."""

import csv
import sys

sys.path.insert(0, "scripts")
from plot_style import COLORS, plt, read_table, run

MODELS = {
    "st_venant_kirchhoff": "St. Venant-Kirchhoff",
    "neo_hookean": "neo-Hookean",
    "mooney_rivlin": "Mooney-Rivlin",
    "ogden": "Ogden (two terms)",
    "hart_smith": "Hart-Smith",
}
MODES = {"uniaxial": "uniaxial", "pure_shear": "pure shear", "inflation": "inflated sheet"}


def draw_curves(axes, results, mode):
    fitted, measured = read_table(results / f"fitted_{mode}.csv"), read_table(results / f"measured_{mode}.csv")
    for color, (name, label) in zip(COLORS, MODELS.items()):
        # Mooney-Rivlin's best is neo-Hookean here: its dashes leave the other visible.
        axes.plot(fitted["stretch"], [p / 1e6 for p in fitted[f"{name} [Pa]"]], color=color, label=label,
                  linestyle="--" if name == "mooney_rivlin" else "-")
    stress = [p / 1e6 for p in measured["stress [Pa]"]]
    axes.plot(measured["stretch"], stress, "o", color="black", label="Treloar 1944")
    axes.set_ylim(0, 1.1 * max(stress))
    axes.set_xlabel("stretch [1]")
    axes.set_title(MODES[mode], fontsize=10)


def draw_matrix(axes, results, model):
    with open(results / "cross_prediction.csv", newline="", encoding="utf-8") as stream:
        errors = {(row["fitted_on"], row["predicted"]): 100 * float(row["mean_relative_error"])
                  for row in csv.DictReader(stream) if row["model"] == model}
    rows, columns = [*MODES, "all"], list(MODES)
    axes.imshow([[min(errors[r, c], 100) for c in columns] for r in rows], cmap="RdYlGn_r", vmin=0, vmax=100)
    for i, r in enumerate(rows):
        for j, c in enumerate(columns):
            text = f"{errors[r, c]:.0f}" if errors[r, c] < 1000 else ">1000"
            axes.text(j, i, text, ha="center", va="center", fontsize=8,
                      color="black" if 15 < errors[r, c] < 85 else "white")
    axes.set_xticks(range(3), ["uniaxial", "shear", "sheet"], fontsize=7)
    axes.set_yticks(range(4), ["uniaxial", "shear", "sheet", "all"], fontsize=7)
    axes.grid(False)
    axes.set_title(MODELS[model], fontsize=8)


def draw(results):
    figure = plt.figure(figsize=(10, 6.4))
    above, below = figure.subfigures(2, 1, height_ratios=(1.5, 1))
    panels = above.subplots(1, 3)
    for axes, mode in zip(panels, MODES):
        draw_curves(axes, results, mode)
    panels[0].set_ylabel("nominal stress [MPa]")
    panels[0].legend(fontsize=8)
    matrices = below.subplots(1, 5)
    for axes, model in zip(matrices, MODELS):
        draw_matrix(axes, results, model)
    matrices[0].set_ylabel("fitted on", fontsize=8)
    # The experiment's own words on its numbers, a sentence a line.
    words = (results / "summary.txt").read_text(encoding="utf-8").strip().replace(". ", ".\n", 1)
    below.supxlabel("mean error [%] of the stress in the mode predicted\n" + words, fontsize=8)
    return figure


run(draw)
