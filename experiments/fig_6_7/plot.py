"""First derivatives of the relaxed energy over the squared stretches: kinked, with the thesis' smoothing, with ours."""

import sys

sys.path.insert(0, "scripts")
import numpy as np
from plot_style import plt, read_table, run

# None at zero, the value of whole regions.
LEVELS = np.linspace(0.02, 0.92, 19)
KINDS = {"relaxed": "as they are", "thesis": "the thesis' smoothing", "energy": "smoothed energy (ours)"}


def draw(results):
    figure, axes = plt.subplots(2, 3, figsize=(9.6, 6), sharex=True, sharey=True)
    for column, (kind, title) in enumerate(KINDS.items()):
        table = read_table(results / f"landscape_{kind}.csv")
        x, y = (np.unique(table[f"lambda_{k}"]) for k in (1, 2))
        for row, name in enumerate(("psi_1", "psi_2")):
            values = np.array(table[name]).reshape(len(x), len(y)).T
            shown = axes[row, column].contourf(x, y, values, levels=LEVELS, cmap="viridis",
                                               extend="both")
            axes[row, column].contour(x, y, values, levels=LEVELS, colors="white", linewidths=0.3)
            line = np.linspace(1, x[-1], 100)
            axes[row, column].plot([1, 1], [y[0], 1], color="#d55e00", linewidth=0.8)
            axes[row, column].plot(line, line ** -0.5, color="#d55e00", linewidth=0.8)
            axes[row, column].plot([x[0], y[-1]], [x[0], y[-1]], color="black", linewidth=0.6, linestyle=":")
            axes[row, column].grid(False)
        axes[0, column].set_title(title)
        axes[1, column].set_xlabel(r"$\lambda_1$")
    for row in range(2):
        axes[row, 0].set_ylabel(r"$\lambda_2$")
        figure.colorbar(shown, ax=axes[row, :], label=rf"$\partial\psi/\partial\lambda_{row + 1}$ over $\kappa$")
    return figure


run(draw)
