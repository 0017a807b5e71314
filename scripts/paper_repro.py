"""Writes paper_repro.md: every claim of the thesis that an experiment checks, our number, and the verdict.

Read from experiments/*/expected.csv (kinds thesis and published) and the paper-size results. Standard library alone.
"""

import json
import os
import subprocess
import sys

import compare
import experiments
from compare import ROOT, ExpectedError

HEADER = """# What of the thesis is reproduced

Written by `./reproduce page` from the expected numbers and the paper-size results; do not edit.
An interval is what counts as reproduced; it is wider than the printed number where our input differs, as the note says.
Times are ratios to the thesis' and decide nothing.

| section | claim | command | thesis | accepted | ours | verdict | note |
|---|---|---|---|---|---|---|---|
"""


def interval(row):
    if row.lower is None and row.upper is None:
        return ""
    if row.lower is None:
        return f"at most {compare.short(row.upper)}"
    if row.upper is None:
        return f"at least {compare.short(row.lower)}"
    return f"{compare.short(row.lower)} to {compare.short(row.upper)}"


def verdict(row, metrics):
    """Our number and the verdict for one expected row."""
    if row.size == "none":
        return "", "not reproducible"
    if metrics is None:
        return "", "not run"
    comparison = compare.compare_row(row, metrics.get(row.metric, []))
    if comparison.verdict == "reported":
        return f"{compare.short(comparison.ours)} {row.unit}", comparison.reason
    words = "reproduced" if comparison.verdict == "pass" else f"deviates: {comparison.reason}"
    return f"{compare.short(comparison.ours)} {row.unit}", words


def paper_metrics(experiment):
    folder = compare.results_dir(experiment, "paper")
    if not (folder / "metrics.csv").exists():
        return None
    compare.check_provenance(folder, "paper")
    return compare.read_metrics(folder / "metrics.csv")


def cell(text):
    return text.replace("|", "\\|").replace("\n", " ")


def rows_of(experiment):
    info = json.loads(subprocess.run([experiments.program(experiment), "--list"], check=True,
                                     capture_output=True).stdout)
    metrics = paper_metrics(experiment)
    for row in compare.read_expected(compare.expected_file(experiment)):
        if row.kind in ("thesis", "published") and (row.applies_to("paper") or row.size == "none"):
            ours, words = verdict(row, metrics)
            thesis = "" if row.value is None else f"{compare.short(row.value)} {row.unit}"
            cells = [info["section"], f"{row.metric} ({row.source})", f"`./reproduce run {experiment} --size paper`", thesis,
                     interval(row), ours, words, row.note]
            yield "| " + " | ".join(cell(text) for text in cells) + " |\n"


def without_times(text):
    """The page without the rows of times, which differ from machine to machine."""
    return [line for line in text.splitlines() if not line.split("|")[2:3] or not line.split("|")[2].startswith(" time")]


def main():
    """Writes the page, or with --check compares the committed one with a fresh one in everything but times."""
    page = ROOT / "paper_repro.md"
    try:
        text = HEADER + "".join(line for experiment in experiments.all_experiments() for line in rows_of(experiment))
    except ExpectedError as error:
        print(f"reproduce: {error}", file=sys.stderr)
        return 2
    if "--check" in sys.argv:
        committed = page.read_text(encoding="utf-8")
        is_fresh = without_times(committed) == without_times(text)
        print("paper_repro.md is " + ("as the results say" if is_fresh else "old: run ./reproduce page and commit it"))
        return 0 if is_fresh else 1
    temporary = page.with_suffix(".md.part")
    temporary.write_text(text, encoding="utf-8")
    os.replace(temporary, page)
    print(f"wrote {page.name}, {text.count('`./reproduce run ')} claims")
    return 0


if __name__ == "__main__":
    sys.exit(main())
