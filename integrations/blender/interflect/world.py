"""The world's light, as an image for `interflect solve --environment`."""

import math
from pathlib import Path

import bpy

from . import versions

RENDER_WORLD = Path(__file__).with_name("render_world.py")


def plain_radiance(world):
    """Returns the radiance of a world of one colour, [r, g, b]. None if it varies."""
    if world is None:
        return [0.0, 0.0, 0.0]
    if not world.use_nodes:
        return list(world.color)
    output = world.node_tree.get_output_node("CYCLES")
    if output is None or not output.inputs["Surface"].is_linked:
        return [0.0, 0.0, 0.0]
    shader = output.inputs["Surface"].links[0].from_node
    if shader.type != "BACKGROUND" or any(socket.is_linked for socket in shader.inputs):
        return None
    strength = shader.inputs["Strength"].default_value
    return [strength * channel for channel in shader.inputs["Color"].default_value[:3]]


def write_plain(path: Path, radiance) -> None:
    """Writes an image of one colour in Radiance's format (.hdr). Negative channels become 0."""
    width, height = 8, 4
    exponent = math.frexp(max(radiance))[1]
    texel = bytes([*(max(0, min(255, round(256 * math.ldexp(c, -exponent)))) for c in radiance), exponent + 128])
    header = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n"
    path.write_bytes(header.encode() + width * height * texel)


def rendering(scene, folder: Path, picture: Path) -> list[str]:
    """Returns a command that renders the world of a scene into a latitude-longitude image. It runs a second Blender, to
    keep the user's last render."""
    file = folder / "world.blend"
    bpy.data.libraries.write(str(file), {scene.world}, path_remap="ABSOLUTE")
    where = [str(file), scene.world.name, str(scene.frame_current), str(picture)]
    return [*versions.background_command(), str(RENDER_WORLD), "--", *where]
