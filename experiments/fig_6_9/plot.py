"""The relaxed energy's derivative from slack to wrinkled, and the transition in between."""

import sys

sys.path.insert(0, "scripts")
from plot_style import COLORS, plt, read_table, run


def draw(results):
    curves = read_table(results / "curves.csv")
    metrics = {}
    for line in (results / "metrics.csv").read_text(encoding="utf-8").splitlines()[1:]:
        name, value = line.split(",")[:2]
        metrics[name] = float(value)
    u, eps = metrics["u"], metrics["eps"]
    figure, axes = plt.subplots()
    axes.plot(curves["lambda_1"], curves["relaxed"], color=COLORS[0], linestyle="--",
              label=r"$\partial\tilde\psi/\partial\lambda_1$ over $\kappa$")
    axes.plot(curves["lambda_1"], curves["smoothed"], color=COLORS[1], linewidth=2.2, label="with the transition $h$")
    for x in (u - 2 * eps, u - eps, u):
        axes.axvline(x, color="black", linewidth=0.6, linestyle=":")
    axes.axvline(1, color="grey", linewidth=0.6)
    axes.set_xticks([u - 2 * eps, u - eps, 1, u], [r"$u-2\epsilon$", "$x_I$", "1", "$u$"])
    axes.set_xlabel(r"$\lambda_1$ at $\lambda_2 = 0.4$")
    axes.legend()
    return figure


run(draw)
