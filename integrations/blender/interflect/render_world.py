"""Renders the light of a world on diffuse surfaces as a latitude-longitude image with north (y) in its middle. A script
for `blender --background --python`, with the arguments: WORLD.blend NAME FRAME PICTURE.exr"""

import math
import sys

import bpy

WIDTH = 512  # 0.7 degrees a texel, a little more than the sun
SAMPLES = 64  # per texel; Blender's sun then has the same power within 1% as at twice the width

file, name, frame, picture = sys.argv[sys.argv.index("--") + 1 :]
bpy.ops.wm.read_factory_settings(use_empty=True)
with bpy.data.libraries.load(file) as (_, loaded):
    loaded.worlds = [name]
world = loaded.worlds[0]

SEEN_BY_DIFFUSE = {"Is Diffuse Ray": 1, "Is Reflection Ray": 1, "Ray Depth": 1, "Diffuse Depth": 1}  # others: 0


def trees(tree):
    yield tree
    for node in tree.nodes:
        if node.type == "GROUP" and node.node_tree:
            yield from trees(node.node_tree)


for tree in trees(world.node_tree):
    for image in [node.image for node in tree.nodes if node.type in ("TEX_ENVIRONMENT", "TEX_IMAGE") and node.image]:
        if image.size[0] == 0:
            print(f"warning: The world's image '{image.filepath}' is not there, which Blender shows in pink", file=sys.stderr)
    for node in [node for node in tree.nodes if node.type == "LIGHT_PATH"]:
        for output in node.outputs:
            value = tree.nodes.new("ShaderNodeValue")
            value.outputs[0].default_value = SEEN_BY_DIFFUSE.get(output.name, 0)
            for link in list(output.links):
                tree.links.new(value.outputs[0], link.to_socket)
for link in list(world.node_tree.get_output_node("CYCLES").inputs["Volume"].links):
    world.node_tree.links.remove(link)
world.cycles_visibility.camera = world.cycles_visibility.diffuse

scene = bpy.context.scene
scene.world = world
scene.render.engine = "CYCLES"
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = WIDTH, WIDTH // 2, 100
scene.cycles.samples = SAMPLES
scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
scene.cycles.pixel_filter_type = "BOX"
scene.cycles.filter_width = 1
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.image_settings.color_depth = "32"
scene.render.filepath = picture
camera = bpy.data.objects.new("north", bpy.data.cameras.new("north"))
camera.data.type = "PANO"
(camera.data if hasattr(camera.data, "panorama_type") else camera.data.cycles).panorama_type = "EQUIRECTANGULAR"
camera.rotation_euler = (math.pi / 2, 0, 0)
scene.collection.objects.link(camera)
scene.camera = camera
scene.frame_set(int(frame))
bpy.ops.render.render(write_still=True)
