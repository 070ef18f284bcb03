"""`interflect export`: what it writes, what it refuses, and that nothing is left half written."""

import base64
import json
import unittest

from command import BAD_INPUT, WRONG_USAGE, CommandTest, room

SHIFTED = "xf -t 1000000 2000000 0\n"


class Export(CommandTest):
    def solve(self, text=None):
        self.write("scene.mgf", text or room())
        self.interflect("solve", "scene.mgf", "--rays", "100k", "-o", "scene.h5")

    def export(self, *arguments):
        self.interflect("export", "scene.h5", *arguments, "-o", "out.gltf")
        return json.loads((self.folder / "out.gltf").read_text())

    def test_same_bytes_each_time(self):
        self.solve()
        for options in ((), ("--lightmap",), ("--lightmap", "--shading", "gather", "--samples", "8", "--texels-per-metre", "4")):
            self.interflect("export", "scene.h5", *options, "-o", "a.glb")
            self.interflect("export", "scene.h5", *options, "-o", "b.glb")
            self.assertEqual(self.bytes("a.glb").replace(b"a.lightmap", b"b.lightmap"), self.bytes("b.glb"), options)

    def test_exposure_is_recorded(self):
        self.solve()
        self.assertEqual(self.export("--exposure", "-3.5")["asset"]["extras"]["interflect"]["exposure"], -3.5)

    def test_up_and_origin(self):
        self.solve(SHIFTED + room() + "xf\n")
        root = self.export("--up", "0,0,1")["nodes"][-1]
        self.assertAlmostEqual(root["rotation"][0], -(0.5**0.5))  # a quarter turn back about x: z becomes y, y becomes -z
        self.assertAlmostEqual(root["rotation"][3], 0.5**0.5)
        for found, expected in zip(root["translation"], (1e6, 0, -2e6)):
            self.assertAlmostEqual(found, expected, delta=10)
        self.assertEqual(self.export("--up", "0,1,0")["nodes"][-1]["rotation"], [0, 0, 0, 1])

    def test_lightmaps_are_beside_the_file(self):
        self.solve()
        self.interflect("export", "scene.h5", "--lightmap", "-o", "room.glb")
        self.interflect("export", "scene.h5", "--lightmap", "--lightmap-image", "hdr", "-o", "room.gltf")
        self.assertEqual(
            [file for file in self.files() if file.startswith("room")],
            ["room.glb", "room.gltf", "room.lightmap-0.exr", "room.lightmap-0.hdr"],
        )

    def test_warns_of_layouts_that_cannot_be_kept(self):
        self.solve()
        scene = self.export("--lightmap")
        attributes = scene["meshes"][0]["primitives"][0]["attributes"]
        accessor = scene["accessors"][attributes["TEXCOORD_1"]]
        view = scene["bufferViews"][accessor["bufferView"]]
        prefix, _, text = scene["buffers"][view["buffer"]]["uri"].partition(",")
        data = bytearray(base64.b64decode(text))
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        data[start : start + 8 * accessor["count"]] = bytes(8 * accessor["count"])  # all at (0, 0)
        scene["buffers"][view["buffer"]]["uri"] = prefix + "," + base64.b64encode(data).decode()
        (self.folder / "flat.gltf").write_text(json.dumps(scene))
        self.interflect("solve", "flat.gltf", "--rays", "100k", "-o", "scene.h5")
        export = ("export", "scene.h5", "--lightmap", "-o", "out.gltf")
        self.assertIn("the object's lightmap layout", self.interflect(*export).stderr)
        self.assertNotIn("the object's lightmap layout", self.interflect(*export, "--own-charts").stderr)

    def test_refusals(self):
        self.solve()
        before = self.files()
        for arguments, code, message in [
            (("scene.h5", "-o", "room.xyz"), BAD_INPUT, ".glb"),
            (("scene.mgf", "-o", "room.glb"), BAD_INPUT, "scene.mgf"),
            (("missing.h5", "-o", "room.glb"), BAD_INPUT, "missing.h5"),
            (("scene.h5", "-o", "nowhere/room.glb"), BAD_INPUT, "nowhere"),
            (("scene.h5", "-o", "room.glb", "--gutter", "3"), WRONG_USAGE, "--lightmap"),
            (("scene.h5", "-o", "room.glb", "--lightmap", "--lightmap-max-size", "65"), BAD_INPUT, "multiple of 4"),
            (("scene.h5", "-o", "room.glb", "--lightmap", "--texels-per-metre", "0"), WRONG_USAGE, "--texels-per-metre"),
            (("scene.h5", "-o", "room.glb", "--up", "0,0,0"), BAD_INPUT, "up"),
        ]:
            with self.subTest(arguments):
                self.assertIn(message, self.interflect("export", *arguments, exit_code=code).stderr)
                self.assertEqual(self.files(), before)


if __name__ == "__main__":
    unittest.main()
