"""softform fit: complete results that inflate and balloon take, refusals that name file, line and cure, warnings."""

import csv
import json
import math
import unittest
from pathlib import Path

import shapes
from program import ProgramTest

RUBBER = Path(__file__).resolve().parents[2] / "datasets" / "rubber"
UNIAXIAL, SHEAR, SHEET = (RUBBER / f"treloar_1944_{name}.csv" for name in ("uniaxial", "pure_shear", "sheet_inflation"))
FILES = {"parameters.csv", "residuals.csv", "prediction.csv", "trust.json", "fit.png", "material.json"}
SOLVERS = ("ceres", "nlopt", "gauss_newton")
MODELS = ("st_venant_kirchhoff", "neo_hookean", "mooney_rivlin", "ogden", "hart_smith")

# What is wrong: (options, words of the message). The files are written by the test.
GOOD = "stretch,nominal_stress_mpa\n1,0\n1.5,0.3\n2,0.5\n2.5,0.6\n3,0.8\n"
BAD_FILES = {
    "missing file": (None, ["rubber.csv", "check the name"]),
    "empty file": ("", ["rubber.csv", "empty", "stretch,nominal_stress_mpa"]),
    "too few points": ("stretch,nominal_stress_mpa\n1,0\n2,0.5\n", ["rubber.csv", "2 points", "at least 3"]),
    "stretch of zero": (GOOD.replace("1,0\n", "0,0\n", 1), ["rubber.csv", "line 2", "1 + strain"]),
    "decreasing": (GOOD.replace("1.5,0.3", "2.5,0.3"), ["rubber.csv", "line 4", "decreases", "sorted"]),
    "NaN": (GOOD.replace("0.5", "nan"), ["rubber.csv", "line 4", "finite"]),
    "wrong column": (GOOD.replace("stretch", "strain"), ["rubber.csv", "line 1", "'stretch'"]),
    "unknown unit": (GOOD.replace("_mpa", "_psi"), ["rubber.csv", "line 1", "_kpa"]),
    "two units": ("stretch,nominal_stress_mpa,nominal_stress_kpa\n1,0,0\n2,1,1\n3,2,2\n", ["line 1", "keep one"]),
    "a unit off by a million": (GOOD.replace("0.8", "800000"), ["rubber.csv", "line 6", "unit"]),
    "a column twice": ("stretch,stretch,nominal_stress_mpa\n1,1,0\n2,2,0.5\n3,3,1\n", ["line 1", "keep one"]),
    "stress at rest": (GOOD.replace("1,0\n", "1,0.25\n", 1), ["rubber.csv", "line 2", "at rest"]),
    "wrong sign": (GOOD.replace("0.5", "-0.5"), ["rubber.csv", "line 4", "sign"]),
    "another mode": ("# mode: pure_shear\n" + GOOD, ["rubber.csv", "pure_shear", "uniaxial"]),
}
BAD_OPTIONS = {
    "no data": ({"--uniaxial": None}, ["nothing to fit", "--uniaxial"]),
    "no model": ({"--model": None}, ["--model"]),
    "no output": ({"--out": None}, ["--out"]),
    "unknown model": ({"--model": "jelly"}, ["jelly", "hart_smith"]),
    "unknown solver": ({"--solver": "magic"}, ["magic", "gauss_newton"]),
    "unknown weights": ({"--weights": "some"}, ["--weights", "some"]),
    "too many parameters": ({"--model": "ogden", "--terms": "3"}, ["ogden", "6 parameters", "measure more"]),
    "output is a file": ({"--out": "rubber.csv"}, ["--out", "rubber.csv", "another"]),
}


