"""Compares an experiment's metrics.csv with its expected.csv: within the bounds, else fail.

NaN, a missing metric, another unit, bounds that are missing: all fail. Times are reported as ratios and never gated.
Standard library alone.
"""

import argparse
import csv
import json
import math
import os
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
KINDS = ("thesis", "published", "analytic", "cross", "own")
# "none" is a claim that cannot be checked; its note says why, and paper_repro.md lists it.
SIZES = ("quick", "paper", "both", "none")
COLUMNS = ["metric", "size", "kind", "value", "lower", "upper", "unit", "source", "note"]


class ExpectedError(Exception):
    """An expected.csv or metrics.csv that cannot be used; names the file and the line."""


@dataclass
class Expected:
    metric: str
    size: str
    kind: str
    value: float | None
    lower: float | None
    upper: float | None
    unit: str
    source: str
    note: str

    def applies_to(self, size):
        return self.size in (size, "both")

    def is_time(self):
        return self.metric == "time" or self.metric.startswith("time_")


@dataclass
class Comparison:
    expected: Expected
    ours: float | None
    verdict: str  # "pass", "fail" or "reported"
    reason: str


def results_dir(experiment, size, root=ROOT):
    return root / "results" / experiment if size == "paper" else root / "results" / "quick" / experiment


def expected_file(experiment, root=ROOT):
    return root / "experiments" / experiment / "expected.csv"


def optional_number(text, where):
    if text == "":
        return None
    try:
        number = float(text)
    except ValueError:
        raise ExpectedError(f"{where}: '{text}' is not a number") from None
    if not math.isfinite(number):
        raise ExpectedError(f"{where}: '{text}' is not finite")
    return number


def checked(row, where):
    """The row as Expected, or ExpectedError saying what is wrong with it."""
    if None in row or None in row.values():
        raise ExpectedError(f"{where}: needs exactly the {len(COLUMNS)} columns {','.join(COLUMNS)}")
    numbers = {name: optional_number(row[name], where) for name in ("value", "lower", "upper")}
    expected = Expected(**{**row, **numbers})
    if not expected.metric or not expected.unit:
        raise ExpectedError(f"{where}: metric and unit must be given ('1' for dimensionless)")
    if expected.kind not in KINDS:
        raise ExpectedError(f"{where}: unknown kind '{expected.kind}', use one of {', '.join(KINDS)}")
    if expected.size not in SIZES:
        raise ExpectedError(f"{where}: unknown size '{expected.size}', use one of {', '.join(SIZES)}")
    if expected.size == "none" and not expected.note:
        raise ExpectedError(f"{where}: a claim that is not checked needs a note that says why")
    if expected.kind != "own" and not expected.source:
        raise ExpectedError(f"{where}: a number of kind {expected.kind} needs its source")
    has_bounds = expected.lower is not None or expected.upper is not None
    if expected.is_time() and has_bounds:
        raise ExpectedError(f"{where}: times are never gated, leave the bounds of {expected.metric} empty")
    if expected.lower is not None and expected.upper is not None and expected.lower > expected.upper:
        raise ExpectedError(f"{where}: lower {expected.lower:g} is above upper {expected.upper:g}")
    return expected


def read_expected(file):
    """The rows of an expected.csv. Raises ExpectedError for anything that could make a check vacuous."""
    try:
        with open(file, newline="", encoding="utf-8") as stream:
            reader = csv.DictReader(stream)
            if reader.fieldnames != COLUMNS:
                raise ExpectedError(f"{file}:1: the header must be {','.join(COLUMNS)}")
            rows = [checked(row, f"{file}:{reader.line_num}") for row in reader]
    except OSError as error:
        raise ExpectedError(f"{file}: cannot be read: {error.strerror}") from None
    for size in ("quick", "paper"):
        keys = [(row.metric, row.kind, row.source) for row in rows if row.applies_to(size)]
        for key in keys:
            if keys.count(key) > 1:
                raise ExpectedError(f"{file}: metric {key[0]} of kind {key[1]} comes twice at size {size}")
    return rows


def read_metrics(file):
    """{name: [(value, unit), ...]}: a list, so that duplicated rows are seen."""
    metrics = {}
    try:
        with open(file, newline="", encoding="utf-8") as stream:
            reader = csv.DictReader(stream)
            if reader.fieldnames != ["metric", "value", "unit"]:
                raise ExpectedError(f"{file}:1: the header must be metric,value,unit")
            for row in reader:
                try:
                    value = float(row["value"])
                except (TypeError, ValueError):
                    value = math.nan
                metrics.setdefault(row["metric"], []).append((value, row["unit"]))
    except OSError as error:
        raise ExpectedError(f"{file}: cannot be read: {error.strerror}; run the experiment first") from None
    return metrics


def compare_row(expected, found):
    """One expected row against the list of (value, unit) under its name."""
    if not found:
        return Comparison(expected, None, "fail", "missing in the results")
    value, unit = found[0]
    fail = lambda reason: Comparison(expected, value, "fail", reason)
    if len(found) > 1:
        return fail(f"comes {len(found)} times in the results")
    if not math.isfinite(value):
        return fail("not finite")
    if unit != expected.unit:
        return fail(f"unit is '{unit}', expected '{expected.unit}'")
    if expected.is_time():
        ratio = f"{value / expected.value:.3g} of the expected time" if expected.value else ""
        return Comparison(expected, value, "reported", ratio)
    if expected.lower is None and expected.upper is None:
        return fail("no bounds to compare with")
    if expected.lower is not None and not value >= expected.lower:
        return fail("below the lower bound")
    if expected.upper is not None and not value <= expected.upper:
        return fail("above the upper bound")
    return Comparison(expected, value, "pass", "")


