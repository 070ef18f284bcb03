"""Scenes from arrays and files: contents, views without copies, and every fault in one exception."""

import copy
import unittest
from pathlib import Path

import numpy as np

import interflect as ifl
from scenes import CORNERS, LAMP, PAINT, VIEW, WALLS, room

ROOT = Path(__file__).resolve().parents[2]


class FromArrays(unittest.TestCase):
    def test_has_the_arrays(self):
        scene = room()
        np.testing.assert_allclose(scene.vertices, np.vstack([CORNERS, LAMP]), rtol=1e-7)
        np.testing.assert_array_equal(scene.faces[:6], WALLS)
        np.testing.assert_array_equal(scene.face_materials, [0] * 6 + [1])
        self.assertEqual(scene.views, [VIEW])
        self.assertEqual([m.name for m in scene.materials], ["paint", "light"])
        self.assertEqual(scene.origin, (0, 0, 0))

    def test_is_summarised(self):
        """A room of 2 x 3 x 2.5 m with a one-sided lamp of 1 m2, 1000 lm."""
        summary = ifl.summarise(room(two_sided=False))
        paint, light = summary.materials
        self.assertAlmostEqual(summary.area, 38, places=4)
        self.assertEqual(summary.bounds, ((0, 0, 0), (2, 3, 2.5)))
        self.assertAlmostEqual(paint.reflectance[1], 0.6, places=6)
        self.assertAlmostEqual(light.power[1], 1000, places=2)
        self.assertEqual((light.material, light.emitting_patches, light.emitting_objects), (1, 1, 1))

    def test_takes_what_numpy_converts(self):
        """Lists, other types and orders, strided and read-only arrays give the same scene."""
        vertices = np.vstack([CORNERS, LAMP])
        faces = np.vstack([WALLS, [(8, 9, 10, 11)]])
        read_only = vertices.copy()
        read_only.flags.writeable = False
        for same in (vertices.tolist(), vertices.astype(np.float32), np.asfortranarray(vertices), read_only,
                     np.repeat(vertices, 2, axis=0)[::2]):
            for alike in (faces.tolist(), faces.astype(np.uint8), faces.astype(np.uint64), np.asfortranarray(faces)):
                scene = room(vertices=same, faces=alike)
                np.testing.assert_array_equal(scene.vertices, room().vertices)
                np.testing.assert_array_equal(scene.faces, room().faces)

    def test_triangles_have_no_fourth_vertex(self):
        triangles = np.vstack([WALLS[:, [0, 1, 2]], WALLS[:, [0, 2, 3]]])
        for faces in (triangles, np.hstack([triangles, np.full((12, 1), -1)])):
            scene = ifl.Scene(CORNERS, faces, PAINT)
            self.assertEqual(len(scene.faces), 12)
            self.assertTrue((scene.faces[:, 3] == ifl.none).all())

    def test_two_sided_faces_have_a_back(self):
        scene = room(two_sided=[False] * 6 + [True])
        self.assertEqual(scene.other_sides.tolist(), [-1] * 6 + [7, 6])
        np.testing.assert_array_equal(scene.faces[7], [8, 11, 10, 9])
        self.assertEqual(len(room(two_sided=True).faces), 14)

    def test_far_coordinates_keep_their_precision(self):
        scene = room(vertices=np.vstack([CORNERS, LAMP]) + (4.5e6, 5.2e6, 100))
        np.testing.assert_allclose(scene.vertices + np.array(scene.origin), room().vertices + (4.5e6, 5.2e6, 100), atol=1e-6)

    def test_textures_are_shared(self):
        texels = np.random.default_rng(1).random((4, 8, 3), np.float32)
        scene = room(textures=[ifl.Texture(texels, "noise")],
                     materials=[ifl.Material("paint", 0.6, reflectance_texture=0), ifl.Material("light", exitance=1000)],
                     texture_coordinates=np.zeros((12, 2)))
        np.testing.assert_array_equal(scene.textures[0].texels, texels)
        self.assertEqual(scene.materials[0].reflectance_texture, 0)
        self.assertTrue(np.shares_memory(scene.textures[0].texels, scene.textures[0].texels))

    def test_one_part_is_a_sequence(self):
        lamp = ifl.Luminaire("lamp", ifl.PointLight((1, 1, 1), 100))
        self.assertEqual(room(luminaires=lamp, views=VIEW).luminaires, [lamp])
        with self.assertRaisesRegex(TypeError, "luminaires: expected a sequence of Luminaire, found"):
            room(luminaires=[VIEW])

    def test_copies_are_the_scene(self):
        scene = room()
        self.assertIs(copy.copy(scene), scene)
        self.assertIs(copy.deepcopy([scene])[0], scene)

    def test_replace_makes_another_scene(self):
        scene = room()
        darker = scene.replace(materials=[m.replace(reflectance=0.1) for m in scene.materials])
        self.assertAlmostEqual(darker.materials[0].reflectance[1], 0.1, places=6)
        self.assertAlmostEqual(scene.materials[0].reflectance[1], 0.6, places=6)
        with self.assertRaises(ifl.InputError):
            scene.replace(materials=[])


class Arrays(unittest.TestCase):
    def test_are_read_only_views(self):
        scene = room()
        for name in ("vertices", "faces", "face_materials", "face_objects"):
            array = getattr(scene, name)
            self.assertFalse(array.flags.writeable, name)
            self.assertFalse(array.flags.owndata, name)
            self.assertTrue(np.shares_memory(array, getattr(scene, name)), name)
            with self.assertRaises(ValueError):
                array[0] = 0

    def test_outlive_the_scene(self):
        vertices = room().vertices
        other = [room() for _ in range(100)]  # would reuse the memory
        np.testing.assert_array_equal(vertices, other[0].vertices)


