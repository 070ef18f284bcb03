"""The module and the command give equal exports, display pictures and measurements."""

import unittest
from contextlib import chdir

import command
import interflect as ifl
import numpy as np


class Exports(command.RenderTest):
    def setUp(self):
        super().setUp()
        self.enterContext(chdir(self.folder))
        self.solve("--view", "door")
        self.solution = ifl.open_solution("room.h5")
        (self.folder / "module").mkdir()
        (self.folder / "command").mkdir()

    def assert_same_files(self):
        """Compares all files in the two folders."""
        names = sorted(path.name for path in (self.folder / "command").iterdir())
        self.assertEqual(names, sorted(path.name for path in (self.folder / "module").iterdir()))
        for name in names:
            self.assertEqual(self.bytes(f"command/{name}"), self.bytes(f"module/{name}"), name)

    def test_tone_mapped_pictures(self):
        self.render("command/room.png", "--view", "floor", source="room.h5")  # whose noise the command filters
        picture = ifl.render(self.solution, "floor", width=32, height=18, samples=4, denoise=True)
        ifl.write_image("module/room.png", picture)
        self.assert_same_files()

    def test_measurements(self):
        options = ("--plane", "0.75", "--samples", "64")
        self.interflect("probe", "room.h5", *options, "-o", "points.csv")
        rows = np.genfromtxt("points.csv", delimiter=",", skip_header=1, usecols=range(5))
        scene = self.solution.scene
        grid = ifl.area_grid(scene, ifl.find_floor(scene, 0.75), height=0.75)
        measured = ifl.probe(self.solution, grid, samples=64)
        self.assertEqual(len(rows), len(measured))
        np.testing.assert_allclose(rows[:, :3], grid.points, rtol=1e-5)
        np.testing.assert_allclose(rows[:, 3], measured.illuminance, rtol=1e-5)  # the table has six digits
        np.testing.assert_allclose(rows[:, 4], measured.illuminance_error, rtol=5e-3)  # three digits

    def test_exports(self):
        lightmap = {"lightmap": True, "texels_per_metre": 4}
        for extension, settings, options in (
            ("glb", {}, ()),
            ("gltf", lightmap, ("--lightmap", "--texels-per-metre", "4")),
            ("ply", {"max_triangles": 300}, ("--max-triangles", "300")),
            ("obj", {"samples": 16, "seed": 3}, ("--samples", "16", "--seed", "3")),
            ("vtu", {}, ()),
            ("json", {"rays": 64}, ("--probe-rays", "64")),
        ):
            self.interflect("export", "room.h5", "-o", f"command/room.{extension}", *options)
            files = ifl.export(self.solution, f"module/room.{extension}", **settings)
            self.assertIn(f"room.{extension}", [path.name for path in files])
        self.assert_same_files()

    def test_export_of_the_scene_warns(self):
        self.interflect("export", "room.mgf", "-o", "command/room.rad")
        with self.assertWarnsRegex(ifl.Warning, "light passes"):
            ifl.export_scene(ifl.load("room.mgf"), "module/room.rad")
        self.assert_same_files()


if __name__ == "__main__":
    unittest.main()
