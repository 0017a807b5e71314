"""The comparison logic: everything that is not within its bounds must fail."""

import contextlib
import io
import json
import math
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
import compare

HEADER = "metric,size,kind,value,lower,upper,unit,source,note\n"


def row(lower=1.0, upper=2.0, unit="m", metric="length", kind="thesis", value=1.5, size="both"):
    return compare.Expected(metric, size, kind, value, lower, upper, unit, "table 1", "")


class Row(unittest.TestCase):
    def verdict(self, expected, *found):
        return compare.compare_row(expected, list(found)).verdict

    def test_within_and_on_the_bounds(self):
        for value in (1.0, 1.5, 2.0):
            self.assertEqual(self.verdict(row(), (value, "m")), "pass")

    def test_outside(self):
        for value in (math.nextafter(1.0, 0), math.nextafter(2.0, 3), -1e300):
            self.assertEqual(self.verdict(row(), (value, "m")), "fail")

    def test_not_finite(self):
        for value in (math.nan, math.inf, -math.inf):
            for expected in (row(), row(lower=None), row(upper=None), row(metric="time", lower=None, upper=None)):
                self.assertEqual(self.verdict(expected, (value, expected.unit)), "fail")

    def test_missing(self):
        self.assertEqual(self.verdict(row()), "fail")

    def test_one_sided(self):
        self.assertEqual(self.verdict(row(lower=None), (-5.0, "m")), "pass")
        self.assertEqual(self.verdict(row(lower=None), (2.1, "m")), "fail")
        self.assertEqual(self.verdict(row(upper=None), (5.0, "m")), "pass")
        self.assertEqual(self.verdict(row(upper=None), (0.9, "m")), "fail")

    def test_no_bounds(self):
        self.assertEqual(self.verdict(row(lower=None, upper=None), (1.5, "m")), "fail")

    def test_wrong_unit(self):
        self.assertEqual(self.verdict(row(), (1.5, "cm")), "fail")

    def test_duplicated(self):
        self.assertEqual(self.verdict(row(), (1.5, "m"), (1.5, "m")), "fail")

    def test_time_is_reported_only(self):
        time = row(metric="time_design", unit="s", lower=None, upper=None, value=100.0)
        result = compare.compare_row(time, [(5000.0, "s")])
        self.assertEqual(result.verdict, "reported")
        self.assertIn("50", result.reason)

    def test_nothing_compared_is_no_pass(self):
        self.assertFalse(compare.passed([]))
        time = row(metric="time", unit="s", lower=None, upper=None)
        self.assertFalse(compare.passed([compare.compare_row(time, [(1.0, "s")])]))

    def test_sizes(self):
        rows = [row(size="quick"), row(size="paper", metric="area"), row(size="none", metric="never")]
        names = lambda size: [c.expected.metric for c in compare.compare(rows, {}, size)]
        self.assertEqual(names("quick"), ["length"])
        self.assertEqual(names("paper"), ["area"])


