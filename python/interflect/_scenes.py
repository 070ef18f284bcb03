"""Reading scenes."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping, Sequence

from interflect import _core
from interflect._errors import InputError, Warning

UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "km": 1000.0, "in": 0.0254, "ft": 0.3048}


def load(path: str | os.PathLike[str], *, unit: float | str = 1.0, up_axis: str = "z", curve_divisions: int = 4,
         max_patches: int = 50_000_000, outside_files: bool = False, further_files: Sequence[str | os.PathLike[str]] = (),
         luminaires: Sequence[_core.PlacedLuminaire] = (), daylight: _core.Daylight | None = None,
         light_groups: bool | Mapping[str, str] | None = None) -> _core.Scene:
    """Reads a scene: glTF, OBJ, PLY, STL, Radiance, View3D or MGF.

    Args:
        path: Scene file.
        unit: Length of the file's unit: "m", "cm", "mm", "km", "in", "ft", or [m].
        up_axis: Up axis of the file, which is rotated to z: "x", "-x", "y", "-y", "z" or "-z".
        curve_divisions: Flat pieces per quarter circle of a curved surface, 1 to 1000. Pieces of an emitting surface
            have its exact area.
        max_patches: Limit of patches.
        outside_files: Whether a file may refer to files outside its folder.
        further_files: More files of a Radiance scene, which see the modifiers of earlier ones, as with oconv.
        luminaires: Measured light to add.
        daylight: Sun, sky or environment to add.
        light_groups: Groups whose light is kept separate: patterns of names by name of the group, or True for one per
            object with light sources.

    Returns:
        The scene as in the file. solve() and Solver cut its faces where others meet them. Unsupported features of the
        file are reported by warnings.warn().

    Raises:
        InputError: with the file and line, for a file that cannot be read.
    """
    length = UNITS.get(unit, unit) if isinstance(unit, str) else unit
    if isinstance(length, str):
        raise InputError(f"unit: expected one of {', '.join(UNITS)}, or metres, found {unit!r}")
    if not isinstance(path, (str, os.PathLike)):
        raise TypeError(f"expected a scene or the path of one, found {path!r}")
    scene = _core.load(path, length, up_axis, curve_divisions, max_patches, outside_files, list(further_files),
                       list(luminaires), daylight)
    for message in scene.warnings:
        warnings.warn(message, Warning, stacklevel=2)
    if light_groups is True:
        return scene.replace(light_groups=_core.groups_by_name(scene))
    if light_groups:
        return scene.replace(light_groups=[_core.LightGroup(name, pattern) for name, pattern in light_groups.items()])
    return scene


def scene_of(scene: _core.Scene | str | os.PathLike[str]) -> _core.Scene:
    """The scene, or the scene in the file."""
    return scene if isinstance(scene, _core.Scene) else load(scene)
