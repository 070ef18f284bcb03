"""Reading a solution: tables with pandas, plots with matplotlib, a grid for VTK and ParaView.

    python3 examples/pandas_matplotlib_vtk.py
"""

import argparse
from pathlib import Path

import interflect as ifl
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_QUAD, VTK_TRIANGLE, vtkCellArray, vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter


SCENE = Path(__file__).resolve().parents[1] / "scenes" / "office.mgf"
LUMINANCE = np.array([0.2126, 0.7152, 0.0722], np.float32)  # of linear Rec. 709


def table_of_leaves(solution: ifl.Solution) -> pd.DataFrame:
    """One row per leaf of the mesh."""
    scene, patch = solution.scene, solution.patch
    material = scene.face_materials[patch]
    names = [".".join(name.split(".")[:2]) for name in scene.objects]  # office.ceiling.a0.0 -> office.ceiling
    reflectance = np.array([m.reflectance for m in scene.materials], np.float32) @ LUMINANCE
    return pd.DataFrame(
        {
            "object": pd.Categorical.from_codes(*as_categories(scene.face_objects[patch], names)),
            "material": pd.Categorical.from_codes(*as_categories(material, [m.name for m in scene.materials])),
            "level": solution.level,
            "area": solution.area.astype(float),
            "illuminance": (solution.irradiance @ LUMINANCE).astype(float),
            "error": solution.error,
            "reflectance": reflectance[material],
        }
    )


def as_categories(index: np.ndarray, names: list[str]) -> tuple[np.ndarray, pd.Index]:
    """Codes and categories of pandas, whose categories must be unique; several objects may have one name."""
    code_of_name, categories = pd.factorize(np.array(names))
    return code_of_name[index], categories


def summary_by(leaves: pd.DataFrame, column: str) -> pd.DataFrame:
    """Area [m^2], mean illuminance [lx] and received flux [lm] of each object or material, the largest flux first."""
    flux = leaves["illuminance"] * leaves["area"]
    groups = leaves.assign(flux=flux).groupby(column, observed=True)
    summary = groups.agg(leaves=("level", "size"), area=("area", "sum"), flux=("flux", "sum"))
    summary["illuminance"] = summary["flux"] / summary["area"]
    return summary.sort_values("flux", ascending=False)


def draw(leaves: pd.DataFrame, iterations: pd.DataFrame) -> plt.Figure:
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4), layout="constrained")
    bins = np.geomspace(1, 10_000, 60)
    left.hist(leaves["illuminance"], bins, weights=leaves["area"])
    left.set(xscale="log", xlabel="illuminance [lx]", ylabel="area [m²]", title="Illuminance of the surfaces")
    labels = {"error_estimate": "total", "noise_estimate": "noise", "discretisation_estimate": "mesh"}
    for column, label in labels.items():
        right.semilogy(iterations["rays"], iterations[column], marker="o", markersize=3, label=label)
    right.set(xlabel="rays", ylabel="estimated relative error", title="Error of the picture")
    right.grid(which="both", alpha=0.3)
    right.legend()
    return figure


def grid_of_leaves(solution: ifl.Solution, values: dict[str, np.ndarray]) -> vtkUnstructuredGrid:
    """One VTK cell per leaf, with arrays of cells.

    VTK reads contiguous arrays in place and keeps a reference to them. Arrays of leaves are columns of a wider table,
    so they are copied here once; `solution.elements` has contiguous arrays.
    """
    points = np.ascontiguousarray(solution.vertices).reshape(-1, 3)
    corners = solution.vertex_count
    is_corner = np.arange(4) < corners[:, np.newaxis]  # a triangle repeats its last vertex
    connectivity = np.arange(len(points)).reshape(-1, 4)[is_corner]
    offsets = np.concatenate([[0], np.cumsum(corners)])
    cells = vtkCellArray()  # keeps no reference to NumPy's memory, so it needs copies
    cells.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True), numpy_to_vtkIdTypeArray(connectivity, deep=True))
    grid = vtkUnstructuredGrid()
    located = vtkPoints()
    located.SetData(numpy_to_vtk(points))
    grid.SetPoints(located)
    grid.SetCells(numpy_to_vtk(np.where(corners == 3, VTK_TRIANGLE, VTK_QUAD).astype(np.uint8)), cells)
    for name, array in values.items():
        shared = numpy_to_vtk(np.ascontiguousarray(array))
        shared.SetName(name)
        grid.GetCellData().AddArray(shared)
    return grid


def main(arguments: list[str] | None = None) -> tuple[pd.DataFrame, vtkUnstructuredGrid]:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rays", type=float, default=10e6, help="rays of the solver")
    parser.add_argument("--output", type=Path, default=Path("out/examples"), help="folder of the plot and the grid")
    options = parser.parse_args(arguments)
    options.output.mkdir(parents=True, exist_ok=True)

    solution = ifl.solve(SCENE, view="desk", rays=options.rays)
    leaves = table_of_leaves(solution)
    print(f"{len(leaves)} leaves. The five objects with the largest flux, areas in m^2, flux in lm, illuminance in lx:")
    print(summary_by(leaves, "object").head().to_string(float_format="{:.1f}".format))
    print("\nMaterials:")
    print(summary_by(leaves, "material").head().to_string(float_format="{:.1f}".format))
    draw(leaves, pd.DataFrame(solution.iterations)).savefig(options.output / "office-leaves.png", dpi=120)

    grid = grid_of_leaves(
        solution,
        {"illuminance": leaves["illuminance"].to_numpy(), "error": solution.error, "level": solution.level},
    )
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetFileName(str(options.output / "office-leaves.vtu"))  # for ParaView; PyVista: pyvista.read(this file)
    writer.Write()
    return leaves, grid


if __name__ == "__main__":
    main()
