"""softform pillow: outlines in, an inflated shape out; bad drawings refused."""

import unittest

from program import ProgramTest

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" width="200mm" height="200mm" viewBox="0 0 200 200">'
DISC = '<circle id="disc" cx="100" cy="100" r="50"/>'


class Pillow(ProgramTest):
    def pillow(self, shapes, *options):
        self.write("flat.svg", HEAD + shapes + "</svg>")
        return self.run_softform("pillow", "flat.svg", "--out", "out", *options)

    def test_two_discs_are_a_mylar_balloon(self):
        process = self.pillow(DISC + DISC, "--pressure", "100kPa", "--thickness", "0.1mm", "--edge", "4mm")
        self.assertEqual(process.returncode, 0, process.text)
        metrics = self.metrics()
        # Radius 50 mm: volume 1.218524 a^3 (Paulsen 1994), 1.5 % for the coarse mesh and the stretch of the foil.
        self.assertAlmostEqual(metrics["volume"][0] / (1.218524 * 0.05**3), 1, delta=0.03)
        self.assertAlmostEqual(metrics["thickness"][0] / metrics["width"][0], 0.599, delta=0.03)
        self.assertGreater(metrics["max_compression"][0], 0.1)
        self.assertLess(metrics["max_residual"][0], 1e-6)
        for name in ("inflated.vtp", "flat.vtp"):
            self.assertGreater((self.folder / "out" / name).stat().st_size, 1000)

    def test_size_scales_the_drawing(self):
        process = self.pillow(DISC, "--pressure", "1kPa", "--edge", "40mm", "--size", "400mm", "--thickness", "1mm")
        self.assertEqual(process.returncode, 0, process.text)
        self.assertAlmostEqual(self.metrics()["width"][0], 0.4 * 0.763, delta=0.02)

    def test_bad_input_is_named_and_nothing_is_written(self):
        cases = {
            "open": ('<path id="arm" d="M0 0L10 0L10 10"/>', [], ["flat.svg", "arm", "close it"]),
            "three": (3 * DISC, [], ["flat.svg", "3 outlines", "one or two"]),
            "none": ("<text>hello</text>", [], ["flat.svg", "no closed outline"]),
            "lengths": (DISC + '<rect width="9" height="9"/>', [], ["flat.svg", "36 mm", "2 %"]),
            "bow tie": ('<polygon points="0,0 30,30 30,0 0,20"/>', [], ["flat.svg", "cross"]),
            "pressure": (DISC, ["--pressure", "5"], ["--pressure", "no unit"]),
            "edge": (DISC, ["--edge", "1um"], ["--edge", "longer"]),
            "material": (DISC, ["--material", "unobtainium"], ["unobtainium"]),
        }
        for name, (shapes, options, words) in cases.items():
            with self.subTest(name):
                options = options if "--pressure" in options else [*options, "--pressure", "1kPa"]
                process = self.pillow(shapes, *options)
                self.assertEqual(process.returncode, 2, process.text)
                for word in words:
                    self.assertIn(word, process.text)
                self.assertFalse((self.folder / "out").exists())


if __name__ == "__main__":
    unittest.main()
