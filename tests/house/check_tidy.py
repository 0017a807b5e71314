"""clang-tidy over the library and the programs, two files at a time; every warning is an error.

Files that include CGAL or VTK are left out: their headers take longer to parse than all the rest together.
Usage: check_tidy.py BUILD_DIR (which holds compile_commands.json)
"""

import json
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HEAVY = re.compile(r"#include <(CGAL/|vtk)")
build = Path(sys.argv[1])


def is_checked(file):
    inside = any(file.is_relative_to(ROOT / folder) for folder in ("src", "apps", "experiments"))
    return inside and not HEAVY.search(file.read_text(encoding="utf-8"))


def tidy(file):
    command = ["clang-tidy-14", "--quiet", "-p", str(build), str(file)]
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        print(f"{file.relative_to(ROOT)}\n{result.stdout}{result.stderr}", flush=True)
    return result.returncode == 0


commands = json.loads((build / "compile_commands.json").read_text())
files = sorted({file for file in (Path(c["file"]) for c in commands) if is_checked(file)})
assert files, "no sources found in compile_commands.json"
with ThreadPoolExecutor(2) as pool:
    clean = list(pool.map(tidy, files))
print(f"{sum(clean)} of {len(files)} files are clean")
sys.exit(0 if all(clean) else 1)
