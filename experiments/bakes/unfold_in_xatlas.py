"""Lays out meshes by xatlas, in a Python that has it: unfold_in_xatlas.py MESHES.npz LAYOUT.npz DENSITY PADDING.

MESHES.npz has positions_0, corners_0, positions_1 ... of each mesh. LAYOUT.npz has the texels of each corner, of all meshes
in turn, the size of the image and the seconds.
"""

import sys
import time

import numpy as np
import xatlas


def main(meshes: str, layout: str, density: str, padding: str) -> None:
    arrays = np.load(meshes)
    count = len(arrays) // 2
    start = time.perf_counter()
    atlas = xatlas.Atlas()
    for i in range(count):
        atlas.add_mesh(arrays[f"positions_{i}"], arrays[f"corners_{i}"])
    options = xatlas.PackOptions()
    options.texels_per_unit, options.padding = float(density), int(padding)
    atlas.generate(xatlas.ChartOptions(), options)
    seconds = time.perf_counter() - start
    size = np.array([atlas.width, atlas.height])
    texels = []
    for i in range(count):
        _, corners, coordinates = atlas.get_mesh(i)
        texels.append(coordinates[corners] * size)
    np.savez(layout, texels=np.concatenate(texels), size=size, images=atlas.atlas_count, seconds=seconds)


main(*sys.argv[1:])
