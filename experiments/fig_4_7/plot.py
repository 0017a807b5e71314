"""Latex measured and fitted by five models, and a teddy of it: how it inflates, and its shapes."""

import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, "scripts")
from plot_style import COLORS, plt, read_table, run

MODELS = {
    "st_venant_kirchhoff": "St. Venant-Kirchhoff",
    "neo_hookean": "neo-Hookean",
    "mooney_rivlin": "Mooney-Rivlin",
    "ogden": "Ogden (two terms)",
    "hart_smith": "Hart-Smith",
}
LAYOUT = Path(__file__).parent / "teddy.json"


def draw_fit(axes, results):
    fitted, measured = read_table(results / "fitted.csv"), read_table(results / "measured.csv")
    for color, (name, label) in zip(COLORS, MODELS.items()):
        style = {"linewidth": 2.4} if name == "hart_smith" else {"linewidth": 1.2}
        axes.plot(fitted["stretch"], [p / 1e6 for p in fitted[f"{name} [Pa]"]], color=color, label=label, **style)
    axes.plot(measured["stretch"], [p / 1e6 for p in measured["stress [Pa]"]], "o", color="black",
              label="latex, Treloar 1944")
    axes.set_ylim(0, 13)
    axes.set_xlabel("stretch, equibiaxial [1]")
    axes.set_ylabel("nominal stress [MPa]")
    axes.legend()


def draw_path(axes, results):
    path, design = read_table(results / "teddy_path.csv"), read_table(results / "teddy_design.csv")
    axes.plot([1, *path["extension"]], [0, *(p / 1e3 for p in path["pressure [Pa]"])], color=COLORS[0],
              label="inflated step by step from rest")
    axes.plot(design["extension"], [p / 1e3 for p in design["pressure [Pa]"]], "o", color=COLORS[1], label="as designed")
    axes.set_ylim(bottom=0)
    axes.set_xlabel("mean extension ratio of the teddy [1]")
    axes.set_ylabel("pressure [kPa]")
    axes.legend(loc="lower right")


def draw_shapes(axes, results):
    with tempfile.TemporaryDirectory() as folder:
        picture = Path(folder) / "teddy.png"
        subprocess.run(["xvfb-run", "-a", "build/release/bin/softform-render", LAYOUT, "--results", results, "--out",
                        picture], check=True)
        axes.imshow(plt.imread(picture))
    axes.set_axis_off()


def draw(results):
    figure = plt.figure(figsize=(9, 7))
    grid = figure.add_gridspec(2, 2, height_ratios=(1, 0.8))
    draw_fit(figure.add_subplot(grid[0, 0]), results)
    draw_path(figure.add_subplot(grid[0, 1]), results)
    draw_shapes(figure.add_subplot(grid[1, :]), results)
    return figure


run(draw)
