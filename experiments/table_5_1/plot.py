"""Table 5.1 typeset: a line a character and stage, a column a pose, the thesis' numbers in brackets."""

import sys

sys.path.insert(0, "scripts")
from plot_style import run
from plot_table import read_rows, typeset

NAMES = {"tour_eiffel": "TourEiffel", "palmy_2d": "Palmy2D", "worm_eye": "WormEye", "question_mark": "Questionmark"}


def draw(results):
    lines = {}
    for row in read_rows(results / "table.csv"):
        cell = f"{float(row['max [mm]']):.1f} / {float(row['mean [mm]']):.2f}"
        thesis = row["thesis max/mean [mm]"]
        lines.setdefault((row["character"], row["stage"]), []).append(cell + (f"  ({thesis})" if thesis else ""))
    poses = max(map(len, lines.values()))
    rows, breaks = [], []
    for (name, stage), cells in lines.items():
        if rows and not rows[-1]["model"].startswith(NAMES[name]):
            breaks.append(len(rows))
        rows.append({"model": f"{NAMES[name]} ({stage})"} | {f"pose {k + 1}": "" for k in range(poses)} |
                    {f"pose {k + 1}": cell for k, cell in enumerate(cells)})
    columns = [("max / mean [mm] (thesis)", "model", "left")] + [
        (f"pose {k + 1}", f"pose {k + 1}", "right") for k in range(poses)]
    return typeset(rows, columns, width=1.75, breaks=breaks)


run(draw)
