"""The docstrings of the module, and the program that makes them of the comments of the public headers."""

import importlib.util
import inspect
import re
import sys
import unittest
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import interflect as ifl

ROOT = Path(__file__).resolve().parents[3]
specification = importlib.util.spec_from_file_location("docstrings", ROOT / "python/docstrings.py")
docstrings = importlib.util.module_from_spec(specification)
sys.modules["docstrings"] = docstrings
specification.loader.exec_module(docstrings)

HEADER = """
/// @file
/// Lamps.
#pragma once
namespace interflect {

/// A lamp, as null says:
///     P = M A
/// where M is its exitance (see lamp_fault()), in Scene::patches.
struct Lamp {
    float power = 0;   ///< Of all sides [lm],
                       ///< without the back.
    float height = 1, width = 1;  ///< Sides [m].
    std::array<Tube, 2> tubes{{{1, 0}, {2, 0}}};  ///< By length.
    /// Sets the size. Takes long. @param height, width  Sides [m],
    ///     > 0.
    /// @param monitor  Its stop.
    /// @note Only in C++.
    /// @return  The area (Lamp::power).
    /// @throws InputError for a size <= 0, Lamp::height; std::runtime_error if it is hot. Cost: O(n).
    double resize(float height, float width, const Monitor& monitor = {});
};

/// In groups. @throws InputError for more than max_light_groups.
std::vector<int> group(const Lamp& lamp);
}
"""


class Comments(unittest.TestCase):
    def setUp(self) -> None:
        self.found = docstrings.comments(HEADER)

    def test_members_are_found_under_their_scopes(self) -> None:
        self.assertEqual(set(self.found), {"Lamp", "Lamp_power", "Lamp_height", "Lamp_width", "Lamp_tubes", "Lamp_resize",
                                          "group"})

    def test_a_trailing_comment_of_two_lines_is_one(self) -> None:
        self.assertEqual(self.found["Lamp_power"].text, "Of all sides [lm], without the back.")

    def test_formulas_are_blocks_and_names_are_those_of_python(self) -> None:
        self.assertEqual(self.found["Lamp"].text,
                         "A lamp, as None says:\n\n    P = M A\n\nwhere M is its exitance, in Scene.faces.")

    def test_a_function_has_sections(self) -> None:
        resize = self.found["Lamp_resize"]
        self.assertTrue(resize.is_function)
        self.assertEqual(resize.text, "Sets the size. Takes long.\n\nCost: O(n).")
        self.assertEqual(resize.arguments,
                         {"height": "Sides [m], > 0.", "width": "Sides [m], > 0.", "monitor": "Its stop."})
        self.assertEqual(resize.returns, "The area.")
        self.assertEqual(resize.raises, ["InputError: for a size <= 0, Lamp.height", "Error: if it is hot."])

    def test_limits_are_numbers(self) -> None:
        self.assertEqual(self.found["group"].raises, ["InputError: for more than 32 groups."])

    def test_an_unknown_error_is_reported(self) -> None:
        with self.assertRaisesRegex(ValueError, "found 'bad luck'"):
            docstrings.comments("/// Fails. @throws bad luck\nvoid fail();")


def public_names() -> Iterator[tuple[str, Any]]:
    """Yields the classes and functions of the module, and their methods and properties, by name."""
    for name in ifl.__all__:
        value = getattr(ifl, name)
        if not inspect.isclass(value) and not callable(value):
            continue
        yield name, value
        if inspect.isclass(value):
            for member in vars(value):
                if not member.startswith("_"):
                    yield f"{name}.{member}", getattr(value, member)


def functions() -> Iterator[tuple[str, Any]]:
    for name, value in public_names():
        if callable(value) and not inspect.isclass(value):
            yield name, value


def is_made_by_users(kind: type) -> bool:
    """Whether a class has a constructor; others are results of functions."""
    try:
        return not issubclass(kind, Exception) and inspect.signature(kind) is not None
    except ValueError:
        return False


def described_arguments(docstring: str) -> set[str]:
    """Returns the names before the colons of the section Args."""
    section = re.search(r"^ *Args:\n((?: +\S.*\n?)+)", docstring, re.MULTILINE)
    if not section:
        return set()
    indent = min(len(line) - len(line.lstrip()) for line in section.group(1).splitlines())
    entries = re.findall(rf"^ {{{indent}}}(\w[\w, ]*):", section.group(1), re.MULTILINE)
    return {name for entry in entries for name in entry.split(", ")}


class Docstrings(unittest.TestCase):
    def test_everything_public_has_one(self) -> None:
        for name, value in public_names():
            with self.subTest(name):
                self.assertGreater(len(inspect.getdoc(value) or ""), 3)
                self.assertNotEqual(inspect.getdoc(value), inspect.getdoc(type(value)))

    def test_every_argument_is_described(self) -> None:
        for name, function in functions():
            with self.subTest(name):
                arguments = set(inspect.signature(function).parameters) - {"self", "cls"}
                self.assertEqual(described_arguments(inspect.getdoc(function)), arguments)

    def test_arguments_of_classes_are_described_or_attributes(self) -> None:
        for name, value in public_names():
            if not inspect.isclass(value) or not is_made_by_users(value):
                continue
            with self.subTest(name):
                described = described_arguments(inspect.getdoc(value)) | described_arguments(
                    inspect.getdoc(value.__init__) or "")
                arguments = set(inspect.signature(value).parameters)
                self.assertEqual(arguments - described - set(vars(value)), set())
                self.assertEqual(described - arguments, set())

    def test_there_is_no_cpp_in_them(self) -> None:
        cpp = re.compile(r"::|std\b|nullopt|\bnull\b|\btrue\b|\bfalse\b|Monitor|Options\b|\bLimits\.|\bconst\b|"
                         r"@\w+|\w\.h\b|_core|<[a-z_]+>|ray_caster|\bmonitor\b|vector<|\bLeaf\b")
        for name, value in public_names():
            with self.subTest(name):
                self.assertIsNone(cpp.search(inspect.getdoc(value)), inspect.getdoc(value))

    def test_the_functions_and_attributes_that_they_name_exist(self) -> None:
        classes = [value for value in vars(ifl).values() if inspect.isclass(value)]
        for name, value in public_names():
            text = inspect.getdoc(value)
            for scope, function in re.findall(r"\b(?:([A-Za-z]\w*)\.)?([a-z]\w*)\(\)", text):
                with self.subTest(name, function=function):
                    if scope and hasattr(ifl, scope):
                        self.assertTrue(hasattr(getattr(ifl, scope), function))
                    elif not scope:
                        self.assertTrue(hasattr(ifl, function) or any(hasattr(c, function) for c in classes), function)
            for scope, member in re.findall(r"\b([A-Z][a-z]\w*)\.([a-z]\w*)\b(?!\()", text):
                with self.subTest(name, member=f"{scope}.{member}"):
                    self.assertTrue(hasattr(ifl, scope) and hasattr(getattr(ifl, scope), member))


    def test_the_words_in_backticks_are_names(self) -> None:
        members = {member for kind in vars(ifl).values() if inspect.isclass(kind) for member in dir(kind)}
        for name, value in public_names():
            arguments = set(inspect.signature(value).parameters) if inspect.isroutine(value) else set()
            for word in re.findall(r"`([a-z]\w*)`", inspect.getdoc(value)):
                with self.subTest(name, word=word):
                    self.assertIn(word, members | arguments | set(ifl.__all__) | {"interflect"})


if __name__ == "__main__":
    unittest.main()
