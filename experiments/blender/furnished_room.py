"""A furnished room as Blender exports it: `blender -b --python furnished_room.py -- OUT.glb [textured]`.

Walls are boxes on one large floor. Light sources: an area lamp (a panel that emits), a point lamp, a spot lamp, and the
sun through a window. Materials are diffuse. Lights are exported without Blender's 683 lm/W, so a watt in Blender is a
lumen in the file.
"""

import sys
from math import pi
from pathlib import Path

import bpy
import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[2] / "integrations/blender/interflect"))
import versions

ROOM = (6.3, 4.7, 2.9)  # [m]
WALL = 0.2  # thickness [m]
SPECULAR = ("Specular IOR Level", "Specular")  # input of a Principled BSDF since Blender 4.0, and before


def main(path: str, textured: bool) -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    build_walls(material("plaster", (0.76, 0.74, 0.68)), floor_material(path, textured))
    build_furniture(textured, path)
    build_lamps()
    build_camera("window", (0.5, 0.6, 1.65), (4.2, 3.4, 0.9))
    build_camera("sofa", (5.8, 3.9, 1.3), (1.0, 1.2, 0.8))
    lighting = versions.watts_as_lumens(bpy.ops.export_scene.gltf)
    bpy.ops.export_scene.gltf(filepath=path, export_lights=True, export_cameras=True, **lighting)


def material(name, colour, emission=0.0, image=None, repeats=1.0):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    surface = nodes["Principled BSDF"]
    surface.inputs["Base Color"].default_value = (*colour, 1)
    surface.inputs["Roughness"].default_value = 1
    next(surface.inputs[name] for name in SPECULAR if name in surface.inputs).default_value = 0
    if emission:
        versions.emission_colour(surface).default_value = (1, 0.92, 0.8, 1)
        surface.inputs["Emission Strength"].default_value = emission
    if image:
        texture = nodes.new("ShaderNodeTexImage")
        texture.image = image
        mapping, coordinates = nodes.new("ShaderNodeMapping"), nodes.new("ShaderNodeUVMap")
        mapping.inputs["Scale"].default_value = (repeats, repeats, 1)
        links.new(coordinates.outputs["UV"], mapping.inputs["Vector"])
        links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
        links.new(texture.outputs["Color"], surface.inputs["Base Color"])
    return made


def image(path: str, name: str, pixels: np.ndarray):
    """Saves an image of sRGB values in [0, 1], shape (height, width, 3), beside the file."""
    height, width, _ = pixels.shape
    made = bpy.data.images.new(name, width, height)
    made.pixels = np.concatenate([pixels, np.ones((height, width, 1))], axis=2).astype(np.float32).ravel()
    made.filepath_raw = str(Path(path).with_name(f"{name}.png"))
    made.file_format = "PNG"
    made.save()
    return made


def floor_material(path: str, textured: bool):
    if not textured:
        return material("floor", (0.42, 0.30, 0.20))
    random = np.random.default_rng(3)
    planks = np.zeros((128, 128, 3))
    for row in range(8):
        tone = random.uniform(0.45, 0.75)
        grain = random.normal(0, 0.02, (16, 128, 1)).cumsum(axis=1) * 0.3
        planks[16 * row : 16 * row + 16] = np.clip(np.array([tone, 0.8 * tone, 0.6 * tone]) + grain, 0.05, 0.95)
    return material("floor", (1, 1, 1), image=image(path, "planks", planks), repeats=3)


def box(name, low, high, material):
    bpy.ops.mesh.primitive_cube_add(size=1, location=[(a + b) / 2 for a, b in zip(low, high)])
    made = bpy.context.object
    made.name = name
    made.scale = [b - a for a, b in zip(low, high)]
    made.data.materials.append(material)
    return made


def build_walls(plaster, floor) -> None:
    x, y, z = ROOM
    box("floor", (-3, -3, -0.3), (x + 3, y + 3, 0), floor)
    box("ceiling", (-WALL, -WALL, z), (x + WALL, y + WALL, z + WALL), plaster)
    box("west", (-WALL, -WALL, 0), (0, y + WALL, z), plaster)
    box("north", (0, y, 0), (x, y + WALL, z), plaster)
    box("south", (0, -WALL, 0), (x, 0, z), plaster)
    # The east wall has a window.
    y0, y1, z0, z1 = 1.2, 3.1, 0.85, 2.2
    box("east-below", (x, -WALL, 0), (x + WALL, y + WALL, z0), plaster)
    box("east-above", (x, -WALL, z1), (x + WALL, y + WALL, z), plaster)
    box("east-left", (x, -WALL, z0), (x + WALL, y0, z1), plaster)
    box("east-right", (x, y1, z0), (x + WALL, y + WALL, z1), plaster)


