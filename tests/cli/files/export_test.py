"""`interflect export`: outputs, refusals, and no partial files after a failure."""

import base64
import json
import struct
import unittest
import zlib

from command import BAD_INPUT, WRONG_USAGE, CommandTest, room, vertices

def png_texels(png):
    position, data = 8, b""
    while position < len(png):
        length, kind = struct.unpack(">I4s", png[position : position + 8])
        chunk = png[position + 8 : position + 8 + length]
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", chunk[:10])
            assert (depth, colour) == (8, 2)
        if kind == b"IDAT":
            data += chunk
        position += 12 + length
    data, row, above, texels = zlib.decompress(data), 3 * width, bytes(3 * width), []
    for y in range(height):
        kind, line = data[y * (row + 1)], bytearray(data[y * (row + 1) + 1 : (y + 1) * (row + 1)])
        for x in range(row):
            a, b, c = line[x - 3] if x >= 3 else 0, above[x], above[x - 3] if x >= 3 else 0
            paeth = min((a, b, c), key=lambda value: abs(a + b - c - value))
            line[x] = line[x] + (0, a, b, (a + b) // 2, paeth)[kind] & 255
        above = line
        texels += [tuple(line[x : x + 3]) for x in range(0, row, 3)]
    return texels


SHIFTED = "xf -t 1000000 2000000 0\n"
# By default the direct light of thousands of triangles and texels is traced.
FEW_TRIANGLES = ("--max-triangles", "300")
FEW_TEXELS = ("--lightmap", "--texels-per-metre", "4")
SMOOTH_LIGHTMAP = ("--lightmap", "--shading", "smooth")


class Export(CommandTest):
    def solve(self, text=None):
        self.write("scene.mgf", text or room())
        self.write_solution("scene.h5", "scene.mgf", "--rays", "100k")

    def export(self, *arguments):
        self.interflect("export", "scene.h5", *arguments, "-o", "out.gltf")
        return json.loads((self.folder / "out.gltf").read_text())

    def test_same_bytes_each_time(self):
        self.solve()
        for options in (FEW_TRIANGLES, FEW_TEXELS, (*FEW_TEXELS, "--shading", "gather", "--samples", "8")):
            self.interflect("export", "scene.h5", *options, "-o", "a.glb")
            self.interflect("export", "scene.h5", *options, "-o", "b.glb")
            self.assertEqual(self.bytes("a.glb").replace(b"a.lightmap", b"b.lightmap"), self.bytes("b.glb"), options)

    def test_exposure_is_recorded(self):
        self.solve()
        self.assertEqual(self.export("--shading", "smooth", "--exposure", "-3.5")["asset"]["extras"]["interflect"]["exposure"], -3.5)

    def test_up_and_origin(self):
        self.solve(SHIFTED + room() + "xf\n")
        root = self.export("--shading", "smooth", "--up", "0,0,1")["nodes"][-1]
        self.assertAlmostEqual(root["rotation"][0], -(0.5**0.5))  # a quarter turn back about x: z becomes y, y becomes -z
        self.assertAlmostEqual(root["rotation"][3], 0.5**0.5)
        for found, expected in zip(root["translation"], (1e6, 0, -2e6)):
            self.assertAlmostEqual(found, expected, delta=10)
        self.assertEqual(self.export("--shading", "smooth", "--up", "0,1,0")["nodes"][-1]["rotation"], [0, 0, 0, 1])

    def solve_groups(self):
        lamps = room().replace("m lamp", "m left") + "m right =\n\tsides 1\n\tc\n\trd 0\n\ted 50\n"
        corners = "".join(f"v w{k} =\n\tp {x} {y} 2.3\n" for k, (x, y) in enumerate([(0.1, 0.1), (0.1, 0.5), (0.5, 0.5), (0.5, 0.1)]))
        self.write("scene.mgf", lamps + corners + "f w0 w1 w2 w3\n")
        self.write_solution("scene.h5", "scene.mgf", "--rays", "100k", "--group", "l=left", "--group", "r=right")

    def colours(self, attribute, *arguments):
        scene, values = self.export(*FEW_TRIANGLES, *arguments), []
        data = base64.b64decode(scene["buffers"][0]["uri"].partition(",")[2])
        for mesh in scene["meshes"]:
            for primitive in mesh["primitives"]:
                accessor = scene["accessors"][primitive["attributes"][attribute]]
                start = scene["bufferViews"][accessor["bufferView"]]["byteOffset"]
                values += struct.iter_unpack("<3f", data[start : start + 12 * accessor["count"]])
        return values

    def irradiance(self, *arguments):
        return sum(map(sum, self.colours("_IRRADIANCE", "--exposure", "0", *arguments)))

    def lightmap(self, *arguments):
        scene = self.export("--lightmap", *arguments)
        data = base64.b64decode(scene["buffers"][0]["uri"].partition(",")[2])
        view = scene["bufferViews"][scene["images"][0]["bufferView"]]
        texels = png_texels(data[view["byteOffset"] : view["byteOffset"] + view["byteLength"]])
        return [[(((c / 255) + 0.055) / 1.055) ** 2.4 if c > 10 else c / 255 / 12.92 for c in texel] for texel in texels]

    # The lamp is orange. Clamping each channel makes bright colours whiter.
    def test_bright_colours_keep_their_hue(self):
        self.solve(room("m lamp =\n\tc\n\t\tcxy .5 .4\n\tsides 1\n\ted 1000\n"))
        self.assertGreater(self.check_hue(self.colours("COLOR_0", "--exposure", "-12"),
                                          self.colours("COLOR_0", "--exposure", "4"), 1e-5), 10)  # fmt: skip
        content = ("--lightmap-content", "radiance", "--texels-per-metre", "2")
        self.assertGreater(self.check_hue(self.lightmap("--exposure", "-6", *content),
                                          self.lightmap("--exposure", "4", *content), 0.05), 10)  # fmt: skip

    def check_hue(self, dim, bright, tolerance):
        """Compares the chromaticity of all scaled colours. Returns their number."""
        pairs = [(d, b) for d, b in zip(dim, bright) if 0 < d[2] and max(d) > 1e-3 and max(b) > 0.999]
        for d, b in pairs:
            for k in range(3):
                self.assertAlmostEqual(b[k], d[k] / max(d), delta=tolerance)
        return len(pairs)

    def test_dims_light_groups(self):
        self.solve_groups()
        left, right = self.irradiance("--dim", "r=0"), self.irradiance("--dim", "l=0")
        self.assertGreater(min(left, right), 0)
        self.assertAlmostEqual(self.irradiance("--dim", "r=0", "--dim", "l=0.5") / left, 0.5, places=3)
        result = self.interflect("export", "scene.h5", "--dim", "x=1", "-o", "out.glb", exit_code=BAD_INPUT)
        self.assertIn("'l'", result.stderr)
        self.interflect("export", "scene.mgf", "--dim", "l=1", "-o", "out.rad", exit_code=WRONG_USAGE)

    def test_lightmaps_of_all_dimmed_states_fit_one_mesh(self):
        """A lamp in a closed box of sheets: without it, the box is dark inside."""
        corners = [(x, y, z) for z in (1, 1.5) for y in (1, 1.5) for x in (1, 1.5)]
        box = "f v0 v2 v3 v1\nf v4 v5 v7 v6\nf v0 v4 v6 v2\nf v1 v3 v7 v5\nf v0 v1 v5 v4\nf v2 v6 v7 v3\n"
        sheet = "m sheet =\n\tsides 2\n\tc\n\trd .5\n"
        lamp = "m left =\n\tsides 1\n\tc\n\trd .1\n\ted 50\n"
        panel, back = (vertices((1.2, 1.2, z), (1.2, 1.3, z), (1.3, 1.3, z), (1.3, 1.2, z)) for z in (1.4, 1.41))
        face = "f v0 v1 v2 v3\n"
        self.write("scene.mgf", "o lit\n" + lamp + panel + face + sheet + back + face + vertices(*corners) + box + "o\n"
                   + room().replace("m lamp", "m right"))  # fmt: skip
        self.interflect("solve", "scene.mgf", "--rays", "100k", "--group", "l=left", "--group", "r=right", "-o", "scene.h5")
        undimmed = self.layout()
        for dimming in (("--dim", "l=0"), ("--dim", "r=0"), ("--dim", "l=0", "--dim", "r=0"), ("--dim", "l=0.5", "--dim", "r=2")):
            with self.subTest(dimming):
                self.assertEqual(self.layout(*dimming), undimmed)

    def layout(self, *arguments):
        """Returns positions and coordinates of a mesh with lightmaps."""
        scene = self.export("--lightmap", "--texels-per-metre", "2", *arguments)
        data = base64.b64decode(scene["buffers"][0]["uri"].partition(",")[2])
        values = []
        for mesh in scene["meshes"]:
            for primitive in mesh["primitives"]:
                for name, number in sorted([*primitive["attributes"].items(), ("indices", primitive["indices"])]):
                    view = scene["bufferViews"][scene["accessors"][number]["bufferView"]]
                    values.append((mesh["name"], name, data[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]))
        return values

    def test_lists_light_groups(self):
        self.solve_groups()
        self.assertEqual(self.json("info", "scene.h5")["light_groups"], ["l", "r"])
        self.assertIn("groups    l, r", self.interflect("info", "scene.h5").stdout)

    def test_writes_lightmaps_of_light_groups(self):
        self.solve_groups()
        described = self.export(*FEW_TEXELS, "--lightmap-groups")["asset"]["extras"]["interflect"]["lightmap"]
        files = [[f"out.gltf.lightmap-0-group-{g}.exr"] for g in (0, 1)]
        self.assertEqual(described["groups"], [{"name": n, "unclamped": f} for n, f in zip("lr", files)])
        self.assertTrue({name for of_group in files for name in of_group} <= set(self.files()))
        self.solve()
        result = self.interflect("export", "scene.h5", "--lightmap", "--lightmap-groups", "-o", "a.glb", exit_code=BAD_INPUT)
        self.assertIn("light groups", result.stderr)
        self.assertNotIn("a.glb", self.files())

    def test_threads_do_not_change_the_result(self):
        self.solve()
        gathered = (*FEW_TEXELS, "--shading", "gather", "--samples", "8")
        for threads, name in (("1", "a.glb"), ("2", "b.glb")):
            self.interflect("export", "scene.h5", *gathered, "--threads", threads, "-o", name)
        self.assertEqual(self.bytes("a.glb").replace(b"a.lightmap", b"b.lightmap"), self.bytes("b.glb"))

    def test_lightmaps_are_beside_the_file(self):
        self.solve()
        self.interflect("export", "scene.h5", *SMOOTH_LIGHTMAP, "-o", "room.glb")
        self.interflect("export", "scene.h5", *SMOOTH_LIGHTMAP, "--lightmap-image", "hdr", "-o", "room.gltf")
        self.assertEqual(
            [file for file in self.files() if file.startswith("room")],
            ["room.glb", "room.gltf", "room.gltf.lightmap-0.hdr", "room.lightmap-0.exr"],
        )

    def test_warns_of_layouts_that_cannot_be_kept(self):
        self.solve()
        scene = self.export(*SMOOTH_LIGHTMAP)
        del scene["asset"]["extras"]  # otherwise the reader would ignore its layouts
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
        export = ("export", "scene.h5", *SMOOTH_LIGHTMAP, "-o", "out.gltf")
        self.assertIn("the object's lightmap layout", self.interflect(*export).stderr)
        self.assertNotIn("the object's lightmap layout", self.interflect(*export, "--own-charts").stderr)

    def test_quality_sets_what_is_not_given(self):
        def image(*options):
            self.export(*SMOOTH_LIGHTMAP, *options)
            return self.bytes("out.gltf.lightmap-0.exr")

        self.solve()
        for quality, texels in ("low", "10"), ("medium", "20"), ("high", "40"):
            self.assertEqual(image("--quality", quality), image("--texels-per-metre", texels))
        self.assertEqual(image("--quality", "high", "--texels-per-metre", "5"), image("--texels-per-metre", "5"))

    def test_quality_sets_samples_and_triangles(self):
        def mesh(*options):
            self.export("--min-edge", "0.5", "--max-edge", "0.5", *options)
            return self.bytes("out.gltf")

        self.solve()
        for shading in "hybrid", "gather":
            low = mesh("--quality", "low", "--shading", shading)
            self.assertEqual(low, mesh("--samples", "16", "--max-triangles", "50000", "--shading", shading))
            self.assertNotEqual(low, mesh("--quality", "low", "--samples", "8", "--shading", shading))
            self.assertNotEqual(low, mesh("--quality", "low", "--max-triangles", "60", "--shading", shading))

    def test_min_edge_may_exceed_the_usual_max_edge(self):
        self.solve()
        self.export("--min-edge", "1")
        coarse = len(self.bytes("out.gltf"))
        self.export("--min-edge", "0.4")
        self.assertGreater(len(self.bytes("out.gltf")), coarse)

    def test_refusals(self):
        self.solve()
        before = self.files()
        for arguments, code, message in [
            (("scene.h5", "-o", "room.xyz"), WRONG_USAGE, ".glb"),
            (("scene.mgf", "-o", "room.glb"), BAD_INPUT, "scene.mgf"),
            (("missing.h5", "-o", "room.glb"), BAD_INPUT, "missing.h5"),
            (("scene.h5", "-o", "nowhere/room.glb"), BAD_INPUT, "nowhere"),
            (("scene.h5", "-o", "room.glb", "--gutter", "3"), WRONG_USAGE, "--lightmap"),
            (("scene.h5", "-o", "room.glb", "--lightmap", "--lightmap-max-size", "65"), WRONG_USAGE, "multiple of 4"),
            (("scene.h5", "-o", "room.glb", "--lightmap", "--texels-per-metre", "0"), WRONG_USAGE, "--texels-per-metre"),
            (("scene.h5", "-o", "room.glb", "--up", "0,0,0"), WRONG_USAGE, "up"),
            (("scene.h5", "-o", "room.glb", "--lightmap", "--max-triangles", "9"), WRONG_USAGE, "--max-triangles"),
            (("scene.h5", "-o", "room.glb", "--lightmap", "--update", "wall"), BAD_INPUT, "is not there"),
            (("scene.h5", "-o", "room.glb", "--lightmap", "--update", "wall", "--exposure", "1"), WRONG_USAGE, "--exposure"),
            (("scene.mgf", "-o", "room.glb", "--lightmap", "--lightmap-content", "density"), BAD_INPUT, "expected a solution"),
            (("scene.h5", "-o", "room.vtu", "--max-triangles", "9"), WRONG_USAGE, "--max-triangles"),
            (("scene.h5", "-o", "room.glb", "--shading", "smooth", "--min-edge", "1"), WRONG_USAGE, "--min-edge"),
            (("scene.h5", "-o", "room.glb", "--shading", "smooth", "--quality", "low"), WRONG_USAGE, "--quality"),
        ]:
            with self.subTest(arguments):
                self.assertIn(message, self.interflect("export", *arguments, exit_code=code).stderr)
                self.assertEqual(self.files(), before)


if __name__ == "__main__":
    unittest.main()
