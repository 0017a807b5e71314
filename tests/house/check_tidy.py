"""clang-tidy over the library, two files at a time; every warning is an error.

Files that include CGAL or VTK are left out: their headers take longer to parse than all the rest together.
The rest is looked at in batches, each as one translation unit, for most of the time goes into Eigen's headers. Where
files of a batch clash (the same name in two unnamed namespaces) or one has a finding, its halves are looked at alone.
A batch that was clean is not looked at again until one of its files, a header or the list of checks changes.
Usage: check_tidy.py BUILD_DIR (which holds compile_commands.json)
"""

import hashlib
import json
import re
import shlex
import subprocess
import sys
from collections import defaultdict
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LIBRARY = ROOT / "src" / "softform"
BATCH = 16
HEAVY = re.compile(r"#include <(CGAL/|vtk)")
build = Path(sys.argv[1])
stamps = build / "tidy"
stamps.mkdir(exist_ok=True)


def digest(*files):
    return hashlib.sha256(b"\0".join(file.read_bytes() for file in files)).hexdigest()


common = digest(ROOT / ".clang-tidy", *sorted(LIBRARY.rglob("*.hpp")))


def compile_options(command):
    """What of a compiler's command matters to clang-tidy."""
    words = shlex.split(command)
    own = [word for word in words if word.startswith(("-D", "-I", "-std", "-m"))]
    system = [option for i, word in enumerate(words) if word == "-isystem" for option in words[i : i + 2]]
    return tuple(own + system)


def hidden_names(file):
    """Names in the file's unnamed namespaces that stand at the start of a line: mostly its definitions."""
    bodies = re.findall(r"^namespace \{\n(.*?)^\}  // namespace$", file.read_text(), re.M | re.S)
    lines = (line for body in bodies for line in body.splitlines() if re.match(r"\w", line))
    return {name for line in lines for name in re.findall(r"\b(\w+)(?= ?[({=;\[]|$)", line)}


def batched(files):
    """Batches of files whose hidden names differ, as far as that can be seen without a compiler."""
    batches = []
    for file in files:
        names = hidden_names(file)
        for batch, taken in batches:
            if len(batch) < BATCH and not names & taken:
                batch.append(file)
                taken |= names
                break
        else:
            batches.append(([file], names))
    return [batch for batch, _ in batches]


def tidy(files, options):
    """How many of the files are clean."""
    name = hashlib.sha256((common + digest(*files)).encode()).hexdigest()[:16]
    stamp, unit = stamps / name, stamps / f"{name}.cpp"
    if stamp.exists():
        return len(files)
    unit.write_text("".join(f'#include "{file}"\n' for file in files))
    command = ["clang-tidy-14", "--quiet", f"--config-file={ROOT}/.clang-tidy", str(unit), "--", *options]
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode == 0:
        stamp.touch()
        return len(files)
    if len(files) > 1:
        half = len(files) // 2
        return tidy(files[:half], options) + tidy(files[half:], options)
    print(f"{files[0].relative_to(ROOT)}\n{result.stdout}{result.stderr}", flush=True)
    return 0


groups = defaultdict(list)
for entry in json.loads((build / "compile_commands.json").read_text()):
    file = Path(entry["file"])
    if LIBRARY in file.parents and not HEAVY.search(file.read_text()):
        groups[compile_options(entry["command"])].append(file)
batches = [(batch, options) for options, files in groups.items() for batch in batched(sorted(files))]
total = sum(len(files) for files, _ in batches)
assert total, "no sources of the library found in compile_commands.json"
with ThreadPoolExecutor(2) as pool:
    clean = sum(pool.map(lambda batch: tidy(*batch), batches))
print(f"{clean} of {total} files are clean")
sys.exit(0 if clean == total else 1)
