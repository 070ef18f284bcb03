"""The module against the command: the same bits for the same scene, settings and seed."""

import unittest
from contextlib import chdir

import command
import interflect as ifl
import numpy as np


class SameAsTheCommand(command.RenderTest):
    def setUp(self):
        super().setUp()
        self.enterContext(chdir(self.folder))  # solution files contain the path of the scene as it was given
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

    def test_solution(self):
        ifl.solve("room.mgf", view="door", rays=50_000, mesh_size=0.5).save("solved.h5")
        self.assertEqual(self.bytes("solved.h5"), self.bytes("room.h5"))

    def test_published_algorithm(self):
        settings = ("--preset", "paper", "--separate-iterations", "--defer-refinement", "--seed", "7", "--rays", "30k")
        self.interflect("solve", "room.mgf", "-o", "paper.h5", "--view", "door", *settings)
        solution = ifl.solve(
            "room.mgf", view="door", preset="paper", separate_iterations=True, defer_refinement=True, seed=7, rays=30e3
        )
        np.testing.assert_array_equal(solution.irradiance, ifl.open_solution("paper.h5").irradiance)

    def test_pictures(self):
        view = self.solution.scene.views[1]
        for shading in ("hybrid", "gather", "smooth", "flat", "path"):
            with self.subTest(shading):
                self.render(f"command/{shading}.exr", "--view", view.name, "--shading", shading, source="room.h5")
                picture = ifl.render(self.solution, view.name, width=32, height=18, samples=4, shading=shading)
                np.testing.assert_array_equal(picture, ifl.read_image(f"command/{shading}.exr"))

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
            ("ply", {}, ()),
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

    def test_run_that_is_saved_continues_as_if_it_was_not(self):
        with ifl.Solver("room.mgf", views="door", rays=100_000) as solver:
            solver.advance(rays=30_000)
            solver.save("run.h5")
            with ifl.Solver.open("run.h5") as opened:
                self.assertFalse(opened.advance(rays=30_000).is_finished)
                solver.advance(rays=30_000)
                np.testing.assert_array_equal(solver.solution.irradiance, opened.solution.irradiance)


if __name__ == "__main__":
    unittest.main()