class Folder(unittest.TestCase):
    """Files in a temporary tree laid out as the repository."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)

    def write(self, expected, metrics="", outcome="completed", size="quick"):
        compare.expected_file("e", self.root).parent.mkdir(parents=True, exist_ok=True)
        compare.expected_file("e", self.root).write_text(HEADER + expected)
        results = compare.results_dir("e", "quick", self.root)
        results.mkdir(parents=True, exist_ok=True)
        (results / "metrics.csv").write_text("metric,value,unit\n" + metrics)
        (results / "provenance.json").write_text(json.dumps({"outcome": outcome, "size": size}))

    def compare(self):
        return compare.compare_experiment("e", "quick", self.root)

    def test_passes_and_writes_the_comparison(self):
        self.write("length,both,thesis,1.5,1,2,m,table 1,\n", "length,1.2,m\n")
        self.assertTrue(compare.passed(self.compare()))
        self.assertIn("length,thesis,1.2,1.5,1.0,2.0,m,pass,",
                      (compare.results_dir("e", "quick", self.root) / "comparison.csv").read_text())

    def test_nan_and_garbage_in_metrics_fail(self):
        for text in ("nan", "", "-nan", "abc"):
            self.write("length,both,thesis,1.5,1,2,m,table 1,\n", f"length,{text},m\n")
            self.assertFalse(compare.passed(self.compare()), text)

    def test_expected_files_that_are_refused(self):
        for line, words in (("length,both,guess,1,0,2,m,s,", "unknown kind"), ("length,huge,own,1,0,2,m,s,", "unknown size"),
                            ("length,both,own,1,2,0,m,s,", "above upper"), ("length,both,own,nan,0,2,m,s,", "not finite"),
                            ("length,both,own,1,0,inf,m,s,", "not finite"), ("length,both,own,one,0,2,m,s,", "not a number"),
                            ("length,both,own,1,0,2,,s,", "unit"), ("length,both,thesis,1,0,2,m,,", "source"),
                            ("length,none,thesis,1,,,m,s,", "says why"), ("time,both,own,1,0,2,s,s,", "never gated"),
                            ("length,both,own,1,0,2,m,s", "columns"), ("length,both,own,1,0,2,m,s,n,x", "columns")):
            self.write(line + "\n", "length,1,m\n")
            with self.assertRaisesRegex(compare.ExpectedError, words, msg=line):
                self.compare()

    def test_duplicated_rows_are_refused(self):
        self.write("length,both,own,1,0,2,m,s,\nlength,quick,own,1,0,3,m,s,\n", "length,1,m\n")
        with self.assertRaisesRegex(compare.ExpectedError, "twice"):
            self.compare()

    def test_two_sources_of_one_metric_are_both_compared(self):
        self.write("length,both,own,1,0,2,m,,\nlength,both,thesis,1,2,3,m,table 1,\n", "length,1,m\n")
        self.assertEqual([c.verdict for c in self.compare()], ["pass", "fail"])

    def test_results_of_another_size_or_an_unfinished_run_are_refused(self):
        for outcome, size, words in (("interrupted", "quick", "not complete"), ("completed", "paper", "not quick")):
            self.write("length,both,own,1,0,2,m,s,\n", "length,1,m\n", outcome, size)
            with self.assertRaisesRegex(compare.ExpectedError, words):
                self.compare()

    def test_missing_results_are_refused(self):
        self.write("length,both,own,1,0,2,m,s,\n")
        (compare.results_dir("e", "quick", self.root) / "metrics.csv").unlink()
        with self.assertRaisesRegex(compare.ExpectedError, "run the experiment"):
            self.compare()

    def test_accept_moves_own_rows_alone(self):
        self.write("length,quick,thesis,1,0,2,m,table 1,\nlength,quick,own,1,0.5,2,m,,\nlength,paper,own,9,8,10,m,,\n",
                   "length,3,m\n")
        with contextlib.redirect_stdout(io.StringIO()) as output:
            compare.accept("e", "quick", self.root)
        thesis, own, paper = compare.read_expected(compare.expected_file("e", self.root))
        self.assertEqual((thesis.value, thesis.lower, thesis.upper), (1, 0, 2))
        self.assertEqual((own.value, own.lower, own.upper), (3, 2.5, 4))
        self.assertEqual((paper.value, paper.lower, paper.upper), (9, 8, 10))
        self.assertIn("1 -> 3 m", output.getvalue())

    def test_accept_refuses_nan_and_other_units(self):
        for metrics in ("length,nan,m\n", "length,3,cm\n", ""):
            self.write("length,quick,own,1,0,2,m,,\n", metrics)
            with self.assertRaises(compare.ExpectedError), contextlib.redirect_stdout(io.StringIO()):
                compare.accept("e", "quick", self.root)


if __name__ == "__main__":
    unittest.main()
