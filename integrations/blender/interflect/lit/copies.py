"""A result as a collection of lit copies, which replace the hidden objects."""

from pathlib import Path

import bpy

from .. import result, versions
from ..gltf_file import GltfFile
from . import sides


def show(scene, path: Path, objects: list[str], left_out: set[str]) -> None:
    """Puts the lit meshes of a file, but for those with the names in `left_out`, into a collection. Hides the objects
    that they represent."""
    _remove_meshes(path, left_out)
    with result.marking():
        # A temporary scene shields the user's units, renderer, selection and active collection from the importer.
        temporary = bpy.data.scenes.new(result.COLLECTION)
        lit = bpy.data.collections.new(result.COLLECTION)
        try:
            with bpy.context.temp_override(scene=temporary, view_layer=temporary.view_layers[0]):
                bpy.ops.import_scene.gltf(filepath=str(path), **versions.watts_as_lumens(bpy.ops.import_scene.gltf))
            for made in temporary.objects:
                made.select_set(False, view_layer=temporary.view_layers[0])
                if made.type == "MESH" or made.children:
                    lit.objects.link(made)
            temporary.view_layers[0].update()  # computes the places of the objects
            sides.separate(lit.objects)
            scene.collection.children.link(lit)
        finally:
            bpy.data.scenes.remove(temporary)
    result.purge()  # removes the file's cameras, lights and nodes without a mesh
    result.hide(scene, objects)


def _remove_meshes(path: Path, names: set[str]) -> None:
    file = GltfFile(path)
    for shown in file.shown_meshes():
        if shown.names[-1] in names:
            del shown.node["mesh"]
    file.write(path)
