"""The time of a whole design against the number of vertices, and what it is spent on."""

import math
import sys

sys.path.insert(0, "scripts")
from plot_style import COLORS, plt, read_table, run

PHASES = {
    "factorization": "factorising the shape step",
    "equilibrium": "equilibria of new rest shapes",
    "assembly": "assembling the shape step",
    "solve": "solving the shape step",
    "inflation": "inflating the downscaled target",
    "collision": "self-intersections",
    "rest": "set-up, alignment, check",
}


def fit(n, seconds):
    """Exponent and factor of seconds = factor n^exponent, by least squares of the logarithms."""
    x, y = [math.log(v) for v in n], [math.log(v) for v in seconds]
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    exponent = sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)
    return exponent, math.exp(mean_y - exponent * mean_x)


def draw(results):
    table = read_table(results / "scaling.csv")
    n, total = table["vertices"], table["total [s]"]
    exponent, factor = fit(n, total)
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.6, 4.2))

    left.loglog(n, total, "o", color="black", label="whole design")
    left.loglog(n, [factor * v**exponent for v in n], color=COLORS[0], label=f"fit, $n^{{{exponent:.2f}}}$")
    left.loglog(n, [total[0] * (v / n[0]) ** 1.3 for v in n], ":", color="grey", label="$n^{1.3}$")
    left.set_xticks(n, [f"{int(v)}" for v in n])
    left.minorticks_off()
    seconds = [s for k in range(-2, 5) for s in (10**k, 2 * 10**k, 5 * 10**k) if total[0] / 2 < s < 2 * total[-1]]
    left.set_yticks(seconds, [f"{s:g}" for s in seconds])
    left.set_xlabel("vertices $n$")
    left.set_ylabel("time [s]")
    left.legend()

    places, below = range(len(n)), [0.0] * len(n)
    for color, (name, label) in zip(COLORS, PHASES.items()):
        share = [100 * t / whole for t, whole in zip(table[f"{name} [s]"], total)]
        right.bar(places, share, bottom=below, color=color, width=0.7, label=label)
        below = [a + b for a, b in zip(below, share)]
    right.set_xticks(list(places), [f"{int(v)}\n{int(k)}" for v, k in zip(n, table["shape steps"])],
                     fontsize=8)
    right.set_xlabel("vertices $n$, and shape steps below")
    right.set_ylabel("share of the time [%]")
    right.set_ylim(0, 100)
    right.grid(False)
    handles, labels = right.get_legend_handles_labels()
    right.legend(handles[::-1], labels[::-1], loc="center left", bbox_to_anchor=(1, 0.5), fontsize=8)
    return figure


run(draw)
