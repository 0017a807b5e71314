"""What comes out: complete results in SI units, exit codes, what is left after Ctrl-C and after a failure."""

import math
import unittest

import shapes
from program import ProgramTest

INFLATE_UNITS = {"pressure": "Pa", "volume": "m^3", "volume_ratio": "1", "mean_stretch": "1", "max_residual": "1",
                 "negative_eigenvalues": "1", "newton_iterations": "1", "time": "s"}
BALLOON_UNITS = {"mean_distance": "m", "max_distance": "m", "downscaled_mean_distance": "m",
                 "downscaled_max_distance": "m", "pressure": "Pa", "mean_stretch": "1", "max_residual": "1",
                 "negative_eigenvalues": "1", "self_intersections": "1", "hausdorff_distance": "m", "iterations": "1",
                 "time": "s"}
BALLOON_FILES = {"rest.stl", "rest.vtp", "inflated.vtp", "downscaled.vtp", "trace.csv", "metrics.csv"}
SILICONE = ("--material", "silicone", "--thickness", "0.3mm", "--out", "out")


def silicone_pressure(stretch, radius, thickness=3e-4):
    """Of a spherical balloon: 4 (h/R) (1/L - 1/L^7) (W1 + L^2 W2), Hart-Smith fitted to silicone [Pa]."""
    G, k1, k2 = 0.16163e6, 0.0219, 0.2453
    W1 = G * math.exp(k1 * (2 * stretch**2 + stretch**-4 - 3) ** 2)
    W2 = G * k2 / (stretch**4 + 2 * stretch**-2)
    return 4 * thickness / radius * (1 / stretch - stretch**-7) * (W1 + stretch**2 * W2)


class Results(ProgramTest):
    def succeeds(self, *arguments):
        process = self.run_softform(*arguments)
        self.assertEqual(process.returncode, 0, process.text)
        return process

    def complete_metrics(self, units):
        metrics = self.metrics()
        self.assertEqual({name: unit for name, (value, unit) in metrics.items()}, units)
        values = {name: value for name, (value, unit) in metrics.items()}
        for name, value in values.items():
            self.assertTrue(math.isfinite(value), f"{name} = {value}")
        return values

    def files(self):
        return {file.name for file in (self.folder / "out").iterdir()}


class Check(Results):
    def test_every_format(self):
        for name, text in (("a.off", shapes.off_text), ("a.obj", shapes.obj_text), ("a.ply", shapes.ply_text),
                           ("a.stl", shapes.stl_text)):
            self.write(name, text(shapes.sphere()))
            with self.subTest(name):
                self.assertIn("162, 480, 320", self.succeeds("check", name).stdout)


class Help(Results):
    def test_teaches(self):
        for command in ("check", "inflate", "balloon", "model"):
            with self.subTest(command):
                self.assertIn(f"softform {command} ", self.succeeds(command, "--help").stdout)
                self.assertIn(command, self.succeeds("--help").stdout)


class Model(Results):
    def test_a_mesh_in_millimetres_with_the_vertices_asked_for(self):
        self.write("egg.json", '{"unit": "cm", "parts": [{"shape": "tube", "balls": [[0, 0, 0, 2], [0, 0, 3, 1]]}]}')
        self.succeeds("model", "egg.json", "--vertices", "300", "--out", "egg.obj")
        said = self.succeeds("check", "egg.obj").stdout
        self.assertIn("300, 894, 596", said)
        size = float(said.split("size")[1].split()[0])
        self.assertAlmostEqual(size, 60, delta=0.5)


