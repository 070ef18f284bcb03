"""Pages of the Python module: sphinx-build -W -b html docs/python out/python, with the module on PYTHONPATH.

The API pages contain the docstrings, which repeat the comments of include/interflect (python/docstrings.py).
"""

from __future__ import annotations

import re
from typing import Any

import interflect
from sphinx.ext.autodoc import ClassDocumenter
from sphinx.ext.napoleon import Config, GoogleDocstring

project = "Interflect"
author = "The Interflect authors"
copyright = author
version = release = interflect.__version__

extensions = ["sphinx.ext.autodoc"]
html_theme = "alabaster"
html_theme_options = {"page_width": "1200px", "body_max_width": "950px", "font_family": "sans-serif",
                      "head_font_family": "sans-serif"}
html_static_path = ["_static"]
html_css_files = ["style.css"]
html_copy_source = False
default_role = "literal"  # `name`, as in the docstrings
highlight_language = "python"

autodoc_typehints = "none"  # the descriptions of arguments and attributes have shapes, units and ranges
autodoc_default_options = {"members": True}
autoclass_content = "both"  # of the class and of its constructor

FUNCTION = re.compile(r"(?<![`\w.])(?:([A-Z]\w+)\.)?([a-z]\w+)\(\)")


class ClassInOrder(ClassDocumenter):
    """Lists the members of a class in the order of their definition, for the compiled module too."""

    def sort_members(self, documenters: list[tuple[Any, bool]], order: str) -> list[tuple[Any, bool]]:
        names = list(vars(self.object))
        return sorted(documenters, key=lambda member: names.index(member[0].name.rpartition(".")[2]))


def linked(line: str) -> str:
    """Links the functions that a docstring names, `solve()` and `Solution.save()`."""

    def link(found: re.Match[str]) -> str:
        scope, function = found.groups()
        if not hasattr(getattr(interflect, scope, None) if scope else interflect, function):
            return found.group(0)
        return f":py:meth:`~interflect.{scope}.{function}`" if scope else f":py:func:`~interflect.{function}`"

    return FUNCTION.sub(link, line)


def convert(app: Any, what: str, name: str, value: object, options: Any, lines: list[str]) -> None:
    """Converts a docstring to reStructuredText. Docstrings of attributes have no sections."""
    lines[:] = [linked(line) for line in lines]
    if what not in ("attribute", "property"):
        lines[:] = GoogleDocstring(lines, Config(napoleon_use_param=False), app, what, name, value, options).lines()


def with_dots(app: Any, what: str, name: str, value: object, options: Any, signature: str, returns: str) -> tuple[str, str]:
    """Shows defaults that are objects as "..."."""
    return (signature or "").replace("=Ellipsis", "=..."), returns


def is_described_once(app: Any, what: str, name: str, value: object, skip: bool, options: Any) -> bool:
    """Omits replace() of plain data, which the module's docstring describes."""
    return skip or (name == "replace" and "Values by name" in (value.__doc__ or ""))


def setup(app: Any) -> None:
    app.add_autodocumenter(ClassInOrder, override=True)
    app.connect("autodoc-process-docstring", convert)
    app.connect("autodoc-process-signature", with_dots)
    app.connect("autodoc-skip-member", is_described_once)
