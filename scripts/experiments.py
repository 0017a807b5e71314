"""Runs, lists, compares and draws the experiments; called by ./reproduce. Standard library alone."""

import argparse
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import compare
from compare import ROOT, ExpectedError

BIN = ROOT / "build" / "release" / "bin"
INTERRUPTED = 130
interrupted = False


def on_interrupt(*_):
    """Programs that run get the signal from the terminal and end by themselves; we only stop afterwards."""
    global interrupted
    interrupted = True


def log(line):
    with open(ROOT / "build" / "reproduce.log", "a", encoding="utf-8") as stream:
        stream.write(f"{time.strftime('%F %T')} {line}\n")


def all_experiments():
    return sorted(file.parent.name for file in (ROOT / "experiments").glob("*/expected.csv"))


def chosen(ids):
    known = all_experiments()
    for experiment in ids:
        if experiment not in known:
            raise ExpectedError(f"there is no experiment '{experiment}'; there are: {', '.join(known)}")
    return ids or known


def program(experiment):
    return BIN / "experiments" / experiment


def figure_file(experiment, size):
    folder = ROOT / "figures"
    return (folder if size == "paper" else folder / size) / f"{experiment}.png"


def draw_command(experiment, size, picture):
    """The command that draws the experiment's figure, from figure.json (surfaces; figure_quick.json where a quick run
    makes fewer) or plot.py (curves)."""
    folder = ROOT / "experiments" / experiment
    results = compare.results_dir(experiment, size)
    for layout in (folder / f"figure_{size}.json", folder / "figure.json"):
        if layout.exists():
            return ["xvfb-run", "-a", BIN / "softform-render", layout, "--results", results, "--out", picture]
    return ["/usr/bin/python3", folder / "plot.py", results, picture]


def draw(experiment, size):
    """Draws under a temporary name, then renames; True when the figure stands."""
    picture = figure_file(experiment, size)
    picture.parent.mkdir(parents=True, exist_ok=True)
    temporary = picture.with_name(f".{picture.name}.part.png")
    code = subprocess.Popen(draw_command(experiment, size, temporary)).wait()
    if code == 0:
        os.replace(temporary, picture)
        if temporary.with_suffix(".pdf").exists():  # the same as vectors
            os.replace(temporary.with_suffix(".pdf"), picture.with_suffix(".pdf"))
        log(f"drew {picture.relative_to(ROOT)}")
    else:
        temporary.unlink(missing_ok=True)
        log(f"{experiment}: the figure failed with exit code {code}")
    return code == 0


def key_metrics(comparisons):
    """The first two gated metrics, ours / the expected value; failures come first."""
    gated = {}
    for c in sorted(comparisons, key=lambda c: c.verdict != "fail"):
        if c.verdict != "reported":
            gated.setdefault(c.expected.metric, c)
    return "   ".join(f"{name} {compare.short(c.ours)} / {compare.short(c.expected.value)} {c.expected.unit}"
                      for name, c in list(gated.items())[:2])


def outcome(experiment, size):
    """How the last run ended, in its own words."""
    try:
        return json.loads((compare.results_dir(experiment, size) / "provenance.json").read_text())["outcome"]
    except (OSError, ValueError, KeyError):
        return "no provenance.json"


def run_one(experiment, size):
    """One line of the summary: id, verdict, key metrics, seconds."""
    start = time.monotonic()
    log(f"running {experiment} ({size})")
    code = subprocess.Popen([program(experiment), "--size", size]).wait()
    seconds = time.monotonic() - start
    verdict, key = "FAIL", f"exit code {code}, {outcome(experiment, size)}"
    if interrupted or code == INTERRUPTED:
        verdict, key = "interrupted", outcome(experiment, size)
    elif code == 0:
        try:
            comparisons = compare.compare_experiment(experiment, size)
            compare.print_comparisons(experiment, size, comparisons)
            verdict, key = ("pass" if compare.passed(comparisons) else "FAIL"), key_metrics(comparisons)
        except ExpectedError as error:
            key = str(error)
        if not draw(experiment, size):
            verdict, key = "FAIL", f"no figure; {key}"
    log(f"{experiment} ({size}): {verdict}, {seconds:.1f} s")
    return [experiment, verdict, key, f"{seconds:.1f}"]


def run(ids, size):
    lines = []
    for experiment in chosen(ids):
        lines.append(run_one(experiment, size or "quick"))
        if interrupted:
            break
    print(f"\nSummary (size {size or 'quick'}; metrics: ours / expected)")
    compare.print_table([["id", "verdict", "key metrics", "seconds"]] + lines)
    if interrupted:
        return INTERRUPTED
    return 0 if all(line[1] == "pass" for line in lines) else 1


def stored_sizes(experiment, size):
    """The sizes with results, or the one that was asked for."""
    sizes = [size] if size else ["quick", "paper"]
    return [s for s in sizes if size or (compare.results_dir(experiment, s) / "provenance.json").exists()]


def compare_stored(ids, size):
    runs = [(experiment, s) for experiment in chosen(ids) for s in stored_sizes(experiment, size)]
    if not runs:
        raise ExpectedError("there are no results to compare: ./reproduce run first")
    all_passed = True
    for experiment, s in runs:
        comparisons = compare.compare_experiment(experiment, s)
        compare.print_comparisons(experiment, s, comparisons)
        all_passed = all_passed and compare.passed(comparisons)
    return 0 if all_passed else 1


def can_draw(experiment, size):
    """Committed results hold the tables but not the surfaces; those come from a run."""
    needs_surfaces = any((ROOT / "experiments" / experiment).glob("*.json"))  # a layout of surfaces
    if needs_surfaces and not any(compare.results_dir(experiment, size).glob("*.vtp")):
        print(f"{experiment} ({size}): its surfaces are not there; ./reproduce run {experiment} --size {size} makes them")
        return False
    return True


def figures(ids, size):
    runs = [(experiment, s) for experiment in chosen(ids) for s in stored_sizes(experiment, size)]
    drawn = [draw(experiment, s) for experiment, s in runs if can_draw(experiment, s)]
    print(f"{sum(drawn)} of {len(runs)} figures drawn")
    return 0 if all(drawn) else 1


def list_experiments():
    lines = [["id", "section", "quick [min]", "paper [min]", "claim"]]
    for experiment in all_experiments():
        info = json.loads(subprocess.run([program(experiment), "--list"], check=True, capture_output=True).stdout)
        lines.append([info["id"], info["section"], f"{info['minutes']['quick']:g}", f"{info['minutes']['paper']:g}",
                      info["claim"]])
    compare.print_table(lines)
    return 0


def main():
    parser = argparse.ArgumentParser(prog="./reproduce", description=__doc__)
    parser.add_argument("verb", choices=("run", "list", "compare", "figures", "accept"))
    parser.add_argument("ids", nargs="*", metavar="ID")
    parser.add_argument("--size", choices=("quick", "paper"))
    arguments = parser.parse_args()
    signal.signal(signal.SIGINT, on_interrupt)
    try:
        if arguments.verb == "run":
            return run(arguments.ids, arguments.size)
        if arguments.verb == "compare":
            return compare_stored(arguments.ids, arguments.size)
        if arguments.verb == "figures":
            return figures(arguments.ids, arguments.size)
        if arguments.verb == "accept":
            if not arguments.ids:
                raise ExpectedError("accept needs the id of an experiment")
            for experiment in chosen(arguments.ids):
                compare.accept(experiment, arguments.size or "quick")
            return 0
        return list_experiments()
    except ExpectedError as error:
        print(f"reproduce: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
