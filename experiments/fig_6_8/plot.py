"""Two lines and the quadratic that joins them with their slopes."""

import sys

sys.path.insert(0, "scripts")
from plot_style import COLORS, plt, read_table, run


def draw(results):
    curves = read_table(results / "curves.csv")
    metrics = {}
    for line in (results / "metrics.csv").read_text(encoding="utf-8").splitlines()[1:]:
        name, value = line.split(",")[:2]
        metrics[name] = float(value)
    eps = metrics["eps"]
    figure, axes = plt.subplots()
    axes.plot(curves["x"], curves["lines"], color=COLORS[0], linestyle="--", label="$g_1 = 0$, $g_2 = c\\,x$")
    inside = [k for k, x in enumerate(curves["x"]) if abs(x) <= eps + 1e-12]
    axes.plot([curves["x"][k] for k in inside], [curves["transition"][k] for k in inside], color=COLORS[1],
              linewidth=2.4, label="transition $h$, (6.9)")
    for x in (-eps, eps):
        axes.axvline(x, color="black", linewidth=0.6, linestyle=":")
    axes.set_xticks([-eps, 0, eps], [r"$-\epsilon$", "0", r"$\epsilon$"])
    axes.set_xlabel("$x$")
    axes.legend()
    return figure


run(draw)
