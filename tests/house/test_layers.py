"""Arrows run downwards only: which folder of src/softform may include which, and what public headers may pull in."""

import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LIBRARY = ROOT / "src" / "softform"

MECHANICS = {"core", "linalg", "mesh", "materials", "fem"}
# A folder that is not here has to be placed first.
MAY_INCLUDE = {
    "core": set(),
    "mesh": {"core"},
    "materials": {"core", "io"},
    "linalg": {"core"},
    "optimizers": {"core", "linalg"},
    "io": {"core", "mesh"},
    "experiment": {"core", "io"},
    "fem": {"core", "linalg", "mesh", "materials"},
    "equilibrium": MECHANICS,
    "objectives": MECHANICS | {"equilibrium"},
    "inverse": MECHANICS | {"equilibrium", "objectives", "optimizers"},
    "fitting": MECHANICS | {"equilibrium", "optimizers", "io"},
    "balloons": MECHANICS | {"equilibrium", "objectives", "inverse", "optimizers", "io"},
    "inflatables": MECHANICS | {"equilibrium", "objectives", "inverse", "optimizers", "io"},
}
# What a public header may include from outside the standard library.
HEADER_LIBRARIES = {"Eigen/Core", "Eigen/SparseCore"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
# The door of the experiments prints what --list asks for.
MAY_PRINT = {LIBRARY / "experiment" / "experiment.cpp"}
PRINTS = re.compile(r'std::cout|\bprintf\(|\bputs\(|fmt::print\(\s*("|stdout)')


def sources(*endings):
    return [file for file in LIBRARY.rglob("*") if file.suffix in endings]


def violations(folder, text, is_public_header):
    """What a file of this folder includes and must not."""
    found = []
    for bracket, name in INCLUDE.findall(text):
        parts = name.split("/")
        if parts[0] == "softform":
            if parts[1] != folder and parts[1] not in MAY_INCLUDE[folder]:
                found.append(f"{folder}/ includes {name}")
        elif is_public_header and bracket == "<" and ("/" in name or name.endswith((".h", ".hpp"))):
            if name not in HEADER_LIBRARIES:
                found.append(f"public header includes <{name}>")
    return found


class Layers(unittest.TestCase):
    def test_every_folder_is_placed(self):
        self.assertEqual({file.parent.name for file in sources(".cpp", ".hpp")} - set(MAY_INCLUDE), set())

    def test_arrows_run_downwards(self):
        self.assertGreater(len(sources(".cpp")), 5)
        for file in sources(".cpp", ".hpp"):
            is_public = file.suffix == ".hpp" and not file.stem.endswith("_internal")
            found = violations(file.parent.name, file.read_text(encoding="utf-8"), is_public)
            with self.subTest(file=str(file.relative_to(ROOT))):
                self.assertEqual(found, [])

    def test_the_library_is_silent(self):
        for file in sources(".cpp", ".hpp"):
            with self.subTest(file=str(file.relative_to(ROOT))):
                if file not in MAY_PRINT:
                    self.assertIsNone(PRINTS.search(file.read_text(encoding="utf-8")), "writes to stdout")

    def test_violations_are_seen(self):
        self.assertTrue(violations("optimizers", '#include "softform/fem/energy.hpp"', False))
        self.assertTrue(violations("materials", '#include "softform/mesh/triangle_mesh.hpp"', False))
        self.assertTrue(violations("core", "#include <CGAL/Kernel.h>", True))
        self.assertEqual(violations("fem", '#include <vector>\n#include "softform/core/types.hpp"', True), [])


if __name__ == "__main__":
    unittest.main()
