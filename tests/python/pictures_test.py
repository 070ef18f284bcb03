"""Pictures, measurements and exports."""

import tempfile
import unittest
from pathlib import Path

import numpy as np

import interflect as ifl
from scenes import VIEW, furnace, room

SMALL = {"width": 64, "height": 36}


class Pictures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.solution = ifl.solve(room(), view="door", rays=1e6)

    def test_all_shadings_show_the_same_light(self):
        """Means agree within 4%: the mesh is coarse; noise of the means is below 1%."""
        reference = ifl.render(self.solution, shading="path", samples=256, **SMALL).mean()
        for shading in ("hybrid", "gather", "smooth", "flat", "instant"):
            picture = ifl.render(self.solution, shading=shading, **SMALL)
            self.assertEqual((picture.shape, picture.dtype), ((36, 64, 3), np.float32))
            self.assertTrue(picture.flags.c_contiguous)
            self.assertAlmostEqual(picture.mean() / reference, 1, delta=0.04, msg=shading)

    def test_previews_show_the_same_light(self):
        reference = ifl.render(self.solution, **SMALL).mean()
        for reduction in (1, 4):
            picture = ifl.preview(self.solution, reduction=reduction, denoiser="own", **SMALL)
            self.assertEqual((picture.shape, picture.dtype), ((36, 64, 3), np.float32))
            self.assertAlmostEqual(picture.mean() / reference, 1, delta=0.03, msg=reduction)
        for wrong in ({"reduction": 0.9}, {"reduction": float("inf")}, {"denoiser": "median"}):
            with self.subTest(wrong), self.assertRaises(ifl.InputError):
                ifl.preview(self.solution, **wrong, **SMALL)
        with self.assertRaises(TypeError):
            ifl.preview(room(), **SMALL)  # not solved

    def test_radiance_of_a_furnace(self):
        """L = B / pi = M / (1 - rho) / pi, without noise in a path tracer but for roulette: 2% of 200 / pi."""
        camera = ifl.View("inside", (0.5, 0.5, 0.5), (1, 0.5, 0.5))
        picture = ifl.render(furnace(), camera, shading="path", samples=256, **SMALL)
        self.assertAlmostEqual(picture.mean(), 200 / np.pi, delta=0.02 * 200 / np.pi)

    def test_views_are_chosen(self):
        default = ifl.render(self.solution, shading="flat", **SMALL)
        np.testing.assert_array_equal(default, ifl.render(self.solution, "door", shading="flat", **SMALL))
        np.testing.assert_array_equal(default, ifl.render(self.solution, VIEW, shading="flat", **SMALL))
        other = VIEW.replace(eye=(1.7, 0.2, 1.6))
        self.assertFalse(np.array_equal(default, ifl.render(self.solution, other, shading="flat", **SMALL)))
        with self.assertRaises(ifl.InputError):
            ifl.render(self.solution, "window", **SMALL)

    def test_wrong_arguments(self):
        for error, options in ((ifl.InputError, {"shading": "phong"}), (ifl.InputError, {"width": 0}),
                               (ifl.InputError, {"quantity": "lumen"}), (TypeError, {"view": 7}),
                               (ifl.InputError, {"samples": 0, "shading": "flat"}),
                               (TypeError, {"shading": "flat", "until": 0.1})):
            with self.subTest(options), self.assertRaises(error):
                ifl.render(self.solution, **{**SMALL, **options})
        with self.assertRaises(TypeError):
            ifl.render(room(), **SMALL)  # not solved

    def test_tracing_has_errors_and_layers(self):
        traced = ifl.trace(self.solution, shading="gather", **SMALL)
        self.assertEqual(traced.standard_error.shape, (36, 64, 3))
        self.assertTrue(np.shares_memory(traced.image, traced.image))
        layers = traced.layers
        np.testing.assert_allclose(layers["emitted"] + layers["direct"] + layers["indirect"], traced.image, rtol=1e-4, atol=1e-4)
        del traced
        self.assertGreater(layers["depth"].max(), 1)

    def test_tonemap(self):
        picture = ifl.render(self.solution, shading="flat", **SMALL)
        for curve in ("srgb", "reinhard", "filmic", "agx", "ward", "tumblin", "ferwerda"):
            mapped = ifl.tonemap(picture, curve=curve)
            self.assertEqual((mapped.shape, mapped.dtype), ((36, 64, 3), np.uint8))
            self.assertGreater(np.ptp(mapped), 50, curve)
        np.testing.assert_array_equal(ifl.tonemap(np.full((1, 1, 3), 0.5), exposure=1), [[[255] * 3]])
        for image in (np.zeros((4, 4)), np.zeros((4, 4, 4)), np.zeros((0, 4, 3))):
            with self.assertRaises(ifl.InputError):
                ifl.tonemap(image)

    def test_files_and_differences(self):
        picture = ifl.render(self.solution, shading="flat", **SMALL)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "picture.exr"
            ifl.write_image(path, picture)
            np.testing.assert_array_equal(ifl.read_image(path), picture)
        self.assertEqual(ifl.compare(picture, picture).relative_mse, 0)
        double = ifl.compare(2 * picture, picture)
        self.assertAlmostEqual(double.ratio_of_means, 2, places=4)
        self.assertEqual(double.flip_map.shape, picture.shape)
        with self.assertRaises(ifl.InputError):
            ifl.compare(picture, picture[:-1])

    def test_solutions_are_pictures_in_notebooks(self):
        self.assertTrue(self.solution._repr_png_().startswith(b"\x89PNG"))


