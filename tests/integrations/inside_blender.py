"""The cases of blender_test.py, each in an empty file: `-- COMMAND FOUND.json CASE...`. A case that fails returns its error."""

import json
import math
import os
import subprocess
import sys
import tempfile
import time
import traceback
from pathlib import Path
from types import SimpleNamespace

import bpy  # before bmesh, which the package bpy brings along

import bmesh

command, out, *cases = sys.argv[sys.argv.index("--") + 1 :]


def start() -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="interflect")
    bpy.context.preferences.addons["interflect"].preferences.command = command


start()
import interflect
from interflect import area_lamps, exchange, pipeline, result, versions
from interflect.lit import sides as lit_sides

KINDS_OF_DATA = ("objects", "collections", "meshes", "cameras", "lights", "materials", "node_groups", "images", "scenes", "worlds")


def make_room() -> None:
    """A closed box with a table, an area lamp and a camera."""
    grey = bpy.data.materials.new("grey")
    for name, size, at, flip in [("room", (4, 3, 2.5), (0, 0, 1.25), True), ("table", (1, 0.6, 0.7), (0.5, 0, 0.35), False)]:
        bpy.ops.mesh.primitive_cube_add(size=1, location=at)
        made = bpy.context.object
        made.name, made.scale = name, size
        made.data.materials.append(grey)
        if flip:
            made.data.flip_normals()
    lamp = bpy.data.lights.new("lamp", "AREA")
    lamp.energy, lamp.shape, lamp.size, lamp.size_y = 100, "RECTANGLE", 1.0, 0.5
    put("lamp", lamp, (0, 0, 2.4))
    put("camera", bpy.data.cameras.new("camera"), (-1.8, -1.2, 1.6)).rotation_euler = (1.2, 0, -0.9)
    bpy.context.scene.camera = bpy.data.objects["camera"]
    bpy.context.view_layer.update()


def put(name, data, at):
    made = bpy.data.objects.new(name, data)
    made.location = at
    bpy.context.collection.objects.link(made)
    return made


def bake(kind: str = "VERTEX", rays: float = 0.2, target: str = "COPY", selected: bool = False, preview: bool = False) -> dict:
    settings = bpy.context.scene.interflect
    settings.rays, settings.kind, settings.texels_per_metre, settings.target = rays, kind, 8, target
    settings.use_selected, settings.use_preview = selected, preview
    try:
        return {"result": list(bpy.ops.interflect.bake()), "said": ""}
    except RuntimeError as error:  # Blender reports an operator's error to scripts this way
        return {"result": ["CANCELLED"], "said": str(error)}


def lit_collection():
    collections = result.collections(bpy.context.scene)
    assert len(collections) <= 1
    return collections[0] if collections else None


def lit_meshes() -> list:
    lit = lit_collection()
    return [o for o in lit.objects if o.type == "MESH"] if lit else []


def corners(lit) -> list:
    return [lit.matrix_world @ vertex.co for vertex in lit.data.vertices]


def colours(lit) -> list:
    """Returns the radiance of a lit object's loops, for results in vertex colours."""
    surface = next(node for node in lit.data.materials[0].node_tree.nodes if node.type == "OUTPUT_MATERIAL").inputs["Surface"]
    strength = surface.links[0].from_node.inputs[1].links[0].from_node.inputs["Strength"].default_value
    return [[strength * channel for channel in texel.color[:3]] for texel in lit.data.color_attributes[0].data]


def brightness(name: str) -> float:
    (lit,) = [o for o in lit_meshes() if o.name.split(".")[0] == name]
    light = colours(lit)
    return sum(map(sum, light)) / len(light) / 3


def in_file() -> dict:
    return {kind: sorted({data.name for data in getattr(bpy.data, kind)} - {"Render Result"}) for kind in KINDS_OF_DATA}


def shown() -> dict:
    """Returns the visibility settings of the user: in pictures, by the monitor, by the eye."""
    return {o.name: [o.hide_render, o.hide_viewport, o.hide_get()] for o in bpy.context.scene.objects}


