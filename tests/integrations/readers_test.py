"""Opens exported light in trimesh, Open3D, meshio and PyVista, which must find the same areas and ranges of values.
Needs the packages of requirements.txt."""

import sys
import unittest
from pathlib import Path

import meshio
import numpy as np
import open3d
import pyvista
import trimesh

sys.path.append(str(Path(__file__).resolve().parents[1] / "cli"))
from command import CommandTest, room

INSIDE = 2 * (2 * 3 + 2 * 2.5 + 3 * 2.5) + 1  # of room(): walls and a one-sided lamp [m^2]
AREA = 2 * INSIDE - 1  # with the outer sides of the walls
CHANNELS = ("red", "green", "blue")
open3d.utility.set_verbosity_level(open3d.utility.VerbosityLevel.Error)


def ranges(values):
    """Returns the smallest and the largest value of each channel."""
    values = np.asarray(values, float)
    return np.array([values.min(axis=0), values.max(axis=0)])


def area(points, triangles):
    a, b, c = (np.asarray(points, float)[triangles[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


class Readers(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("room.mgf", room())
        self.write_solution("room.h5", "room.mgf", "--rays", "50k")
        self.export("room.ply")
        self.ply = meshio.read(self.folder / "room.ply")

    def export(self, name):
        self.interflect("export", "room.h5", "-o", name, "--exposure", "-6")
        return str(self.folder / name)

    def export_grid(self, name):
        self.interflect("export", "room.h5", "-o", name)
        return str(self.folder / name)

    def check(self, found, colours=None, irradiance=None):
        """Compares an area, and ranges with those that meshio finds in the .ply file."""
        self.check_area(found, AREA)
        for values, prefix in ((colours, ""), (irradiance, "irradiance_")):
            if values is None:
                continue
            channels = np.stack([self.ply.point_data[prefix + channel] for channel in CHANNELS], axis=1)
            # meshio takes bytes for signed numbers.
            expected = ranges(channels.astype(np.uint8) if channels.dtype == np.int8 else channels)
            self.assertGreater(expected[1].min(), expected[0].max())
            np.testing.assert_allclose(ranges(values), expected, rtol=1e-5)

    def check_area(self, found, expected):
        self.assertAlmostEqual(found, expected, delta=1e-4 * expected)

    def test_ply(self):
        (block,) = self.ply.cells
        self.assertEqual(block.type, "triangle")
        self.check(area(self.ply.points, block.data))
        path = str(self.folder / "room.ply")
        mesh = trimesh.load(path, process=False)
        raw = mesh.metadata["_ply_raw"]["vertex"]["data"]
        irradiance = np.stack([raw["irradiance_" + channel].ravel() for channel in CHANNELS], axis=1)
        self.check(mesh.area, mesh.visual.vertex_colors[:, :3], irradiance)
        mesh = open3d.io.read_triangle_mesh(path)
        self.assertEqual(len(mesh.triangles), len(block.data))
        self.check(mesh.get_surface_area(), 255 * np.asarray(mesh.vertex_colors))
        mesh = pyvista.read(path)
        self.check(mesh.area, mesh.point_data["RGB"])

    def test_obj(self):
        path = self.export("room.obj")
        mesh = trimesh.load(path, process=False, force="mesh")
        self.check(mesh.area)
        self.check(open3d.io.read_triangle_mesh(path).get_surface_area())
        self.check(pyvista.read(path).area)
        mesh = meshio.read(path)
        self.check(sum(area(mesh.points[:, :3], block.data) for block in mesh.cells))

    def test_glb(self):
        """The file omits the outer sides, which nobody sees."""
        path = self.export("room.glb")
        meshes = list(trimesh.load(path, process=False).geometry.values())
        self.check_area(sum(mesh.area for mesh in meshes), INSIDE)
        self.check_area(open3d.io.read_triangle_mesh(path).get_surface_area(), INSIDE)
        self.check_area(pyvista.read(path).combine().extract_surface(algorithm="dataset_surface").area, INSIDE)
        irradiance = np.concatenate([mesh.vertex_attributes["_IRRADIANCE"] for mesh in meshes])
        for k, channel in enumerate(CHANNELS):
            of_ply = self.ply.point_data["irradiance_" + channel]
            np.testing.assert_allclose(ranges(irradiance[:, k]), ranges(of_ply[of_ply > 0]), rtol=1e-5)

    def test_vtk(self):
        grids = [pyvista.read(self.export_grid(name)) for name in ("room.vtu", "room.vtkhdf")]
        for grid in grids:
            self.check(grid.area)
            for name in ("irradiance", "radiosity", "standard_error"):
                np.testing.assert_array_equal(grid.cell_data[name], grids[0].cell_data[name])
        mesh = meshio.read(self.folder / "room.vtu")
        np.testing.assert_array_equal(ranges(mesh.point_data["irradiance"]), ranges(grids[1].point_data["irradiance"]))


if __name__ == "__main__":
    unittest.main()
