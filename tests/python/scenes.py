"""Scenes from arrays, shared by the tests."""

import numpy as np

import interflect as ifl

CORNERS = np.array([(x, y, z) for z in (0, 2.5) for y in (0, 3) for x in (0, 2)])
WALLS = np.array([(0, 1, 3, 2), (4, 6, 7, 5), (0, 2, 6, 4), (1, 5, 7, 3), (0, 4, 5, 1), (2, 3, 7, 6)])
LAMP = np.array([(0.5, 1, 2.4), (0.5, 2, 2.4), (1.5, 2, 2.4), (1.5, 1, 2.4)])
PAINT = ifl.Material("paint", reflectance=0.6)
LIGHT = ifl.Material("light", exitance=1000)
VIEW = ifl.View("door", (0.3, 0.2, 1.6), (1.2, 3, 1))


def room(**changes):
    """A closed room of 2 x 3 x 2.5 m with a lamp under its ceiling."""
    parts = {
        "vertices": np.vstack([CORNERS, LAMP]), "faces": np.vstack([WALLS, [(8, 9, 10, 11)]]),
        "materials": [PAINT, LIGHT], "face_materials": [0] * 6 + [1], "views": [VIEW], "name": "room",
    }
    return ifl.Scene(**{**parts, **changes})


def furnace(reflectance=0.5, exitance=100.0):
    """A cube whose walls all emit and reflect alike: H = M / (1 - rho) exactly."""
    cube = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
    return ifl.Scene(cube, WALLS, ifl.Material("wall", reflectance, exitance), name="furnace")
