"""Objective and infeasibility against linear solves and time, and the profiles over all instances."""

import csv
import sys

sys.path.insert(0, "scripts")
from plot_style import COLORS, plt, read_table, run

# A result counts where the balance of forces is met to this; solved is within 5 % of the best that counts.
FEASIBLE = 1e-6
SOLVED = 1.05
STYLES = ["-", "--", ":"]


def traces(results):
    """{instance: {method: table}}; instances are told by the metrics' names."""
    with open(results / "metrics.csv", newline="", encoding="utf-8") as stream:
        names = [row["metric"][len("termination_"):] for row in csv.DictReader(stream)
                 if row["metric"].startswith("termination_")]
    found = {}
    for name in names:
        instance, method = split(name)
        found.setdefault(instance, {})[method] = read_table(results / f"trace_{name}.csv")
    return found


def split(name):
    methods = ["augmented_lagrangian_gauss_newton", "augmented_lagrangian", "reduced_gauss_newton", "quadratic_penalty",
               "gradient_projection", "sqp", "nlopt_slsqp", "nlopt_mma", "nlopt_lbfgs", "nlopt_auglag", "lbfgs", "ceres",
               "ipopt"]
    method = next(m for m in methods if name.endswith("_" + m))
    return name[: -len(method) - 1], method


def best_objective(tables):
    feasible = [o for t in tables.values() for o, c in zip(t["objective"], t["infeasibility"]) if c <= FEASIBLE]
    return min(feasible) if feasible else float("nan")


def cost_to_solve(table, best, column):
    for objective, infeasibility, cost in zip(table["objective"], table["infeasibility"], table[column]):
        if infeasibility <= FEASIBLE and objective <= SOLVED * best + 1e-12:
            return max(cost, 1e-3)
    return float("inf")


def draw_profile(axes, instances, methods, column, title):
    """Dolan and More 2002: the share of instances solved within a factor of the cheapest method."""
    for k, method in enumerate(methods):
        ratios = []
        for tables in instances.values():
            best = best_objective(tables)
            costs = {m: cost_to_solve(t, best, column) for m, t in tables.items()}
            if method in costs:
                cheapest = min(costs.values())
                ratios.append(costs[method] / cheapest if cheapest < float("inf") else float("inf"))
        solved = sorted(r for r in ratios if r < float("inf"))
        x = [1, *solved, 1e3]
        y = [sum(r <= v for r in ratios) / len(ratios) for v in x]
        axes.step(x, y, where="post", label=method, color=COLORS[k % 7], linestyle=STYLES[k // 7])
    axes.set(xscale="log", xlim=(1, 1e3), ylim=(0, 1.02), title=title, xlabel="factor of the cheapest method",
             ylabel="share of instances solved")


def draw(results):
    instances = traces(results)
    shown = [i for i in instances if not i.startswith("rubber")][:3]
    methods = sorted({m for tables in instances.values() for m in tables})
    figure, axes = plt.subplots(len(shown) + 1, 3, figsize=(13, 3.4 * (len(shown) + 1)))
    for row, instance in zip(axes, shown):
        for method, table in instances[instance].items():
            k = methods.index(method)
            style = {"color": COLORS[k % 7], "linestyle": STYLES[k // 7], "label": method}
            row[0].plot(table["linear_solves"], table["objective"], **style)
            row[1].plot(table["elapsed [s]"], table["objective"], **style)
            row[2].plot(table["elapsed [s]"], [max(c, 1e-16) for c in table["infeasibility"]], **style)
        best = best_objective(instances[instance])
        for panel, x in ((row[0], "linear solves"), (row[1], "time [s]")):
            panel.set(yscale="log", ylim=(0.8 * best, 200 * best), title=instance, xlabel=x, ylabel="objective [1]")
        row[2].set(yscale="log", title=instance, xlabel="time [s]", ylabel="infeasibility [1]")
    draw_profile(axes[-1][0], instances, methods, "elapsed [s]", "performance profile: time")
    draw_profile(axes[-1][1], instances, methods, "iteration", "performance profile: iterations")
    axes[-1][2].axis("off")
    handles, labels = axes[-1][0].get_legend_handles_labels()
    axes[-1][2].legend(handles, labels, loc="center", ncols=1)
    return figure


run(draw)
