"""The cases of blender_test.py, each run in a Blender of its own: `-- CASE COMMAND FOUND.json`."""

import json
import sys
import tempfile
import time
from pathlib import Path

import bpy

case, command, out = sys.argv[sys.argv.index("--") + 1 :]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.preferences.addon_enable(module="interflect")
bpy.context.preferences.addons["interflect"].preferences.command = command
from interflect import exchange, pipeline


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


def bake(kind: str) -> dict:
    make_room()
    settings = bpy.context.scene.interflect
    settings.rays, settings.kind, settings.texels_per_metre = 0.2, kind, 8
    try:
        result, said = list(bpy.ops.interflect.bake()), ""
    except RuntimeError as error:  # how Blender's scripts are told of a report of an error
        result, said = ["CANCELLED"], str(error)
    lit = bpy.data.collections.get(exchange.LIT_COLLECTION)
    found = {
        "result": result,
        "said": said,
        "lit_objects": len([o for o in lit.objects if o.type == "MESH"]) if lit else 0,
        "has_colours": bool(lit) and all(o.data.color_attributes for o in lit.objects if o.type == "MESH"),
        "images": len([i for i in bpy.data.images if i.size[0] > 0]),
        "originals_hidden": all(bpy.data.objects[name].hide_render for name in ("room", "table", "lamp")),
    }
    bpy.ops.interflect.clear()
    found["originals_shown_again"] = not any(bpy.data.objects[name].hide_render for name in ("room", "table", "lamp"))
    found["left_in_file"] = [o.name for o in bpy.data.objects if o.name not in ("room", "table", "lamp", "camera")]
    return found


def panel() -> dict:
    make_room()
    before = [o.name for o in bpy.data.objects]
    with exchange._area_lamps_as_panels():
        (made,) = [o for o in bpy.data.objects if o.name not in before]
        bpy.context.view_layer.update()
        (face,) = made.data.polygons
        surface = made.data.materials[0].node_tree.nodes["Principled BSDF"]
        found = {
            "area": face.area,
            "expected_area": 0.5,
            "strength": surface.inputs["Emission Strength"].default_value,
            "expected_strength": 100 / (4 * 0.5),  # what Cycles takes for the lamp's radiance
            "normal": list(made.matrix_world.to_3x3() @ face.normal),
        }
    return {**found, "objects_before": before, "objects_after": [o.name for o in bpy.data.objects]}


def cancel() -> dict:
    make_room()
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder, "scene.glb")
        exchange.export_scene(scene)
        wanted = pipeline.Settings(rays=10**11)
        start = time.monotonic()
        running = pipeline.Bake(command, pipeline.stages(scene, Path(folder, "light.h5"), Path(folder, "lit.glb"), wanted))
        while running.fraction == 0 and running.is_running() and time.monotonic() - start < 5:
            time.sleep(0.05)
        running.cancel()
        running.wait()
    return {"was_cancelled": running.is_cancelled and not running.error, "seconds": time.monotonic() - start}


def world() -> dict:
    """A grey floor under a sky of one colour, of radiance L: as bright as the sky times its reflectance."""
    bpy.ops.mesh.primitive_plane_add(size=2)
    bpy.context.object.data.materials.append(bpy.data.materials.new("grey"))
    sky = bpy.data.worlds.new("sky")
    sky.use_nodes = True
    sky.node_tree.nodes["Background"].inputs["Color"].default_value = (0.2, 0.4, 0.8, 1)
    sky.node_tree.nodes["Background"].inputs["Strength"].default_value = 2
    bpy.context.scene.world = sky
    settings = bpy.context.scene.interflect
    settings.rays, settings.kind, settings.use_camera = 0.5, "VERTEX", False
    result = list(bpy.ops.interflect.bake())
    (lit,) = [o for o in bpy.data.collections[exchange.LIT_COLLECTION].objects if o.type == "MESH"]
    nodes = lit.data.materials[0].node_tree.nodes
    output = next(node for node in nodes if node.type == "OUTPUT_MATERIAL")
    front = output.inputs["Surface"].links[0].from_node.inputs[1].links[0].from_node
    strength = front.inputs["Strength"].default_value
    colours = [list(c.color)[:3] for c in lit.data.color_attributes[0].data]
    return {"result": result, "brightest": [strength * max(c[i] for c in colours) for i in range(3)]}


cases = {"world": world, "vertex": lambda: bake("VERTEX"), "lightmap": lambda: bake("LIGHTMAP"), "panel": panel, "cancel": cancel}
Path(out).write_text(json.dumps(cases[case]()))
