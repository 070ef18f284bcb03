"""What others make of exported glTF: the Khronos validator, three.js in headless Chromium, and Blender."""

import json
import math
import subprocess
import unittest

from command import ROOT, CommandTest, room, vertices

WEB = ROOT / "tests" / "web"
EXPORTS = {  # by name: options, extension
    "vertices": ((), ".glb"),
    "json": ((), ".gltf"),
    "irradiance": (("--lightmap",), ".glb"),
    "radiance": (("--lightmap", "--lightmap-content", "radiance"), ".glb"),
    "gathered": (("--lightmap", "--shading", "gather", "--samples", "512", "--texels-per-metre", "1"), ".glb"),
    "hdr": (("--lightmap", "--lightmap-image", "hdr", "--lightmap-max-size", "64"), ".gltf"),
}
VIEW = {"name": "camera", "eye": [1, 0.2, 2], "look_at": [1, 2, 0], "up": [0, 0, 1], "fov": 60}
LARGEST_DIFFERENCE = {"vertices": 0.06, "irradiance": 0.06, "radiance": 0.15}  # the last has blurred textures


def srgb(linear):
    """What a display is sent, 0 to 255."""
    return 255 * (12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055)


def linear(byte):
    encoded = byte / 255
    return encoded / 12.92 if encoded <= 0.04045 else ((encoded + 0.055) / 1.055) ** 2.4


class GltfTest(CommandTest):
    def solved(self, text, *options, view=VIEW):
        self.write("scene.mgf", text)
        self.write("scene.views.json", json.dumps({"views": [view]}))
        self.interflect("solve", "scene.mgf", "--rays", "500k", *options, "-o", "scene.h5")

    def textured(self):
        self.interflect("make-scene", "boxes", "--texture", "-o", "boxes.mgf")
        self.interflect("solve", "boxes.mgf", "--rays", "500k", "-o", "scene.h5")

    def export(self, name, *more):
        options, extension = EXPORTS[name]
        self.interflect("export", "scene.h5", *options, *more, "-o", name + extension)
        return self.folder / (name + extension)

    def run_tool(self, *command, **options):
        result = subprocess.run(
            [*map(str, command)], cwd=self.folder, capture_output=True, text=True, timeout=300, **options
        )
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return result.stdout

    def draw(self, file, camera, width, height, *picture):
        """As three.js draws it; run `npm ci --prefix tests/web` where this finds no modules."""
        return json.loads(self.run_tool("node", WEB / "draw.mjs", file, camera, width, height, *picture))

    def import_to_blender(self, file):
        plain = {"HOME": str(self.folder), "PATH": "/usr/bin:/bin"}  # Blender takes its modules from any python3 first
        output = self.run_tool(
            "blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python", WEB / "load_in_blender.py",
            "--", file, env=plain,
        )  # fmt: skip
        return json.loads(next(line for line in output.splitlines() if line.startswith("IMPORTED "))[9:])


class ValidatorTest(GltfTest):
    def check_exports(self):
        files = [self.export(name) for name in EXPORTS]
        for file, report in json.loads(self.run_tool("node", WEB / "validate.mjs", *files)).items():
            issues = report["issues"]
            self.assertEqual((issues["numErrors"], issues["numWarnings"]), (0, 0), f"{file}: {issues['messages'][:5]}")
            self.assertGreater(report["info"]["totalTriangleCount"], 10)

    def test_room(self):
        self.solved(room())
        self.check_exports()

    def test_textures(self):
        self.textured()
        self.check_exports()

    def test_finds_a_fault(self):
        self.solved(room())
        text = self.export("json").read_text().replace('"COLOR_0"', '"COLOUR"')
        file = self.write("broken.gltf", text)
        report = json.loads(self.run_tool("node", WEB / "validate.mjs", file))[str(file)]
        self.assertGreater(report["issues"]["numErrors"], 0)


class ThreeTest(GltfTest):
    # A plate under the open sky: its illuminance is that of the sky by definition, 10,000 lx, and all of it is seen.
    SKY_ILLUMINANCE, REFLECTANCE, EXPOSURE = 10_000, 0.5, -12

    def plate(self, view, *options):
        plate = vertices((0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0))
        paint = f"m paint =\n\tsides 1\n\tc\n\trd {self.REFLECTANCE}\n"
        self.solved(plate + paint + "f v0 v1 v2 v3\n", "--sky", f"overcast:{self.SKY_ILLUMINANCE}", *options, view=view)

    def check_radiance(self, view):
        self.plate(view)
        radiance = self.REFLECTANCE * self.SKY_ILLUMINANCE / math.pi
        expected = radiance * 2**self.EXPOSURE
        for name in EXPORTS:
            drawn = self.draw(self.export(name, "--exposure", self.EXPOSURE), "camera", 16, 16)
            for pixel in drawn["pixels"]:
                for value in pixel:
                    self.assertAlmostEqual(linear(value) / expected, 1, delta=0.02, msg=f"{name}: {srgb(expected)}")

    def test_shows_the_radiance_of_a_grey_plate_from_above(self):
        self.check_radiance({**VIEW, "eye": [2, 1.9, 1], "look_at": [2, 2, 0], "fov": 60})

    def test_shows_the_same_radiance_at_a_grazing_angle(self):
        self.check_radiance({**VIEW, "eye": [2, 0.05, 0.3], "look_at": [2, 2, 0], "fov": 5})

    def test_draws_the_picture_that_render_draws(self):
        self.textured()
        view = self.json("info", "scene.h5")["views"][0]["name"]
        self.interflect("render", "scene.h5", "--view", view, "--shading", "smooth", "--exposure", "-7",
                        "--size", "320x180", "-o", "render.png")  # fmt: skip
        for name, largest in LARGEST_DIFFERENCE.items():
            self.draw(self.export(name, "--exposure", "-7"), view, 320, 180, f"{name}.png")
            blocks = self.json("compare", f"{name}.png", "render.png")["blocks"]
            relative_rmse = next(b["relative_rmse"] for b in blocks if b["block"] == 9)  # edges differ in single pixels
            self.assertLess(relative_rmse, largest, name)


class BlenderTest(GltfTest):
    def test_loads_every_export(self):
        self.solved(room())
        for name in EXPORTS:
            with self.subTest(name):
                imported = self.import_to_blender(self.export(name))
                # A material has a copy for each image of the lightmap: "paint.001".
                self.assertEqual({m.split(".")[0] for m in imported["materials"]}, {"lamp", "paint"})
                self.assertEqual(imported["cameras"], ["camera"])
                self.assertGreaterEqual(imported["triangles"], 12)
                for found, expected in zip(imported["low"] + imported["high"], [0, 0, 0, 2, 3, 2.5]):
                    self.assertAlmostEqual(found, expected, places=5)

    def test_has_what_the_file_has(self):
        self.textured()
        self.assertEqual(self.import_to_blender(self.export("vertices"))["colours"], ["Col"])
        imported = self.import_to_blender(self.export("irradiance"))
        self.assertEqual(imported["uv_maps"], ["UVMap", "UVMap.001"])


if __name__ == "__main__":
    unittest.main()
