"""Pressure against stretch of a spherical balloon: computed (points) and in closed form (lines)."""

import sys

sys.path.insert(0, "scripts")
from plot_style import COLORS, plt, read_table, run

MATERIALS = {
    "st_venant_kirchhoff": "St. Venant-Kirchhoff",
    "neo_hookean": "neo-Hookean",
    "mooney_rivlin": "Mooney-Rivlin",
    "ogden_1972": "Ogden (1972)",
    "silicone": "Hart-Smith (silicone)",
}
LARGEST_ASPHERICITY = 2e-2


def draw(results):
    figure, axes = plt.subplots()
    for color, (name, label) in zip(COLORS, MATERIALS.items()):
        table = read_table(results / f"{name}.csv")
        stretch = table["stretch"]
        axes.plot(stretch, [p / 1e3 for p in table["analytic_pressure [Pa]"]], color=color, label=label)
        for is_sphere, face in ((True, color), (False, "white")):
            points = [(s, p / 1e3) for s, p, a in zip(stretch, table["pressure [Pa]"], table["asphericity"])
                      if (a <= LARGEST_ASPHERICITY) == is_sphere]
            axes.plot(*zip(*points) if points else ([], []), "o", color=color, markerfacecolor=face, linestyle="none")
    axes.set_ylim(0, 20)
    axes.set_xlabel("stretch of the radius [1]")
    axes.set_ylabel("pressure [kPa]")
    axes.set_title("lines: closed form; points: computed (open: the stable balloon is no sphere)", fontsize=8)
    axes.legend()
    return figure


run(draw)
