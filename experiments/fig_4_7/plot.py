"""Nominal stress against stretch of latex in equibiaxial extension: measured, and the five models fitted to it."""

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


def draw(results):
    fitted, measured = read_table(results / "fitted.csv"), read_table(results / "measured.csv")
    figure, axes = plt.subplots()
    for color, (name, label) in zip(COLORS, MODELS.items()):
        style = {"linewidth": 2.4} if name == "hart_smith" else {"linewidth": 1.2}
        axes.plot(fitted["stretch"], [p / 1e6 for p in fitted[f"{name} [Pa]"]], color=color, label=label, **style)
    axes.plot(measured["stretch"], [p / 1e6 for p in measured["stress [Pa]"]], "o", color="black",
              label="latex, Treloar 1944")
    axes.set_ylim(0, 13)
    axes.set_xlabel("stretch, equibiaxial [1]")
    axes.set_ylabel("nominal stress [MPa]")
    axes.legend()
    return figure


run(draw)