def first_bake(kind: str) -> dict:
    make_room()
    found = bake(kind)
    lit = lit_collection()
    found |= {
        "lit_objects": len(lit_meshes()),
        "has_colours": bool(lit) and all(o.data.color_attributes for o in lit_meshes()),
        "images": len([i for i in bpy.data.images if i.size[0] > 0]),
        "originals_hidden": all(bpy.data.objects[name].hide_render for name in ("room", "table", "lamp")),
    }
    bpy.ops.interflect.clear()
    found["originals_shown_again"] = not any(bpy.data.objects[name].hide_render for name in ("room", "table", "lamp"))
    return found


def three_bakes(kind: str) -> dict:
    make_room()
    before = in_file(), shown()
    results, files, light = [], [], []
    for _ in range(3):
        results.append(bake(kind)["result"])
        files.append(in_file())
        light.append([colours(o) for o in lit_meshes()] if kind == "VERTEX" else [list(i.pixels) for i in bpy.data.images])
    bpy.ops.interflect.clear()
    return {
        "results": results,
        "files": files,
        "light_is_the_same": light[0] == light[1] == light[2] and len(light[0]) > 0,
        "before": before,
        "after": (in_file(), shown()),
    }


def visibility() -> dict:
    """Rendered objects are baked, even if the viewport hides them. Hidden objects stay hidden."""
    make_room()
    scene, context = bpy.context.scene, bpy.context
    objects = {}
    hidden = {name: bpy.data.collections.new(name) for name in ("excluded", "not rendered", "monitor", "deeper")}
    for name in ("excluded", "not rendered", "monitor"):
        scene.collection.children.link(hidden[name])
    hidden["not rendered"].children.link(hidden["deeper"])
    for name in ["eye", "off", "alone", *hidden]:
        bpy.ops.mesh.primitive_cube_add(size=0.1, location=(-1.5 + 0.2 * len(objects), 1, 0.05))
        objects[name] = context.object
        context.object.name = f"cube {name}"
        context.object.modifiers.new("two", "ARRAY").count = 2
        if name in hidden:
            context.collection.objects.unlink(objects[name])
            hidden[name].objects.link(objects[name])
    layers = context.view_layer.layer_collection.children
    layers["excluded"].exclude = True
    hidden["not rendered"].hide_render = True
    hidden["monitor"].hide_viewport = True
    objects["eye"].hide_set(True)
    objects["off"].hide_render = True
    objects["alone"].hide_viewport = True
    bpy.data.objects["camera"].hide_render = True  # cameras work nevertheless
    before = shown()
    found = bake()
    baked = {o.name.split(".")[0]: [round(d, 3) for d in o.dimensions] for o in lit_meshes()}
    bpy.ops.interflect.clear()
    return {**found, "baked": baked, "before": before, "after": shown()}


def user() -> dict:
    """A typical session: bake, edit, bake, delete by hand, undo, save and open again."""
    make_room()
    scene, wall = bpy.context.scene, bpy.data.materials["grey"]
    wall.use_nodes = True
    reflectance = wall.node_tree.nodes["Principled BSDF"].inputs["Base Color"]
    reflectance.default_value = (0.5, 0.5, 0.5, 1)
    before = in_file(), shown()
    bpy.ops.ed.undo_push(message="room")
    found = {"grey": (bake()["result"], brightness("room"))}
    bpy.ops.ed.undo_push(message="bake")
    baked = in_file(), shown()
    bpy.ops.ed.undo()
    found["undone"] = before == (in_file(), shown())
    bpy.ops.ed.redo()
    found["redone"] = baked == (in_file(), shown())
    scene = bpy.context.scene
    reflectance = bpy.data.materials["grey"].node_tree.nodes["Principled BSDF"].inputs["Base Color"]
    reflectance.default_value = (0.25, 0.25, 0.25, 1)
    found["dark"] = bake()["result"], brightness("room")
    for each in lit_meshes():
        bpy.data.objects.remove(each)
    bpy.data.collections.remove(lit_collection())
    found["deleted"] = bake()["result"], brightness("room")
    lit = lit_collection()
    lit.name = "mine"
    kept = put("kept", bpy.data.meshes.new("kept"), (0, 0, 1))
    bpy.context.collection.objects.unlink(kept)
    lit.objects.link(kept)
    with tempfile.TemporaryDirectory() as folder:
        bpy.ops.wm.save_as_mainfile(filepath=str(Path(folder, "room.blend")))
        bpy.ops.wm.open_mainfile(filepath=str(Path(folder, "room.blend")))
    found["opened"] = bake()["result"], brightness("room")
    bpy.ops.interflect.clear()
    bpy.data.objects.remove(bpy.data.objects["kept"])
    bpy.data.meshes.remove(bpy.data.meshes["kept"])
    return {**found, "before": before, "after": (in_file(), shown())}


