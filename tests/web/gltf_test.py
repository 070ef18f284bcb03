"""Reads exported glTF with other programs: the Khronos validator, engines in Chromium, Godot, and Blender."""

import base64
import json
import math
import shutil
import subprocess
import unittest

from command import ROOT, CommandTest, room, vertices

WEB = ROOT / "tests" / "web"
EXPORTS = {  # by name: options, extension
    "vertices": (("--shading", "smooth"), ".glb"),
    "json": ((), ".gltf"),
    "irradiance": (("--lightmap", "--shading", "smooth"), ".glb"),
    "radiance": (("--lightmap", "--shading", "smooth", "--lightmap-content", "radiance"), ".glb"),
    "gathered": (("--lightmap", "--shading", "gather", "--texels-per-metre", "1"), ".glb"),
    "hdr": (("--lightmap", "--shading", "smooth", "--lightmap-image", "hdr", "--lightmap-max-size", "64"), ".gltf"),
}
VIEW = {"name": "camera", "eye": [1, 0.2, 2], "look_at": [1, 2, 0], "up": [0, 0, 1], "fov": 60}
FEW = {"json": ("--max-triangles", "300"), "gathered": ("--samples", "8")}  # by name: less work where light does not matter
LARGEST_DIFFERENCE = {"vertices": 0.06, "irradiance": 0.06, "radiance": 0.15}  # the last has blurred textures


def srgb(linear):
    """Returns the display value, 0 to 255."""
    return 255 * (12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055)


def linear(byte):
    encoded = byte / 255
    return encoded / 12.92 if encoded <= 0.04045 else ((encoded + 0.055) / 1.055) ** 2.4


class GltfTest(CommandTest):
    def solved(self, text, *options, views=(VIEW,)):
        self.write("scene.mgf", text)
        self.write("scene.views.json", json.dumps({"views": views}))
        rays = () if "--rays" in options else ("--rays", "500k")
        self.write_solution("scene.h5", "scene.mgf", *rays, *options)

    def textured(self):
        self.interflect("make-scene", "boxes", "--texture", "-o", "boxes.mgf")
        self.write_solution("scene.h5", "boxes.mgf", "--rays", "500k")

    def export(self, name, *more, prefix=""):
        options, extension = EXPORTS[name]
        file = prefix + name + extension
        self.interflect("export", "scene.h5", *options, *more, "-o", file)
        return self.folder / file

    def run_tool(self, *command, **options):
        result = subprocess.run(
            [*map(str, command)], cwd=self.folder, capture_output=True, text=True, timeout=300, **options
        )
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return result.stdout

    def draw_with(self, engines, views):
        """Draws (camera, size, file) into FILE.CAMERA.ENGINE.png; modules are from `npm ci --prefix tests/web`."""
        arguments = [argument for view in views for argument in view]
        drawn = json.loads(self.run_tool("node", WEB / "draw.mjs", ",".join(engines), *arguments))
        for picture in (picture for pictures in drawn.values() for picture in pictures):
            values = base64.b64decode(picture["pixels"])
            picture["pixels"] = [tuple(values[k : k + 3]) for k in range(0, len(values), 4)]
        return drawn

    def draw(self, files, camera, width, height):
        return self.draw_with(["three"], [(camera, f"{width}x{height}", file) for file in files])["three"]

    def check_picture(self, picture, largest_difference):
        blocks = self.json("compare", picture, "render.png")["blocks"]
        relative_rmse = next(b["relative_rmse"] for b in blocks if b["block"] == 9)  # edges differ in single pixels
        self.assertLess(relative_rmse, largest_difference, picture)

    def import_to_blender(self, *files):
        plain = {"HOME": str(self.folder), "PATH": "/usr/bin:/bin"}  # Blender takes its modules from any python3 first
        output = self.run_tool(
            "blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python", WEB / "load_in_blender.py",
            "--", *files, env=plain,
        )  # fmt: skip
        return [json.loads(line[9:]) for line in output.splitlines() if line.startswith("IMPORTED ")]


class ValidatorTest(GltfTest):
    def check_exports(self):
        files = [self.export(name, *FEW.get(name, ())) for name in EXPORTS]
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
        text = self.export("json", *FEW["json"]).read_text().replace('"COLOR_0"', '"COLOUR"')
        file = self.write("broken.gltf", text)
        report = json.loads(self.run_tool("node", WEB / "validate.mjs", file))[str(file)]
        self.assertGreater(report["issues"]["numErrors"], 0)


