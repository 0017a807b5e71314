"""softform panels: files that a cutter and a printer can use, read back here, and what is refused."""

import csv
import json
import math
import re
import unittest
import xml.etree.ElementTree as ET
import zlib

import shapes
from program import ProgramTest

SVG = "{http://www.w3.org/2000/svg}"
FILES = {"panels.svg", "panels.dxf", "panels.pdf", "seams.csv", "target.vtp", "flat.vtp", "metrics.csv"}
RADIUS = 50.0
LAYERS = ("sheet", "cut", "seam", "notches", "labels", "grain")


def meridian(degrees):
    a = math.radians(degrees)
    return {"name": f"meridian {degrees}", "points": [[0, 0, RADIUS], [RADIUS * math.cos(a), RADIUS * math.sin(a), 0],
                                                      [0, 0, -RADIUS]]}


def parallel(name, z):
    r = math.sqrt(RADIUS**2 - z**2)
    return {"name": name, "closed": True,
            "points": [[r * math.cos(k * math.pi / 3), r * math.sin(k * math.pi / 3), z] for k in range(6)]}


LUNES = {"seams": [meridian(0), meridian(120), meridian(240)]}


class PanelsTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("ball.off", shapes.off_text(shapes.sphere(3, RADIUS)))

    def panels(self, *options, mesh="ball.off", seams=None):
        self.write("seams.json", json.dumps(LUNES if seams is None else seams))
        return self.run_softform("panels", mesh, "--seams", "seams.json", "--out", "out", *options)

    def read(self, name):
        return (self.folder / "out" / name).read_text(encoding="utf-8")


