"""Objective and infeasibility against factorisations and CPU time; performance and data profiles over all instances."""

import csv
import sys

sys.path.insert(0, "scripts")
from plot_style import COLORS, plt, read_table, run

BALANCED = 1e-6  # as in sec_3_2.cpp
LINES = {"full": "-", "reduced": "--"}
ORDER = ["reduced_gauss_newton", "augmented_lagrangian", "augmented_lagrangian_gauss_newton", "quadratic_penalty", "sqp",
         "ipopt", "nlopt_lbfgs", "gradient_projection", "lbfgs", "nlopt_mma", "nlopt_slsqp", "nlopt_auglag", "ceres",
         "feasible_newton"]
PALETTE = COLORS + ["#999999", "#8b4513", "#7f0000", "#006d5b", "#9467bd", "#bcbd22", "#17becf"]


def outcomes(results):
    with open(results / "outcomes.csv", newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def style(row):
    return {"color": PALETTE[ORDER.index(row["method"])], "linestyle": LINES[row["formulation"]],
            "linewidth": 2.4 if row["method"] == "reduced_gauss_newton" else 1.2}


def best_so_far(trace):
    """The least objective of the iterates up to each that balance the forces; infinite before the first."""
    least, values = float("inf"), []
    for objective, infeasibility in zip(trace["objective"], trace["infeasibility"]):
        if infeasibility <= BALANCED:
            least = min(least, objective)
        values.append(least)
    return values


def draw_traces(axes, results, rows, instance):
    rows = [row for row in rows if row["instance"] == instance]
    best = min(float(row["resolved_objective"]) for row in rows if row["has_equilibrium"] == "1")
    for row in rows:
        trace = read_table(results / f"trace_{instance}_{row['method']}_{row['formulation']}.csv")
        gap = [max(objective / best - 1, 1e-4) for objective in best_so_far(trace)]
        time = [max(t, 1e-3) for t in trace["elapsed [s]"]]
        axes[0].plot([max(s, 1) for s in trace["linear_solves"]], gap, **style(row))
        axes[1].plot(time, gap, **style(row))
        if row["formulation"] == "full":
            axes[2].plot(time, [max(c, 1e-16) for c in trace["infeasibility"]], **style(row))
    for panel in axes[:2]:
        panel.axhline(0.05, color="black", linewidth=0.8, linestyle=":")
        panel.set(xscale="log", yscale="log", ylim=(1e-4, 2e1), ylabel="best balanced objective / best $-$ 1")
    axes[2].axhline(1e-8, color="black", linewidth=0.8, linestyle=":")
    axes[2].set(xscale="log", yscale="log", ylim=(1e-16, 1e1), ylabel="infeasibility [1]")
    for panel, label in zip(axes, ("factorisations", "CPU time [s]", "CPU time [s]")):
        panel.set(xlabel=label)
        panel.set_title(instance.replace("_", " "), fontsize=9)


def group(rows, prefixes):
    """{instance: {(method, formulation): row}} of the instances whose names begin so."""
    found = {}
    for row in rows:
        if row["instance"].startswith(prefixes):
            found.setdefault(row["instance"], {})[row["method"], row["formulation"]] = row
    return found


def draw_profile(axes, instances, cost, xlabel, relative):
    """The share of instances brought within 5 % of the best, against the cost: in units of the cheapest method's (Dolan
    and Moré 2002, performance profile) or as it is (Moré and Wild 2009, data profile). What was not run is not solved."""
    solvers = sorted({s for rows in instances.values() for s in rows}, key=lambda s: (ORDER.index(s[0]), s[1]))
    costs = {}
    for solver in solvers:
        for rows in instances.values():
            unit = min(max(float(row[cost]), 1e-9) for row in rows.values()) if relative else 1
            own = float(rows[solver][cost]) if solver in rows else float("inf")
            costs.setdefault(solver, []).append(max(own, 1e-9) / unit)
    finite = [c for all_costs in costs.values() for c in all_costs if c < float("inf")]
    first, last = (1, 1.2 * max(finite)) if relative else (0.8 * min(finite), 1.2 * max(finite))
    for number, solver in enumerate(solvers):
        solved = sorted(c for c in costs[solver] if c < float("inf"))
        count = len(costs[solver])
        lift = 0.004 * number  # lines that coincide stay visible
        x = [first, *solved, last]
        y = [sum(c <= v for c in costs[solver]) / count + lift for v in x]
        axes.step(x, y, where="post", **style(dict(zip(("method", "formulation"), solver))))
    axes.set(xscale="log", xlim=(first, last), ylim=(-0.02, 1.09), xlabel=xlabel, ylabel="share of instances")


def draw(results):
    rows = outcomes(results)
    balloons = sorted({row["instance"] for row in rows if row["instance"].startswith(("bump", "ellip"))},
                      key=lambda name: int(name.rsplit("_", 1)[1]))
    shown = [*balloons, "sheet_hart_smith"]
    count = len(shown) + 1
    figure, axes = plt.subplots(count + 1, 3, figsize=(12, 2.9 * count + 1.4), height_ratios=[1] * count + [0.4])
    *axes, legend = axes
    for line, instance in zip(axes, shown):
        draw_traces(line, results, rows, instance)
    designs, fits = group(rows, ("bump", "ellip", "sheet")), group(rows, "rubber")
    for panel, what in zip(axes[-1], ((designs, "reached_cpu [s]", "CPU time / cheapest method's", True),
                                      (designs, "reached_linear_solves", "factorisations", False),
                                      (fits, "reached_cpu [s]", "CPU time / cheapest method's", True))):
        draw_profile(panel, *what)
    axes[-1][0].set_title(f"performance profile, {len(designs)} designs", fontsize=9)
    axes[-1][1].set_title(f"data profile, {len(designs)} designs", fontsize=9)
    axes[-1][2].set_title(f"performance profile, {len(fits)} rubber fits", fontsize=9)
    used = sorted({(row["method"], row["formulation"]) for row in rows}, key=lambda s: (s[1], ORDER.index(s[0])))
    handles = [plt.Line2D([], [], **style(dict(zip(("method", "formulation"), s)))) for s in used]
    for panel in legend:
        panel.axis("off")
    table = legend[1].legend(handles, [f"{method}, {formulation}" for method, formulation in used], loc="center", ncols=4,
                             fontsize=8)
    table.set_in_layout(False)
    return figure


run(draw, vectors=True)
