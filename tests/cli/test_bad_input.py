"""What cannot be used: exit code 2, a message that names the thing and the cure, and nothing written."""

import json
import unittest

import shapes
from program import ProgramTest

MESH = shapes.off_text(shapes.sphere())
MATERIAL = {"model": "hart_smith", "parameters": {"G": "0.16163 MPa", "k1": 0.0219, "k2": 0.2453}, "source": "test"}


def material(**changes):
    return json.dumps({**MATERIAL, "parameters": {**MATERIAL["parameters"], **changes}})


# What is wrong: (the mesh's file and text, words of the message: the element, the cure)
BAD_MESHES = {
    "open mesh": ("open.off", shapes.off_text(shapes.open_mesh()), ["edge", "open", "fill the hole"]),
    "non-manifold edge": ("edge.off", shapes.off_text(shapes.non_manifold_edge()), ["edge", "3 triangles", "remove"]),
    "inverted orientation": ("inverted.off", shapes.off_text(shapes.inverted()), ["triangle 0", "flip the normals"]),
    "one flipped triangle": ("flipped.obj", shapes.obj_text(shapes.one_flipped()), ["triangle", "normals consistent"]),
    "self-intersection": ("cut.ply", shapes.ply_text(shapes.self_intersecting()), ["triangles", "cut", "repair"]),
    "NaN coordinate": ("nan.obj", shapes.obj_text(shapes.not_finite()), ["nan", "not finite", "repair"]),
    "NaN coordinate in OFF": ("nan.off", shapes.off_text(shapes.not_finite()), ["nan", "not finite", "repair"]),
    "single triangle": ("one.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", ["1 triangles", "closed surface"]),
    "two parts": ("two.stl", shapes.stl_text(shapes.two_spheres()), ["2 separate parts", "keep one"]),
    "index out of range": ("index.obj", shapes.obj_text(shapes.sphere()) + "f 1 2 9999\n", ["index.obj", "repair"]),
    "no area": ("flat.off", "OFF\n4 4 0\n0 0 0\n1 0 0\n2 0 0\n3 0 0\n3 0 1 2\n3 0 2 3\n3 0 3 1\n3 1 3 2\n",
                ["triangle 0", "no area"]),
    "cut off in the middle": ("half.off", MESH[:len(MESH) // 2], ["half.off", "repair"]),
    "empty file": ("empty.off", "", ["empty", "export"]),
    "no mesh at all": ("story.obj", "once upon a time\n", ["story.obj", "repair"]),
    "unknown format": ("mesh.step", "ISO-10303-21;", [".step", ".off"]),
    "missing file": ("missing.off", None, ["no such file", "check the path"]),
}

# What is wrong: (changed options, words of the message)
BAD_OPTIONS = {
    "thickness without a unit": ({"--thickness": "0.3"}, ["--thickness", "'0.3'", "no unit", "0.3mm"]),
    "thickness in a pressure's unit": ({"--thickness": "0.3kPa"}, ["--thickness", "kPa", "mm"]),
    "unknown unit": ({"--thickness": "0.3furlong"}, ["--thickness", "furlong", "mm"]),
    "no number": ({"--thickness": "thin"}, ["--thickness", "thin", "0.3mm"]),
    "negative thickness": ({"--thickness": "-0.3mm"}, ["--thickness", "-0.3mm", "above 0"]),
    "no thickness": ({"--thickness": "0mm"}, ["--thickness", "0mm", "above 0"]),
    "infinite thickness": ({"--thickness": "infmm"}, ["--thickness", "infmm"]),
    "size without a unit": ({"--size": "146"}, ["--size", "no unit"]),
    "size negative": ({"--size": "-146mm"}, ["--size", "above 0"]),
    "unknown option": ({"--colour": "red"}, ["--colour"]),
    "output below a file": ({"--out": "mesh.off/out"}, ["--out", "mesh.off", "another"]),
    "unknown material": ({"--material": "unobtainium"}, ["unobtainium", "silicone"]),
    "missing material file": ({"--material": "missing.json"}, ["missing.json", "silicone"]),
    "material is a mesh": ({"--material": "mesh.off"}, ["mesh.off", "JSON", "line 1"]),
}
BAD_INFLATIONS = {
    "pressure without a unit": ({"--volume-ratio": None, "--pressure": "1000"}, ["--pressure", "no unit", "1kPa"]),
    "pressure in a length's unit": ({"--volume-ratio": None, "--pressure": "1mm"}, ["--pressure", "mm", "kPa"]),
    "negative pressure": ({"--volume-ratio": None, "--pressure": "-1kPa"}, ["--pressure", "above 0"]),
    "no load": ({"--volume-ratio": None}, ["--pressure", "--volume-ratio"]),
    "two loads": ({"--pressure": "1kPa"}, ["--pressure", "--volume-ratio"]),
    "shrinking": ({"--volume-ratio": "0.5"}, ["--volume-ratio", "above 1"]),
    "ratio is a word": ({"--volume-ratio": "much"}, ["--volume-ratio", "much"]),
    "ratio is not a number": ({"--volume-ratio": "nan"}, ["--volume-ratio", "nan"]),
}
BAD_BALLOONS = {
    "scale not below one": ({"--scale": "1"}, ["--scale", "1"]),
    "scale negative": ({"--scale": "-0.5"}, ["--scale", "-0.5"]),
}

# What is wrong: (the material's text, words of the message)
BAD_MATERIALS = {
    "k1 < 0": (material(k1=-0.02), ["k1 = -0.02", "k1 >= 0"]),
    "k2 < 0": (material(k2=-0.1), ["k2 = -0.1", "k2 >= 0"]),
    "modulus negative": (material(G="-1 MPa"), ["G = ", "positive"]),
    "modulus without a unit": (material(G=161630), ["G = 161630", "0.16 MPa"]),
    "modulus in a length's unit": (material(G="1 mm"), ["mm", "MPa"]),
    "unreadable JSON": ('{"model": "hart_smith",\n "parameters": {', ["line 2", "correct"]),
    "unknown parameter": (material(k3=1), ["'k3'", "G, k1, k2"]),
    "unknown model": (json.dumps({**MATERIAL, "model": "jelly"}), ["'jelly'", "hart_smith"]),
    "empty": ("", ["JSON"]),
}

EGG = '{"unit": "mm", "parts": [{"shape": "ellipsoid", "center": [0, 0, 0], "radii": [20, 20, 30]}]}'
# What is wrong: (model, vertices, out, words of the message)
BAD_MODELS = {
    "missing model": ("none.json", "300", "egg.obj", ["none.json"]),
    "unknown key": ("bad.json", "300", "egg.obj", ["bad.json", "parts[0]", "'radius'", "radii"]),
    "too few vertices": ("egg.json", "10", "egg.obj", ["--vertices", "100"]),
    "no whole number": ("egg.json", "3e2.5", "egg.obj", ["--vertices"]),
    "unknown format": ("egg.json", "300", "egg.step", [".step", ".obj"]),
    "output below a file": ("egg.json", "300", "egg.json/egg.obj", ["egg.json", "another"]),
}


class BadInput(ProgramTest):
    def refuses(self, command, changes, words):
        options = {"--material": "silicone", "--thickness": "0.3mm", "--out": "out"}
        if command == "inflate":
            options["--volume-ratio"] = "2"
        options |= changes
        mesh = options.pop("mesh", "mesh.off")
        if not (self.folder / "mesh.off").exists():
            self.write("mesh.off", MESH)
        arguments = [word for name, value in options.items() if value is not None for word in (name, value)]
        before = sorted(self.folder.iterdir())
        process = self.run_softform(command, mesh, *arguments)
        self.assertEqual(process.returncode, 2, process.text)
        for word in words:
            self.assertIn(word.lower(), process.text.lower())
        self.assertEqual(sorted(self.folder.iterdir()), before, "something was written")

    def test_meshes(self):
        for name, (file, text, words) in BAD_MESHES.items():
            if text is not None:
                self.write(file, text)
            for command in ("inflate", "balloon"):
                with self.subTest(name, command=command):
                    self.refuses(command, {"mesh": file}, [file, *words])
            with self.subTest(name, command="check"):
                process = self.run_softform("check", file)
                self.assertEqual(process.returncode, 2, process.text)
                for word in [file, *words]:
                    self.assertIn(word.lower(), process.text.lower())

    def test_options(self):
        for command, own in (("inflate", BAD_INFLATIONS), ("balloon", BAD_BALLOONS)):
            for name, (changes, words) in (BAD_OPTIONS | own).items():
                with self.subTest(name, command=command):
                    self.refuses(command, changes, words)

    def test_materials(self):
        for name, (text, words) in BAD_MATERIALS.items():
            self.write("rubber.json", text)
            for command in ("inflate", "balloon"):
                with self.subTest(name, command=command):
                    self.refuses(command, {"--material": "rubber.json"}, ["rubber.json", *words])

    def test_models(self):
        self.write("egg.json", EGG)
        self.write("bad.json", EGG.replace("radii", "radius"))
        for name, (model, vertices, out, words) in BAD_MODELS.items():
            with self.subTest(name):
                before = sorted(self.folder.iterdir())
                process = self.run_softform("model", model, "--vertices", vertices, "--out", out)
                self.assertEqual(process.returncode, 2, process.text)
                for word in words:
                    self.assertIn(word.lower(), process.text.lower())
                self.assertEqual(sorted(self.folder.iterdir()), before, "something was written")

    def test_a_subcommand_is_asked_for(self):
        self.assertEqual(self.run_softform().returncode, 2)
        self.assertEqual(self.run_softform("deflate").returncode, 2)


if __name__ == "__main__":
    unittest.main()
