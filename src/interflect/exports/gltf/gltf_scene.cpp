#include "interflect/exports/gltf/gltf_scene.h"

#include <ImathBox.h>
#include <ImathMatrix.h>
#include <ImathMatrixAlgo.h>
#include <ImathQuat.h>

#include <filesystem>
#include <numbers>

#include "interflect/base/files/escapes.h"
#include "interflect/exports/mesh/opacity.h"

namespace interflect::detail {

namespace {

Json json_of(const Imath::V3d& v) { return {v.x, v.y, v.z}; }
/// Returns the components in glTF's order (x, y, z, w).
Json json_of(const Imath::Quatd& q) { return {q.v.x, q.v.y, q.v.z, q.r}; }

double size_of(const Scene& scene) {
    Imath::Box3d bounds;
    for (const Patch& patch : scene.patches)
        for (int c = 0; c < patch.vertex_count(); ++c) bounds.extendBy(Imath::V3d(scene.vertices[patch.vertices[c]]));
    return bounds.size().length();
}

/// Returns the rotation of a camera of glTF, which looks along -z with y up and x to the right.
Imath::Quatd rotation_of(const View& view) {
    const Imath::V3d back = (view.eye - view.look_at).normalized();
    const Imath::V3d right = Imath::V3d(view.up).cross(back).normalized(), up = back.cross(right);
    const Imath::M44d rows(right.x, right.y, right.z, 0, up.x, up.y, up.z, 0, back.x, back.y, back.z, 0, 0, 0, 0, 1);
    return Imath::extractQuat(rows).normalized();
}

Json camera_of(const View& view, double scene_size) {
    const double distance = (view.look_at - view.eye).length();
    const double far = scene_size + distance, near = 1e-3 * far;  // depth buffers in single precision limit the ratio
    if (view.extent > 0) {
        const double half = view.extent / 2;
        return {{"name", escaped(view.name)},
                {"type", "orthographic"},
                {"orthographic", {{"xmag", half}, {"ymag", half}, {"znear", 0}, {"zfar", far}}}};
    }
    const double yfov = view.fov * std::numbers::pi / 180;
    return {{"name", escaped(view.name)},
            {"type", "perspective"},
            {"perspective", {{"yfov", yfov}, {"znear", near}, {"zfar", 2 * far}}}};
}

}  // namespace

void add_nodes(GltfDocument& document, const Scene& scene, const GltfPrimitives& primitives, const V3f& up) {
    const std::string name = escaped(std::filesystem::path(scene.name).stem().string());
    Json children = Json::array();
    for (const auto& [object, object_primitives] : primitives) {
        const std::string object_name = scene.objects[object].empty() ? name : escaped(scene.objects[object]);
        const int mesh = document.add("meshes", {{"name", object_name}, {"primitives", object_primitives}});
        children.push_back(document.add("nodes", {{"name", object_name}, {"mesh", mesh}}));
    }
    const double scene_size = size_of(scene);
    for (const View& view : scene.views) {
        const int camera = document.add("cameras", camera_of(view, scene_size));
        children.push_back(document.add("nodes", {{"name", escaped(view.name)},
                                                  {"camera", camera},
                                                  {"translation", json_of(view.eye - scene.origin)},
                                                  {"rotation", json_of(rotation_of(view))}}));
    }
    Imath::Quatd to_y_up;
    to_y_up.setRotation(Imath::V3d(up).normalized(), Imath::V3d(0, 1, 0));
    Json root{{"name", name},
              {"rotation", json_of(to_y_up)},
              {"translation", json_of(to_y_up.rotateVector(scene.origin))},
              {"children", children}};
    const int root_index = document.add("nodes", root);
    document.json["scene"] = 0;
    document.add("scenes", {{"name", name}, {"nodes", {root_index}}});
}

Json GltfTextures::reference(std::uint32_t texture, const Rgb& peak) {
    const auto [entry, is_new] = numbers_.try_emplace({texture, peak != Rgb(1)}, 0);
    if (is_new) {
        const Texture& image = scene_.textures[texture];
        Image pixels(static_cast<int>(image.width), static_cast<int>(image.height));
        for (std::size_t i = 0; i < image.texels.size(); ++i) pixels.pixels[i] = image.texels[i] / peak;
        entry->second = document_.add_texture(pixels, image.name, true);
    }
    return {{"index", entry->second}};
}

Json GltfTextures::diffuse(const Material& material) {
    const Rgb& rho = material.reflectance;
    Json result{{"baseColorFactor", {rho.x, rho.y, rho.z, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}};
    // With a transmittance texture, cut_out() adds the texture of the reflectance.
    if (material.reflectance_texture != none && material.transmittance_texture == none)
        result["baseColorTexture"] = reference(material.reflectance_texture);
    return result;
}

void GltfTextures::cut_out(Json& json, const Material& material, const Rgb& peak) {
    const Texture opacity = opacity_of(scene_, material);
    const Texture reflectance = opaque_reflectance(scene_, material, opacity);
    Image pixels(static_cast<int>(opacity.width), static_cast<int>(opacity.height));
    std::vector<float> alpha;
    for (std::size_t i = 0; i < pixels.pixels.size(); ++i) {
        pixels.pixels[i] = reflectance.texels[i] / peak;
        alpha.push_back(opacity.texels[i].x);
    }
    json["pbrMetallicRoughness"]["baseColorTexture"] = {
        {"index", document_.add_texture(pixels, opacity.name, true, alpha)}};
    json["alphaMode"] = is_mask(opacity) ? "MASK" : "BLEND";
}

}  // namespace interflect::detail
