"""softform inflatable: panels that inflate into the target, what is left after Ctrl-C, and what is refused."""

import csv
import json
import math
import re
import unittest
import xml.etree.ElementTree as ET

import shapes
from program import ProgramTest

RADIUS = 100.0
FILES = {"inflated.vtp", "panels.svg", "panels.dxf", "panels.pdf", "flat.vtp", "seams.csv", "trace.csv", "metrics.csv"}
UNITS = {"panels": "1", "inner_panels": "1", "triangles": "1", "mean_distance": "1", "max_distance": "1",
         "unoptimised_mean_distance": "1", "seam_mismatch_mean": "1", "seam_mismatch_max": "1", "smallest_quality": "1",
         "max_residual": "1", "iterations": "1", "remeshings": "1", "preview_time": "s", "time": "s"}
SHEETS = ("--sheet", "900x600mm")


def meridian(degrees):
    a = math.radians(degrees)
    return {"name": f"meridian {degrees}", "points": [[0, 0, RADIUS], [RADIUS * math.cos(a), RADIUS * math.sin(a), 0],
                                                      [0, 0, -RADIUS]]}


def parallel(name, z):
    r = math.sqrt(RADIUS**2 - z**2)
    return {"name": name, "closed": True,
            "points": [[r * math.cos(k * math.pi / 3), r * math.sin(k * math.pi / 3), z] for k in range(6)]}


LUNES = {"seams": [meridian(0), meridian(120), meridian(240)]}


class InflatableTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("ball.off", shapes.off_text(shapes.sphere(2, RADIUS)))
        self.write("seams.json", json.dumps(LUNES))

    def arguments(self, *options, mesh="ball.off"):
        return ("inflatable", mesh, "--seams", "seams.json", "--material", "mylar", "--out", "out", *SHEETS, *options)

    def inflatable(self, *options, **arguments):
        return self.run_softform(*self.arguments(*options, **arguments))

    def rows(self, name):
        with open(self.folder / "out" / name, encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def complete_results(self):
        """The metrics of results that are all there."""
        self.assertEqual({file.name for file in (self.folder / "out").iterdir()}, FILES)
        for file in (self.folder / "out").iterdir():
            self.assertGreater(file.stat().st_size, 200, file)
        metrics = self.metrics()
        self.assertEqual({name: unit for name, (value, unit) in metrics.items()}, UNITS)
        values = {name: value for name, (value, unit) in metrics.items()}
        self.assertTrue(all(map(math.isfinite, values.values())), values)
        return values


class Results(InflatableTest):
    def test_a_sphere_of_three_panels(self):
        process = self.inflatable("--iterations", "15")  # enough to see that the design gets better
        self.assertIn(process.returncode, (0, 3), process.text)
        values = self.complete_results()
        self.assertEqual((values["panels"], values["inner_panels"]), (3, 0))
        self.assertLess(values["mean_distance"], 0.5 * values["unoptimised_mean_distance"])
        self.assertLessEqual(values["mean_distance"], values["max_distance"])
        self.assertLess(values["seam_mismatch_max"], 0.02)
        self.assertLessEqual(values["seam_mismatch_mean"], values["seam_mismatch_max"])
        self.assertGreater(values["smallest_quality"], 0.2)
        self.assertLess(values["max_residual"], 1e-5)
        self.assertLessEqual(values["preview_time"], values["time"])
        trace = self.rows("trace.csv")
        self.assertEqual(float(trace[-1]["iteration"]), values["iterations"])
        self.assertLess(float(trace[-1]["objective"]), float(trace[0]["objective"]))
        self.assertEqual([row["name"] for row in self.rows("seams.csv")], [s["name"] for s in LUNES["seams"]])
        self.assertEqual(len(ET.parse(self.folder / "out" / "panels.svg").getroot()), 6)
        for field in (b"panel [1]", b"compression [1]", b"distance [m]"):
            self.assertIn(field, (self.folder / "out" / "inflated.vtp").read_bytes())

    def test_a_limit_of_iterations_leaves_what_there_is(self):
        process = self.inflatable("--iterations", "2")
        self.assertEqual(process.returncode, 3, process.text)
        values = self.complete_results()
        self.assertLessEqual(values["iterations"], 2)
        self.assertLess(values["max_residual"], 1e-5)

    def test_a_fine_target_is_designed_on_coarser_panels(self):
        process = self.inflatable("--iterations", "2", "--triangles", "150")
        self.assertEqual(process.returncode, 3, process.text)
        self.assertAlmostEqual(self.complete_results()["triangles"], 150, delta=50)

    def test_a_wall(self):
        self.write("seams.json", json.dumps({
            "seams": [meridian(0), meridian(180)],
            "walls": [{"name": "brace", "between": ["meridian 0", "meridian 180"]}]}))
        process = self.inflatable("--iterations", "2")
        self.assertEqual(process.returncode, 3, process.text)
        values = self.complete_results()
        self.assertEqual((values["panels"], values["inner_panels"]), (3, 1))
        self.assertEqual(len(self.rows("seams.csv")), 4)

    def test_an_interruption_leaves_panels_that_can_be_cut(self):
        code, said = self.run_until("iteration 1", *self.arguments())
        self.assertEqual(code, 130, said)
        self.assertIn("interrupted", said)
        values = self.complete_results()
        self.assertLess(values["max_residual"], 1e-5)
        self.assertGreaterEqual(len(re.findall(r"<path", (self.folder / "out" / "panels.svg").read_text())), 6)

    def test_help_teaches(self):
        text = self.run_softform("inflatable", "--help").stdout
        for word in ("softform inflatable", "--pressure", "inflated.vtp", "closed", "Ctrl-C"):
            self.assertIn(word, text)


class BadInput(InflatableTest):
    def refuses(self, words, *options, **arguments):
        process = self.inflatable(*options, **arguments)
        self.assertEqual(process.returncode, 2, process.text)
        for word in words:
            self.assertIn(word, process.text)
        self.assertFalse((self.folder / "out").exists(), "something was written")
        self.assertNotIn("iteration", process.text)

    def test_options(self):
        for options, words in (
                (("--allowance", "0mm"), ["--allowance", "above 0"]),
                (("--pressure", "0Pa"), ["--pressure", "above 0"]),
                (("--pressure", "1"), ["--pressure", "no unit"]),
                (("--pressure", "1MPa"), ["--pressure", "lower pressure", "%"]),
                (("--thickness", "-1mm"), ["--thickness", "above 0"]),
                (("--sheet", "100x80mm"), ["100 x 80 mm", "panel '", "larger sheet"]),
                (("--material", "paper"), ["paper", "mylar"]),
                (("--triangles", "6"), ["--triangles", "6 for 3 panels", "60 or more"]),
                (("--iterations", "0"), ["--iterations"])):
            with self.subTest(options):
                kept = [*self.arguments()]
                for option in options[::2]:
                    if option in kept:
                        del kept[kept.index(option):kept.index(option) + 2]
                process = self.run_softform(*kept, *options)
                self.assertEqual(process.returncode, 2, process.text)
                for word in words:
                    self.assertIn(word, process.text)
                self.assertFalse((self.folder / "out").exists())

    def test_seams(self):
        for name, seams, words in (
                ("crossing", [meridian(0), {"name": "cross", "points": [[70, -40, 58], [70, 40, 58]]}],
                 ["'cross'", "'meridian 0'", "without meeting"]),
                ("off the target", [{"name": "far", "points": [[0, 0, 100], [140, 0, 0]]}],
                 ["'far'", "point 2", "off the target"]),
                ("a hole", [parallel("north", 40), parallel("south", -40)], ["hole", "'north'", "'south'"])):
            with self.subTest(name):
                self.write("seams.json", json.dumps({"seams": seams}))
                self.refuses(words)

    def test_an_open_target(self):
        self.write("open.off", shapes.off_text(shapes.open_mesh()))
        self.refuses(["open.off", "edge", "fill the hole"], mesh="open.off")


if __name__ == "__main__":
    unittest.main()
