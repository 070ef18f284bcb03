"""Output of `info`."""

import json
import math
import unittest
import zlib

from command import BAD_INPUT, ROOT, VIEWS, WRONG_USAGE, CommandTest, room, vertices


class Info(CommandTest):
    def test_json_has_the_keys_that_programs_read(self):
        self.write("room.mgf", room())
        self.write("room.views.json", json.dumps(VIEWS))
        report = self.json("info", "room.mgf")
        for key in ("patches", "area", "emitted_power", "emitters", "views", "warnings"):
            self.assertIn(key, report)
        self.assertEqual(report["patches"], 6 * 2 + 1)  # two-sided walls, one-sided lamp
        self.assertAlmostEqual(report["area"], 2 * (2 * 3 + 2 * 2.5 + 3 * 2.5) + 1, places=4)  # one side of each face
        self.assertEqual(report["bounds"], {"min": [0, 0, 0], "max": [2, 3, 2.5]})
        for channel in report["emitted_power"]:
            self.assertAlmostEqual(channel, 1000, places=2)  # [lm]: 1 m2 of 1000 lm/m2
        self.assertEqual([emitter["material"] for emitter in report["emitters"]], ["lamp"])
        view, expected = report["views"][1], VIEWS["views"][1]
        self.assertEqual(list(view), list(expected))
        self.assertEqual((view["name"], view["fov"]), (expected["name"], expected["fov"]))
        for key in ("eye", "look_at", "up"):
            for found, wanted in zip(view[key], expected[key], strict=True):
                self.assertAlmostEqual(found, wanted, places=5)
        self.assertEqual(report["warnings"], [])
        memory = report["memory"]
        self.assertGreater(memory["ray_tracer"], 0)
        self.assertLessEqual(memory["per_element"], 128)  # the target is 96; docs/develop/performance.md explains the rest
        self.assertGreater(memory["at_least"], memory["ray_tracer"] + 13 * memory["per_element"])

    def test_text_tells_the_same(self):
        self.write("room.mgf", room())
        self.write("room.views.json", json.dumps(VIEWS))
        text = self.interflect("info", "room.mgf").stdout
        for words in ("13 ", "x 0 to 2, y 0 to 3, z 0 to 2.5 m", "38 m2", "1000 lm", "lamp", "door", "floor"):
            self.assertIn(words, text)

    def test_a_file_outside_the_folder_is_reported(self):
        self.write("parts/paint.mgf", "# nothing but a comment\n")
        self.write("rooms/room.mgf", "i ../parts/paint.mgf\ni lamps/lamp.mgf\n" + room())
        self.write("rooms/lamps/lamp.mgf", "# nothing either\n")
        report = self.json("info", "rooms/room.mgf")
        self.assertEqual(len(report["files"]), 3)
        self.assertEqual(report["files_outside"], ["rooms/../parts/paint.mgf"])
        self.assertIn("rooms/../parts/paint.mgf", self.interflect("info", "rooms/room.mgf").stdout)

    def test_a_texture_that_is_missing_beside_a_scene_named_without_folder_is_a_warning(self):
        """Seen to be refused as outside of the folder."""
        self.write("leaf.mtl", "newmtl leaf\nmap_Kd missing.png\n")
        self.write("leaf.obj", "mtllib leaf.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl leaf\nf 1/1 2/1 3/1\n")
        self.assertIn("a texture (map_Kd) is left out", self.interflect("info", "leaf.obj").stderr)
        self.write("leaf.mtl", "newmtl leaf\nmap_Kd ../missing.png\n")
        result = self.interflect("info", "leaf.obj", exit_code=BAD_INPUT)
        self.assertIn("lies outside the folder of the scene", result.stderr)
        self.assertIn("see --outside-files", result.stderr)

    def test_several_radiance_files_are_one_scene(self):
        """The second file was an unexpected argument, and the first one alone has no surfaces."""
        self.write("grey.mat", "void plastic grey\n0\n0\n5 .5 .5 .5 0 0\n")
        self.write("room/room.rad", "!genbox grey room 4 3 2.5 -i\n")
        report = self.json("info", "grey.mat", "room/room.rad")
        self.assertEqual(report["files"], ["grey.mat", "room/room.rad"])
        self.assertAlmostEqual(report["area"], 59, places=4)
        self.assertIn("give that file first", self.interflect("info", "room/room.rad", exit_code=BAD_INPUT).stderr)
        self.write("other.obj", "v 0 0 0\n")
        message = self.interflect("info", "grey.mat", "other.obj", exit_code=WRONG_USAGE).stderr
        self.assertIn("only if all are Radiance's", message)
        for output in ("grey.mat", "room/room.rad"):
            result = self.interflect("viewfactors", "grey.mat", "room/room.rad", "-o", output, exit_code=WRONG_USAGE)
            self.assertIn("error: --output", result.stderr)
        self.interflect("solve", "grey.mat", "room/room.rad", "--sky", "overcast", "--rays", "1k", "-o", "room.h5")
        self.assertIn("it has no effect", self.interflect("info", "room.h5", "grey.mat", exit_code=WRONG_USAGE).stderr)

    def test_refusals_of_outside_files_name_the_option_in_every_format(self):
        self.write("outside.bin", "nothing")
        gltf = {
            "asset": {"version": "2.0"},
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"uri": "../outside.bin", "byteLength": 36}],
        }
        self.write("in/a.gltf", json.dumps(gltf))
        self.write("in/a.obj", "mtllib ../outside.bin\n")
        self.write("in/a.rad", "!xform ../outside.bin\n")
        self.write("in/a.ies", "IESNA91\nTILT=../outside.bin\n")
        self.write("in/a.mgf", room() + "ies a.ies\n")
        for name in ("a.obj", "a.rad", "a.mgf", "a.gltf"):
            with self.subTest(name=name):
                result = self.interflect("info", f"in/{name}", exit_code=BAD_INPUT)
                self.assertIn("see --outside-files", result.stderr)

    def test_what_is_left_out_is_reported_once_a_kind_with_file_and_line(self):
        shiny = vertices((0.5, 1, 1), (0.5, 2, 1), (1.5, 2, 1)) + "m shiny =\n\trs .2 0\n\trd .3\nf v0 v1 v2\n"
        self.write("room.mgf", room() + shiny + "glow a\nglow b\n")
        result = self.interflect("info", "room.mgf", "--json")
        warnings = {warning["kind"]: warning for warning in json.loads(result.stdout)["warnings"]}
        self.assertEqual(len(warnings), 2, warnings)
        for warning in warnings.values():
            self.assertRegex(warning["where"], r"^room\.mgf:\d+$")
        self.assertEqual(result.stderr.count("warning: "), 2, result.stderr)
        self.assertIn("(2 times)", result.stderr)

    def test_unit_and_up_are_those_of_the_file_whatever_its_format(self):
        for name, text in {
            "room.mgf": vertices((0, 0, 0), (200, 0, 0), (200, 300, 0)) + "m grey =\n\trd .5\nf v0 v1 v2\n",
            "room.obj": "v 0 0 0\nv 200 0 0\nv 200 300 0\nf 1 2 3\n",
            "room.rad": "void plastic a 0 0 5 .5 .5 .5 0 0\na polygon p 0 0 9 0 0 0 200 0 0 200 300 0\n",
            "room.stl": "solid\nfacet\nvertex 0 0 0\nvertex 200 0 0\nvertex 200 300 0\n",
        }.items():
            with self.subTest(name):
                self.write(name, text)
                found = self.json("info", name, "--unit", "cm", "--up-axis", "y")["bounds"]
                for corner, expected in {"min": (0, 0, 0), "max": (2, 0, 3)}.items():  # y of the file is z
                    for a, b in zip(found[corner], expected, strict=True):
                        self.assertAlmostEqual(a, b, places=5)

    def test_an_implausible_size_is_told(self):
        self.write("room.obj", "v 0 0 0\nv 2000 0 0\nv 2000 3000 0\nf 1 2 3\n")
        for unit, expected in {"m": True, "mm": False, "0.00001": True}.items():
            kinds = [warning["kind"] for warning in self.json("info", "room.obj", "--unit", unit)["warnings"]]
            self.assertEqual("implausible-size" in kinds, expected, unit)

    def test_curves_are_divided_as_asked(self):
        self.write("ball.mgf", "v centre =\n\tp 0 0 0\nm paint =\n\trd .5\n\tsides 1\nsph centre 1\n")
        area = {n: self.json("info", "ball.mgf", "--curve-divisions", n)["area"] for n in (2, 16)}
        self.assertLess(area[2], area[16])
        self.assertLess(abs(area[16] / (4 * math.pi) - 1), 0.01)


