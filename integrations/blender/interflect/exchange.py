"""Exchange between Blender's scene and files: export for the solver, and import of lit meshes."""

import json
import struct
from pathlib import Path

import bpy

from . import area_lamps, lit_sides, result, versions
from .visibility import only_rendered

LIT_COLLECTION = "Interflect"
EXPORTED_TYPES = ("MESH", "CURVE", "SURFACE", "FONT", "LIGHT")
LEFT_OUT_TYPES = ("META", "CURVES", "VOLUME", "POINTCLOUD", "GPENCIL")


class Exported:
    def __init__(self, objects: list[str], warnings: list[str]):
        self.objects, self.warnings = objects, warnings


def export_scene(scene, path: Path) -> Exported:
    """Writes the rendered objects of the current scene at its frame, without an earlier result and with panels for area
    lamps. Watts in Blender are lumens in the file."""
    with only_rendered(scene) as rendered, area_lamps.as_panels(scene) as warnings:
        objects = [o for o in rendered if o.type in EXPORTED_TYPES or o.instance_type == "COLLECTION"]
        warnings += _left_out(rendered)
        bpy.ops.export_scene.gltf(
            filepath=str(path),
            use_active_scene=True,
            use_renderable=True,
            export_lights=True,
            export_cameras=True,
            export_apply=True,
            export_animations=False,
            export_current_frame=True,
            **versions.watts_as_lumens(bpy.ops.export_scene.gltf),
        )
        return Exported([o.name for o in objects], warnings)


def _left_out(rendered):
    shapes = [o.name for o in rendered if o.type in LEFT_OUT_TYPES]
    if shapes:
        yield f"Neither mesh nor curve nor text, and left out: {', '.join(shapes)}"
    instances = bpy.context.evaluated_depsgraph_get().object_instances
    by_nodes = {i.parent.name for i in instances if i.is_instance and not i.parent.is_instancer}.difference(shapes)
    if by_nodes:
        yield f"Instances that geometry nodes make are left out unless nodes make them real: {', '.join(sorted(by_nodes))}"


def camera_names(path: Path) -> list[str]:
    content = path.read_bytes()
    (length,) = struct.unpack_from("<I", content, 12)  # length of the JSON, after the headers of the file and the chunk
    nodes = json.loads(content[20 : 20 + length]).get("nodes", [])
    return [node["name"] for node in nodes if "camera" in node]


def import_lit(scene, path: Path, replaced: list[str], warnings: list[str]) -> None:
    """Puts the lit meshes of a file into their own collection, which replaces an earlier one. Hides the objects that
    they represent."""
    result.remove(scene)
    with result.marking():
        # A temporary scene shields the user's units, renderer, selection and active collection from the importer.
        temporary = bpy.data.scenes.new(LIT_COLLECTION)
        lit = bpy.data.collections.new(LIT_COLLECTION)
        try:
            with bpy.context.temp_override(scene=temporary, view_layer=temporary.view_layers[0]):
                bpy.ops.import_scene.gltf(filepath=str(path), **versions.watts_as_lumens(bpy.ops.import_scene.gltf))
            for made in temporary.objects:
                made.select_set(False, view_layer=temporary.view_layers[0])
                if made.type not in ("CAMERA", "LIGHT"):
                    lit.objects.link(made)
            temporary.view_layers[0].update()  # computes the places of the objects
            lit_sides.separate(lit.objects)
            scene.collection.children.link(lit)
        finally:
            bpy.data.scenes.remove(temporary)
    result.purge()  # removes the file's cameras and lights
    lit[result.WARNINGS] = "\n".join(warnings)
    result.hide(scene, replaced)
