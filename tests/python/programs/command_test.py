"""The module gives the bits of the command."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

import interflect as ifl

ROOT = Path(__file__).resolve().parents[3]
COMMAND = os.environ["INTERFLECT_COMMAND"]
FRESH_PROCESS = """
import sys, interflect as ifl
import numpy as np
np.save(sys.argv[1], ifl.render(ifl.solve("scenes/office.mgf", view="desk", rays=5e4), width=48, height=27))
"""


class SameBits(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def interflect(self, *arguments):
        subprocess.run([COMMAND, *map(str, arguments)], cwd=ROOT, check=True, capture_output=True)

    def test_of_a_picture(self):
        subprocess.run([sys.executable, "-B", "-c", FRESH_PROCESS, self.folder / "python.npy"], cwd=ROOT, check=True)
        # The size of the picture is part of the view that the command solves for.
        self.interflect("solve", "scenes/office.mgf", "--view", "desk", "--rays", "50k", "-o", self.folder / "office.h5")
        self.interflect("render", self.folder / "office.h5", "--view", "desk", "--size", "48x27", "-o", self.folder / "command.exr")
        np.testing.assert_array_equal(np.load(self.folder / "python.npy"), ifl.read_image(self.folder / "command.exr"))

    def test_of_a_picture_without_options(self):
        """Of small faces far away: most pixels are empty. tests/cli/pictures/default_picture_test.cpp compares with C++."""
        scene = ifl.Scene([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (0, 1, 1), (1, 1, 1), (1, 0, 1)],
                          [(0, 1, 2, 3), (4, 5, 6, 7)], materials=[ifl.Material("floor", 0.5), ifl.Material("lamp", 0.5, 100)],
                          face_materials=[0, 1], views=[ifl.View("far", (20, -10, 8), (0.5, 0.5, 0.5))])
        solution = ifl.solve(scene, rays=1e4)
        solution.save(self.folder / "floor.h5")
        self.interflect("render", self.folder / "floor.h5", "-o", self.folder / "command.exr")
        np.testing.assert_array_equal(ifl.render(solution), ifl.read_image(self.folder / "command.exr"))

    def test_of_pictures_of_all_shadings(self):
        self.interflect("solve", "scenes/lights.mgf", "--rays", "100k", "-o", self.folder / "lights.h5")
        solution = ifl.Solution.open(self.folder / "lights.h5")
        camera = ifl.View("camera", (5, -4, 2.5), (0, 0, 0.5))
        for shading in ("hybrid", "gather", "smooth", "flat", "path", "instant"):
            picture = ifl.render(solution, camera, shading=shading, width=48, height=27)
            self.interflect("render", self.folder / "lights.h5", "--eye", "5,-4,2.5", "--look-at", "0,0,0.5", "--size", "48x27",
                            "--shading", shading, "-o", self.folder / "command.exr")
            np.testing.assert_array_equal(picture, ifl.read_image(self.folder / "command.exr"), shading)

    def test_of_solution_files(self):
        for number, (scene, options, arguments) in enumerate((
                # The command moves these views to the front of the scene's, where they are.
                ("office", {"views": ["desk", "doorway"], "seed": 5}, ["--view", "desk", "--view", "doorway", "--seed", "5"]),
                ("maze", {"method": "srr"}, ["--method", "srr"]),
                ("maze", {"view": "room-0", "preset": "paper"}, ["--view", "room-0", "--preset", "paper"]),
                ("maze", {"view": "room-0", "one_bounce": True, "alpha": 0.2, "min_area": 0.01},
                 ["--view", "room-0", "--one-bounce", "--alpha", "0.2", "--min-area", "0.01"]),
        )):
            with self.subTest(options):
                # Saved scenes have the name of the file as it was given.
                os.chdir(ROOT)
                file = f"scenes/{scene}.mgf"
                ifl.solve(file, rays=5e4, **options).save(self.folder / "python.h5")
                self.interflect("solve", file, "--rays", "50k", *arguments, "-o", self.folder / f"{number}.h5")
                self.assertEqual((self.folder / "python.h5").read_bytes(), (self.folder / f"{number}.h5").read_bytes())

    def test_of_light_groups(self):
        os.chdir(ROOT)
        ifl.solve(ifl.load("scenes/office.mgf", light_groups=True), rays=5e4).save(self.folder / "python.h5")
        self.interflect("solve", "scenes/office.mgf", "--rays", "50k", "--light-groups", "-o", self.folder / "command.h5")
        self.assertEqual((self.folder / "python.h5").read_bytes(), (self.folder / "command.h5").read_bytes())

    def test_of_measuring_grids(self):
        """Grids of the office, before and after faces are cut for solving. Some points lie inside chairs."""
        self.interflect("solve", "scenes/office.mgf", "--rays", "10k", "-o", self.folder / "office.h5")
        scenes = ifl.load(ROOT / "scenes/office.mgf"), ifl.Solution.open(self.folder / "office.h5").scene
        for options, boundary in (([], 0), (["--boundary"], 0.5)):
            grids = [ifl.area_grid(scene, ifl.find_floor(scene, 0.44), boundary=boundary, height=0.44) for scene in scenes]
            self.assertGreater(grids[0].enclosed, 0)
            for source in (ROOT / "scenes/office.mgf", self.folder / "office.h5"):
                self.interflect("probe", source, "--shading", "path", "--samples", "2", "--plane", "0.44", *options, "-o",
                                self.folder / "grid.csv")
                points = np.genfromtxt(self.folder / "grid.csv", delimiter=",", skip_header=1, usecols=(0, 1, 2))
                for grid in grids:
                    np.testing.assert_allclose(grid.points, points, rtol=1e-9)

    def test_of_view_factors(self):
        self.interflect("viewfactors", "scenes/office.mgf", "--groups", "materials", "--rays", "1M", "-o", self.folder / "office.npz")
        command, python = np.load(self.folder / "office.npz"), ifl.view_factors(ROOT / "scenes/office.mgf", "materials", rays=1e6)
        self.assertEqual(command["names"].tolist(), python.names)
        for name in ("areas", "row_offsets", "columns", "values", "errors", "sky", "blocked"):
            np.testing.assert_array_equal(command[name], getattr(python, name), name)


if __name__ == "__main__":
    unittest.main()