class PlateTest(GltfTest):
    # A plate under an unobstructed sky: its illuminance is the sky's, 10,000 lx.
    SKY_ILLUMINANCE, REFLECTANCE, EXPOSURE = 10_000, 0.5, -12
    ABOVE = {**VIEW, "name": "above", "eye": [2, 1.9, 1], "look_at": [2, 2, 0]}
    GRAZING = {**VIEW, "name": "grazing", "eye": [2, 0.05, 0.3], "look_at": [2, 2, 0], "fov": 5}

    def plate(self, *views):
        plate = vertices((0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0))
        paint = f"m paint =\n\tsides 1\n\tc\n\trd {self.REFLECTANCE}\n"
        self.solved(plate + paint + "f v0 v1 v2 v3\n", "--sky", f"overcast:{self.SKY_ILLUMINANCE}", views=views)

    def export_plate(self, name, *options):
        return self.export(name, "--exposure", self.EXPOSURE, *options)

    def check_radiance(self, drawn, name, low=0.98, high=1.02):
        """Checks every pixel relative to the radiance of a diffuse plate."""
        expected = self.REFLECTANCE * self.SKY_ILLUMINANCE / math.pi * 2**self.EXPOSURE
        values = [linear(value) / expected for value in {value for pixel in drawn["pixels"] for value in pixel}]
        self.assertGreater(min(values), low, f"{name}: {srgb(expected)}")
        self.assertLess(max(values), high, f"{name}: {srgb(expected)}")


