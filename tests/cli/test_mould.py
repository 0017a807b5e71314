"""softform mould, and the nozzle of softform balloon: files, units, and what is refused."""

import json
import re
import unittest
import zipfile

import shapes
from program import ProgramTest

NOZZLE = ("--nozzle", "bottom", "--nozzle-diameter", "12mm")
# What is wrong: (changed options, words of the message)
BAD = {
    "no direction": ({"--nozzle": "down"}, ["--nozzle", "'down'", "-y"]),
    "no such vertex": ({"--nozzle": "9999"}, ["9999", "0 to"]),
    "nozzle too fine": ({"--nozzle-diameter": "0.1mm"}, ["0.1 mm", "finer than the mesh", "at least"]),
    "nozzle without a unit": ({"--nozzle-diameter": "12"}, ["--nozzle-diameter", "no unit"]),
    "wall without a unit": ({"--wall": "2"}, ["--wall", "no unit", "solid"]),
    "wall closes the tube": ({"--wall": "6mm"}, ["6 mm", "thinner wall"]),
    "plate is a word": ({"--plate": "large"}, ["--plate", "40x40x4mm"]),
    "plate too small": ({"--plate": "10x40x4mm"}, ["10 mm", "or more"]),
    "pull nowhere": ({"--pull": "0,0,0"}, ["--pull", "no length"]),
    "open mesh": ({"mesh": "open.off"}, ["open", "fill the hole"]),
}


class Mould(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("rest.off", shapes.off_text(shapes.sphere(3, radius=30)))
        self.write("open.off", shapes.off_text(shapes.open_mesh()))

    def test_solid_and_hollow(self):
        volumes = []
        genus = 4  # the screw holes; a hollow with one mouth adds none
        for wall in ("solid", "3mm"):
            with self.subTest(wall):
                process = self.run_softform("mould", "rest.off", *NOZZLE, "--wall", wall, "--plate", "50x40x3mm", "--out", "out")
                self.assertEqual(process.returncode, 0, process.text)
                self.assertEqual({file.name for file in (self.folder / "out").iterdir()},
                                 {"mould.stl", "mould.3mf", "mould.vtp", "report.json", "metrics.csv"})
                metrics = self.metrics()
                self.assertEqual(metrics["genus"], (genus, "1"))
                volumes.append(metrics["volume"][0])
                report = json.loads((self.folder / "out" / "report.json").read_text())
                self.assertAlmostEqual(report["volume_cm3"], 1e6 * metrics["volume"][0], places=9)
                self.assertTrue(report["printable"])
                check = self.run_softform("check", "out/mould.stl")
                self.assertEqual(check.returncode, 0, check.text)
                self.assertRegex(check.stdout, rf"genus\s+{genus}")
        self.assertGreater(volumes[0], 1.1e-4)  # the ball alone
        self.assertLess(volumes[1], 0.6 * volumes[0])

    def test_3mf_is_in_millimetres(self):
        process = self.run_softform("mould", "rest.off", *NOZZLE, "--pull", "z", "--out", "out")
        self.assertEqual(process.returncode, 0, process.text)
        with zipfile.ZipFile(self.folder / "out" / "mould.3mf") as archive:
            model = archive.read("3D/3dmodel.model").decode()
        self.assertIn('unit="millimeter"', model)
        heights = [float(z) for z in re.findall(r'<vertex [^>]*z="([^"]*)"', model)]
        self.assertAlmostEqual(max(heights), 30, delta=0.1)
        self.assertAlmostEqual(min(heights), -30 - 20 - 4, delta=0.1)

    def test_refuses(self):
        for name, (changes, words) in BAD.items():
            options = {"mesh": "rest.off", "--nozzle": "bottom", "--out": "out"} | changes
            mesh = options.pop("mesh")
            arguments = [word for pair in options.items() for word in pair]
            with self.subTest(name):
                process = self.run_softform("mould", mesh, *arguments)
                self.assertEqual(process.returncode, 2, process.text)
                for word in words:
                    self.assertIn(word, process.text)
                self.assertFalse((self.folder / "out").exists())


class Nozzle(ProgramTest):
    def test_balloon_with_a_nozzle_leads_to_a_mould(self):
        self.write("target.off", shapes.off_text(shapes.sphere(3, radius=50)))
        process = self.run_softform("balloon", "target.off", "--material", "silicone", "--thickness", "0.3mm", "--nozzle", "-z",
                                    "--nozzle-diameter", "30mm", "--out", "out")
        self.assertEqual(process.returncode, 0, process.text)
        vertex = re.search(r"--nozzle (\d+) --nozzle-diameter 30mm", process.text)
        self.assertIsNotNone(vertex, process.text)
        metrics = self.metrics()
        self.assertEqual(metrics["negative_eigenvalues"][0], 0)
        self.assertLess(metrics["max_residual"][0], 1e-6)
        process = self.run_softform("mould", "out/rest.obj", "--nozzle", vertex[1], "--nozzle-diameter", "30mm", "--plate",
                                    "60x60x4mm", "--out", "mould")
        self.assertEqual(process.returncode, 0, process.text)

    def test_diameter_alone_is_refused(self):
        self.write("target.off", shapes.off_text(shapes.sphere(2, radius=50)))
        process = self.run_softform("balloon", "target.off", "--material", "silicone", "--thickness", "0.3mm",
                                    "--nozzle-diameter", "30mm", "--out", "out")
        self.assertEqual(process.returncode, 2, process.text)
        self.assertIn("--nozzle bottom", process.text)


if __name__ == "__main__":
    unittest.main()