def scenes() -> dict:
    """Two scenes, one with another unit and renderer, keep their own results and settings."""
    make_room()
    first = bpy.context.scene
    found = {"first": bake()["result"]}
    second = bpy.data.scenes.new("second")
    bpy.context.window.scene = second
    second.unit_settings.scale_length = 0.01
    second.render.engine = "BLENDER_WORKBENCH"
    bpy.ops.mesh.primitive_plane_add(size=3)
    plane = bpy.context.object
    put("bulb", bpy.data.lights.new("bulb", "POINT"), (0, 0, 1)).data.energy = 10
    found["second"] = bake()["result"]
    lit = lit_meshes()
    found |= {
        "second_lit": len(lit),
        "size": lit[0].dimensions.x if lit else 0,
        "engine": second.render.engine,
        "scenes": [scene.name for scene in bpy.data.scenes],
        "active": bpy.context.view_layer.objects.active == plane,
        "results": [len(result.collections(scene)) for scene in (first, second)],
    }
    bpy.ops.interflect.clear()
    found["results_after"] = [len(result.collections(scene)) for scene in (first, second)]
    return found


def instances() -> dict:
    """A collection with an area lamp, instanced twice in the scene."""
    make_room()
    scene = bpy.context.scene
    fitting = bpy.data.collections.new("fitting")
    lamp = bpy.data.objects["lamp"]
    scene.collection.objects.unlink(lamp)
    fitting.objects.link(lamp)
    lamp.location = (0, 0, 0)
    for x in (-1, 1):
        empty = put("instance", None, (x, 0, 2.4))
        empty.instance_type, empty.instance_collection = "COLLECTION", fitting
    bpy.context.view_layer.update()
    found = bake()
    panels = [o for o in lit_meshes() if o.name.startswith("lamp")]
    found["lamps_at"] = sorted(round(sum(x for x, _, _ in corners(o)) / len(corners(o)), 3) for o in panels)
    found["instances_hidden"] = all(o.hide_render for o in scene.objects if o.name.startswith("instance"))
    return found


def sheets(kind: str, magnified: float = 1) -> dict:
    """A box of sheets without its front, under a sky that lights both sides of each sheet. Returns the shares of
    pixels that show, from inside, the sky through the sheets, and, from outside, a lamp that fills the box through its
    corners. Moving the sides farther apart magnifies cracks that are thinner than a pixel."""
    usual, lit_sides.RELATIVE_DISTANCE = lit_sides.RELATIVE_DISTANCE, lit_sides.RELATIVE_DISTANCE * magnified
    bpy.ops.mesh.primitive_cube_add(size=1, location=(0, 0, 1.25))
    box = bpy.context.object
    box.scale = 4, 3, 2.5
    box.data.materials.append(bpy.data.materials.new("grey"))
    editable = bmesh.new()
    editable.from_mesh(box.data)
    bmesh.ops.delete(editable, geom=[face for face in editable.faces if face.normal.y < -0.5], context="FACES")
    editable.to_mesh(box.data)
    new_world()
    found = bake(kind)
    lit_sides.RELATIVE_DISTANCE = usual
    camera = put("camera", bpy.data.cameras.new("camera"), (0.3, -1, 1.2))
    bpy.context.scene.camera = camera
    camera.data.lens, camera.data.clip_start = 18, 0.01
    camera.rotation_euler = (math.pi / 2, 0, 0)  # away from the missing front
    sky = 1 - sum(picture(width=128, height=96)[3::4]) / (128 * 96)
    lamp = bpy.data.materials.new("lamp")
    lamp.use_nodes = True
    versions.emission_colour(lamp.node_tree.nodes["Principled BSDF"]).default_value = (0, 1, 0, 1)
    lamp.node_tree.nodes["Principled BSDF"].inputs["Emission Strength"].default_value = 1e6
    bpy.ops.mesh.primitive_cube_add(size=1, location=(0, 0, 1.25))
    bpy.context.object.scale = 3.99, 2.99, 2.49
    bpy.context.object.data.materials.append(lamp)
    camera.location, camera.data.lens = (5, 6, 6), 50
    camera.rotation_euler = (math.radians(59), 0, math.radians(140))  # towards the box
    through_corners = sum(green > 100 for green in picture(width=128, height=96)[1::4]) / (128 * 96)
    return {**found, "sky": sky, "through_corners": through_corners}