class FitTest(ProgramTest):
    def fit(self, *arguments):
        process = self.run_softform("fit", *arguments)
        self.assertEqual(process.returncode, 0, process.text)
        return process

    def table(self, name, out="out"):
        with open(self.folder / out / name, encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def files(self, out="out"):
        return {file.name for file in (self.folder / out).iterdir()}


class Results(FitTest):
    def test_inflated_sheet(self):
        process = self.fit("--inflation", SHEET, "--model", "hart_smith", "--solver", "all", "--out", "out")
        self.assertIn("one mode alone", process.stderr)
        self.assertEqual(self.files(), FILES)
        rows = self.table("parameters.csv")
        self.assertEqual(list(rows[0]), ["model", "solver", "parameter", "value", "standard_error", "unit"])
        self.assertEqual([(r["solver"], r["parameter"]) for r in rows], [(s, p) for s in SOLVERS for p in ("G", "k1", "k2")])
        for row in rows:
            expected = {"G": 0.1848e6, "k1": 2.87e-4, "k2": 0.283}[row["parameter"]]
            self.assertAlmostEqual(float(row["value"]) / expected, 1, delta=0.01)
            self.assertTrue(0 < float(row["standard_error"]) < 0.5 * float(row["value"]))
            self.assertEqual(row["unit"], "Pa" if row["parameter"] == "G" else "1")
        for solver in SOLVERS:
            residuals = [float(r["residual [Pa]"]) for r in self.table("residuals.csv") if r["solver"] == solver]
            self.assertEqual(len(residuals), 16)
            self.assertLess(math.sqrt(sum(r * r for r in residuals) / 16), 0.0155e6)
        trust = json.loads((self.folder / "out" / "trust.json").read_text())
        self.assertEqual([entry["solver"] for entry in trust], list(SOLVERS))
        for entry in trust:
            self.assertTrue(entry["is_stable_over_data"])
            self.assertGreater(entry["condition_number"], 1)
            self.assertAlmostEqual(entry["correlation"][0][0], 1)
        self.assertIn("stable by Drucker's", process.stderr)
        costs = [entry["cost"] for entry in trust]
        self.assertLess(max(costs) / min(costs) - 1, 1e-6)
        self.assertTrue((self.folder / "out" / "fit.png").read_bytes().startswith(b"\x89PNG"))

    def test_all_models(self):
        process = self.fit("--uniaxial", UNIAXIAL, "--pure-shear", SHEAR, "--inflation", SHEET, "--model", "all",
                           "--solver", "gauss_newton", "--out", "out")
        self.assertNotIn("one mode alone", process.stderr)
        self.assertEqual(self.files(), FILES | {f"material_{model}.json" for model in MODELS})
        chosen = json.loads((self.folder / "out" / "material.json").read_text())
        self.assertEqual(chosen["model"], "hart_smith")
        self.assertIn("least rms of 5 models", chosen["source"])
        rows = self.table("prediction.csv")
        self.assertEqual(len(rows), len(MODELS) * 4 * 3)
        for row in rows:
            self.assertTrue(math.isfinite(float(row["mean_relative_error"])), row)
        # Every material can be inflated.
        self.write("sphere.off", shapes.off_text(shapes.sphere(2)))
        for model in ("", *(f"_{model}" for model in MODELS if model != "st_venant_kirchhoff")):
            inflation = self.run_softform("inflate", "sphere.off", "--material", f"out/material{model}.json",
                                          "--thickness", "0.3mm", "--volume-ratio", "1.5", "--out", "inflated")
            self.assertEqual(inflation.returncode, 0, inflation.text)

    def test_a_test_too_small_alone_leaves_a_gap_in_the_predictions(self):
        self.write("u.csv", "stretch,nominal_stress_mpa\n1.5,0.3\n2,0.5\n3,0.8\n")
        self.write("e.csv", "stretch,nominal_stress_mpa\n1.5,0.4\n2,0.6\n3,1.1\n")
        process = self.fit("--uniaxial", "u.csv", "--equibiaxial", "e.csv", "--model", "hart_smith", "--out", "out")
        self.assertIn("no predictions from uniaxial alone", process.stderr)
        self.assertEqual(self.files(), FILES)
        rows = self.table("prediction.csv")
        self.assertEqual(len(rows), 6)
        for row in rows:
            self.assertEqual(row["mean_relative_error"] != "", row["fitted_on"] == "all", row)

    def test_the_material_is_chosen_by_the_weights(self):
        self.fit("--inflation", SHEET, "--model", "all", "--solver", "gauss_newton", "--weights", "relative",
                 "--out", "out")
        trust = json.loads((self.folder / "out" / "trust.json").read_text())
        self.assertEqual(min(trust, key=lambda entry: entry["rms [Pa]"])["model"], "hart_smith")
        self.assertEqual(min(trust, key=lambda entry: entry["cost"])["model"], "ogden")
        chosen = json.loads((self.folder / "out" / "material.json").read_text())
        self.assertEqual(chosen["model"], "ogden")
        self.assertIn("least rms of relative errors of 5 models", chosen["source"])

    def test_a_lower_end_that_is_no_minimum_is_warned_of(self):
        process = self.fit("--equibiaxial", RUBBER / "meunier_2008_silicone_equibiaxial.csv", "--model", "ogden",
                           "--terms", "3", "--solver", "gauss_newton", "--out", "out")
        entry, = json.loads((self.folder / "out" / "trust.json").read_text())
        self.assertEqual(entry["cost"], entry["minima"][0]["cost"])
        self.assertGreater(entry["unfinished_starts"], 0)
        self.assertIn("did not end in a minimum came lower", process.stderr)

    def test_units_do_not_matter(self):
        self.write("mpa.csv", GOOD)
        rows = [line.split(",") for line in GOOD.splitlines()[1:]]
        self.write("kgf.csv", "stretch,nominal_stress_kgf_cm2\n" +
                   "".join(f"{l},{float(p) / 0.0980665}\n" for l, p in rows))
        self.write("true.csv", "stretch,true_stress_kpa\n" +
                   "".join(f"{l},{1000 * float(p) * float(l)}\n" for l, p in rows))
        values = []
        for name in ("mpa", "kgf", "true"):
            self.fit("--equibiaxial", f"{name}.csv", "--model", "neo_hookean", "--weights", "relative", "--out", name)
            values.append(float(self.table("parameters.csv", name)[0]["value"]))
        self.assertAlmostEqual(values[1] / values[0], 1, places=9)
        self.assertAlmostEqual(values[2] / values[0], 1, places=9)

    def test_biaxial(self):
        # Mooney-Rivlin with mu_1 = 0.3 MPa and mu_2 = 0.05 MPa.
        def stress(a, b):
            return (a - 1 / (a**3 * b**2)) * (0.3 + 0.05 * b * b)

        pairs = [(1 + 0.25 * i, 1 + 0.2 * j) for i in range(1, 5) for j in range(3)]
        self.write("biaxial.csv", "stretch_1,stretch_2,nominal_stress_1_mpa,nominal_stress_2_mpa\n" +
                   "".join(f"{a},{b},{stress(a, b)},{stress(b, a)}\n" for a, b in pairs))
        process = self.fit("--biaxial", "biaxial.csv", "--model", "mooney_rivlin", "--out", "out")
        self.assertNotIn("one mode alone", process.stderr)
        for row in self.table("parameters.csv"):
            self.assertAlmostEqual(float(row["value"]) / {"mu_1": 3e5, "mu_2": 5e4}[row["parameter"]], 1, places=5)

    def test_results_repeat(self):
        for out in ("a", "b"):
            self.fit("--pure-shear", SHEAR, "--model", "hart_smith", "--out", out)
        for name in FILES:
            self.assertEqual((self.folder / "a" / name).read_bytes(), (self.folder / "b" / name).read_bytes(), name)

    def test_help_teaches(self):
        text = self.fit("--help").stdout
        for word in ("softform fit --uniaxial", "stretch,nominal_stress_mpa", "material.json", "hart_smith"):
            self.assertIn(word, text)


class BadInput(FitTest):
    def refuses(self, changes, words):
        options = {"--uniaxial": "rubber.csv", "--model": "mooney_rivlin", "--solver": "ceres", "--out": "out"} | changes
        arguments = [word for name, value in options.items() if value is not None for word in (name, value)]
        before = sorted(self.folder.iterdir())
        process = self.run_softform("fit", *arguments)
        self.assertEqual(process.returncode, 2, process.text)
        for word in words:
            self.assertIn(word.lower(), process.text.lower())
        self.assertEqual(sorted(self.folder.iterdir()), before, "something was written")

    def test_files(self):
        for name, (text, words) in BAD_FILES.items():
            with self.subTest(name):
                if text is not None:
                    self.write("rubber.csv", text)
                self.refuses({}, words)

    def test_options(self):
        self.write("rubber.csv", GOOD)
        for name, (changes, words) in BAD_OPTIONS.items():
            with self.subTest(name):
                self.refuses(changes, words)

    def test_one_mode_is_warned_of_by_name(self):
        self.write("rubber.csv", GOOD)
        for model, warned in (("neo_hookean", False), ("mooney_rivlin", True), ("hart_smith", True)):
            with self.subTest(model):
                process = self.fit("--uniaxial", "rubber.csv", "--model", model, "--solver", "ceres", "--out", "out")
                self.assertEqual("one mode alone (uniaxial)" in process.stderr, warned, process.stderr)


if __name__ == "__main__":
    unittest.main()
