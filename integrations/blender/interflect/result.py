"""The result of a bake in Blender's file: its data, the hidden objects that it represents, and objects that show light.

Custom properties mark all. They survive renaming, manual deletion, undo and saving."""

from contextlib import contextmanager

import bpy
import numpy

from .lit.arrays import read

COLLECTION = "Interflect"  # of lit copies
UV_MAP = "Interflect"  # of objects that show light themselves
RESULT = "interflect_result"  # marks data that a bake made
HIDDEN = "interflect_hidden"  # marks objects that a bake hid: names of the view layers that showed them, one per line
LIT = "interflect_lit"  # marks objects that show light themselves: their number of material slots before
HAS_MAP = "interflect_has_map"  # marks objects that show light in an additional UV map
ORIGINAL = "interflect_original"  # of a lit material: the material that it replaces
WARNINGS = "interflect_warnings"  # of the scene's last bake: one per line

KINDS = ("collections", "objects", "meshes", "cameras", "lights", "materials", "node_groups", "images")


@contextmanager
def marking():
    """Marks the data created in the `with` block as a result."""
    before = {kind: set(getattr(bpy.data, kind)) for kind in KINDS}
    try:
        yield
    finally:
        for kind in KINDS:
            for made in set(getattr(bpy.data, kind)) - before[kind]:
                made[RESULT] = True


def is_result(data) -> bool:
    return RESULT in data


def collections(scene) -> list:
    return [collection for collection in scene.collection.children_recursive if is_result(collection)]


def warnings(scene) -> list[str]:
    return scene.get(WARNINGS, "").splitlines()


def set_warnings(scene, warnings: list[str]) -> None:
    scene[WARNINGS] = "\n".join(warnings)


def hide(scene, names) -> None:
    """Hides the objects with these names from pictures and from all view layers."""
    names, members = set(names), [(layer, set(layer.objects)) for layer in scene.view_layers]
    for original in [each for each in scene.objects if each.name in names]:
        layers = [layer for layer, objects in members if original in objects]
        original[HIDDEN] = "\n".join(layer.name for layer in layers if not original.hide_get(view_layer=layer))
        original.hide_render = True
        for layer in layers:
            original.hide_set(True, view_layer=layer)


def leave_edit_mode() -> None:
    """Writes the user's edits to the meshes, which can only be changed afterwards."""
    if bpy.context.mode.startswith("EDIT"):
        bpy.ops.object.mode_set(mode="OBJECT")


def put_on(lit, materials, coordinates) -> None:
    """Shows light in an object: a material in each slot, and coordinates in a UV map."""
    slots = lit[LIT] = len(lit.data.materials)
    for slot, material in zip(lit.material_slots, materials[:slots]):
        slot.material = material
    for material in materials[slots:]:
        lit.data.materials.append(material)
    if coordinates is not None:
        layers = lit.data.uv_layers
        active, lit[HAS_MAP] = layers.active_index, True
        layers.new(name=UV_MAP, do_init=False).data.foreach_set("uv", coordinates.ravel())
        layers.active_index = max(active, 0)


def _showing_light(scene) -> list:
    """Returns the user's objects with light, also those with a lit material after a join or an assignment."""

    def shows_light(each):
        return LIT in each or any(slot.material and is_result(slot.material) for slot in each.material_slots)

    def is_linked(each):
        return each.library or (each.data and each.data.library)

    return [each for each in scene.objects if shows_light(each) and not is_result(each) and not is_linked(each)]


def take_off(lit):
    """Removes the additions of `put_on()`. Returns its arguments."""
    leave_edit_mode()
    slots, materials = lit.pop(LIT, len(lit.data.materials)), [slot.material for slot in lit.material_slots]
    for slot in lit.material_slots:
        if slot.material and is_result(slot.material):
            slot.material = slot.material.get(ORIGINAL)
    while len(lit.data.materials) > slots and lit.data.materials[-1] is None:
        lit.data.materials.pop()
    lit.data = lit.data  # counts the slots of the object again
    layers, coordinates = getattr(lit.data, "uv_layers", ()), None  # none in a mesh that became a curve
    if lit.pop(HAS_MAP, False) and UV_MAP in layers:  # a linked duplicate has lost it with the first object
        coordinates = read(layers[UV_MAP].data, "uv", numpy.float32, 2)
        layers.remove(layers[UV_MAP])
    return materials, coordinates


@contextmanager
def taken_off(scene):
    """Shows objects without their light in the `with` block."""
    light = [(each, take_off(each)) for each in _showing_light(scene)]
    try:
        yield
    finally:
        for each, (materials, coordinates) in reversed(light):
            put_on(each, materials, coordinates)


def remove(scene) -> None:
    """Removes the result of a scene with its unused data, and shows the objects as before."""
    scene.pop(WARNINGS, None)
    bpy.data.batch_remove([made for made in scene.objects if is_result(made)])
    for collection in collections(scene):
        for kept in collection.objects:  # put there by the user
            if kept.name not in scene.collection.objects:
                scene.collection.objects.link(kept)
        for kept in collection.children:
            if kept.name not in scene.collection.children:
                scene.collection.children.link(kept)
        bpy.data.collections.remove(collection)
    for lit in _showing_light(scene):
        take_off(lit)
    purge()
    members = [(layer, set(layer.objects)) for layer in scene.view_layers]
    for original in [each for each in scene.objects if HIDDEN in each]:
        shown_in = original.pop(HIDDEN).splitlines()
        original.hide_render = False
        for layer, objects in members:
            if layer.name in shown_in and original in objects:
                original.hide_set(False, view_layer=layer)


def purge() -> None:
    """Removes unused data of bakes, users before the data that they use."""
    for kind in KINDS:
        bpy.data.batch_remove([made for made in getattr(bpy.data, kind) if is_result(made) and made.users == 0])
