// Scenes as Python programs for Blender 2.93 or later (https://docs.blender.org/api).
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "interflect/exports/foreign/foreign_scene.h"

namespace interflect::detail {

namespace for_blender {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

constexpr const char* prologue = R"(
# Builds the scene in place of what is open, for Cycles. With a file name after "--" it renders the scene's first view
# into that OpenEXR file, in linear values:
#     blender --background --python THIS.py -- picture.exr
import math
import os
import sys

import bpy
from mathutils import Matrix, Vector

FOLDER = os.path.dirname(os.path.abspath(__file__))
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
world = scene.world = bpy.data.worlds.new("World")
world.use_nodes = True
world.node_tree.nodes["Background"].inputs["Color"].default_value = (0, 0, 0, 1)


def link(data, name):
    thing = bpy.data.objects.new(name, data)
    scene.collection.objects.link(thing)
    return thing


def image(nodes, name):
    node = nodes.new("ShaderNodeTexImage")
    node.image = bpy.data.images.load(os.path.join(FOLDER, name))
    node.image.colorspace_settings.name = "Non-Color"  # linear as they are
    return node.outputs["Color"]


def set_colour(links, nodes, socket, value):
    if isinstance(value, str):
        links.new(image(nodes, value), socket)
    else:
        socket.default_value = (*value, 1)


def material(name, reflectance, radiance, transmittance, backs):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    nodes.clear()

    def added(a, b):
        node = nodes.new("ShaderNodeAddShader")
        links.new(a, node.inputs[0])
        links.new(b, node.inputs[1])
        return node.outputs[0]

