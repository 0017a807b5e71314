"""softform-render: draws what the layout says, and names what is wrong with a layout."""

import json
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib
from pathlib import Path

RENDER = Path(sys.argv.pop(1))

OCTAHEDRON = """<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian"><PolyData>
<Piece NumberOfPoints="6" NumberOfPolys="8">
<PointData><DataArray type="Float64" Name="height" format="ascii">0 0 0 0 0.01 -0.01</DataArray></PointData>
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">
 1 0 0 -1 0 0 0 1 0 0 -1 0 0 0 1 0 0 -1</DataArray></Points>
<Polys><DataArray type="Int32" Name="connectivity" format="ascii">
 0 2 4 2 1 4 1 3 4 3 0 4 2 0 5 1 2 5 3 1 5 0 3 5</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">3 6 9 12 15 18 21 24</DataArray></Polys>
</Piece></PolyData></VTKFile>
"""


def layout(**cell):
    cell = {"surface": "octahedron.vtp", **cell}
    return {"width": 400, "columns": [{"title": "left", "color": "#ff0000"}, {}],
            "rows": [{"title": "row", "cells": [cell, None]}]}


def pixels(png):
    """Width, height and the raw bytes of the rows, filters left in place: enough to tell white from drawn."""
    data = png.read_bytes()
    width, height = struct.unpack(">II", data[16:24])
    compressed, position = b"", 8
    while position < len(data):
        length, kind = struct.unpack(">I4s", data[position:position + 8])
        compressed += data[position + 8:position + 8 + length] if kind == b"IDAT" else b""
        position += length + 12
    return width, height, zlib.decompress(compressed)


class Render(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        (self.folder / "octahedron.vtp").write_text(OCTAHEDRON)
        self.png = self.folder / "picture.png"

    def draw(self, text):
        file = self.folder / "figure.json"
        file.write_text(text if isinstance(text, str) else json.dumps(text))
        return subprocess.run(["xvfb-run", "-a", RENDER, file, "--results", self.folder, "--out", self.png],
                              capture_output=True, text=True)

    def test_draws(self):
        for cell in ({}, {"edges": True, "title": "below"},
                     {"scalar": {"field": "height", "unit": "cm", "factor": 100, "map": "coolwarm"}},
                     {"scalar": {"field": "height", "factor": 100, "map": "categories"}}):
            result = self.draw(layout(**cell))
            self.assertEqual(result.returncode, 0, result.stderr)
            width, height, raw = pixels(self.png)
            self.assertEqual(width, 400)
            self.assertGreater(height, 150)
            self.assertGreater(sum(1 for byte in raw if byte not in (0, 255)), 2000, "an empty page")

    def test_blocks_stand_side_by_side(self):
        rows = layout()["rows"] * 4
        heights = []
        for blocks in (1, 2):
            result = self.draw(layout() | {"rows": rows, "blocks": blocks})
            self.assertEqual(result.returncode, 0, result.stderr)
            heights.append(pixels(self.png)[1])
        self.assertLess(heights[1], heights[0] / 2.5)  # half the rows, of less than half the width

    def test_says_what_is_wrong(self):
        for text, words in (("{", "not JSON"), (layout(surface="none.vtp"), "none.vtp"), (layout(colour="#ffffff"), "colour"),
                            (layout(color="red"), "#b8bec8"), (layout(edges="yes"), "edges"),
                            (layout(scalar={"field": "depth"}), "depth"), (layout(scalar={"unit": "m"}), "field"),
                            (layout(scalar={"field": "height", "range": [1, 1]}), "low < high"),
                            (layout(scalar={"field": "height", "map": "jet"}), "viridis"),
                            (layout() | {"blocks": 0}, "blocks"),
                            ({"columns": [{}], "rows": [{"cells": []}]}, "not empty"),
                            ({"columns": [{}, {}], "rows": [{"cells": [None]}]}, "2 columns"),
                            ({"columns": [{}], "rows": [{"view": [0, 0, 1], "cells": [None]}]}, "directions")):
            result = self.draw(text)
            self.assertEqual(result.returncode, 2, text)
            self.assertIn(words, result.stderr)
            self.assertFalse(self.png.exists())


if __name__ == "__main__":
    unittest.main()
