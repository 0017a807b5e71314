"""softform character: a small planar body by pins and a small bar by clamps, from file to print; what is refused."""

import csv
import json
import math
import re
import signal
import struct
import subprocess
import unittest
import xml.etree.ElementTree as ET
import zipfile

from program import PROGRAM, ProgramTest

SVG = "{http://www.w3.org/2000/svg}"
LENGTH, WIDTH = 80.0, 12.0


def strip(nx=20, ny=3, bend=0.0, length=LENGTH):
    """A strip along x as (vertices, triangles), its centre line bent to an arc of `bend` radians."""
    vertices = []
    for j in range(ny + 1):
        for i in range(nx + 1):
            s, t = length * i / nx, WIDTH * j / ny - WIDTH / 2
            if bend:
                r, a = length / bend, bend * i / nx
                vertices.append(((r - t) * math.sin(a), r - (r - t) * math.cos(a), 0.0))
            else:
                vertices.append((s, t, 0.0))
    triangles = []
    for j in range(ny):
        for i in range(nx):
            a = j * (nx + 1) + i
            b, c, d = a + 1, a + nx + 1, a + nx + 2
            triangles += [(a, b, d), (a, d, c)] if (i + j) % 2 == 0 else [(a, b, c), (b, d, c)]
    return vertices, triangles


def obj(mesh):
    vertices, triangles = mesh
    return "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in vertices) + "".join(
        f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in triangles)


def pins_task(**changes):
    task = {"body": {"mesh": "strip.obj", "thickness": "5mm",
                     "poses": [{"name": "up", "file": "up.obj"}, {"name": "down", "file": "down.obj"}]},
            "materials": {"soft": {"shear_modulus": "160kPa"}, "stiff": {"shear_modulus": "16MPa"}},
            "actuators": {"kind": "pins", "count": [2, 4]}}
    task.update(changes)
    return task


def bar_task(**changes):
    task = {"body": {"bar": [80, 4, 6], "cells": [20, 3, 1], "poses": [{"name": "hook", "bends": [[10, 50, -100]]}]},
            "materials": {"soft": {"shear_modulus": "200kPa"}, "stiff": {"shear_modulus": "200MPa"}},
            "actuators": {"kind": "clamps", "clamps": {"near": [[0, 0, 0], [4, 4, 6]], "far": [[76, 0, 0], [80, 4, 6]]}}}
    task.update(changes)
    return task


def read_stl(path):
    """The triangles of a binary STL, each three corners."""
    data = path.read_bytes()
    count = struct.unpack_from("<I", data, 80)[0]
    corners = [struct.unpack_from("<9f", data, 84 + 50 * t + 12) for t in range(count)]
    return [(c[0:3], c[3:6], c[6:9]) for c in corners]


def volume(triangles):
    return sum(a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
               a[2] * (b[0] * c[1] - b[1] * c[0]) for a, b, c in triangles) / 6


def is_watertight(triangles):
    """Every directed edge once, and its reverse once."""
    edges = [(t[k], t[(k + 1) % 3]) for t in triangles for k in range(3)]
    return len(set(edges)) == len(edges) and all((b, a) in set(edges) for a, b in edges[:200]) and set(
        edges) == {(b, a) for a, b in edges}


class CharacterTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("strip.obj", obj(strip()))
        self.write("up.obj", obj(strip(bend=1.2)))
        self.write("down.obj", obj(strip(bend=-0.7)))

    def character(self, task, *options):
        self.write("task.json", task if isinstance(task, str) else json.dumps(task))
        return self.run_softform("character", "task.json", *(options or ("--out", "out")))

    def file(self, name):
        return self.folder / "out" / name

    def table(self, name):
        with open(self.file(name), encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def files(self):
        return {file.name for file in (self.folder / "out").iterdir()}

    def printed_volume(self):
        """Of both materials [mm^3]; each surface is closed."""
        total = 0
        for name in ("soft.stl", "stiff.stl"):
            if self.file(name).exists():
                triangles = read_stl(self.file(name))
                self.assertTrue(is_watertight(triangles), name)
                total += volume(triangles)
        return total


class Pins(CharacterTest):
    STAGES = ("actuators", "places", "materials")
    POSES = ("up", "down")

    def setUp(self):
        super().setUp()
        self.process = self.character(pins_task())
        self.assertEqual(self.process.returncode, 0, self.process.text)

    def test_results(self):
        with self.subTest("files"):
            expected = {f"{stage}_{pose}.vtu" for stage in self.STAGES for pose in self.POSES}
            expected |= {f"target_{pose}.vtu" for pose in self.POSES}
            expected |= {f"drill_{pose}.svg" for pose in ("rest", *self.POSES)}
            expected |= {"rest.vtu", "metrics.csv", "poses.csv", "report.txt", "soft.stl", "stiff.stl", "print.3mf",
                         "islands.csv", "drill.csv"}
            self.assertEqual(self.files(), expected)
        with self.subTest("metrics"):
            values = {name: value for name, (value, _) in self.metrics().items()}
            for value in values.values():
                self.assertTrue(math.isfinite(value))
            for stage in self.STAGES:
                for pose in self.POSES:
                    self.assertEqual(values[f"negative_eigenvalues_{stage}_{pose}"], 0)
                    self.assertLess(values[f"residual_{stage}_{pose}"], 1e-6)
                    self.assertGreaterEqual(values[f"max_error_{stage}_{pose}"], values[f"mean_error_{stage}_{pose}"])
            self.assertLessEqual(values["mean_error_places"], 1.001 * values["mean_error_actuators"])
            self.assertLess(values["mean_error_materials"], 0.7 * values["mean_error_places"])
            self.assertEqual(values["mean_error"], values["mean_error_materials"])
            self.assertIn(values["actuators"], (2, 3, 4))
            self.assertEqual(values["grey_elements"], 0)
            self.assertGreaterEqual(values["failed_equilibria"], values["failed_equilibria_materials"])
            self.assertEqual({pose["stage"] for pose in self.table("poses.csv")}, set(self.STAGES))
        with self.subTest("print"):
            self.assertAlmostEqual(self.printed_volume() / (LENGTH * WIDTH * 5), 1, delta=1e-3)
            self.check_3mf()
            islands = self.table("islands.csv")
            self.assertAlmostEqual(sum(float(i["area [mm^2]"]) for i in islands), LENGTH * WIDTH, delta=0.5)
            self.assertEqual({i["material"] for i in islands}, {"soft", "stiff"})
        with self.subTest("plates"):
            self.check_plates(int(self.metrics()["actuators"][0]))
        with self.subTest("words"):
            report = self.file("report.txt").read_text(encoding="utf-8")
            for word in ("Stage materials", "up: largest error", "reached from rest", "islands"):
                self.assertIn(word, report)

    def check_3mf(self):
        """Both materials by name, in millimetres, with the triangles of the STL files."""
        with zipfile.ZipFile(self.file("print.3mf")) as archive:
            model = ET.fromstring(archive.read("3D/3dmodel.model"))
        space = model.tag[:model.tag.index("}") + 1]
        self.assertEqual(model.get("unit"), "millimeter")
        objects = {part.get("name"): len(list(part.iter(space + "triangle"))) for part in model.iter(space + "object")}
        self.assertEqual(objects, {name: len(read_stl(self.file(name + ".stl"))) for name in ("soft", "stiff")})
        self.assertEqual(len(list(model.iter(space + "item"))), 2)

    def check_plates(self, pins):
        rows = self.table("drill.csv")
        for pose in ("rest", *self.POSES):
            root = ET.fromstring(self.file(f"drill_{pose}.svg").read_text(encoding="utf-8"))
            self.assertEqual(root.get("width")[:-2], root.get("viewBox").split()[2])
            groups = {group.get("id"): group for group in root.findall(SVG + "g")}
            plate = groups["plate"].find(SVG + "rect")
            left, bottom = float(plate.get("x")), float(plate.get("y")) + float(plate.get("height"))
            holes = [(float(c.get("cx")) - left, bottom - float(c.get("cy")))
                     for c in groups["holes"].findall(SVG + "circle")]
            listed = [(float(r["x [mm]"]), float(r["y [mm]"])) for r in rows if r["pose"] == pose]
            self.assertEqual(len(holes), pins)
            for hole, row in zip(holes, listed):
                self.assertLess(math.dist(hole, row), 2e-3)
                self.assertTrue(0 < hole[0] < float(plate.get("width")) and 0 < hole[1] < float(plate.get("height")))
            words = [text.text for text in groups["dimensions"].findall(SVG + "text")]
            for x, y in holes:
                for value in (x, y):
                    self.assertTrue(any(re.fullmatch(r"[\d.]+", w) and abs(float(w) - value) < 6e-3 for w in words))


class Clamps(CharacterTest):
    def test_a_bar(self):
        process = self.character(bar_task())
        self.assertEqual(process.returncode, 0, process.text)
        values = {name: value for name, (value, _) in self.metrics().items()}
        self.assertLess(values["mean_error_materials_hook"], 0.6 * values["mean_error_uniform_hook"])
        self.assertEqual((values["actuators"], values["grey_elements"], values["negative_eigenvalues"]), (2, 0, 0))
        self.assertAlmostEqual(self.printed_volume() / (80 * 4 * 6), 1, delta=1e-3)
        self.assertFalse(self.file("drill.csv").exists())

    def test_one_material_of_a_surface_filled_with_tetrahedra(self):
        def box(bend):
            middle, triangles = strip(16, 1, bend)
            n = len(middle)
            vertices = [(x, y, 0.0) for x, y, _ in middle] + [(x, y, 8.0) for x, y, _ in middle]
            faces = [(c, b, a) for a, b, c in triangles] + [(a + n, b + n, c + n) for a, b, c in triangles]
            edges = {(t[k], t[(k + 1) % 3]) for t in triangles for k in range(3)}
            for a, b in sorted(edges):
                if (b, a) not in edges:
                    faces += [(a, b, b + n), (a, b + n, a + n)]
            return vertices, faces

        self.write("box.obj", obj(box(0)))
        self.write("arc.obj", obj(box(0.6)))
        task = bar_task(body={"mesh": "box.obj", "tetrahedra": 600, "poses": [{"name": "arc", "file": "arc.obj"}]},
                        stages=["uniform"])
        task["materials"].pop("stiff")
        task["actuators"]["clamps"] = {"near": [[-1, -7, -1], [6, 7, 9]], "far": [[74, -7, -1], [81, 7, 9]]}
        process = self.character(task)
        self.assertEqual(process.returncode, 0, process.text)
        self.assertLess(self.metrics()["mean_error_uniform_arc"][0], 2e-3)
        self.assertAlmostEqual(self.printed_volume() / (80 * 12 * 8), 1, delta=1e-6)


class Strings(CharacterTest):
    def test_a_strip(self):
        task = pins_task(actuators={"kind": "strings", "count": [2, 3], "clamps": {"foot": [[-1, -7], [4, 7]]}})
        process = self.character(task)
        self.assertEqual(process.returncode, 0, process.text)
        values = {name: value for name, (value, _) in self.metrics().items()}
        self.assertEqual(values["actuators"], 3)
        self.assertLess(values["mean_error_places"], 3e-3)
        self.assertEqual(values["negative_eigenvalues"], 0)
        rows = self.table("strings.csv")
        self.assertEqual([(r["pose"], r["string"]) for r in rows], [(p, s) for p in ("up", "down") for s in "123"])
        for up, down in zip(rows[:3], rows[3:]):
            self.assertGreaterEqual(float(up["tension [N]"]), 0)
            rest = float(up["length [mm]"]) - float(up["from_rest [mm]"])
            self.assertAlmostEqual(float(down["length [mm]"]) - float(down["from_rest [mm]"]), rest, delta=2e-3)
            self.assertAlmostEqual(float(up["from_previous [mm]"]), float(up["from_rest [mm]"]), delta=2e-3)
            self.assertAlmostEqual(float(down["length [mm]"]) - float(up["length [mm]"]),
                                   float(down["from_previous [mm]"]), delta=2e-3)
        self.assertTrue({"drill_ring.svg", "drill_rest.svg", "soft.stl"} <= self.files())
        self.assertAlmostEqual(self.printed_volume() / (LENGTH * WIDTH * 5), 1, delta=1e-6)


class NotReached(CharacterTest):
    def test_a_pose_without_an_equilibrium_is_no_success(self):
        """A strip that its own weight, ten thousand times the earth's, tears off its clamps."""
        task = pins_task(
            materials={"soft": {"shear_modulus": "1kPa", "density": "1000kg/m^3"}}, gravity=["0m/s^2", "-1e5m/s^2"],
            stages=["uniform"],
            actuators={"kind": "clamps", "clamps": {"left": [[-1, -7], [4, 7]], "right": [[76, -7], [81, 7]]}})
        process = self.character(task)
        self.assertEqual(process.returncode, 3, process.text)
        self.assertIn("not every pose is a stable equilibrium", process.text)
        report = self.file("report.txt").read_text(encoding="utf-8")
        for words in ("no equilibrium on the way to 'up'", "NOT an equilibrium", "NOT reached from rest"):
            self.assertIn(words, report)
        self.assertEqual({row["reached"] for row in self.table("poses.csv")}, {"no"})
        self.assertEqual(self.metrics()["reached_uniform_up"][0], 0)


class Interrupted(CharacterTest):
    def test_what_there_is_is_written(self):
        task = pins_task()
        self.write("task.json", json.dumps(task))
        command = [PROGRAM, "character", "task.json", "--out", "out"]
        with subprocess.Popen(command, cwd=self.folder, stderr=subprocess.PIPE, text=True) as process:
            said = ""
            for line in process.stderr:
                said += line
                if "stage 3" in line:
                    process.send_signal(signal.SIGINT)
                    break
            said += process.stderr.read()
        self.assertEqual(process.returncode, 130, said)
        self.assertIn("interrupted", said)
        self.assertTrue({"places_up.vtu", "metrics.csv", "drill_up.svg", "soft.stl"} <= self.files())
        self.assertIn("places", self.file("report.txt").read_text(encoding="utf-8"))
        self.assertAlmostEqual(self.printed_volume() / (LENGTH * WIDTH * 5), 1, delta=1e-3)


class BadInput(CharacterTest):
    def refuses(self, task, *words):
        process = self.character(task)
        self.assertEqual(process.returncode, 2, process.text)
        for word in words:
            self.assertIn(word, process.text)
        self.assertFalse((self.folder / "out").exists(), "something was written")

    def test_poses(self):
        self.write("up.obj", obj(strip(nx=19)))
        self.refuses(pins_task(), "up.obj", "80 vertices", "strip.obj", "84", "same mesh")
        vertices, triangles = strip()
        self.write("up.obj", obj((vertices, triangles[1:] + triangles[:1])))
        self.refuses(pins_task(), "up.obj", "element 0", "other corners", "order")
        self.write("up.obj", obj(([(-x, y, z) for x, y, z in vertices], triangles)))
        self.refuses(pins_task(), "up.obj", "pose 'up'", "triangle 0")
        self.write("up.obj", obj(([(x, y, 1.0) for x, y, z in vertices], triangles)))
        self.refuses(pins_task(), "up.obj", "z = 1", "flatten")
        (self.folder / "up.obj").unlink()
        self.refuses(pins_task(), "up.obj", "no such file")

    def test_body(self):
        vertices, triangles = strip()
        self.write("strip.obj", obj((vertices + [(0.0, 0.0, 0.0)], triangles)))
        self.refuses(pins_task(), "strip.obj", "vertex 84", "loose")
        self.write("strip.obj", obj((vertices, [(a, c, b) for a, b, c in triangles])))
        self.refuses(pins_task(), "strip.obj", "triangle 0", "counter-clockwise")
        self.refuses(pins_task(body={}), "'body'", "'drawing'")
        self.refuses(pins_task(body={"drawing": "none.json", "triangles": 300, "thickness": "1mm"}), "none.json")
        self.refuses(pins_task(body={"drawing": "none.json", "triangles": 300}), "'thickness' is missing")

    def test_range_of_actuators(self):
        for count, words in (([5, 4], ["from 5 to 4"]), ([1, 1], ["1 cannot be reached", "two at least"]),
                             ([400, 500], ["500 cannot be reached", "only 46"]), ([4], ["1 entries", "2"]),
                             ([2.5, 4], ["2.5", "whole number"])):
            with self.subTest(count):
                self.refuses(pins_task(actuators={"kind": "pins", "count": count}), "task.json", "'count'", *words)

    def test_materials(self):
        def materials(**changes):
            return pins_task(materials={"soft": {"shear_modulus": "160kPa"}, **changes})

        self.refuses(materials(stiff={"shear_modulus": "80kPa"}), "task.json", "'stiff'", "0.5 times", "exchange")
        self.refuses(materials(stiff={"shear_modulus": "80"}), "'shear_modulus'", "no unit")
        self.refuses(materials(hard={"shear_modulus": "80kPa"}), "unknown key 'hard'", "soft, stiff, poisson_ratio")
        self.refuses({**materials(), "stages": ["actuators", "places", "materials"]}, "'stages'", "\"stiff\"")
        self.refuses(materials(poisson_ratio=0.3), "'poisson_ratio'", "incompressible")

    def test_clamps_and_pins(self):
        foot = {"foot": [[-1, -7], [5, 7]]}
        self.refuses(pins_task(actuators={"kind": "pins", "vertices": [0, 20], "clamps": foot}), "vertex 0",
                     "clamp 'foot'")
        self.refuses(pins_task(actuators={"kind": "pins", "vertices": [25, 20]}), "vertex 25", "boundary")
        self.refuses(pins_task(actuators={"kind": "pins", "count": [2, 4], "vertices": [0, 20]}), "either 'count'")
        self.refuses(pins_task(actuators={"kind": "magnets"}), "'magnets'", "pins, strings or clamps")
        bar = bar_task()
        bar["actuators"]["clamps"]["far"] = [[2, 0, 0], [80, 4, 6]]
        self.refuses(bar, "'far' and 'near'", "move them apart")
        bar["actuators"]["clamps"]["far"] = [[100, 0, 0], [120, 4, 6]]
        self.refuses(bar, "'far'", "0 vertices")
        self.refuses(bar_task(actuators={"kind": "pins", "count": [2, 4]}), "planar")

    def test_keys_and_files(self):
        self.refuses(pins_task(colour="red"), "task.json", "unknown key 'colour'", "body, materials, actuators")
        self.refuses(pins_task(weights={"smoth": 1}), "'weights'", "'smoth'", "smooth")
        self.refuses(pins_task(weights={"smooth": -1}), "'smooth'", "above 0")
        self.refuses(pins_task(stages=["places"]), "'places' is not the next stage", "actuators, places, materials")
        self.refuses(pins_task(gravity=["0m/s^2", "-9.81m/s^2"]), "'gravity'", "density")
        self.refuses(pins_task(print={"smallest": "1"}), "'smallest'", "no unit")
        self.refuses('{"body": ', "task.json", "not valid JSON")
        bad = pins_task()
        bad["body"]["poses"][0]["name"] = "up/down"
        self.refuses(bad, "'up/down'", "letters")
        bad["body"]["poses"] = []
        self.refuses(bad, "no pose")
        process = self.run_softform("character", "none.json", "--out", "out")
        self.assertEqual(process.returncode, 2, process.text)
        self.assertIn("none.json", process.text)
        self.assertEqual(self.run_softform("character", "task.json").returncode, 2)


class Help(CharacterTest):
    def test_teaches(self):
        text = self.run_softform("character", "--help").stdout
        for word in ("softform character", "drill_<pose>.svg", "\"clamps\"", "shear_modulus", "metrics.csv"):
            self.assertIn(word, text)

    def test_check_computes_nothing(self):
        process = self.character(pins_task(), "--check")
        self.assertEqual(process.returncode, 0, process.text)
        self.assertIn("120 elements", process.text)
        self.assertFalse((self.folder / "out").exists())


if __name__ == "__main__":
    unittest.main()