    diffuse = nodes.new("ShaderNodeBsdfDiffuse")
    set_colour(links, nodes, diffuse.inputs["Color"], reflectance)
    back = front = diffuse.outputs[0]
    if any(transmittance):
        glass = nodes.new("ShaderNodeBsdfTransparent")
        set_colour(links, nodes, glass.inputs["Color"], transmittance)
        back = front = added(front, glass.outputs[0])
    if radiance:
        emission = nodes.new("ShaderNodeEmission")
        set_colour(links, nodes, emission.inputs["Color"], radiance)
        front = added(front, emission.outputs[0])
    if backs == "emit":
        back = front
    if backs == "pass":
        back = nodes.new("ShaderNodeBsdfTransparent").outputs[0]
    sides = nodes.new("ShaderNodeMixShader")
    links.new(nodes.new("ShaderNodeNewGeometry").outputs["Backfacing"], sides.inputs[0])
    links.new(front, sides.inputs[1])
    links.new(back, sides.inputs[2])
    links.new(sides.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return made


def mesh(name, shown, positions, faces, coordinates=None):
    data = bpy.data.meshes.new(name)
    data.from_pydata(positions, [], faces)
    data.materials.append(shown)
    if coordinates:
        layer = data.uv_layers.new()
        for loop in data.loops:
            layer.data[loop.index].uv = coordinates[loop.vertex_index]
    link(data, name)


def place(thing, position, direction, up=(0, 0, 1)):
    """Looks along `direction` from `position`: lamps and cameras look along -z."""
    z = -Vector(direction).normalized()
    x = Vector(up).cross(z)
    if x.length < 1e-6:
        x = Vector((1, 0, 0)).cross(z)
    x.normalize()
    y = z.cross(x)
    thing.matrix_world = Matrix.Translation(position) @ Matrix((x, y, z)).transposed().to_4x4()


def lamp(name, kind, colour, power):
    data = bpy.data.lights.new(name, kind)
    peak = max(colour)
    data.color = [c / peak for c in colour] if peak > 0 else colour
    data.energy = peak * power
    return data, link(data, name)


def point(name, position, intensity):
    data, thing = lamp(name, "POINT", intensity, WATTS_PER_INTENSITY)
    data.shadow_soft_size = 0
    place(thing, position, (0, 0, -1))


def spot(name, position, direction, intensity, inner_cosine, outer_cosine):
    """A point lamp whose intensity follows the cosine of the angle from its axis; a spot of Cycles fades otherwise."""
    data, thing = lamp(name, "POINT", intensity, WATTS_PER_INTENSITY)
    data.shadow_soft_size = 0
    data.use_nodes = True
    nodes, links = data.node_tree.nodes, data.node_tree.links
    axis = nodes.new("ShaderNodeSeparateXYZ")
    links.new(nodes.new("ShaderNodeTexCoord").outputs["Normal"], axis.inputs[0])
    share = nodes.new("ShaderNodeMapRange")
    links.new(axis.outputs["Z"], share.inputs["Value"])
    edge = max(inner_cosine - outer_cosine, 1e-6)
    for socket, value in zip(("From Min", "From Max", "To Min", "To Max"), (-outer_cosine, -outer_cosine - edge, 0, 1)):
        share.inputs[socket].default_value = value
    square = nodes.new("ShaderNodeMath")
    square.operation = "MULTIPLY"
    for k in (0, 1):
        links.new(share.outputs[0], square.inputs[k])
    links.new(square.outputs[0], nodes["Emission"].inputs["Strength"])
    place(thing, position, direction)


def sun(name, direction, irradiance, diameter):
    data, thing = lamp(name, "SUN", irradiance, 1)
    data.angle = diameter
    place(thing, (0, 0, 0), direction)


def sky(name):
    nodes, links = world.node_tree.nodes, world.node_tree.links
    node = nodes.new("ShaderNodeTexEnvironment")
    node.image = bpy.data.images.load(os.path.join(FOLDER, name))
    node.image.colorspace_settings.name = "Non-Color"
    links.new(node.outputs["Color"], nodes["Background"].inputs["Color"])


def camera(name, eye, look_at, up, fov, extent):
    data = bpy.data.cameras.new(name)
    data.sensor_fit = "VERTICAL"
    data.angle = fov
    if extent:
        data.type = "ORTHO"
        data.ortho_scale = extent
    data.clip_start = 1e-3
    data.clip_end = 1e5
    thing = link(data, name)
    place(thing, eye, Vector(look_at) - Vector(eye), up)
    scene.camera = scene.camera or thing


# A lamp of 1 W has the radiant intensity 1 / (4 pi) W/sr.
WATTS_PER_INTENSITY = 4 * math.pi

scene.render.engine = "CYCLES"
scene.cycles.use_adaptive_sampling = False
scene.cycles.use_denoising = False
scene.cycles.sample_clamp_indirect = 0
scene.cycles.light_sampling_threshold = 0
scene.cycles.blur_glossy = 0
scene.cycles.max_bounces = scene.cycles.diffuse_bounces = scene.cycles.transparent_max_bounces = 128
scene.cycles.pixel_filter_type = "BOX"
scene.cycles.filter_width = 1
scene.render.resolution_percentage = 100
scene.render.use_compositing = False
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.image_settings.color_depth = "32"
)";

constexpr const char* epilogue = R"(
if "--" in sys.argv and len(sys.argv) > sys.argv.index("--") + 1:
    scene.render.filepath = os.path.abspath(sys.argv[sys.argv.index("--") + 1])
    bpy.ops.render.render(write_still=True)
)";

std::string tuple(const V3f& v) { return "(" + triple(v, ", ") + ")"; }
float radians(float degrees) { return degrees / 180 * pi; }

std::string material_text(ForeignScene& scene, const ForeignMesh& mesh) {
    constexpr std::array backs{"pass", "reflect", "emit"};
    const Material& m = scene.material(mesh);
    const std::string reflectance =
        m.reflectance_texture == none ? tuple(m.reflectance) : "\"" + scene.add_reflectance_image(mesh.material) + "\"";
    std::string radiance = "None";
    if (scene.emits(mesh))
        radiance = m.exitance_texture == none ? tuple(scene.radiance(mesh))
                                              : "\"" + scene.add_radiance_image(mesh.material) + "\"";
    const std::string transmittance = m.transmittance_texture == none
                                          ? tuple(m.transmittance)
                                          : "\"" + scene.add_transmittance_image(mesh.material) + "\"";
    return fmt::format("material(\"{}\", {}, {}, {}, \"{}\")", mesh.name, reflectance, radiance, transmittance,
                       backs[static_cast<std::size_t>(mesh.backs)]);
}

std::string mesh_text(ForeignScene& scene, const ForeignMesh& mesh) {
    std::string positions, faces, coordinates;
    for (const V3f& position : mesh.positions) positions += tuple(position) + ", ";
    for (const auto& [a, b, c, d] : mesh.faces)
        faces += d == none ? fmt::format("({}, {}, {}), ", a, b, c) : fmt::format("({}, {}, {}, {}), ", a, b, c, d);
    for (const V2f& uv : mesh.texture_coordinates) coordinates += fmt::format("({}, {}), ", uv.x, uv.y);
    return fmt::format("mesh(\"{}\", {},\n    [{}],\n    [{}],\n    [{}])\n", mesh.name, material_text(scene, mesh),
                       positions, faces, coordinates);
}

std::string luminaire_text(ForeignScene& scene, const Luminaire& luminaire, const std::string& name) {
    if (const auto* light = std::get_if<PointLight>(&luminaire.kind))
        return fmt::format("point(\"{}\", {}, {})\n", name, tuple(light->position), tuple(light->intensity));
    if (const auto* light = std::get_if<SpotLight>(&luminaire.kind))
        return fmt::format("spot(\"{}\", {}, {}, {}, {}, {})\n", name, tuple(light->position), tuple(light->direction),
                           tuple(light->intensity), light->inner_cosine(), light->outer_cosine());
    if (const auto* light = std::get_if<DirectionalLight>(&luminaire.kind))
        return fmt::format("sun(\"{}\", {}, {}, {})\n", name, tuple(light->direction), tuple(light->irradiance),
                           radians(light->diameter));
    if (!is_sky(luminaire)) scene.leave_out(fmt::format("lights of the kind '{}'", kind_name(luminaire)));
    return "";
}

std::string camera_text(const View& view, std::size_t number) {
    return fmt::format("camera(\"view-{}\", {}, {}, {}, {}, {})\n", number, tuple(V3f(view.eye)),
                       tuple(V3f(view.look_at)), tuple(view.up), radians(view.fov), view.extent);
}

}  // namespace
}  // namespace for_blender

std::string blender_description(ForeignScene& scene) {
    using namespace for_blender;
    std::string text = fmt::format("# Made by Interflect {}.{}", INTERFLECT_VERSION, prologue);
    text += fmt::format("scene.cycles.samples = {}\nscene.render.resolution_x = {}\nscene.render.resolution_y = {}\n\n",
                        scene.options.samples, scene.options.width, scene.options.height);
    for (std::size_t i = 0; i < scene.views.size(); ++i) text += camera_text(scene.views[i], i);
    for (const ForeignMesh& mesh : scene.meshes) text += mesh_text(scene, mesh);
    for (std::size_t i = 0; i < scene.scene.luminaires.size(); ++i)
        text += luminaire_text(scene, scene.scene.luminaires[i], scene.luminaires[i]);
    if (const std::string image = scene.add_sky_image(2, latitude_longitude_direction); !image.empty())
        text += fmt::format("sky(\"{}\")\n", image);
    scene.warn_of_materials(ForeignScene::Support::all);
    return text + epilogue;
}

}  // namespace interflect::detail
