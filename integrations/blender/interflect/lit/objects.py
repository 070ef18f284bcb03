"""A result in the scene's own objects: a UV map, and images in copies of their materials."""

from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy

from .. import result
from ..gltf_file import Z_UP, GltfFile
from ..visibility import only_rendered
from . import layouts
from .arrays import read
from .materials import LIGHTMAP, UnclampedImages, light_copy

TOLERANCE = 1e-5  # between corners in the file and in the scene, relative to the largest coordinate of their mesh
MOST_UV_MAPS = 8  # of a mesh in Blender
TO_Z_UP = numpy.array(Z_UP)[:3, :3].T  # for rows
CHANGED = "These objects are not as they were exported, and stay unlit"
NO_ROOM = f"These objects have {MOST_UV_MAPS} UV maps or one named '{result.UV_MAP}', and stay unlit"


@dataclass
class Light:
    """Light of one object."""

    target: bpy.types.Object  # the object, or a copy of it
    images: dict[int, str]  # names, by material slot
    coordinates: numpy.ndarray | None  # of each loop of the mesh in its image, unless the object has a layout
    uv_map: str
    layout: layouts.Layout | None  # the object's own


def show(scene, path: Path) -> list[str]:
    """Shows the light of a file in the objects that it was computed for. Copies with applied modifiers replace objects
    whose own meshes cannot show it. Returns warnings."""
    result.leave_edit_mode()
    file = GltfFile(path)
    layer = bpy.context.view_layer if bpy.context.scene == scene else scene.view_layers[0]
    images, materials = UnclampedImages(path.parent, file.json["asset"]["extras"]["interflect"]), {}
    with bpy.context.temp_override(scene=scene, view_layer=layer), result.marking():
        with only_rendered(scene) as rendered:
            plan = Plan(file, {each.name: each for each in rendered})
        for light in plan.lights:
            by_name = {name: images.load(name) for name in light.images.values()}
            if light.layout:
                by_name = {name: layouts.cut(image, light.layout, light.target.name) for name, image in by_name.items()}
            own = [slot.material for slot in light.target.material_slots] or [None]
            lit = list(own)
            for used, name in light.images.items():
                slot = min(used, len(own) - 1)  # faces of a later slot show the last one
                key = own[slot], by_name[name], light.uv_map
                if key not in materials:
                    materials[key] = light_copy(*key)
                lit[slot] = materials[key]
            result.put_on(light.target, lit, light.coordinates)
        if plan.copies:
            collection = bpy.data.collections.new(result.COLLECTION)
            scene.collection.children.link(collection)
            for copy in plan.copies:
                collection.objects.link(copy)
    result.purge()  # removes images whose parts are in other ones
    result.hide(scene, plan.replaced)
    return [f"{reason}: {', '.join(sorted(names))}" for reason, names in plan.reasons.items()]


class Plan:
    """Where the light of a file is shown. Makes the copies."""

    def __init__(self, file: GltfFile, objects: dict):
        self.lights: list[Light] = []
        self.copies: list[bpy.types.Object] = []
        self.replaced: set[str] = set()  # names of objects that copies represent
        self.reasons = defaultdict(set)  # names of objects that do not show light themselves, by reason
        self._depsgraph = bpy.context.evaluated_depsgraph_get()
        self._whole = {"preserve_all_data_layers": True, "depsgraph": self._depsgraph}
        self._instances = [  # instancer, object and place
            (each.parent.original, each.object.original, each.matrix_world.copy())
            for each in self._depsgraph.object_instances
            if each.is_instance
        ]
        for shown in file.shown_meshes():
            lightmaps = _lightmaps(file, shown)
            if any(lightmaps):
                self._add(file, shown, lightmaps, shown.owner(objects))
        for owner, source, matrix in self._instances:
            if owner.name in self.replaced and source.type == "LIGHT":
                self._copy(source, source.data, matrix)

    def _add(self, file, shown, lightmaps, owner):
        source, matrix = self._source(shown, owner)
        if source is None:
            self.reasons[CHANGED].add(shown.names[-1])
            return
        evaluated = source.evaluated_get(self._depsgraph)
        mesh = evaluated.to_mesh(**self._whole)
        unfolded = _unfold(file, shown, lightmaps, mesh)
        obstacle, has_room = _obstacle(source, owner), True
        if unfolded and not unfolded["layout"]:
            has_room = len(mesh.uv_layers) < MOST_UV_MAPS and result.UV_MAP not in mesh.uv_layers
            if not obstacle and not numpy.array_equal(_faces(source.data), _faces(mesh)):
                obstacle = "Modifiers change the faces"
        evaluated.to_mesh_clear()
        if not (unfolded and has_room):
            self.reasons[NO_ROOM if unfolded else CHANGED].add(owner.name)
            return
        target = source
        if obstacle:
            self.reasons[f"{obstacle}: lit copies replace these objects"].add(owner.name)
            self.replaced.add(owner.name)
            target = self._copy(source, bpy.data.meshes.new_from_object(evaluated, **self._whole), matrix)
            for slot, own in zip(target.material_slots, source.material_slots):
                slot.material = own.material  # the object's, which takes precedence over its mesh's
        self.lights.append(Light(target, **unfolded))

    def _source(self, shown, owner):
        """Returns the object whose mesh a node shows, and its place."""
        if owner is None or owner.instance_type != "COLLECTION":
            return owner, owner and owner.matrix_world.copy()
        alike = [(source, matrix) for by, source, matrix in self._instances if by == owner and source.name == shown.names[-1]]
        place = numpy.array(shown.matrix)
        return min(alike, key=lambda found: numpy.abs(numpy.array(found[1]) - place).max(), default=(None, None))

    def _copy(self, source, data, matrix):
        copy = bpy.data.objects.new(source.name, data)
        copy.matrix_world = matrix
        self.copies.append(copy)
        return copy


