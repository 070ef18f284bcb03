"""Attributes of objects have the types of the stubs, and the shapes and dtypes of their docstrings."""

import ast
import inspect
import pickle
import re
import types
import typing
import unittest
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import interflect as ifl
from interflect import _core

STUBS = ast.parse(Path(_core.__file__).with_name("_core.pyi").read_text(encoding="utf-8"))
SHAPE = re.compile(r"\(([\w, ]+)\) (u?int\d+|float\d+)\b")


def examples() -> Iterator[object]:
    """Yields objects of most classes, with every optional part."""
    corners = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
    texture = ifl.Texture(np.full((2, 3, 3), 0.5))
    lamp = ifl.Luminaire("lamp", ifl.PointLight((1, 1, 1), 100))
    scene = ifl.Scene(corners, [(0, 1, 2, 3), (4, 7, 6, 5), (2, 6, 7, 3)],
                      [ifl.Material("paint", 0.5, reflectance_texture=0), ifl.Material("light", exitance=100)],
                      face_materials=[0, 1, 0], two_sided=[False, False, True], objects=["", "floor"],
                      face_objects=[1, 0, 0], normals=np.tile((0, 0, 1), (8, 1)), texture_coordinates=np.zeros((8, 2)),
                      lightmap_coordinates=np.zeros((8, 2)), textures=[texture], luminaires=[lamp],
                      views=[ifl.View("view", (1, -4, 1), (1, 1, 1))], light_groups=[ifl.LightGroup("lamps", "lamp")])
    solver = ifl.Solver(scene, views="view", rays=2000, keep_direct=True, threads=1)
    yield from (scene, texture, lamp, solver, *scene.materials, *scene.views, *scene.light_groups)
    yield solver.advance(progress=(progress := []).append)
    solution = solver.solution
    yield from (progress[-1], solution, solution.elements, solution.power_balance(), *solution.views)
    yield from (solution.find_escapes(), solution.find_one_way_light(), ifl.summarise(scene), *ifl.summarise(scene).materials)
    area = ifl.find_top(scene, "floor")
    grid = ifl.area_grid(scene, area)
    measurement = ifl.probe(solution, grid, samples=16)
    yield from (area, grid, measurement, measurement.summary())
    for rating in ifl.rate_glare(solution, (1, 0.2, 1), (0, 1, 0.5), samples=16):
        yield from (rating, *rating.sources)
    yield (tracing := ifl.trace(solution, shading="gather", width=8, height=4, samples=4))
    yield (difference := ifl.compare(tracing.image, tracing.image))
    yield from difference.blocks
    for finding in ifl.validate(scene):
        yield from (finding, *finding.places)
    yield from (ifl.SkyDome(ifl.cie_standard_sky(1)), ifl.cie_standard_sky(1), ifl.Daylight(sun=ifl.Sun()), ifl.Sun())


OBJECTS = list(examples())


def fits(value: object, kind: Any) -> bool:
    """Whether a value has a type, with the types of its elements."""
    origin, arguments = typing.get_origin(kind), typing.get_args(kind)
    if kind is Any:
        return True
    if origin in (typing.Union, types.UnionType):
        return any(fits(value, argument) for argument in arguments)
    if origin is np.ndarray:
        return isinstance(value, np.ndarray) and value.dtype == typing.get_args(arguments[1])[0]
    if origin is list:
        return isinstance(value, list) and all(fits(item, arguments[0]) for item in value)
    if origin is dict:
        return isinstance(value, dict) and all(
            fits(key, arguments[0]) and fits(item, arguments[1]) for key, item in value.items())
    if origin is tuple:
        return isinstance(value, tuple) and len(value) == len(arguments) and all(map(fits, value, arguments))
    return isinstance(value, (int, float) if kind is float else kind)


def stub_types() -> dict[str, dict[str, Any]]:
    """Returns the types of the attributes and properties of each class."""
    names: dict[str, Any] = {**vars(_core)}
    result: dict[str, dict[str, Any]] = {}
    for node in STUBS.body:
        if isinstance(node, (ast.Import, ast.ImportFrom)) or isinstance(node, ast.Assign):
            exec(compile(ast.Module([node], []), "_core.pyi", "exec"), names)
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            members = {item.target.id: item.annotation for item in node.body if isinstance(item, ast.AnnAssign)}
            members |= {item.name: item.returns for item in node.body
                        if isinstance(item, ast.FunctionDef) and item.decorator_list
                        and ast.unparse(item.decorator_list[0]) == "property"}
            result[node.name] = {name: eval(ast.unparse(kind), names) for name, kind in members.items()}
    return result


class Attributes(unittest.TestCase):
    def test_have_the_types_of_the_stubs(self) -> None:
        kinds = stub_types()
        for item in OBJECTS:
            for name, kind in kinds[type(item).__name__].items():
                with self.subTest(type(item).__name__, name=name):
                    value = getattr(item, name)
                    self.assertTrue(fits(value, kind), f"expected {kind}, found {value!r}")

    def test_have_the_shapes_of_their_docstrings(self) -> None:
        checked = 0
        for item in OBJECTS:
            for name, member in vars(type(item)).items():
                shape = SHAPE.match(inspect.getdoc(member) or "") if isinstance(member, property) else None
                if shape is None:
                    continue
                with self.subTest(type(item).__name__, name=name):
                    array = getattr(item, name)
                    self.assertEqual(array.dtype, shape.group(2))
                    sizes = [size.strip() for size in shape.group(1).split(",") if size.strip()]
                    self.assertEqual(array.ndim, len(sizes))
                    for found, size in zip(array.shape, sizes):
                        self.assertTrue(not size.isdigit() or found == int(size), array.shape)
                checked += 1
        self.assertGreater(checked, 30)

    def test_arrays_are_described_with_their_shapes(self) -> None:
        for item in OBJECTS:
            for name, member in vars(type(item)).items():
                if isinstance(member, property) and isinstance(getattr(item, name), np.ndarray):
                    with self.subTest(type(item).__name__, name=name):
                        self.assertRegex(inspect.getdoc(member), SHAPE)

    def test_reprs_are_short(self) -> None:
        for item in OBJECTS:
            with self.subTest(type(item).__name__):
                self.assertNotIn(" object at 0x", repr(item))
                self.assertLess(len(repr(item)), 200)

    def test_reprs_of_plain_data_make_it_again(self) -> None:
        names = {**vars(ifl)}
        for item in OBJECTS:
            if hasattr(item, "replace") and not isinstance(item, ifl.Scene):
                with self.subTest(type(item).__name__):
                    self.assertEqual(eval(repr(item), names), item)

    def test_objects_without_pickle_refuse_it(self) -> None:
        """pybind11 ends the process for protocols 0 and 1."""
        for item in OBJECTS:
            for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
                with self.subTest(type(item).__name__, protocol=protocol):
                    if hasattr(item, "replace") and not isinstance(item, ifl.Scene):
                        self.assertEqual(pickle.loads(pickle.dumps(item, protocol)), item)
                    else:
                        with self.assertRaisesRegex(TypeError, f"(?i)pickle.*{type(item).__name__}|Solver.*save"):
                            pickle.dumps(item, protocol)


if __name__ == "__main__":
    unittest.main()
