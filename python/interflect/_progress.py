"""Progress of long work, by tqdm if it is installed."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib import import_module
from importlib.util import find_spec
from typing import Any

from interflect import _core

Report = Callable[[_core.Progress], Any]
UNNOTICED = 1.0  # [s]: waiting that needs no explanation
ProgressArgument = bool | Report | None


def _is_in_notebook() -> bool:
    shell = sys.modules.get("IPython") and sys.modules["IPython"].get_ipython()
    return bool(shell) and "ipykernel" in sys.modules


@contextmanager
def reporting(progress: ProgressArgument, what: str) -> Iterator[Report | None]:
    """Yields a function that shows progress, or None.

    Args:
        progress: The function itself; True for a bar of tqdm; False for none; None for a bar in notebooks only.
        what: Label of the bar.
    """
    if callable(progress):
        yield progress
        return
    if not (progress or (progress is None and _is_in_notebook())):
        yield None
        return
    try:
        # Without ipywidgets tqdm.auto warns in every notebook.
        has_widgets = _is_in_notebook() and find_spec("ipywidgets") is not None
        tqdm = import_module("tqdm.notebook" if has_widgets else "tqdm").tqdm
    except ImportError:
        yield None
        return
    # Default bars appear only for long work, and disappear at its end.
    quiet = {"leave": False, "delay": UNNOTICED} if progress is None else {}
    form = "{l_bar}{bar}| {elapsed}<{remaining}{postfix}"
    with tqdm(total=100, desc=what, unit="%", bar_format=form, **quiet) as bar:

        def show(now: _core.Progress) -> None:
            error = f", error {100 * now.relative_error:.2g}%" if now.relative_error < float("inf") else ""
            bar.set_postfix_str(f"{now.rays:.3g} rays{error}", refresh=False)
            bar.update(min(100, round(100 * now.fraction)) - bar.n)

        yield show
        bar.update(100 - bar.n)