def _lightmaps(file, shown) -> list:
    """Returns the names of the image and of the coordinates of each primitive, if it has a lightmap."""

    def lightmap(primitive):
        material = file.json["materials"][primitive["material"]] if "material" in primitive else {}
        found = material.get("extensions", {}).get(LIGHTMAP)
        if found is None:
            return None
        image = file.json["images"][file.json["textures"][found["index"]]["source"]]
        return image["name"], f"TEXCOORD_{found['texCoord']}"

    return [lightmap(primitive) for primitive in _primitives(file, shown)]


def _primitives(file, shown) -> list[dict]:
    return file.json["meshes"][shown.node["mesh"]]["primitives"]


def _unfold(file, shown, lightmaps, mesh) -> dict | None:
    """Returns the members of Light except its target; None if the mesh differs from the file. The exporter writes a
    primitive for each material slot in use, and the triangles in the order of the mesh."""
    mesh.calc_loop_triangles()
    corners = read(mesh.loop_triangles, "loops", numpy.int32, 3)
    slots = read(mesh.loop_triangles, "material_index", numpy.int32, 1)
    places = read(mesh.vertices, "co", numpy.float32, 3)[read(mesh.loops, "vertex_index", numpy.int32, 1)]
    used, primitives = numpy.unique(slots).tolist(), _primitives(file, shown)
    if len(used) != len(primitives):
        return None
    images, coordinates, is_lit = {}, numpy.zeros((len(places), 2), numpy.float32), numpy.zeros(len(places), bool)
    for slot, primitive, lightmap in zip(used, primitives, lightmaps):
        loops, indices = corners[slots == slot].ravel(), file.array(primitive["indices"])
        attributes = primitive["attributes"]
        if len(loops) != len(indices):
            return None
        moved = numpy.abs(file.array(attributes["POSITION"])[indices] @ TO_Z_UP - places[loops])
        is_posed = "JOINTS_0" in attributes  # the file has the pose of rest
        if not is_posed and moved.max() > TOLERANCE * numpy.abs(places).max():
            return None
        if lightmap:
            images[slot], name = lightmap
            u, v = file.array(attributes[name])[indices].T
            coordinates[loops], is_lit[loops] = numpy.stack((u, 1 - v), axis=1), True
    layout = None
    if len(mesh.uv_layers) > 1:
        layout = layouts.find(read(mesh.uv_layers[1].data, "uv", numpy.float32, 2)[is_lit], coordinates[is_lit])
    if layout:
        return {"images": images, "coordinates": None, "uv_map": mesh.uv_layers[1].name, "layout": layout}
    return {"images": images, "coordinates": coordinates, "uv_map": result.UV_MAP, "layout": None}


def _obstacle(source, owner) -> str | None:
    """Returns the reason for which an object cannot show light itself, if any."""
    if source != owner:
        return "Instances of a collection have common meshes"
    if source.type != "MESH":
        return "Curves and text have no UV maps"
    if source.library or source.data.library:
        return "Linked data cannot be changed"
    if source.data.users - source.data.use_fake_user > 1:
        return "Several objects have one mesh"
    return None


def _faces(mesh):
    """Returns the vertex of each loop, and the first loop of each face."""
    starts = read(mesh.polygons, "loop_start", numpy.int32, 1)
    return numpy.concatenate((read(mesh.loops, "vertex_index", numpy.int32, 1), starts))
