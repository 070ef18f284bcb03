"""Renders a glTF file with Cycles: `blender -b --python cycles_picture.py -- FILE.glb CAMERA WIDTH HEIGHT SAMPLES SEED
OUT.exr`.

Removes features that Interflect lacks from the imported file: surfaces that are not Lambertian, interpolated normals,
soft lamps and Cycles' own shortcuts (clamping, few bounces). A lumen in the file is a watt in Blender.
"""

import sys
from pathlib import Path

import bpy

sys.path.append(str(Path(__file__).resolve().parents[2] / "integrations/blender/interflect"))
import versions


def main(path, camera, width, height, samples, seed, out) -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=path, import_shading="FLAT", **versions.watts_as_lumens(bpy.ops.import_scene.gltf))
    for material in bpy.data.materials:
        make_lambertian(material)
    for light in bpy.data.lights:
        if light.type == "SUN":
            light.angle = 0
        else:
            light.shadow_soft_size = 0
        light.cycles.max_bounces = 1024
    render_to(out, camera, width, height, samples, seed)


def make_lambertian(material) -> None:
    """Replaces Blender's principled surface, which even without gloss is up to a fifth brighter at grazing light."""
    nodes, links = material.node_tree.nodes, material.node_tree.links
    principled = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
    diffuse, emission, both = (nodes.new(f"ShaderNode{kind}") for kind in ("BsdfDiffuse", "Emission", "AddShader"))
    for source, to in [
        (principled.inputs["Base Color"], diffuse.inputs["Color"]),
        (versions.emission_colour(principled), emission.inputs["Color"]),
        (principled.inputs["Emission Strength"], emission.inputs["Strength"]),
    ]:
        to.default_value = source.default_value
        for link in source.links:
            links.new(link.from_socket, to)
    links.new(diffuse.outputs[0], both.inputs[0])
    links.new(emission.outputs[0], both.inputs[1])
    links.new(both.outputs[0], next(node for node in nodes if node.type == "OUTPUT_MATERIAL").inputs["Surface"])


def render_to(out, camera, width, height, samples, seed) -> None:
    scene = bpy.context.scene
    scene.camera = next(o for o in bpy.data.objects if o.type == "CAMERA" and camera in (o.name, o.parent and o.parent.name))
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    scene.camera.data.sensor_fit = "VERTICAL"
    cycles.samples, cycles.seed, cycles.use_adaptive_sampling, cycles.use_denoising = samples, seed, False, False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.light_sampling_threshold = 0
    cycles.max_bounces = cycles.diffuse_bounces = 64
    cycles.pixel_filter_type = "BOX"
    render.film_transparent = False
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    render.image_settings.exr_codec = "ZIP"
    render.filepath = out
    bpy.ops.render.render(write_still=True)


path, camera, *numbers, out = sys.argv[sys.argv.index("--") + 1 :]
main(path, camera, *map(int, numbers), out)
