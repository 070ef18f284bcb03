"""check_vtk.py SOLUTION GRID...: checks that VTK reads the mesh and the light of SOLUTION from each GRID, all alike.
Prints the number of cells, bounds and area of each. Needs Debian's Python, which has VTK."""

import json
import sys

import h5py
import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter
from vtkmodules.vtkIOHDF import vtkHDFReader
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

OF_ELEMENTS = ("irradiance", "standard_error", "discretisation_error", "rays", "view_importance", "indirect_importance")
LUMINANCE = numpy.array([0.2126, 0.7152, 0.0722], dtype=numpy.float32)


def read(path):
    reader = vtkHDFReader() if path.endswith(".vtkhdf") else vtkXMLUnstructuredGridReader()
    assert reader.CanReadFile(path), path
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def arrays(data):
    return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}


def everything(grid):
    cells = grid.GetCells()
    named = {
        "connectivity": vtk_to_numpy(cells.GetConnectivityArray()),
        "offsets": vtk_to_numpy(cells.GetOffsetsArray()),
        "types": vtk_to_numpy(grid.GetCellTypesArray()),
        "points": vtk_to_numpy(grid.GetPoints().GetData()),
    }
    named |= {f"of points, {name}": array for name, array in arrays(grid.GetPointData()).items()}
    return named | {f"of cells, {name}": array for name, array in arrays(grid.GetCellData()).items()}


def areas(grid):
    sizes = vtkCellSizeFilter()
    sizes.SetInputData(grid)
    sizes.Update()
    return vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Area"))


def check_light(grid, file):
    cells, element = arrays(grid.GetCellData()), arrays(grid.GetCellData())["element"]
    assert len(set(element)) == len(element) == grid.GetNumberOfCells()
    for name in OF_ELEMENTS:
        assert numpy.array_equal(cells[name], file["solution"][name][:][element]), name
    assert numpy.allclose(cells["illuminance"], cells["irradiance"] @ LUMINANCE, rtol=1e-5)
    for group, irradiance in file.get("solution/groups", {}).items():
        assert numpy.array_equal(cells[f"irradiance_of_group_{group}"], irradiance[:][element]), group
    materials = json.loads(bytes(file["description"][:]))["materials"]
    exitance, reflectance = (
        numpy.array([each[name] for each in materials])[cells["material"]] for name in ("exitance", "reflectance")
    )
    assert numpy.allclose(cells["radiosity"], exitance + reflectance * cells["irradiance"], rtol=1e-5)
    of_points = arrays(grid.GetPointData())
    assert numpy.allclose(of_points["illuminance"], of_points["irradiance"] @ LUMINANCE, rtol=1e-5)
    assert of_points["illuminance"].min() >= 0 and of_points["illuminance"].max() > 0


def check_mesh(grid, file):
    """Requires rectangular patches."""
    patches, vertices = file["scene/patches"][:], file["scene/vertices"][:]
    cells = arrays(grid.GetCellData())
    patch, level = cells["patch"], cells["level"]
    assert numpy.array_equal(cells["material"], patches[patch, 4])
    assert numpy.array_equal(cells["object"], patches[patch, 5])
    assert ((level == 0) == (cells["element"] < len(patches))).all()
    a, b, c = (vertices[patches[patch, k]] for k in range(3))
    expected = numpy.linalg.norm(numpy.cross(b - a, c - b), axis=1) / 4.0**level
    assert numpy.allclose(areas(grid), expected, rtol=1e-4), "cells are not the elements that they tell of"


def check_layout(path):
    """Checks that VTK 9.1 omits: attributes for other versions, and compression to save disk space."""
    with h5py.File(path) as file:
        root = file["VTKHDF"]
        assert list(root.attrs["Version"]) == [1, 0]
        text = root.attrs.get_id("Type").get_type()
        assert root.attrs["Type"] == b"UnstructuredGrid", root.attrs["Type"]
        assert not text.is_variable_str() and text.get_cset() == h5py.h5t.CSET_ASCII
        cells = root["CellData"].values()
        assert all(array.shuffle and array.compression == "gzip" for array in (*cells, root["Points"]))


def main(solution, *paths):
    grids = {path: read(path) for path in paths}
    first = everything(grids[paths[0]])
    with h5py.File(solution) as file:
        for path, grid in grids.items():
            if path.endswith(".vtkhdf"):
                check_layout(path)
            check_light(grid, file)
            check_mesh(grid, file)
            others = everything(grid)
            assert others.keys() == first.keys(), (path, others.keys() ^ first.keys())
            for name, array in others.items():
                assert numpy.array_equal(array, first[name]), (path, name)
                assert array.dtype == first[name].dtype, (path, name, array.dtype)
            print(grid.GetNumberOfCells(), *grid.GetBounds(), areas(grid).sum())


main(*sys.argv[1:])
