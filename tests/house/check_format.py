"""Fails where clang-format would change a file; prints the command that repairs it."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("src", "apps", "experiments", "tests", "benchmarks", "docs")

files = sorted(str(f.relative_to(ROOT)) for folder in FOLDERS for f in (ROOT / folder).rglob("*")
               if f.suffix in (".cpp", ".hpp") and "_generated." not in f.name)
assert files, "no sources found"
result = subprocess.run(["clang-format-14", "--dry-run", "--Werror", *files], cwd=ROOT)
if result.returncode != 0:
    print("repair with: clang-format-14 -i <the files above>")
sys.exit(result.returncode)
