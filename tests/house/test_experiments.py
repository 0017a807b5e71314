"""Every experiment is complete: source, expected numbers, the claim in words, and a source of its figure."""

import re
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import compare


class Experiments(unittest.TestCase):
    def test_every_folder_is_complete(self):
        registered = (ROOT / "experiments" / "CMakeLists.txt").read_text()
        for folder in sorted(f for f in (ROOT / "experiments").iterdir() if f.is_dir()):
            with self.subTest(experiment=folder.name):
                self.assertIn(f"\nsoftform_add_experiment({folder.name}", registered)
                self.assertTrue((folder / f"{folder.name}.cpp").is_file(), "no source")
                self.assertTrue((folder / "README.md").is_file(), "no README.md with the claim and what differs")
                figures = [name for name in ("figure.json", "plot.py") if (folder / name).is_file()]
                self.assertEqual(len(figures), 1, "needs figure.json or plot.py, and one of them")
                rows = compare.read_expected(folder / "expected.csv")
                self.assertTrue(any(r.applies_to("quick") and not r.is_time() for r in rows), "no quick row")

    def test_the_comparison_of_optimisers_draws_every_one(self):
        """A method new in the registry had no place in the figure, which was then not drawn at all."""
        registry = (ROOT / "src" / "softform" / "optimizers" / "registry.cpp").read_text()
        methods = re.findall(r'^ +\{"(\w+)"', registry, re.M)
        self.assertGreater(len(methods), 10)
        plot = (ROOT / "experiments" / "sec_3_2" / "plot.py").read_text()
        order = re.findall(r'"(\w+)"', re.search(r"^ORDER = \[(.*?)\]", plot, re.M | re.S).group(1))
        self.assertEqual(sorted(methods), sorted(order))


if __name__ == "__main__":
    unittest.main()