def moves() -> dict:
    """Returns how far each corner of a lit mesh moves, in units of lit_sides.py: forward and within its plane."""
    make_room()
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12, radius=0.3, location=(-1, -0.5, 0.25))
    bpy.ops.mesh.primitive_cube_add(size=0.5, location=(-1, 0.5, 0.2), rotation=(0.1, 0.05, 0.7))
    separate, lit_sides.separate = lit_sides.separate, lambda _: None
    found = bake()
    lit_sides.separate = separate
    meshes, before = lit_meshes(), []
    for lit in meshes:  # splitting keeps the order of the corners
        before += [(face.normal.copy(), [lit.data.vertices[i].co.copy() for i in face.vertices]) for face in lit.data.polygons]
    separate(meshes)
    after = [[lit.data.vertices[i].co for i in face.vertices] for lit in meshes for face in lit.data.polygons]
    unit = lit_sides.RELATIVE_DISTANCE * 2.5  # height of the room
    forward, within = [], []
    for (normal, old), new in zip(before, after):
        for start, end in zip(old, new):
            step = (end - start) / unit
            forward.append(step.dot(normal))
            within.append((step - forward[-1] * normal).length)
    return {**found, "forward": [min(forward), max(forward)], "within": max(within)}


SHAPES = {"SQUARE": (0.8, 0.3), "RECTANGLE": (0.9, 0.4), "DISK": (0.8, 0.3), "ELLIPSE": (0.9, 0.4)}


def panels() -> dict:
    """Area lamps of all shapes: Cycles' light below each lamp, and below the panel that replaces it."""
    scene, lamps = bpy.context.scene, []
    bpy.ops.mesh.primitive_plane_add(size=8, location=(1.5, 0, 0.5))
    floor, glass = bpy.context.object, bpy.data.materials.new("glass")
    glass.use_nodes = True
    nodes = glass.node_tree.nodes
    through = nodes.new("ShaderNodeBsdfTranslucent").outputs["BSDF"]
    glass.node_tree.links.new(through, nodes["Material Output"].inputs["Surface"])
    floor.data.materials.append(glass)
    for i, (shape, (width, height)) in enumerate(SHAPES.items()):
        light = bpy.data.lights.new(shape, "AREA")
        light.energy, light.shape, light.size, light.size_y, light.color = 1, shape, width, height, (1, 0.5, 0.25)
        lamps.append(put(shape, light, (i, 0, 1)))
    lamps[1].scale = (0.5, -1.5, 1)
    camera = put("below", bpy.data.cameras.new("below"), (1.5, 0, 0))
    camera.data.type, camera.data.ortho_scale, camera.rotation_euler = "ORTHO", 4, (math.pi, 0, 0)
    scene.camera = camera
    bpy.context.view_layer.update()
    by_lamps = powers_seen()
    before = in_file()
    with area_lamps.as_panels(scene) as warnings:
        for lamp in lamps:
            lamp.hide_render = True
        by_panels = powers_seen()
        faces = [o for o in scene.objects if o.type == "MESH" and o != floor]
        bpy.context.view_layer.update()
        normals = [list(o.matrix_world.to_3x3() @ o.data.polygons[0].normal) for o in faces]
    return {"lamps": by_lamps, "panels": by_panels, "normals": normals, "warnings": warnings, "left": [before, in_file()]}


