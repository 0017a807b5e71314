"""Table 5.2 typeset: our times beside the thesis'."""

import sys

sys.path.insert(0, "scripts")
from plot_style import run
from plot_table import read_rows, typeset

NAMES = {"tour_eiffel": "TourEiffel", "palmy_2d": "Palmy2D", "worm_eye": "WormEye", "question_mark": "Questionmark"}
COLUMNS = [("", "character", "left"), ("elements", "elements", "right"), ("actuators", "actuators", "right"),
           ("wall time [s]", "wall time [s]", "right"), ("processor [s]", "processor time [s]", "right"),
           ("failed equilibria", "failed equilibria", "right"), ("thesis [s]", "thesis time [s]", "right"),
           ("over ours", "thesis time over ours", "right")]


def draw(results):
    rows = read_rows(results / "table.csv")
    for row in rows:
        row["character"] = NAMES[row["character"]]
    return typeset(rows, COLUMNS)


run(draw)
