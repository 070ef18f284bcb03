"""View factors between groups of faces."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from interflect import _core
from interflect._progress import ProgressArgument, reporting
from interflect._scenes import scene_of

if TYPE_CHECKING:
    from scipy.sparse import csr_matrix


class ViewFactors:
    """View factors F_ij: the fraction of the diffuse radiation that leaves group i and reaches group j directly.

    A sparse matrix in compressed rows. All arrays are read-only and not copied.
    """

    def __init__(self, factors: _core.ViewFactors) -> None:
        self._factors = factors

    names: list[str]
    areas: NDArray[np.float64]
    row_offsets: NDArray[np.int64]
    columns: NDArray[np.int32]
    values: NDArray[np.float32]
    errors: NDArray[np.float32]
    sky: NDArray[np.float32]
    sky_errors: NDArray[np.float32]
    ground: NDArray[np.float32]
    ground_errors: NDArray[np.float32]
    blocked: NDArray[np.float32]
    blocked_errors: NDArray[np.float32]
    rays_per_group: int

    def __getattr__(self, name: str) -> Any:
        return getattr(self._factors, name)

    @property
    def matrix(self) -> csr_matrix:
        """The factors as a sparse matrix of SciPy (n, n), which shares the arrays."""
        return self._csr(self._factors.values)

    @property
    def error_matrix(self) -> csr_matrix:
        """Standard errors of the non-zero factors, (n, n). Absent factors have 1 / rays_per_group."""
        return self._csr(self._factors.errors)

    def dense(self) -> NDArray[np.float64]:
        """The factors as an array (n, n)."""
        n = len(self)
        result = np.zeros((n, n))
        result[self._rows(), self._factors.columns] = self._factors.values
        return result

    def dense_errors(self) -> NDArray[np.float64]:
        """Standard errors as an array (n, n); those of absent factors are 1 / rays_per_group."""
        n = len(self)
        result = np.full((n, n), 1 / self._factors.rays_per_group)
        result[self._rows(), self._factors.columns] = self._factors.errors
        return result

    def closure(self) -> NDArray[np.float64]:
        """Sum of each row with sky, ground and blocked, (n,): 1, unless the group has no uncovered area."""
        f = self._factors
        sums = np.bincount(self._rows(), f.values.astype(np.float64), len(self))
        return sums + f.sky + f.ground + f.blocked

    def consistency(self) -> _core.Consistency:
        """How far the factors are from closure and from reciprocity."""
        return self._factors.consistency()

    def reconciled(self, *, closure: bool = True, reciprocity: bool = True, threads: int = 0,
                   progress: ProgressArgument = None) -> tuple[ViewFactors, _core.Reconciliation]:
        with reporting(progress, "fitting") as report:
            fitted, reconciliation = self._factors.reconciled(closure, reciprocity, threads=threads, progress=report)
        return ViewFactors(fitted), reconciliation

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the arrays to a .npz file, named as here; numpy.load() reads it."""
        names = ("areas", "row_offsets", "columns", "values", "errors", "sky", "sky_errors", "ground", "ground_errors",
                 "blocked", "blocked_errors", "rays_per_group")
        np.savez(path, names=np.array(self.names), **{name: getattr(self, name) for name in names})

    def _rows(self) -> NDArray[np.int64]:
        return np.repeat(np.arange(len(self)), np.diff(self._factors.row_offsets))

    def _csr(self, values: NDArray[np.float32]) -> csr_matrix:
        from scipy.sparse import csr_matrix
        f = self._factors
        return csr_matrix((values, f.columns, f.row_offsets), shape=(len(f), len(f)), copy=False)

    def __len__(self) -> int:
        return len(self._factors)

    def __repr__(self) -> str:
        return repr(self._factors)


ViewFactors.reconciled.__doc__ = (
    "A copy that obeys closure and reciprocity, and a report.\n\n" + _core.ViewFactors.reconciled.__doc__.split("\n\n", 1)[1])


def view_factors(scene: _core.Scene | str | os.PathLike[str], groups: str | Mapping[str, str | ArrayLike] = "objects", *,
                 rays: float = 20e6, sides: str = "both", opaque_backs: bool = True, seed: int = 1, threads: int = 0,
                 progress: ProgressArgument = None) -> ViewFactors:
    """Estimates the view factors between groups of faces by ray casting, as `interflect viewfactors`.

    Args:
        scene: Scene, or the path of one; .vs3 files of View3D too.
        groups: "objects", "materials", "facets" (every face is a group), or a dict by name of the group: patterns of the
            names of objects or materials ("wall*"), or indices of faces, or one boolean per face. Other faces only block.
        rays: Total number; every group has the same power of two of them, at least 1024.
        sides: "both", "front" or "back": sides of two-sided faces that belong to groups; the others only block.
        opaque_backs: Whether the backs of one-sided faces block radiation; otherwise they let it through.
        seed: The same seed gives the same bits for any number of threads.
        threads: Number of threads; 0: all.
        progress: As of solve().

    Raises:
        InputError: for groups with common or missing faces, and a number of rays out of range.
        Stopped, KeyboardInterrupt: if it is stopped.
    """
    with reporting(progress, "view factors") as report:
        return ViewFactors(_core.view_factors(scene_of(scene), groups, round(rays), sides, opaque_backs, seed, threads,
                                              report))