def build_furniture(textured: bool, path: str) -> None:
    wood, cloth = material("wood", (0.35, 0.2, 0.1)), material("cloth", (0.15, 0.3, 0.5))
    red, pale = material("red", (0.65, 0.1, 0.08)), material("pale", (0.8, 0.8, 0.8))
    box("table", (2.4, 1.5, 0.70), (3.9, 2.4, 0.75), wood)
    for i, (x, y) in enumerate([(2.45, 1.55), (3.79, 1.55), (2.45, 2.29), (3.79, 2.29)]):
        box(f"leg-{i}", (x, y, 0), (x + 0.06, y + 0.06, 0.70), wood)
    box("sofa-seat", (0.3, 3.6, 0.12), (2.5, 4.4, 0.45), cloth)
    box("sofa-back", (0.3, 4.4, 0.12), (2.5, 4.65, 0.95), cloth)
    box("cupboard", (4.9, 4.15, 0), (6.1, 4.7, 1.9), pale)
    turned = box("crate", (4.4, 0.4, 0), (5.2, 1.1, 0.6), red)
    turned.rotation_euler = (0, 0, 0.4)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=32, ring_count=16, radius=0.22, location=(3.4, 2.0, 0.97))
    bpy.context.object.data.materials.append(pale)
    bpy.ops.mesh.primitive_monkey_add(size=0.6, location=(4.8, 0.75, 0.9), rotation=(0, 0, 2.2))
    bpy.context.object.data.materials.append(pale)
    bpy.ops.mesh.primitive_cylinder_add(vertices=24, radius=0.15, depth=0.5, location=(1.2, 1.0, 0.25))
    bpy.context.object.data.materials.append(red)
    if textured:
        rows, columns = np.mgrid[0:96, 0:128]
        colours = np.stack([0.5 + 0.4 * np.sin(columns / 9), 0.5 + 0.4 * np.cos(rows / 7), 0.3 + 0.002 * columns], axis=2)
        picture = material("picture", (1, 1, 1), image=image(path, "picture", colours))
        bpy.ops.mesh.primitive_plane_add(size=1, location=(0.005, 2.2, 1.6), rotation=(0, pi / 2, 0))
        bpy.context.object.scale = (0.9, 1.2, 1)
        bpy.context.object.data.materials.append(picture)


def build_lamps() -> None:
    lamp = material("lamp", (0, 0, 0), emission=40)
    bpy.ops.mesh.primitive_plane_add(size=1, location=(3.1, 2.3, 2.6))
    bpy.context.object.name = "area"
    bpy.context.object.scale = (1.2, 0.5, 1)
    bpy.context.object.data.materials.append(lamp)
    for name, kind, energy, location, rotation in [
        ("point", "POINT", 120, (1.1, 1.0, 1.4), (0, 0, 0)),
        ("spot", "SPOT", 400, (4.0, 1.2, 2.5), (-0.5, 0.9, 0.3)),
        ("sun", "SUN", 60, (10, 2, 6), (0, 0.9, 0.25)),
    ]:
        data = bpy.data.lights.new(name, kind)
        data.energy = energy
        if kind == "SPOT":
            data.spot_size, data.spot_blend = 0.9, 0  # soft edges differ between glTF and Blender
        made = bpy.data.objects.new(name, data)
        made.location, made.rotation_euler = location, rotation
        bpy.context.collection.objects.link(made)


def build_camera(name, eye, target) -> None:
    from mathutils import Vector

    data = bpy.data.cameras.new(name)
    data.sensor_fit, data.angle = "VERTICAL", 0.85
    made = bpy.data.objects.new(name, data)
    made.location = eye
    made.rotation_euler = (Vector(target) - Vector(eye)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.collection.objects.link(made)


arguments = sys.argv[sys.argv.index("--") + 1 :]
main(arguments[0], "textured" in arguments[1:])
