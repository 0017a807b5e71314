"""clang-tidy over the library, two files at a time; every warning is an error.

Files that include CGAL or VTK are left out: their headers take longer to parse than all the rest together.
A file that was clean is not looked at again until it, a header or the list of checks changes.
Usage: check_tidy.py BUILD_DIR (which holds compile_commands.json)
"""

import hashlib
import json
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LIBRARY = ROOT / "src" / "softform"
HEAVY = re.compile(r"#include <(CGAL/|vtk)")
build = Path(sys.argv[1])
stamps = build / "tidy"
stamps.mkdir(exist_ok=True)


def digest(*files):
    return hashlib.sha256(b"\0".join(file.read_bytes() for file in files)).hexdigest()


common = digest(ROOT / ".clang-tidy", *sorted(LIBRARY.rglob("*.hpp")))


def tidy(file):
    stamp = stamps / f"{file.stem}-{common[:16]}-{digest(file)[:16]}"
    if stamp.exists():
        return True
    command = ["clang-tidy-14", "--quiet", "-p", str(build), str(file)]
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode == 0:
        stamp.touch()
    else:
        print(f"{file.relative_to(ROOT)}\n{result.stdout}{result.stderr}", flush=True)
    return result.returncode == 0


built = {Path(command["file"]) for command in json.loads((build / "compile_commands.json").read_text())}
files = [file for file in sorted(LIBRARY.rglob("*.cpp")) if file in built and not HEAVY.search(file.read_text())]
assert files, "no sources of the library found in compile_commands.json"
with ThreadPoolExecutor(2) as pool:
    clean = list(pool.map(tidy, files))
print(f"{sum(clean)} of {len(files)} files are clean")
sys.exit(0 if all(clean) else 1)