def powers_seen() -> list:
    """Measures the mean light in each quarter of a picture from below, with a lamp in its middle."""
    red = picture(width=256, height=64)[0::4]
    return [sum(red[i] for i in range(256 * 64) if i % 256 // 64 == part) / 64**2 for part in range(4)]


def picture(width: int, height: int) -> list:
    """Renders in Cycles with a transparent sky. Returns red, green, blue and opacity of each pixel."""
    scene = bpy.context.scene
    scene.render.engine, scene.render.film_transparent = "CYCLES", True
    scene.cycles.samples, scene.cycles.max_bounces, scene.cycles.use_denoising = 64, 1, False
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = width, height, 100
    scene.render.image_settings.file_format, scene.render.image_settings.color_mode = "OPEN_EXR", "RGBA"
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = str(Path(folder, "picture.exr"))
        bpy.ops.render.render(write_still=True)
        rendered = bpy.data.images.load(scene.render.filepath)
        pixels = list(rendered.pixels)
        bpy.data.images.remove(rendered)
    return pixels


def authored() -> dict:
    """A plate below a point lamp, and a metal that reflects the plate, lit in their own glTF file and imported."""
    for name, metallic, shade, at, turn in [("plate", 0, 0.5, (0, 0, 0), 0), ("mirror", 1, 0.8, (0.6, 0, 0.5), -math.pi / 2)]:
        bpy.ops.mesh.primitive_plane_add(size=1, location=at, rotation=(0, turn, 0))
        material = bpy.data.materials.new(name)
        material.use_nodes = True
        inputs = material.node_tree.nodes["Principled BSDF"].inputs
        inputs["Base Color"].default_value = (shade, shade, shade, 1)
        inputs["Metallic"].default_value, inputs["Roughness"].default_value = metallic, 1 - metallic
        bpy.context.object.data.materials.append(material)
    lamp = bpy.data.lights.new("lamp", "POINT")
    lamp.energy = 4 * math.pi  # 1 cd
    put("lamp", lamp, (0, 0, 2))
    with tempfile.TemporaryDirectory() as folder:
        scene, solution, lit = (str(Path(folder, name)) for name in ("scene.glb", "lit.h5", "lit.glb"))
        option = versions.watts_as_lumens(bpy.ops.export_scene.gltf)
        bpy.ops.export_scene.gltf(filepath=scene, export_lights=True, **option)
        subprocess.run([command, "solve", scene, "-o", solution, "--rays", "20k"], check=True, capture_output=True)
        subprocess.run([command, "export", solution, "-o", lit, "--lightmap"], check=True, capture_output=True)
        start()
        bpy.ops.import_scene.gltf(filepath=lit)
    return {
        "plate": seen_from((0, 0, 1), (0, 0, 0)),
        "mirror": seen_from((0, 0, 0.8), (0, -math.pi / 4, 0)),  # at 45 degrees; sees the plate at x = 0.4
        "lamps": len(bpy.data.lights),
    }


def seen_from(at, turn) -> float:
    """Returns the radiance in the middle of a camera's view."""
    camera = put("eye", bpy.data.cameras.new("eye"), at)
    camera.data.type, camera.data.ortho_scale, camera.rotation_euler = "ORTHO", 0.02, turn
    bpy.context.scene.camera = camera
    bpy.context.view_layer.update()
    return picture(width=1, height=1)[0]


def make_plates() -> None:
    """Makes a lamp of 1 cd above plates. A face of `plain` has a later slot than the only one. `bare` has no material, and
    `bent` has one with disabled nodes. `first` and `second` have one mesh, `left` and `right` are instances. `row` and
    `drawn` have modifiers that add faces, that of `bent` moves vertices. `drawn` has a lightmap layout, and `named`
    another map, with the name of the add-on's UV map."""
    lamp = bpy.data.lights.new("lamp", "POINT")
    lamp.energy = 4 * math.pi
    put("lamp", lamp, (0, 0, 2))
    for i, name in enumerate(("plain", "bare", "first", "second", "row", "bent", "drawn", "named")):
        faces = 2 if name == "plain" else 1
        bpy.ops.mesh.primitive_grid_add(x_subdivisions=faces, y_subdivisions=1, size=1, location=(1.2 * i, 0, 0))
        made = bpy.context.object
        made.name = made.data.name = name
        if name != "bare":
            made.data.materials.append(bpy.data.materials.get("half") or grey_material("half", 0.5))
    bpy.data.objects["plain"].data.polygons[1].material_index = 1
    bpy.data.objects["named"].data.uv_layers[0].name = result.UV_MAP
    disabled = bpy.data.objects["bent"].data.materials[0] = grey_material("disabled", 0.5)
    disabled.use_nodes = False
    if not disabled.use_nodes:  # Blender 5.0 always uses nodes
        disabled.node_tree.nodes.clear()
    bpy.data.objects["second"].data = bpy.data.objects["first"].data
    bpy.data.meshes.remove(bpy.data.meshes["second"])
    bpy.data.objects["row"].modifiers.new("two", "ARRAY").relative_offset_displace = (0, 1.2, 0)
    bpy.data.objects["bent"].modifiers.new("bent", "SIMPLE_DEFORM").deform_method = "TAPER"
    drawn = bpy.data.objects["drawn"]
    drawn.location = (1.2, 2, 0)
    for corner in drawn.data.uv_layers.new(name=result.UV_MAP).data:
        corner.uv = 0.5 + 0.5 * (corner.uv[1] - 0.5), 0.25 + 0.5 * corner.uv[0]
    drawn.modifiers.new("finer", "SUBSURF").subdivision_type = "SIMPLE"
    leaves = bpy.data.collections.new("leaves")
    leaves.objects.link(bpy.data.objects.new("leaf", bpy.data.objects["row"].data.copy()))
    leaves.objects["leaf"].data.name = "leaf"
    for name, x in (("left", -1.2), ("right", -2.4)):
        empty = put(name, None, (x, 0, 0))
        empty.instance_type, empty.instance_collection = "COLLECTION", leaves


def grey_material(name: str, reflectance: float):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    surface = material.node_tree.nodes["Principled BSDF"]
    surface.inputs["Base Color"].default_value = (reflectance, reflectance, reflectance, 1)
    return material


def surfaces() -> dict:
    """Returns the materials, the UV maps and the custom properties of each mesh object."""

    def surface(shown):
        maps = shown.data.uv_layers
        return [[slot.name for slot in shown.material_slots], maps.active_index, [uv.name for uv in maps], sorted(shown.keys())]

    return {o.name: surface(o) for o in bpy.context.scene.objects if o.type == "MESH"}


def state() -> list:
    return [in_file(), shown(), surfaces()]


def objects() -> dict:
    """Light in the objects themselves, twice; undo, redo, and *Clear* after a lit material has been given to another object."""
    make_plates()
    before = state()
    bpy.ops.ed.undo_push(message="plates")
    found = {"first": bake("LIGHTMAP", target="OBJECTS")["result"]}
    bpy.ops.ed.undo_push(message="bake")
    baked = state()
    bpy.ops.ed.undo()
    found["undone"] = before == state()
    bpy.ops.ed.redo()
    found["redone"] = baked == state()
    found["second"] = bake("LIGHTMAP", target="OBJECTS")["result"]
    found["same"] = baked == state()
    found |= {
        "lit": sorted(o.name for o in bpy.context.scene.objects if result.LIT in o and not result.is_result(o)),
        "copies": sorted(o.name.split(".")[0] for o in lit_meshes()),
        "hidden": sorted(o.name for o in bpy.context.scene.objects if result.HIDDEN in o),
        "warnings": result.warnings(bpy.context.scene),
    }
    bpy.data.objects["lamp"].hide_render = True
    places = [(-2.4, 0), (0, 0), (1.2, 0), (2.4, 0), (0.9, 1.7), (1.5, 2.3)]
    found["radiance"] = [(x, y, seen_from((x, y, 1), (0, 0, 0))) for x, y in places]
    bpy.data.objects["lamp"].hide_render = False
    for camera in [o for o in bpy.data.objects if o.type == "CAMERA"]:
        data = camera.data
        bpy.data.objects.remove(camera)
        bpy.data.cameras.remove(data)
    bpy.data.objects["row"].material_slots[0].material = bpy.data.objects["plain"].material_slots[0].material
    bpy.ops.interflect.clear()
    return {**found, "before": before, "after": state()}


def selected() -> dict:
    """Light of a selected object, shown by the object and by a copy. A bake without a selection fails."""
    make_plates()
    bpy.ops.object.select_all(action="DESELECT")
    found = {"nothing": bake("LIGHTMAP", selected=True)["said"]}
    bpy.data.objects["plain"].select_set(True)
    bake("LIGHTMAP", target="OBJECTS", selected=True)
    found["lit"] = [o.name for o in bpy.context.scene.objects if result.LIT in o]
    for kind in ("LIGHTMAP", "VERTEX"):
        bake(kind, selected=True)
        hidden = [o.name for o in bpy.context.scene.objects if result.HIDDEN in o]
        found[kind] = [[o.name.split(".")[0] for o in lit_collection().objects], hidden]
    return found


def preview() -> dict:
    """Returns the files whose light is shown."""
    make_room()
    shown_files, whole, interval = [], exchange.show_light, interflect.POLL
    interflect.POLL = 0.01
    exchange.show_light = lambda scene, file, *rest: shown_files.append(file.name) or whole(scene, file, *rest)
    found = bake("LIGHTMAP", preview=True)
    exchange.show_light, interflect.POLL = whole, interval
    return {**found, "files": shown_files}


def warnings() -> dict:
    make_room()
    metal = bpy.data.materials.new("metal")
    metal.use_nodes = True
    metal.node_tree.nodes["Principled BSDF"].inputs["Metallic"].default_value = 1
    bpy.data.objects["table"].data.materials[0] = metal
    bpy.data.lights["lamp"].spread = 1
    bpy.ops.object.metaball_add(location=(-1, 0, 1))
    bpy.context.object.name = "ball"
    put("outer", bpy.data.lights.new("outer", "POINT"), (40, -70, 30)).data.energy = 500
    new_world()
    found = bake()
    return {**found, "warnings": result.warnings(bpy.context.scene), "ball_hidden": bpy.data.objects["ball"].hide_render}


def failures() -> dict:
    """Failing exports and imports restore the scene and allow the next bake."""
    make_room()
    before = in_file(), shown()
    found = {}
    for name in ("export_scene", "import_scene"):
        whole = getattr(bpy.ops, name)

        def gltf(**_):
            raise RuntimeError(f"Error: {name} is broken")

        gltf.get_rna_type = whole.gltf.get_rna_type
        setattr(bpy.ops, name, SimpleNamespace(gltf=gltf))
        found[name] = bake()["said"]
        setattr(bpy.ops, name, whole)
        found[name + "_left"] = [before, (in_file(), shown())]
    return {**found, **bake()}


def long_bake(folder: Path) -> pipeline.Bake:
    scene = folder / "scene.glb"
    exchange.export_scene(bpy.context.scene, scene)
    wanted = pipeline.Settings(command=command, rays=10**11)
    start = time.monotonic()
    running = pipeline.Bake(pipeline.stages(scene, folder / "light.h5", folder / "lit.glb", wanted))
    while running.fraction == 0 and running.is_running() and time.monotonic() - start < 5:
        time.sleep(0.05)
    return running


def cancel() -> dict:
    make_room()
    with tempfile.TemporaryDirectory() as folder:
        running = long_bake(Path(folder))
        cancelled = time.monotonic()
        running.cancel()
        running.wait()
    return {"was_cancelled": running.is_cancelled and not running.error, "seconds": time.monotonic() - cancelled}


def disable() -> dict:
    """A second bake is refused, and disabling the add-on ends the first."""
    make_room()
    folder = Path(tempfile.mkdtemp(prefix="interflect-"))
    running = long_bake(folder)
    interflect.Bake.running, interflect.Bake.folder = running, folder
    found = {"may_bake": bpy.ops.interflect.bake.poll(), "may_clear": bpy.ops.interflect.clear.poll()}
    bpy.ops.preferences.addon_disable(module="interflect")
    return {**found, "is_running": running.is_running(), "was_cancelled": running.is_cancelled and not running.error}


def new_world():
    world = bpy.context.scene.world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    return world.node_tree.nodes, world.node_tree.links


def plain_world() -> dict:
    """A grey floor under a sky of constant radiance L: its radiance is L times its reflectance."""
    bpy.ops.mesh.primitive_plane_add(size=2)
    bpy.context.object.data.materials.append(bpy.data.materials.new("grey"))
    nodes, _ = new_world()
    nodes["Background"].inputs["Color"].default_value = (-0.1, 0.4, 0.8, 1)
    nodes["Background"].inputs["Strength"].default_value = 2
    found = bake(rays=0.5)
    (lit,) = lit_meshes()
    light = colours(lit)
    return {**found, "brightest": [max(texel[c] for texel in light) for c in range(3)]}


def hdri_world() -> dict:
    """A cube in an image that is bright towards x, turned by a quarter, and other light that only cameras would see."""
    bpy.ops.mesh.primitive_cube_add(size=1)
    bpy.context.object.data.materials.append(bpy.data.materials.new("grey"))
    scene = bpy.context.scene
    scene.camera = put("camera", bpy.data.cameras.new("camera"), (0, -4, 0))  # shows the lit side, for the exposure
    scene.camera.rotation_euler = (math.pi / 2, 0, 0)
    nodes, links = new_world()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "sky.hdr")
        width, height = 32, 16
        texels = [(128, 128, 128, 132 if abs(x - 15.5) < 2 and abs(y - 7.5) < 2 else 0) for y in range(height) for x in range(width)]
        header = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n"
        file.write_bytes(header.encode() + b"".join(map(bytes, texels)))
        coordinates, turn, image = (nodes.new(f"ShaderNode{kind}") for kind in ("TexCoord", "Mapping", "TexEnvironment"))
        turn.inputs["Rotation"].default_value = (0, 0, math.pi / 2)
        image.image = bpy.data.images.load(str(file))
        links.new(coordinates.outputs["Generated"], turn.inputs["Vector"])
        links.new(turn.outputs["Vector"], image.inputs["Vector"])
        links.new(image.outputs["Color"], nodes["Background"].inputs["Color"])
        path, seen, mixed = (nodes.new(f"ShaderNode{kind}") for kind in ("LightPath", "Background", "MixShader"))
        seen.inputs["Strength"].default_value = 1000
        links.new(path.outputs["Is Camera Ray"], mixed.inputs["Fac"])
        links.new(nodes["Background"].outputs["Background"], mixed.inputs[1])
        links.new(seen.outputs["Background"], mixed.inputs[2])
        links.new(mixed.outputs["Shader"], nodes["World Output"].inputs["Surface"])
        before = in_file()
        found = bake(rays=1)
    (lit,) = lit_meshes()
    light = colours(lit)
    sides = {}
    for face in lit.data.polygons:
        normal = lit.matrix_world.to_3x3() @ face.normal
        axis = max(range(3), key=lambda i: abs(normal[i]))
        side = ("-" if normal[axis] < 0 else "+") + "xyz"[axis]
        red = [light[i][0] for i in face.loop_indices]
        area, power = sides.get(side, (0, 0))
        sides[side] = area + face.area, power + face.area * sum(red) / len(red)
    bpy.ops.interflect.clear()
    return {**found, "sides": {side: power / area for side, (area, power) in sides.items()}, "left": [before, in_file()]}


CASES = {
    "vertex": lambda: first_bake("VERTEX"),
    "lightmap": lambda: first_bake("LIGHTMAP"),
    "sheets_vertex": lambda: sheets("VERTEX"),
    "sheets_lightmap": lambda: sheets("LIGHTMAP"),
    "sheets_magnified": lambda: sheets("LIGHTMAP", 256),
    "three_vertex": lambda: three_bakes("VERTEX"),
    "three_lightmaps": lambda: three_bakes("LIGHTMAP"),
    **{each.__name__: each for each in (authored, moves, visibility, user, scenes, instances, panels, warnings, failures)},
    **{each.__name__: each for each in (objects, selected, preview, plain_world, hdri_world, cancel, disable)},
}
found = {}
for case in cases:
    start()
    try:
        found[case] = CASES[case]()
    except Exception:
        found[case] = {"error": traceback.format_exc()}
Path(out).write_text(json.dumps(found))
os._exit(0)  # the package bpy 4.2 crashes when Python ends
