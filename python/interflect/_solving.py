"""Solving: in one call, or step by step."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from types import TracebackType
from typing import Any, NoReturn, TypeVar

from interflect import _core
from interflect._progress import ProgressArgument, reporting
from interflect._scenes import scene_of

ViewArgument = _core.View | _core.WeightedView | str
ViewsArgument = ViewArgument | Iterable[ViewArgument] | None
SceneArgument = _core.Scene | str | os.PathLike[str]
Function = TypeVar("Function", bound=Callable[..., Any])


def _documented_as(original: Callable[..., Any]) -> Callable[[Function], Function]:
    """Copies the docstring of a method of the C++ library."""

    def with_docstring(method: Function) -> Function:
        method.__doc__ = original.__doc__
        return method

    return with_docstring


class Solver:
    def __init__(self, scene: SceneArgument, *, method: str | None = None, views: ViewsArgument = None, seed: int = 1,
                 threads: int = 0, rays: float | None = None, time: float | None = None, until: float | None = None,
                 contact_cuts: bool = True, mesh_size: float | None = None, **settings: Any) -> None:
        given = {"rays": rays, "time": time, "until": until}
        settings.update({name: value for name, value in given.items() if value is not None}, seed=seed)
        self._solver = _core.Solver(scene_of(scene), method, views, threads, contact_cuts, mesh_size, settings)

    @classmethod
    def _of(cls, solver: _core.Solver) -> Solver:
        self = cls.__new__(cls)
        self._solver = solver
        return self

    @_documented_as(_core.Solver.advance)
    def advance(self, rays: float | None = None, time: float | None = None, until: float | None = None, *,
                progress: ProgressArgument = None) -> _core.AdvanceReport:
        with reporting(progress, "solving") as report:
            return self._solver.advance(rays, time, until, report)

    @_documented_as(_core.Solver.set_views)
    def set_views(self, views: ViewsArgument) -> None:
        self._solver.set_views(views)

    @_documented_as(_core.Solver.set_dimming)
    def set_dimming(self, group: str, factor: float) -> None:
        self._solver.set_dimming(group, factor)

    @_documented_as(_core.Solver.set_plan)
    def set_plan(self, rays: float | None = None, time: float | None = None, until: float | None = None) -> None:
        self._solver.set_plan(rays, time, until)

    @property
    def solution(self) -> _core.Solution:
        """Current solution, computed on first request in O(elements). It stays as it is when the solver goes on."""
        return self._solver.solution

    def take_solution(self) -> _core.Solution:
        """Current solution without a copy. Closes the solver."""
        return self._solver.take_solution()

    @property
    def scene(self) -> _core.Scene:
        """The scene as it is solved, with its sources as scaled by set_dimming()."""
        return self._solver.scene

    @property
    def views(self) -> list[_core.WeightedView]:
        """Views that define importance, with their weights."""
        return self._solver.views

    @property
    def options(self) -> dict[str, Any]:
        """Settings by name, including defaults."""
        return self._solver.options

    @_documented_as(_core.Solver.save)
    def save(self, path: str | os.PathLike[str]) -> None:
        self._solver.save(path)

    @classmethod
    @_documented_as(_core.Solver.open)
    def open(cls, path: str | os.PathLike[str], *, threads: int = 0) -> Solver:
        return cls._of(_core.Solver.open(path, threads))

    def close(self) -> None:
        """Frees the memory of the run. Solutions and their arrays stay valid; other calls raise Error."""
        self._solver.close()

    @property
    def is_closed(self) -> bool:
        """Whether close() was called."""
        return self._solver.is_closed

    def __enter__(self) -> Solver:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 traceback: TracebackType | None) -> None:
        self.close()

    def __reduce__(self) -> NoReturn:
        raise TypeError("a Solver can be neither copied nor pickled: save() it, and Solver.open() the file")

    def __repr__(self) -> str:
        if self.is_closed:
            return "<Solver: closed>"
        return f"<Solver of '{self.scene.name}': {self.options['method']}>"


Solver.__doc__ = f"""{_core.Solver.__doc__}

Args:
    scene: Scene, or the path of one.
    method: Name of the method; default: ihsrr with views, otherwise hsrr.
    views: Views that define importance: a View, WeightedView or name of a view of the scene, or several.
    seed: The same seed gives the same bits for any number of threads.
    threads: Number of threads; 0: all.
    rays: Limit of the whole run; default: 20 million if no other limit is given.
    time: Limit of the whole run [s]; results then depend on the speed.
    until: Target of the estimated relative error, in [0, 1).
    contact_cuts: Cuts faces where others meet them, to prevent light leaks.
    mesh_size: Divides patches to this longest edge [m] first; default: only for methods that do not refine.
    settings: Other settings, named as the options of `interflect solve`: keep_direct, min_area, max_elements,
        refinement_criterion, importance, camera_rays, importance_smoothing, importance_exponent, preset="paper", and the
        experimental ones; `options` lists all.

Raises:
    InputError: that lists every setting out of range and every fault of the scene.
    TypeError: for an unknown setting or a value of another type.
"""


def solve(scene: SceneArgument, *, view: ViewArgument | None = None, views: ViewsArgument = None,
          method: str | None = None, rays: float | None = None, time: float | None = None, until: float | None = None,
          seed: int = 1, threads: int = 0, progress: ProgressArgument = None, **settings: Any) -> _core.Solution:
    """Solves a scene in one call, as the command `interflect solve` does, with the same bits.

    Args:
        scene: Scene, or the path of one.
        view: View that defines importance; or
        views: several.
        method, rays, time, until, seed, threads, settings: As of Solver.
        progress: True, False, or a function of a Progress; default: a bar in notebooks, if tqdm is installed.

    Returns:
        The light, on a mesh that is refined where it varies.

    Raises:
        InputError, TypeError: as Solver.
        KeyboardInterrupt: at Ctrl-C. A Solver keeps its finished iterations; its `solution` is then usable.
    """
    if view is not None and views is not None:
        raise TypeError("solve: expected view or views, found both")
    chosen = view if view is not None else views
    with Solver(scene, method=method, views=chosen, rays=rays, time=time, until=until, seed=seed, threads=threads,
                **settings) as solver:
        while not solver.advance(progress=progress).is_finished:
            pass
        return solver.take_solution()


def open_solution(path: str | os.PathLike[str]) -> _core.Solution:
    """Reads a solution file, as Solution.open().

    Args:
        path: File of Solution.save(), Solver.save() or `interflect solve`.

    Raises:
        InputError: for a file that is missing, damaged or of another kind.
    """
    return _core.Solution.open(path)
