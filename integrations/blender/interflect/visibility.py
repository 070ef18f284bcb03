"""Visibility of objects while a scene is exported."""

from contextlib import contextmanager

import bpy

from .result import HIDDEN, is_result


@contextmanager
def only_rendered(scene):
    """Shows exactly the rendered objects: in pictures for the exporter, in the viewport for their modifiers. The
    objects below a result replace it. Yields the objects; restores everything afterwards."""
    layer = bpy.context.view_layer
    rendered, parts = {}, []
    _collect(layer.layer_collection, rendered, parts)
    changed = []  # (owner, name of its property, value before)

    def change(owner, name, value):
        before = getattr(owner, name)
        if before != value:
            changed.append((owner, name, before))
            setattr(owner, name, value)

    by_eye = []
    try:
        for each in scene.objects:
            change(each, "hide_render", each not in rendered and each != scene.camera)
        for part in parts:
            change(part, "hide_viewport", False)
            change(part.collection, "hide_viewport", False)
        for each in rendered:
            change(each, "hide_viewport", False)
        layer.update()
        by_eye += [each for each in rendered if each.hide_get(view_layer=layer)]
        for each in by_eye:
            each.hide_set(False, view_layer=layer)
        layer.update()
        yield rendered
    finally:
        for each in by_eye:
            each.hide_set(True, view_layer=layer)
        for owner, name, before in reversed(changed):
            setattr(owner, name, before)


def _collect(part, rendered, parts) -> None:
    """Adds the rendered objects below a layer's collection, and the parts of the layer that have some."""
    if part.collection.hide_render:
        return
    if not part.exclude:
        parts.append(part)
        for each in part.collection.objects:
            if not is_result(each) and (HIDDEN in each or not each.hide_render):
                rendered[each] = True
    for child in part.children:
        _collect(child, rendered, parts)