class Results(PanelsTest):
    def setUp(self):
        super().setUp()
        self.process = self.panels()
        self.assertEqual(self.process.returncode, 0, self.process.text)

    def test_files_and_metrics(self):
        self.assertEqual({file.name for file in (self.folder / "out").iterdir()}, FILES)
        metrics = {name: value for name, (value, _) in self.metrics().items()}
        self.assertEqual((metrics["panels"], metrics["inner_panels"], metrics["seams"]), (3, 0, 3))
        self.assertEqual(metrics["triangles"], 1280)
        self.assertAlmostEqual(metrics["area"] / (4 * math.pi * 0.05**2), 1, delta=0.01)
        self.assertLess(metrics["seam_mismatch_max"], 0.005)
        self.assertGreater(metrics["smallest_quality"], 0.3)
        self.assertIn("millimetres", self.process.stderr)

    def test_seam_table(self):
        with open(self.folder / "out" / "seams.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["name"] for row in rows], ["meridian 0", "meridian 120", "meridian 240"])
        for row in rows:
            left, right = float(row["left_length [mm]"]), float(row["right_length [mm]"])
            self.assertAlmostEqual(left, math.pi * RADIUS, delta=0.02 * math.pi * RADIUS)
            self.assertAlmostEqual(float(row["mismatch [mm]"]), abs(left - right), delta=2e-3)
            self.assertNotEqual(row["left"], row["right"])

    def test_svg_has_its_layers_in_millimetres(self):
        root = ET.fromstring(self.read("panels.svg"))
        self.assertEqual(root.get("width"), "600.000mm")
        self.assertEqual(root.get("viewBox").split()[2], "600.000")
        groups = {group.get("id"): group for group in root.findall(SVG + "g")}
        self.assertEqual(tuple(groups), LAYERS)
        self.assertEqual(len({(group.get("stroke"), group.get("fill")) for group in groups.values()}), 6)
        for layer, count in (("cut", 3), ("seam", 3), ("sheet", 1)):
            paths = [path.get("d") for path in groups[layer].findall(SVG + "path")]
            self.assertEqual(len(paths), count)
            for d in paths:
                self.assertTrue(d.endswith("Z"))
                points = [tuple(map(float, p)) for p in re.findall(r"(-?[\d.]+),(-?[\d.]+)", d)]
                self.assertGreaterEqual(min(min(p) for p in points), 0)
                self.assertLessEqual(max(p[0] for p in points), 600)
                if layer == "seam":
                    around = sum(math.dist(a, b) for a, b in zip(points, points[1:] + points[:1]))
                    self.assertAlmostEqual(around, 2 * math.pi * RADIUS, delta=0.03 * math.pi * RADIUS)
        numbers = [text.text for text in groups["labels"].findall(SVG + "text")]
        for number in ("1", "2", "3"):
            self.assertEqual(numbers.count(number), 2)
        self.assertGreater(len(groups["notches"].findall(SVG + "path")), 3 * 2 * 2)
        self.assertEqual(len(groups["grain"].findall(SVG + "path")), 3 * 3)

    def test_dxf_has_its_layers_and_unit(self):
        lines = [line.strip() for line in self.read("panels.dxf").splitlines()]
        codes = list(zip(lines[0::2], lines[1::2]))
        self.assertEqual(codes[-1], ("0", "EOF"))
        unit = codes.index(("9", "$INSUNITS"))
        self.assertEqual(codes[unit + 1], ("70", "4"))
        entities = codes[codes.index(("2", "ENTITIES")):]
        for layer in LAYERS:
            self.assertIn(("8", layer), entities)
        self.assertEqual(sum(entities[i][1] == "LWPOLYLINE" and ("8", "cut") in entities[i:i + 8]
                             for i in range(len(entities) - 8)), 3)

    def test_pdf_is_a4_at_true_scale(self):
        data = (self.folder / "out" / "panels.pdf").read_bytes()
        self.assertEqual(data[:5], b"%PDF-")
        boxes = re.findall(rb"/MediaBox \[ ?([\d. ]+) ?\]", data)
        pages = []
        for stream in re.findall(rb"stream\r?\n(.*?)endstream", data, re.DOTALL):
            try:
                text = zlib.decompress(stream).decode("latin-1")
            except zlib.error:
                continue
            if " cm" in text and " l" in text:
                pages.append(text)
        self.assertGreater(len(pages), 1)
        self.assertEqual(len(boxes), len(pages))
        for box in boxes:
            self.assertEqual([round(float(x) * 25.4 / 72, 1) for x in box.split()], [0, 0, 210, 297])
        for page in pages:
            self.assertAlmostEqual(min(self.horizontals(page), key=lambda length: abs(length - 100)), 100, places=2)

    def horizontals(self, page):
        """Lengths on paper of the horizontal lines of a page [mm]; one of them is the rule."""
        scales, numbers, lengths, start = [1.0], [], [], None
        for token in page.split():
            if re.fullmatch(r"-?[\d.]+", token):
                numbers.append(float(token))
                continue
            if token == "q":
                scales.append(scales[-1])
            elif token == "Q":
                scales.pop()
            elif token == "cm":
                scales[-1] *= math.hypot(numbers[-6], numbers[-5])
            elif token in "ml":
                x, y = numbers[-2:]
                if token == "l" and y == start[1]:
                    lengths.append(abs(x - start[0]) * scales[-1] * 25.4 / 72)
                start = (x, y)
            numbers = []
        return lengths

    def test_results_repeat(self):
        first = {name: (self.folder / "out" / name).read_bytes() for name in FILES - {"metrics.csv"}}
        self.panels()
        for name, text in first.items():
            self.assertEqual((self.folder / "out" / name).read_bytes(), text, name)


class Options(PanelsTest):
    def test_boundary_flattening_size_and_vertices(self):
        process = self.panels("--flattening", "boundary", "--size", "20cm", "--vertices", "400", "--allowance", "1cm",
                              "--sheet", "50cm x 60cm", "--grain")
        self.assertEqual(process.returncode, 0, process.text)
        metrics = {name: value for name, (value, _) in self.metrics().items()}
        self.assertEqual(metrics["triangles"], 796)
        self.assertAlmostEqual(metrics["area"] / (4 * math.pi * 0.1**2), 1, delta=0.03)
        self.assertIn('width="500.000mm"', self.read("panels.svg"))

    def test_a_wall(self):
        seams = {"seams": [meridian(0), meridian(180)],
                 "walls": [{"name": "brace", "between": ["meridian 0", "meridian 180"]}]}
        process = self.panels(seams=seams)
        self.assertEqual(process.returncode, 0, process.text)
        self.assertEqual(self.metrics()["inner_panels"][0], 1)
        self.assertEqual(self.read("seams.csv").count("brace"), 2)

    def test_help_teaches(self):
        text = self.run_softform("panels", "--help").stdout
        for word in ("softform panels", "--allowance", "seams.csv", "closed"):
            self.assertIn(word, text)


class BadInput(PanelsTest):
    def refuses(self, words, *options, **arguments):
        process = self.panels(*options, **arguments)
        self.assertEqual(process.returncode, 2, process.text)
        for word in words:
            self.assertIn(word, process.text)
        self.assertFalse((self.folder / "out").exists(), "something was written")

    def test_options(self):
        for options, words in (
                (("--allowance", "0mm"), ["--allowance", "above 0"]),
                (("--allowance", "-8mm"), ["--allowance", "above 0"]),
                (("--allowance", "8"), ["--allowance", "no unit"]),
                (("--sheet", "100x80mm"), ["100 x 80 mm", "panel '", "larger sheet"]),
                (("--sheet", "600mm"), ["--sheet", "600x400mm"]),
                (("--sheet", "600x400"), ["--sheet", "no unit"]),
                (("--sheet", "0x400mm"), ["--sheet", "above 0"]),
                (("--flattening", "iron"), ["'iron'", "symmetric-dirichlet"]),
                (("--vertices", "3"), ["--vertices"])):
            with self.subTest(options):
                self.refuses(words, *options)

    def test_seams(self):
        crossing = {"name": "cross", "points": [[35, -20, 29], [35, 20, 29]]}
        for name, seams, words in (
                ("crossing", {"seams": [meridian(0), crossing]}, ["'cross'", "'meridian 0'", "without meeting"]),
                ("off the target", {"seams": [{"name": "far", "points": [[0, 0, 50], [70, 0, 0]]}]},
                 ["'far'", "point 2", "off the target"]),
                ("a hole", {"seams": [parallel("north", 20), parallel("south", -20)]},
                 ["hole", "'north'", "'south'", "a seam from"]),
                ("unknown key", {"seams": [meridian(0)], "colour": 1}, ["seams.json", "'colour'"])):
            with self.subTest(name):
                self.refuses(words, seams=seams)

    def test_an_open_target(self):
        self.write("open.off", shapes.off_text(shapes.open_mesh()))
        self.refuses(["open.off", "edge", "fill the hole"], mesh="open.off")

    def test_missing_seam_file(self):
        process = self.run_softform("panels", "ball.off", "--seams", "none.json", "--out", "out")
        self.assertEqual(process.returncode, 2, process.text)
        self.assertIn("none.json", process.text)


if __name__ == "__main__":
    unittest.main()
