"""Exchange between Blender's scene and files: export for the solver, and import of the light."""

from dataclasses import dataclass
from pathlib import Path

import bpy

from . import area_lamps, result, versions
from .gltf_file import GltfFile
from .lit import copies, objects
from .visibility import only_rendered

EXPORTED_TYPES = ("MESH", "CURVE", "SURFACE", "FONT", "LIGHT")
LEFT_OUT_TYPES = ("META", "CURVES", "VOLUME", "POINTCLOUD", "GPENCIL")
NO_MATERIAL = {  # Blender's default
    "name": "no material",
    "doubleSided": True,
    "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.8, 0.8, 1], "metallicFactor": 0},
}


@dataclass
class Receivers:
    """Objects whose light is shown."""

    is_copied: bool = True  # shown by lit copies, which represent lamps too, else by the objects
    selected: set[str] | None = None  # names of the objects; None: all objects


@dataclass
class Exported:
    objects: list[str]  # names of the objects that lit copies represent
    unlit: set[str]  # names that the solver gives to the meshes without light
    warnings: list[str]


def export_scene(scene, path: Path, receivers: Receivers = Receivers()) -> Exported:
    """Writes the rendered objects of the current scene at its frame, without an earlier result and with panels for area
    lamps. Watts in Blender are lumens in the file."""
    with result.taken_off(scene), only_rendered(scene) as rendered, area_lamps.as_panels(scene) as warnings:
        lit = {o.name: o for o in rendered if o.type in EXPORTED_TYPES or o.instance_type == "COLLECTION"}
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
        file = GltfFile(path)
        _add_material(file)
        unlit = _leave_unlit(file, lit, receivers)
        file.write(path)
        names = [name for name, o in lit.items() if _gets_light(o, receivers)]
        if not names and receivers.selected is not None:
            raise RuntimeError("No object that renders is selected")
        return Exported(names, unlit, warnings)


def _gets_light(owner, receivers) -> bool:
    """@param owner  An object of the scene; None for the panel of an area lamp."""
    if receivers.selected is None:
        return owner is not None or receivers.is_copied
    return owner is not None and owner.type != "LIGHT" and owner.name in receivers.selected


def _leave_unlit(file, objects, receivers) -> set[str]:
    """Requests no lightmap for meshes whose light is not shown. Returns their names in the solver."""
    unlit = set()
    for shown in file.shown_meshes():
        if not _gets_light(shown.owner(objects), receivers):
            shown.node["extras"] = {"texels_per_metre": 0}
            unlit.add(".".join(shown.names))
    return unlit


def _add_material(file) -> None:
    """Adds Blender's default material to surfaces without a material."""
    materials = file.json.setdefault("materials", [])
    materials.append(NO_MATERIAL)
    for mesh in file.json.get("meshes", []):
        for primitive in mesh["primitives"]:
            primitive.setdefault("material", len(materials) - 1)


def _left_out(rendered):
    shapes = [o.name for o in rendered if o.type in LEFT_OUT_TYPES]
    if shapes:
        yield f"Neither mesh nor curve nor text, and left out: {', '.join(shapes)}"
    instances = bpy.context.evaluated_depsgraph_get().object_instances
    by_nodes = {i.parent.name for i in instances if i.is_instance and not i.parent.is_instancer and not _is_own_mesh(i)}
    by_nodes.difference_update(shapes)
    if by_nodes:
        yield f"Instances that geometry nodes make are left out unless nodes make them real: {', '.join(sorted(by_nodes))}"


def _is_own_mesh(instance) -> bool:
    """Returns whether an instance is the mesh of a curve or text."""
    return instance.parent.type in ("CURVE", "SURFACE", "FONT") and instance.object.original == instance.parent.original


def camera_names(path: Path) -> list[str]:
    return [node["name"] for node in GltfFile(path).json.get("nodes", []) if "camera" in node]


def show_light(scene, path: Path, exported: Exported, receivers: Receivers) -> list[str]:
    """Replaces the result of a scene by the light of a file. Returns warnings."""
    result.remove(scene)
    try:
        if receivers.is_copied:
            copies.show(scene, path, exported.objects, exported.unlit)
            return []
        return objects.show(scene, path)
    except Exception:
        result.remove(scene)
        raise
