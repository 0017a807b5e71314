"""Runs the softform program in a folder of its own."""

import csv
import os
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["SOFTFORM_PROGRAM"]


class ProgramTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path

    def run_softform(self, *arguments, timeout=200):
        """The finished process; its `text` is all that it said."""
        process = subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True,
                                 timeout=timeout, check=False)
        process.text = process.stdout + process.stderr
        return process

    def run_until(self, line, *arguments):
        """Starts the program, sends it Ctrl-C when it has said `line`, and returns its exit code and all it said."""
        with subprocess.Popen([PROGRAM, *arguments], cwd=self.folder, stderr=subprocess.PIPE, text=True) as process:
            said = ""
            for text in process.stderr:
                said += text
                if line in text:
                    process.send_signal(signal.SIGINT)
                    break
            said += process.stderr.read()
        return process.returncode, said

    def metrics(self, out="out"):
        """metrics.csv as {metric: (value, unit)}."""
        with open(self.folder / out / "metrics.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(list(rows[0]), ["metric", "value", "unit"])
        return {row["metric"]: (float(row["value"]), row["unit"]) for row in rows}