class UpAxis(CommandTest):
    def test_is_that_of_the_views(self):
        self.write("room.mgf", room())
        self.write("room.views.json", json.dumps(VIEWS).replace("[0, 0, 1]", "[0, -1, 0]").replace("[1, 2, 0]", "[1, 2, 1]"))
        self.assertEqual(self.json("info", "room.mgf")["up"], {"axis": "-y", "evidence": "views"})
        self.assertIn("up        -y, from views", self.interflect("info", "room.mgf").stdout)

    def test_is_guessed_from_the_light_where_there_are_no_views(self):
        self.write("room.mgf", room())
        self.assertEqual(self.json("info", "room.mgf")["up"], {"axis": "z", "evidence": "light"})
        self.write("turned.mgf", "i room.mgf -rx 90\n")
        self.assertEqual(self.json("info", "turned.mgf")["up"], {"axis": "-y", "evidence": "light"})

    def test_is_not_known_of_a_dark_scene(self):
        self.write("dark.mgf", room().replace("ed 1000", "ed 0"))
        self.assertIsNone(self.json("info", "dark.mgf")["up"])
        self.assertIn("up        not known", self.interflect("info", "dark.mgf").stdout)


class Solution(CommandTest):
    OPTIONS = ("--method", "ihsrr", "--rays", "20k", "--seed", "7", "--epsilon-decay", "0.5", "--view", "door")

    def setUp(self):
        super().setUp()
        self.write("room.mgf", room())
        self.write("room.views.json", json.dumps(VIEWS))
        self.interflect("solve", "room.mgf", "-o", "room.h5", "--stats", "stats", *self.OPTIONS)
        self.header, *self.iterations = map(json.loads, (self.folder / "stats").read_text().splitlines())

    def test_json_tells_what_the_statistics_told(self):
        report = self.json("info", "room.h5")
        for key in ("scene", "method", "options", "seed", "version", "patches", "emitted_power"):
            self.assertEqual(report[key], self.header[key], key)
        for iteration in self.iterations:
            del iteration["seconds"]
        self.assertIsNotNone(self.iterations[-1]["error_estimate"])
        self.assertEqual(report["result"], self.iterations[-1])
        self.assertEqual(report["history"], self.iterations)
        self.assertGreater(len(self.iterations), 1)
        self.assertEqual((report["format_version"], report["interrupted"]), (8, False))
        checksums = [f"{zlib.crc32(self.bytes(name)):08x}" for name in report["files"]]
        self.assertEqual(report["file_checksums"], checksums)
        self.assertEqual(report["files"], ["room.mgf", "room.views.json"])
        self.assertEqual([view["name"] for view in report["views"]], ["door", "floor"])

    def test_text_tells_the_same(self):
        text = self.interflect("info", "room.h5").stdout
        result = self.json("info", "room.h5")["result"]
        words = ("room.mgf", "version 8", "ihsrr, seed 7", "epsilon_decay 0.5", "1000 lm", "floor")
        for word in (*words, str(result["rays"]), str(result["elements"]), "noise ", "mesh "):
            self.assertIn(word, text)
        self.assertNotIn("alpha", text, "only what differs from the defaults")

    def test_of_version_3_tells_what_it_knows(self):
        report = self.json("info", ROOT / "tests/exports/hdf5/version-3.h5")
        self.assertEqual((report["format_version"], report["method"], report["patches"]), (3, "isrr", 13))
        self.assertEqual((report["result"]["rays"], report["result"]["elements"]), (1000, 13))
        for key in ("version", "options", "files"):
            self.assertNotIn(key, report)

    def test_damaged_is_refused(self):
        content = bytearray(self.bytes("room.h5"))
        content[-1] ^= 1
        (self.folder / "bad.h5").write_bytes(content)
        for arguments in (("info", "bad.h5"), ("render", "bad.h5", "-o", "out.png")):
            message = self.interflect(*arguments, exit_code=BAD_INPUT).stderr
            self.assertIn("the file is damaged: the checksum of /solution/indirect_importance differs", message)


class Views(CommandTest):
    def test_are_told_in_no_more_digits_than_they_have(self):
        single, double = 1.600000023841858, 100000000.3  # the float nearest to 1.6, and a double between floats
        views = {"views": [{"name": "door", "eye": [single, double, 0], "look_at": [1, 2, 1], "fov": 38.7}]}
        self.write("room.mgf", room())
        self.write("room.views.json", json.dumps(views))
        text = self.interflect("info", "room.mgf").stdout
        self.assertIn("door: eye 1.6 100000000.3 0, look at 1 2 1, up 0 0 1, fov 38.7\n", text)


class Office(CommandTest):
    def test_is_a_furnished_room_with_luminaires_and_views(self):
        report = self.json("info", ROOT / "scenes" / "office.mgf")
        self.assertGreater(report["patches"], 1000)
        self.assertGreaterEqual(len(report["emitters"]), 2)
        self.assertIn("desk", [view["name"] for view in report["views"]])
        self.assertEqual(report["warnings"], [])
        self.assertEqual(report["files_outside"], [])


if __name__ == "__main__":
    unittest.main()