def compare(rows, metrics, size):
    return [compare_row(row, metrics.get(row.metric, [])) for row in rows if row.applies_to(size)]


def passed(comparisons):
    """True when something was compared and nothing failed."""
    return any(c.verdict == "pass" for c in comparisons) and all(c.verdict != "fail" for c in comparisons)


def check_provenance(folder, size):
    """Raises ExpectedError unless the results come from a completed run of this size."""
    file = folder / "provenance.json"
    try:
        provenance = json.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise ExpectedError(f"{file}: cannot be read: {error.strerror}; run the experiment first") from None
    except ValueError as error:
        raise ExpectedError(f"{file}: is not JSON: {error}") from None
    if provenance.get("outcome") != "completed":
        raise ExpectedError(f"{file}: the run did not complete: {provenance.get('outcome')}")
    if provenance.get("size") != size:
        raise ExpectedError(f"{file}: the run has size {provenance.get('size')}, not {size}")


def compare_experiment(experiment, size, root=ROOT):
    """The comparisons of stored results; also writes comparison.csv beside them."""
    folder = results_dir(experiment, size, root)
    rows = read_expected(expected_file(experiment, root))
    if not any(row.applies_to(size) for row in rows):
        raise ExpectedError(f"{expected_file(experiment, root)}: expects nothing at size {size}")
    check_provenance(folder, size)
    comparisons = compare(rows, read_metrics(folder / "metrics.csv"), size)
    header = ["metric", "kind", "ours", "value", "lower", "upper", "unit", "verdict", "reason"]
    lines = [[c.expected.metric, c.expected.kind, number(c.ours), number(c.expected.value), number(c.expected.lower),
              number(c.expected.upper), c.expected.unit, c.verdict, c.reason] for c in comparisons]
    write_csv(folder / "comparison.csv", [header] + lines)
    return comparisons


def number(value):
    return "" if value is None else repr(value)


def short(value):
    return "-" if value is None else f"{value:.5g}"


def write_csv(file, lines):
    temporary = Path(f"{file}.part")
    with open(temporary, "w", newline="", encoding="utf-8") as stream:
        csv.writer(stream, lineterminator="\n").writerows(lines)
    os.replace(temporary, file)


def print_table(lines):
    """Columns as wide as their widest cell; the first line is the header."""
    widths = [max(len(line[k]) for line in lines) for k in range(len(lines[0]))]
    for index, line in enumerate(lines):
        print("  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip())
        if index == 0:
            print("  ".join("-" * width for width in widths))


def print_comparisons(experiment, size, comparisons):
    print(f"\n{experiment} ({size}): {'pass' if passed(comparisons) else 'FAIL'}")
    lines = [["verdict", "metric", "ours", "bounds", "value", "unit", "kind", "reason"]]
    for c in comparisons:
        bounds = "" if c.verdict == "reported" else f"{short(c.expected.lower)} .. {short(c.expected.upper)}"
        verdict = "FAIL" if c.verdict == "fail" else c.verdict
        lines.append([verdict, c.expected.metric, short(c.ours), bounds, short(c.expected.value), c.expected.unit,
                      c.expected.kind, c.reason])
    print_table(lines)


def accepted(row, value):
    """The own row moved to a new value: its bounds move along, or are set to 5 % when it had none."""
    lower, upper = row.lower, row.upper
    if lower is None and upper is None:
        lower, upper = value - 0.05 * abs(value), value + 0.05 * abs(value)
    elif row.value is not None:
        lower = None if lower is None else lower + (value - row.value)
        upper = None if upper is None else upper + (value - row.value)
    return Expected(row.metric, row.size, row.kind, value, lower, upper, row.unit, row.source, row.note)


def accept(experiment, size, root=ROOT):
    """Rewrites the rows of kind own, and only those, to the stored results; prints old and new."""
    check_provenance(results_dir(experiment, size, root), size)
    metrics = read_metrics(results_dir(experiment, size, root) / "metrics.csv")
    lines = [COLUMNS]
    for row in read_expected(expected_file(experiment, root)):
        if row.kind == "own" and row.applies_to(size) and not row.is_time():
            comparison = compare_row(row, metrics.get(row.metric, []))
            if comparison.ours is None or not math.isfinite(comparison.ours) or "unit" in comparison.reason:
                raise ExpectedError(f"{experiment}: {row.metric} cannot be accepted: {comparison.reason}")
            print(f"{experiment}: {row.metric} {short(row.value)} -> {short(comparison.ours)} {row.unit}")
            row = accepted(row, comparison.ours)
        lines.append([row.metric, row.size, row.kind, number(row.value), number(row.lower), number(row.upper), row.unit,
                      row.source, row.note])
    write_csv(expected_file(experiment, root), lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("experiment", nargs="+")
    parser.add_argument("--size", choices=("quick", "paper"), default="quick")
    parser.add_argument("--accept", action="store_true", help="rewrite the rows of kind own to these results")
    arguments = parser.parse_args()
    all_passed = True
    try:
        for experiment in arguments.experiment:
            if arguments.accept:
                accept(experiment, arguments.size)
                continue
            comparisons = compare_experiment(experiment, arguments.size)
            print_comparisons(experiment, arguments.size, comparisons)
            all_passed = all_passed and passed(comparisons)
    except ExpectedError as error:
        print(error, file=sys.stderr)
        return 2
    return 0 if all_passed else 1


if __name__ == "__main__":
    sys.exit(main())