class Inflate(Results):
    def setUp(self):
        super().setUp()
        self.write("sphere.off", shapes.off_text(shapes.sphere(3, radius=20)))

    def test_volume_gives_the_analytic_pressure(self):
        process = self.succeeds("inflate", "sphere.off", *SILICONE, "--volume-ratio", "3")
        self.assertIn("millimetres", process.stderr)
        values = self.complete_metrics(INFLATE_UNITS)
        self.assertAlmostEqual(values["volume_ratio"], 3, places=8)
        self.assertAlmostEqual(values["mean_stretch"], 3 ** (1 / 3), places=3)
        self.assertAlmostEqual(values["pressure"] / silicone_pressure(3 ** (1 / 3), 0.02), 1, delta=0.01)
        self.assertLess(values["max_residual"], 1e-6)
        self.assertEqual(values["negative_eigenvalues"], 0)
        self.assertEqual(self.files(), {"inflated.vtp", "metrics.csv"})

    def test_pressure_and_size(self):
        process = self.succeeds("inflate", "sphere.off", *SILICONE, "--pressure", "2 kPa", "--size", "8cm")
        self.assertNotIn("millimetres", process.stderr)
        values = self.complete_metrics(INFLATE_UNITS)
        self.assertEqual(values["pressure"], 2000)
        self.assertAlmostEqual(silicone_pressure(values["mean_stretch"], 0.04) / 2000, 1, delta=0.02)
        self.assertLess(values["max_residual"], 1e-6)
        self.assertEqual(values["negative_eigenvalues"], 0)

    def test_results_replace_older_ones_and_repeat(self):
        self.succeeds("inflate", "sphere.off", *SILICONE, "--volume-ratio", "3")
        self.succeeds("inflate", "sphere.off", *SILICONE, "--volume-ratio", "2")
        first = self.metrics()
        self.succeeds("inflate", "sphere.off", *SILICONE, "--volume-ratio", "2")
        second = self.metrics()
        self.assertAlmostEqual(second["volume_ratio"][0], 2, places=8)
        for name in set(INFLATE_UNITS) - {"time", "max_residual"}:
            self.assertAlmostEqual(first[name][0], second[name][0], delta=1e-9 * abs(first[name][0]))

    def test_unreachable_pressure_leaves_the_last_state(self):
        process = self.run_softform("inflate", "sphere.off", "--material", "neo_hookean", "--thickness", "0.3mm", "--out",
                                    "out", "--pressure", "20kPa")  # the peak is at 6.5 kPa
        self.assertEqual(process.returncode, 3, process.text)
        self.assertIn("no equilibrium", process.stderr)
        self.assertEqual(self.files(), {"inflated.vtp", "metrics.csv"})
        self.assertLess(self.metrics()["pressure"][0], 20e3)

    def test_interrupted(self):
        code, said = self.run_until("volume ratio", "inflate", "sphere.off", "--material", "neo_hookean", "--thickness",
                                    "0.3mm", "--out", "out", "--pressure", "20kPa")
        self.assertEqual(code, 130, said)
        self.assertIn("interrupted", said)
        self.assertEqual(self.files(), {"inflated.vtp", "metrics.csv"})


class Balloon(Results):
    def test_ellipsoid(self):
        self.write("target.obj", shapes.obj_text(shapes.ellipsoid(2)))
        process = self.succeeds("balloon", "target.obj", *SILICONE, "--size", "100mm", "--scale", "0.6")
        self.assertIn("iteration", process.stderr)
        values = self.complete_metrics(BALLOON_UNITS)
        self.assertEqual(self.files(), BALLOON_FILES)
        self.assertLess(values["mean_distance"], 0.5 * values["downscaled_mean_distance"])
        self.assertLess(values["max_distance"], 0.5 * values["downscaled_max_distance"])
        self.assertGreaterEqual(values["hausdorff_distance"], values["max_distance"])
        self.assertLess(values["hausdorff_distance"], 0.05)
        self.assertLess(values["max_residual"], 1e-6)
        self.assertEqual((values["negative_eigenvalues"], values["self_intersections"]), (0, 0))
        trace = (self.folder / "out" / "trace.csv").read_text().splitlines()
        self.assertEqual(len(trace), 2 + values["iterations"])
        self.assertIn("It can be used.", self.succeeds("check", "out/rest.stl").stdout)

        # The fabricated balloon, read back from its STL in millimetres, inflates to the same state.
        self.succeeds("inflate", "out/rest.stl", "--material", "silicone", "--thickness", "0.3mm", "--out", "again",
                      "--pressure", f"{values['pressure']} Pa")
        self.assertAlmostEqual(self.metrics("again")["mean_stretch"][0], values["mean_stretch"], places=4)

    def test_unreachable_inflation_leaves_the_last_state(self):
        # At a hundredth of the size the rubber would have to stretch beyond what its energy can be computed for.
        self.write("target.off", shapes.off_text(shapes.ellipsoid(1)))
        process = self.run_softform("balloon", "target.off", *SILICONE, "--scale", "0.01")
        self.assertEqual(process.returncode, 3, process.text)
        self.assertIn("does not inflate", process.stderr)
        self.assertEqual(self.files(), BALLOON_FILES)
        self.assertGreater(self.metrics()["pressure"][0], 0)

    def test_interrupted_keeps_the_best_so_far(self):
        self.write("target.off", shapes.off_text(shapes.ellipsoid(3)))
        code, said = self.run_until("iteration 2", "balloon", "target.off", *SILICONE)
        self.assertEqual(code, 130, said)
        self.assertIn("interrupted: the best rest shape so far is in out", said)
        self.assertEqual(self.files(), BALLOON_FILES)
        values = self.complete_metrics(BALLOON_UNITS)
        self.assertLess(values["mean_distance"], values["downscaled_mean_distance"])
        self.assertLess(values["max_residual"], 1e-6)
        self.assertEqual((values["negative_eigenvalues"], values["self_intersections"]), (0, 0))


if __name__ == "__main__":
    unittest.main()
