"""Area lamps, which glTF lacks, as faces that emit."""

import math
from contextlib import contextmanager

import bpy

from . import versions
from .result import is_result

DISC_CORNERS = 32
WIDEST_SPREAD = math.pi  # [rad]; the spread of a lamp without an angle limit


@contextmanager
def as_panels(scene):
    """Adds a face with the same light for each visible area lamp, including instances. Yields warnings."""
    shown = [
        (instance.object.original, instance.matrix_world.copy())
        for instance in bpy.context.evaluated_depsgraph_get().object_instances
        if instance.object.type == "LIGHT"
        and instance.object.data.type == "AREA"
        and (instance.is_instance or not instance.object.original.hide_render)
    ]
    panels, warnings = [], []
    names = _reserve_names(tuple(lamp.name for lamp, _ in shown))
    try:
        for lamp, matrix in shown:
            corners, area = _outline(lamp.data)
            scale = matrix.to_scale()
            area *= abs(scale.x * scale.y)
            warnings += _left_out(lamp, area)
            if area > 0:
                panels.append(_panel(lamp, matrix, corners, area))
                scene.collection.objects.link(panels[-1])
        yield warnings
    finally:
        for panel in panels:
            mesh, (material,) = panel.data, panel.data.materials
            bpy.data.objects.remove(panel)
            bpy.data.meshes.remove(mesh)
            bpy.data.materials.remove(material)
        for data, name in names:
            data.name = name


def _reserve_names(names):
    """Renames earlier results whose names begin so, to keep the names the same in all bakes. Returns the former names.
    """
    former = []
    for data in (*bpy.data.objects, *bpy.data.meshes, *bpy.data.materials):
        if is_result(data) and not data.library and data.name.startswith(names):
            former.append((data, data.name))
            data.name = "result"
    return former


def _left_out(lamp, area):
    if area == 0:
        yield f"The area lamp '{lamp.name}' has no area and is left out"
    elif lamp.data.energy < 0:
        yield f"The power of the area lamp '{lamp.name}' is negative: it is baked as 0"
    elif lamp.data.spread < WIDEST_SPREAD * 0.999:
        yield f"The spread of the area lamp '{lamp.name}' is left out: it shines to all sides"
    if lamp.data.use_nodes and _emission(lamp.data) is None:
        yield f"The nodes of the area lamp '{lamp.name}' are left out"


def _outline(light):
    width = light.size
    height = light.size_y if light.shape in ("RECTANGLE", "ELLIPSE") else light.size
    if light.shape in ("RECTANGLE", "SQUARE"):
        corners = [(-width / 2, -height / 2), (width / 2, -height / 2), (width / 2, height / 2), (-width / 2, height / 2)]
        return corners, width * height
    angles = [2 * math.pi * i / DISC_CORNERS for i in range(DISC_CORNERS)]
    corners = [(width / 2 * math.cos(a), height / 2 * math.sin(a)) for a in angles]
    return corners, DISC_CORNERS / 8 * math.sin(2 * math.pi / DISC_CORNERS) * width * height


def _emission(light):
    """Returns the colour of a lamp's nodes, [r, g, b], a factor of its own colour. None if it varies."""
    output = light.node_tree.get_output_node("CYCLES")
    if output is None or not output.inputs["Surface"].is_linked:
        return [0, 0, 0]
    node = output.inputs["Surface"].links[0].from_node
    if node.type != "EMISSION" or any(socket.is_linked for socket in node.inputs):
        return None
    strength = node.inputs["Strength"].default_value
    return [strength * channel for channel in node.inputs["Color"].default_value[:3]]


def _panel(lamp, matrix, corners, area):
    light = lamp.data
    mesh = bpy.data.meshes.new(lamp.name)
    # A lamp shines along its -z axis, so the face is counter-clockwise from there.
    mesh.from_pydata([(x, y, 0) for x, y in corners], [], [list(reversed(range(len(corners))))])
    material = bpy.data.materials.new(lamp.name)
    material.use_nodes = True
    material.use_backface_culling = True  # it emits on one side
    surface = material.node_tree.nodes["Principled BSDF"]
    surface.inputs["Base Color"].default_value = (0, 0, 0, 1)
    factors = (light.use_nodes and _emission(light)) or [1, 1, 1]
    colour = [max(0, own * factor) for own, factor in zip(light.color, factors)]
    versions.emission_colour(surface).default_value = (*colour, 1)
    surface.inputs["Emission Strength"].default_value = max(0, light.energy) * versions.area_lamp_radiance() / area
    mesh.materials.append(material)
    panel = bpy.data.objects.new(lamp.name, mesh)
    panel.matrix_world = matrix
    return panel
