"""The C++ of CONTRIBUTING.md is that of docs/examples, which a test compiles and runs."""

import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


class Contributing(unittest.TestCase):
    def test_its_code_is_compiled(self):
        blocks = re.findall(r"```cpp\n(.*?)```", (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"), re.DOTALL)
        examples = [file.read_text(encoding="utf-8") for file in (ROOT / "docs" / "examples").iterdir()]
        self.assertGreaterEqual(len(blocks), 2)
        for block in blocks:
            self.assertTrue(any(block in example for example in examples), f"in no file of docs/examples:\n{block}")


if __name__ == "__main__":
    unittest.main()