class ThreeTest(PlateTest):
    # One test, because the start of a browser takes longer than the pictures.
    def test_shows_the_radiance_of_a_grey_plate_from_above_and_at_a_grazing_angle(self):
        self.plate(self.ABOVE, self.GRAZING)
        more = {"gathered": ("--samples", "512")}
        files = [self.export_plate(name, *more.get(name, ())) for name in EXPORTS]
        views = [(camera, "16x16", file) for camera in ("above", "grazing") for file in files]
        drawn = self.draw_with(["three"], views)["three"]
        for (camera, _, file), picture in zip(views, drawn, strict=True):
            self.check_radiance(picture, f"{file.stem} {camera}")

    def test_shows_the_lit_room_in_metals(self):
        self.solved(room())
        lit = json.loads(self.export("hdr").read_text())
        for material in lit["materials"]:
            if material["name"] == "paint":
                material["pbrMetallicRoughness"] |= {"metallicFactor": 1, "roughnessFactor": 1}
                del material["extensions"]["KHR_materials_specular"]
        (drawn,) = self.draw([self.write("metal.gltf", json.dumps(lit))], "camera", 16, 16)  # of paint alone
        self.assertGreater(sorted(map(max, drawn["pixels"]))[len(drawn["pixels"]) // 2], 0)

    def test_draws_the_picture_that_render_draws(self):
        self.textured()
        view = self.json("info", "scene.h5")["views"][0]["name"]
        self.interflect("render", "scene.h5", "--view", view, "--shading", "smooth", "--exposure", "-7",
                        "--size", "320x180", "-o", "render.png")  # fmt: skip
        files = [self.export(name, "--exposure", "-7") for name in LARGEST_DIFFERENCE]
        self.draw(files, view, 320, 180)
        for file, largest in zip(files, LARGEST_DIFFERENCE.values(), strict=True):
            self.check_picture(f"{file}.{view}.three.png", largest)


class EnginesTest(PlateTest):
    """integrations/babylon, playcanvas and godot: lightmaps in other engines than three.js, and the brightest ones in all."""

    ENGINES = {"babylon": (0.97, 0.995), "playcanvas": (0.955, 0.97)}  # share of diffuse light that gloss leaves
    REFLECTANCE, EXPOSURE = 0.02, -7  # light is 25 times white, 3 times the largest value of 8 bits
    SIZE, PLATE_SIZE = "320x180", "16x16"
    GODOT_PROJECT = """config_version=4
[display]
window/size/width=320
window/size/height=180
[rendering]
environment/default_clear_color=Color(0, 0, 0, 1)
"""
    GODOT_IMPORT = """[remap]
importer="scene"
type="PackedScene"
[params]
nodes/custom_script="res://lightmap_import.gd"
materials/storage=0
"""
    # The editor imports the files of a project when it starts, but does not end by itself. It starts faster with GLES 2.
    GODOT_COMMANDS = """
godot3 -e --video-driver GLES2 --disable-render-loop --audio-driver Dummy --path . & editor=$!
for _ in $(seq 600); do
  sleep 0.2
  [ "$(ls .import/*.glb-*.md5 2>/dev/null | wc -l)" = 2 ] && break
done
kill $editor
wait $editor
exec godot3 --audio-driver Dummy --path . -s draw_in_godot.gd "$@"
"""

    def edited(self, name, edit):
        """Returns the plate's file with another material."""
        plate = json.loads(self.export_plate("hdr").read_text())
        edit(plate["materials"][0])
        return self.write(name + ".gltf", json.dumps(plate))

    def plates(self):
        def make_glossy(material):
            del material["extensions"]["KHR_materials_specular"]

        def make_metallic(material):
            make_glossy(material)
            material["pbrMetallicRoughness"]["metallicFactor"] = 1

        self.plate(self.ABOVE, self.GRAZING)
        diffuse, glossy = self.export_plate("irradiance"), self.edited("glossy", make_glossy)
        metal = self.edited("metal", make_metallic)
        views = ("above", diffuse), ("grazing", diffuse), ("above", glossy), ("above", metal)
        return [(camera, self.PLATE_SIZE, file) for camera, file in views]

    def boxes(self):
        """Renders and exports textured boxes."""
        self.textured()
        view = self.json("info", "scene.h5")["views"][0]["name"]
        self.interflect("render", "scene.h5", "--view", view, "--shading", "smooth", "--exposure", self.EXPOSURE,
                        "--size", self.SIZE, "-o", "render.png")  # fmt: skip
        self.interflect("export", "scene.h5", *EXPORTS["irradiance"][0], "--exposure", self.EXPOSURE, "-o", "boxes.glb")
        return view, self.SIZE, self.folder / "boxes.glb"

    def draw_with_godot(self, *views):
        """Draws with Debian's Godot 3, in the project's size, on a virtual screen: without one it imports no materials."""
        self.write("project.godot", self.GODOT_PROJECT)
        shutil.copy(ROOT / "integrations" / "godot" / "lightmap_import.gd", self.folder)
        shutil.copy(WEB / "draw_in_godot.gd", self.folder)
        for file in {file.name for _, _, file in views}:
            self.write(file + ".import", self.GODOT_IMPORT)
        plain = {"HOME": str(self.folder), "PATH": "/usr/bin:/bin", "LANG": "C.UTF-8"}
        arguments = [f"{file.name}:{camera}" for camera, _, file in views]
        output = self.run_tool("xvfb-run", "-a", "bash", "-c", self.GODOT_COMMANDS, "bash", *arguments, env=plain)
        return [{"pixels": [json.loads(line[6:])]} for line in output.splitlines() if line.startswith("DRAWN ")]

    # One test, because the start of a browser and of an engine takes longer than the pictures. It fails if a loader drops
    # pi, the reflectance, the intensity (which contains the exposure), the gain, or the share of light that gloss takes.
    def test_show_the_radiance(self):
        plates, boxes = self.plates(), self.boxes()
        pictures = self.draw_with(["three", *self.ENGINES], [*plates, boxes])
        pictures["godot"] = self.draw_with_godot(*plates[:2], boxes)
        for engine, (above, grazing, *others) in pictures.items():
            with self.subTest(engine):
                self.check_radiance(above, "above")
                self.check_radiance(grazing, "grazing")
                if engine in self.ENGINES:
                    glossy, metal, _ = others
                    self.check_radiance(glossy, "gloss, which takes some percent", *self.ENGINES[engine])
                    self.check_radiance(metal, "metal, which has no diffuse light", -1, 0.01)
                self.check_picture(f"{boxes[2]}.{boxes[0]}.{engine}.png", LARGEST_DIFFERENCE["irradiance"])


class TransformTest(GltfTest):
    """integrations/gltf-transform in glTF Transform, which drops extensions that it does not know."""

    def optimized(self, file, *config):
        modules = self.folder / "node_modules"
        if not modules.exists():
            modules.symlink_to(WEB / "node_modules")
            for script in ("lightmap.mjs", "config.mjs"):
                shutil.copy(ROOT / "integrations" / "gltf-transform" / script, self.folder)
        small = self.folder / f"small-{file.name}"
        self.run_tool("node", WEB / "optimize.mjs", file, small, *config)
        return small

    def test_keeps_lightmaps_of_files_that_it_optimizes(self):
        self.textured()
        view = self.json("info", "scene.h5")["views"][0]["name"]
        file = self.export("irradiance", "--exposure", "-7")
        small = self.optimized(file, "config.mjs")
        before, after = (drawn["pixels"] for drawn in self.draw([file, small], view, 160, 90))
        differences = [abs(a - b) for p, q in zip(before, after, strict=True) for a, b in zip(p, q, strict=True)]
        self.assertGreater(sum(map(sum, before)), 0)
        self.assertLess(sum(differences) / len(differences), 1.5)  # of 255; rounded coordinates move edges

    def test_loses_lightmaps_without_the_extension(self):
        self.textured()
        small = self.optimized(self.export("irradiance"))
        self.assertNotIn(b"MOZ_lightmap", small.read_bytes())


class EdgesTest(GltfTest):
    """A closed white room of slabs: parts of the floor and of the ceiling are dark, below and above walls."""

    VIEW = {"name": "camera", "eye": [0.3, 1.6, 1.3], "look_at": [3, 6, 1.4], "up": [0, 0, 1], "fov": 70}
    SIZE = WIDTH, HEIGHT = 480, 270
    LOW, HIGH, THICKNESS = (0, 0, 0), (4, 6, 2.8), 0.2

    def box(self, low, high):
        corners = vertices(*((x, y, z) for z in (low[2], high[2]) for y in (low[1], high[1]) for x in (low[0], high[0])))
        return corners + "f v0 v2 v3 v1\nf v4 v5 v7 v6\nf v0 v4 v6 v2\nf v1 v3 v7 v5\nf v0 v1 v5 v4\nf v2 v6 v7 v3\n"

    def slabs(self, sides):
        (x, y, z), t = self.HIGH, self.THICKNESS
        walls = [((-t, -t, 0), (0, y + t, z)), ((x, -t, 0), (x + t, y + t, z)),
                 ((0, -t, 0), (x, 0, z)), ((0, y, 0), (x, y + t, z))]  # fmt: skip
        floor_and_ceiling = [((-t, -t, h), (x + t, y + t, h + t)) for h in (-t, z)]
        paint = f"m white =\n\tsides {sides}\n\tc\n\trd 0.8\n"
        lamp = "m lamp =\n\tc\n\trd 0.5\n\ted 1000\n" + self.box((1, 0.4, 0.1), (3, 1.4, 0.2))  # behind the camera
        return paint + "".join(self.box(*slab) for slab in walls + floor_and_ceiling) + lamp

    def dips(self, pixels):
        """Counts pixels darker than 0.8 of both opposite neighbours at distance one or two: lines, not creases."""
        light = [sum(map(linear, pixel)) for pixel in pixels]
        at = lambda x, y: light[y * self.WIDTH + x]  # noqa: E731
        steps = [(k * dx, k * dy) for k in (1, 2) for dx, dy in ((1, 0), (0, 1), (1, 1), (1, -1))]
        return sum(
            any(at(x, y) < 0.8 * min(at(x + dx, y + dy), at(x - dx, y - dy)) for dx, dy in steps)
            for y in range(2, self.HEIGHT - 2)
            for x in range(2, self.WIDTH - 2)
        )

    # Before encased patches were omitted, 155 and 430 pixels of the picture of the vertices were dark.
    def test_no_dark_lines_along_the_edges_of_one_sided_and_two_sided_walls(self):
        files = []
        for sides in (1, 2):
            self.solved(self.slabs(sides), "--rays", "4M", "--min-area", "0.01", views=(self.VIEW,))
            files += [self.export(name, "--exposure", "-9", prefix=f"{sides}-") for name in ("vertices", "irradiance")]
        for file, drawn in zip(files, self.draw(files, "camera", *self.SIZE), strict=True):
            self.assertEqual(self.dips(drawn["pixels"]), 0, file.name)


class BlenderTest(GltfTest):
    # One test, because Blender takes longer to start than to import.
    def test_loads_every_export_with_what_the_file_has(self):
        self.solved(room())
        files = [self.export(name, *FEW.get(name, ())) for name in EXPORTS]
        self.textured()
        textured = [self.export(name, prefix="textured-") for name in ("vertices", "irradiance")]
        *of_room, with_colours, with_lightmap = self.import_to_blender(*files, *textured)
        for name, imported in zip(EXPORTS, of_room, strict=True):
            with self.subTest(name):
                # A material has a copy for each image of the lightmap: "paint.001".
                self.assertEqual({m.split(".")[0] for m in imported["materials"]}, {"lamp", "paint"})
                self.assertEqual(imported["cameras"], ["camera"])
                self.assertGreaterEqual(imported["triangles"], 12)
                for found, expected in zip(imported["low"] + imported["high"], [0, 0, 0, 2, 3, 2.5]):
                    self.assertAlmostEqual(found, expected, places=5)
        self.assertEqual(with_colours["colours"], ["Col"])
        self.assertEqual(with_lightmap["uv_maps"], ["UVMap", "UVMap.001"])


if __name__ == "__main__":
    unittest.main()
