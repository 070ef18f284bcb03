"""The result of a bake in Blender's file: its data, and the hidden objects that it represents.

Custom properties mark both. They survive renaming, manual deletion, undo and saving."""

from contextlib import contextmanager

import bpy

RESULT = "interflect_result"  # marks data that a bake made
HIDDEN = "interflect_hidden"  # marks objects that a bake hid: names of the view layers that showed them, one per line
WARNINGS = "interflect_warnings"  # of the result's collection: one per line

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
    return [warning for collection in collections(scene) for warning in collection.get(WARNINGS, "").splitlines()]


def hide(scene, names) -> None:
    """Hides the objects with these names from pictures and from all view layers."""
    names, members = set(names), [(layer, set(layer.objects)) for layer in scene.view_layers]
    for original in [each for each in scene.objects if each.name in names]:
        layers = [layer for layer, objects in members if original in objects]
        original[HIDDEN] = "\n".join(layer.name for layer in layers if not original.hide_get(view_layer=layer))
        original.hide_render = True
        for layer in layers:
            original.hide_set(True, view_layer=layer)


def remove(scene) -> None:
    """Removes the result of a scene with its unused data, and shows the objects that it represents."""
    bpy.data.batch_remove([made for made in scene.objects if is_result(made)])
    for collection in collections(scene):
        for kept in collection.objects:  # put there by the user
            if kept.name not in scene.collection.objects:
                scene.collection.objects.link(kept)
        for kept in collection.children:
            if kept.name not in scene.collection.children:
                scene.collection.children.link(kept)
        bpy.data.collections.remove(collection)
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