class Measurements(unittest.TestCase):
    def test_irradiance_of_a_furnace(self):
        """H = 200 at every point and for every normal; 3% are more than 5 standard errors."""
        solution = ifl.solve(furnace(), rays=1e6)
        points = [(0.5, 0.5, 0.5), (0.2, 0.7, 0.1), (0.5, 0.5, 0.9)]
        measured = ifl.probe(solution, points, [(0, 0, 1), (1, 1, 0), (0, 0, -1)])
        np.testing.assert_allclose(measured.illuminance, 200, rtol=0.03)
        np.testing.assert_allclose(measured.direct + measured.indirect, measured.irradiance, rtol=1e-6)
        self.assertEqual(measured.irradiance.shape, (3, 3))
        self.assertEqual(len(ifl.probe(solution, points[0], samples=16)), 1)

    def test_grids(self):
        scene = room(objects=["", "floor"], face_objects=[1] + [0] * 6)
        grid = ifl.area_grid(scene, ifl.find_surface(scene, "floor"), spacing=0.5, height=0.75)
        self.assertEqual((grid.columns * grid.rows, len(grid.points)), (24, 24))
        solution = ifl.solve(scene, rays=1e6)
        summary = ifl.probe(solution, grid, samples=64).summary()
        self.assertEqual(summary.points, 24)
        self.assertLess(summary.min, summary.mean)
        self.assertGreater(summary.min, 0)
        with self.assertRaises(ifl.InputError):
            ifl.find_surface(scene, "flor")

    def test_wrong_points(self):
        solution = ifl.solve(furnace(), rays=1e4)
        for points, normals in (([(0, 0)], (0, 0, 1)), ([(0, 0, np.nan)], (0, 0, 1)), ([(0, 0, 0)], (0, 0, 0)),
                                ([(0, 0, 0)] * 3, [(0, 0, 1)] * 2)):
            with self.assertRaises(ifl.InputError):
                ifl.probe(solution, points, normals)


class Exports(unittest.TestCase):
    def test_files_are_written(self):
        solution = ifl.solve(room(), rays=1e5)
        with tempfile.TemporaryDirectory() as folder:
            files = ifl.export(solution, Path(folder) / "room.glb", shading="smooth")
            files += ifl.export(solution, Path(folder) / "map.glb", lightmap=True, texels_per_metre=2, shading="smooth")
            for file in files:
                self.assertGreater(file.stat().st_size, 100)
        with self.assertRaises(ifl.InputError):
            ifl.export(solution, "room.xyz")
        with self.assertRaises(TypeError):
            ifl.export(solution, "room.glb", texels_per_metre=2)


if __name__ == "__main__":
    unittest.main()
