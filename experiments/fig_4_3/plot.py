"""Averaged extension against pressure: simulated measurements with their spread, and the best fit of each model."""

import sys

sys.path.insert(0, "scripts")
from plot_style import COLORS, plt, read_table, run

MODELS = {
    "st_venant_kirchhoff": ("St. Venant-Kirchhoff (2)", "-"),
    "neo_hookean": ("neo-Hookean (1)", "-"),
    "mooney_rivlin": ("Mooney-Rivlin (2)", "-"),
    "ogden_1": ("Ogden, one term (2)", "--"),
    "ogden_2": ("Ogden, two terms (4)", "--"),
    "hart_smith": ("Hart-Smith (3)", "-"),
}
TRUTHS = {"": "silicone (truth: Hart-Smith)", "_on_ogden_1972": "truth: Ogden 1972, three terms"}


def draw_truth(axes, results, truth, title):
    measured = read_table(results / f"measured{truth}.csv")
    pressure = [p / 1e3 for p in measured["pressure [Pa]"]]
    for color, (name, (label, style)) in zip(COLORS, MODELS.items()):
        curve = read_table(results / f"curve_{name}{truth}.csv")
        if not curve:  # the fit has not converged
            continue
        axes.plot([p / 1e3 for p in curve["pressure [Pa]"]], curve["extension"], style, color=color, label=label,
                  zorder=3 if name == "hart_smith" else 2)
    axes.errorbar(pressure, measured["extension"], xerr=[p / 1e3 for p in measured["pressure_deviation [Pa]"]],
                  yerr=measured["extension_deviation"], fmt="o", color="black", markerfacecolor="white", markersize=4,
                  linewidth=0.8, capsize=2, zorder=4, label="mean of three samples")
    axes.set_xlim(0, 1.25 * max(pressure))
    axes.set_ylim(1, 1.05 * max(measured["extension"]))
    axes.set_xlabel("pressure [kPa]")
    axes.set_ylabel("averaged extension ratio [1]")
    axes.set_title(f"{title}, 0.5 mm", fontsize=9)


def draw(results):
    truths = {truth: title for truth, title in TRUTHS.items() if (results / f"measured{truth}.csv").exists()}
    figure, all_axes = plt.subplots(1, len(truths), figsize=(5.6 * len(truths), 4.4), squeeze=False)
    for axes, (truth, title) in zip(all_axes[0], truths.items()):
        draw_truth(axes, results, truth, title)
    all_axes[0][0].legend(title="model (number of parameters)", fontsize=8, title_fontsize=8)
    return figure


run(draw)