class Faults(unittest.TestCase):
    def faults(self, **changes):
        with self.assertRaises(ifl.InputError) as raised:
            room(**changes)
        return raised.exception

    def test_all_are_in_one_exception(self):
        error = self.faults(materials=[ifl.Material("white", 1.2), ifl.Material("black", -0.1, exitance=-5)],
                            faces=np.vstack([WALLS, [(8, 8, 8, 8)]]), face_materials=[0] * 6 + [7])
        text = "\n".join(fault.text for fault in error.faults)
        for expected in ("'white'", "'black'", "patch 6", "material 7 does not exist"):
            self.assertIn(expected, text)
            self.assertIn(expected, str(error))
        self.assertGreaterEqual(len(error.faults), 4)
        self.assertEqual(error.object, "white")
        self.assertEqual([fault.object for fault in error.faults], ["white", "black", "black", "patch 6", "patch 6"])
        self.assertIsNone(error.file)
        self.assertIsInstance(error, ValueError)
        self.assertIsInstance(error, ifl.Error)

    def test_shapes_and_types(self):
        corners = np.vstack([CORNERS, LAMP])
        broken = corners.copy()
        broken[3, 1] = np.nan
        for changes, expected in (
                ({"vertices": corners[:, :2]}, "vertices: expected the shape (n, 3), found (12, 2)"),
                ({"vertices": corners[0]}, "vertices: expected the shape (n, 3), found (3)"),
                ({"vertices": "corners"}, "vertices: expected an array of numbers"),
                ({"vertices": broken}, "vertex 3 is (2, nan, 0): expected finite numbers"),
                ({"faces": WALLS.astype(float)}, "faces: expected integers, found float64"),
                ({"faces": WALLS[:, :2]}, "faces: expected the shape (n, 3 or 4), found (6, 2)"),
                ({"faces": np.zeros((0, 4), int), "face_materials": None}, "faces: expected at least one"),
                ({"faces": WALLS + 9, "face_materials": None}, "face 0: vertex 12 does not exist; expected below 12"),
                ({"face_materials": [0, 1]}, "face_materials: expected the shape (7,), found (2)"),
                ({"face_materials": [-1] * 7}, "face_materials: face 0 has -1, which is no index"),
                ({"two_sided": [True]}, "two_sided: expected True, False or an array of 7 booleans"),
                ({"normals": np.zeros((3, 3))}, "normals: expected the shape (12, 3), found (3, 3)"),
                ({"texture_coordinates": np.zeros((12, 3))}, "texture_coordinates: expected the shape (12, 2)"),
                ({"face_objects": [1] * 7}, "patch 0: object 1 does not exist"),
                ({"views": [VIEW.replace(look_at=VIEW.eye)]}, "view 'door'"),
        ):
            self.assertIn(expected, str(self.faults(**changes)))

    def test_wrong_kinds_of_objects(self):
        for call in (lambda: ifl.Material("x", reflectance="red"), lambda: ifl.Material(colour=1), lambda: ifl.View(3),
                     lambda: room(materials=[1]), lambda: room(views=["door"]), lambda: room(luminaires=[PAINT])):
            self.assertRaises(TypeError, call)

    def test_fields_of_another_type_are_named_with_the_expected_one(self):
        for call, expected in (
                (lambda: ifl.Material("x", reflectance="red"),
                 r"Material.reflectance: expected tuple\[float, float, float\], found 'red'"),
                (lambda: ifl.Material(3), "Material.name: expected str, found 3"),
                (lambda: ifl.Material("x", reflectance_texture="a"), r"expected Optional\[int\], found 'a'"),
                (lambda: ifl.WeightedView("door"), "WeightedView.view: expected View, found 'door'"),
                (lambda: VIEW.replace(eye=list(range(10_000))), r"View.eye: expected .* \.\.\.$")):
            with self.subTest(expected), self.assertRaisesRegex(TypeError, expected):
                call()


class FromFiles(unittest.TestCase):
    def test_office(self):
        scene = ifl.load(ROOT / "scenes/office.mgf")
        self.assertEqual(len(scene.faces), 18857)
        self.assertIn("desk", [view.name for view in scene.views])
        self.assertEqual(scene.warnings, [])

    def test_units_scale(self):
        self.assertAlmostEqual(np.ptp(ifl.load(ROOT / "scenes/office.mgf", unit="cm").vertices, axis=0).max() * 100,
                               np.ptp(ifl.load(ROOT / "scenes/office.mgf").vertices, axis=0).max(), places=3)

    def test_errors_have_file_and_line(self):
        import tempfile
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "bad.mgf"
            path.write_text("m paint =\n\trd 0.5\nf a b c\n")
            with self.assertRaises(ifl.InputError) as raised:
                ifl.load(path)
        self.assertEqual(raised.exception.file, path)
        self.assertEqual(raised.exception.line, 3)
        with self.assertRaises(ifl.InputError) as raised:
            ifl.load("nowhere.mgf")
        self.assertEqual(raised.exception.file, Path("nowhere.mgf"))
        self.assertIsNone(raised.exception.line)

    def test_unknown_views_name_the_view(self):
        with self.assertRaises(ifl.InputError) as raised:
            ifl.solve(room(), view="window")
        self.assertEqual(raised.exception.object, "window")


if __name__ == "__main__":
    unittest.main()
