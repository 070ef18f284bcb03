"""Between Blender's scene and files: what is exported to be lit, and how lit meshes come back."""

import math
from contextlib import contextmanager
from pathlib import Path

import bpy
import numpy

if bpy.app.version < (3, 5):
    numpy.bool = bool  # its importer asks for it by the name that later versions of NumPy have dropped

LIT_COLLECTION = "Interflect"
DISC_CORNERS = 32
HIDDEN = "interflect_hidden"  # marks objects that were hidden when their lit copies came


def export_scene(path: Path) -> None:
    """Writes what renders, with area lamps as panels that emit. Watts in Blender are lumens in the file."""
    with _area_lamps_as_panels():
        bpy.ops.export_scene.gltf(
            filepath=str(path),
            use_renderable=True,
            export_lights=True,
            export_cameras=True,
            export_apply=True,
            export_animations=False,
            convert_lighting_mode="COMPAT",
        )


def world_radiance():
    """Radiance of the world where it is of one colour, [r, g, b]; none where nodes make it vary."""
    world = bpy.context.scene.world
    if world is None:
        return [0.0, 0.0, 0.0]
    if not world.use_nodes:
        return list(world.color)
    backgrounds = [node for node in world.node_tree.nodes if node.type == "BACKGROUND"]
    if len(backgrounds) != 1 or any(socket.is_linked for socket in backgrounds[0].inputs):
        return None
    strength = backgrounds[0].inputs["Strength"].default_value
    return [strength * channel for channel in backgrounds[0].inputs["Color"].default_value[:3]]


def write_environment(path: Path, radiance) -> None:
    """Writes an image of one colour as Radiance has them (.hdr), for `interflect solve --environment`."""
    width, height = 8, 4
    exponent = math.frexp(max(radiance))[1]
    texel = bytes([*(min(255, round(256 * math.ldexp(channel, -exponent))) for channel in radiance), exponent + 128])
    header = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n"
    path.write_bytes(header.encode() + width * height * texel)


@contextmanager
def _area_lamps_as_panels():
    """glTF has no area lamps: each is replaced, while the scene is written, by a face of its size that emits as much."""
    lamps = [o for o in bpy.context.scene.objects if o.type == "LIGHT" and o.data.type == "AREA" and not o.hide_render]
    panels = [_panel(lamp) for lamp in lamps]
    try:
        yield
    finally:
        for panel in panels:
            mesh, (material,) = panel.data, panel.data.materials
            bpy.data.objects.remove(panel)
            bpy.data.meshes.remove(mesh)
            bpy.data.materials.remove(material)


def _panel(lamp):
    light = lamp.data
    width = light.size
    height = light.size_y if light.shape in ("RECTANGLE", "ELLIPSE") else light.size
    if light.shape in ("RECTANGLE", "SQUARE"):
        corners = [(-width / 2, -height / 2), (width / 2, -height / 2), (width / 2, height / 2), (-width / 2, height / 2)]
        area = width * height
    else:
        angles = [2 * math.pi * i / DISC_CORNERS for i in range(DISC_CORNERS)]
        corners = [(width / 2 * math.cos(a), height / 2 * math.sin(a)) for a in angles]
        area = DISC_CORNERS / 8 * math.sin(2 * math.pi / DISC_CORNERS) * width * height  # of the polygon
    mesh = bpy.data.meshes.new(lamp.name)
    # A lamp shines along its -z axis: the face is seen, counter-clockwise, from there.
    mesh.from_pydata([(x, y, 0) for x, y in corners], [], [list(reversed(range(len(corners))))])
    material = bpy.data.materials.new(lamp.name)
    material.use_nodes = True
    material.use_backface_culling = True  # it emits on one side
    surface = material.node_tree.nodes["Principled BSDF"]
    scale = lamp.matrix_world.to_scale()
    surface.inputs["Base Color"].default_value = (0, 0, 0, 1)
    surface.inputs["Emission"].default_value = (*light.color, 1)
    # Cycles gives an area lamp of P watts the radiance P / (4 A), not P / (pi A): it emits 0.785 P.
    surface.inputs["Emission Strength"].default_value = light.energy / (4 * area * scale.x * scale.y)
    mesh.materials.append(material)
    panel = bpy.data.objects.new(lamp.name, mesh)
    panel.matrix_world = lamp.matrix_world
    bpy.context.scene.collection.objects.link(panel)
    return panel


def import_lit(path: Path) -> None:
    """Puts the lit meshes of a file into a collection of their own, in place of an earlier one, and hides what they stand for."""
    remove_lit()
    lit = bpy.data.collections.new(LIT_COLLECTION)
    bpy.context.scene.collection.children.link(lit)
    originals = list(bpy.context.scene.objects)
    bpy.ops.import_scene.gltf(filepath=str(path), convert_lighting_mode="COMPAT")
    for made in [o for o in bpy.context.scene.objects if o not in originals]:
        if made.type in ("CAMERA", "LIGHT"):
            bpy.data.objects.remove(made)
            continue
        for collection in made.users_collection:
            collection.objects.unlink(made)
        lit.objects.link(made)
    for original in originals:
        if original.type in ("MESH", "CURVE", "SURFACE", "FONT", "META", "LIGHT") and not original.hide_render:
            original.hide_render = True
            original.hide_set(True)
            original[HIDDEN] = True


def remove_lit() -> None:
    """Removes the lit meshes, and shows again what they stood for."""
    if lit := bpy.data.collections.get(LIT_COLLECTION):
        for copy in list(lit.objects):
            bpy.data.objects.remove(copy)
        bpy.data.collections.remove(lit)
    for original in bpy.context.scene.objects:
        if original.pop(HIDDEN, False):
            original.hide_render = False
            original.hide_set(False)
