"""View factors between groups of faces."""

from __future__ import annotations

import os
from collections.abc import Mapping

from numpy.typing import ArrayLike

from interflect import _core
from interflect._progress import ProgressArgument, reporting
from interflect._scenes import scene_of


def view_factors(scene: _core.Scene | str | os.PathLike[str], groups: str | Mapping[str, str | ArrayLike] | None = None, *,
                 rays: float = 20e6, sides: str = "both", opaque_backs: bool = True, seed: int = 1, threads: int = 0,
                 progress: ProgressArgument = None) -> _core.ViewFactors:
    """Estimates the view factors between groups of faces by ray casting, as the command `interflect viewfactors`.

    Args:
        scene: Scene, or the path of one; .vs3 files of View3D too.
        groups: "objects", "materials", "facets" (every face is a group), or a dict by name of the group: patterns of the
            names of objects or materials ("wall*"), or indices of faces, or one boolean per face. Other faces only block.
            Default: the named objects, or the materials if no object has a name.
        rays: Total number; every group has the same power of two of them, at least 1024.
        sides: "both", "front" or "back": sides of two-sided faces that belong to groups; the others only block.
        opaque_backs: Whether the backs of one-sided faces block radiation; otherwise they let it through.
        seed: The same seed gives the same bits for any number of threads.
        threads: Number of threads; 0: all.
        progress: As of solve().

    Returns:
        The factors, with a standard error for each.

    Raises:
        InputError: for groups with common or missing faces, and a number of rays out of range.
    """
    with reporting(progress, "view factors") as report:
        return _core.view_factors(scene_of(scene), groups, rays, sides, opaque_backs, seed, threads, report)
