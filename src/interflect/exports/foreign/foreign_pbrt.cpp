// Scenes for pbrt-v4 (https://pbrt.org/fileformat-v4).
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "interflect/exports/foreign/foreign_scene.h"

namespace interflect::detail {

namespace for_pbrt {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// Returns the field of view along the shorter side of the picture, as pbrt expects [degrees].
/// @param fov  Vertical field of view [degrees].
float shorter_fov(const ForeignScene& scene, float fov) {
    const float aspect = static_cast<float>(scene.options.width) / static_cast<float>(scene.options.height);
    return aspect >= 1 ? fov : 360 / pi * std::atan(aspect * std::tan(fov / 360 * pi));
}

/// Describes a camera. Mirrors x, because pbrt's cameras are left-handed.
std::string camera_text(const ForeignScene& scene, const View& view) {
    std::string text = fmt::format("Scale -1 1 1\nLookAt {}  {}  {}\n", triple(V3f(view.eye)),
                                   triple(V3f(view.look_at)), triple(view.up));
    if (!(view.extent > 0))
        return text + fmt::format("Camera \"perspective\" \"float fov\" [ {} ]\n", shorter_fov(scene, view.fov));
    const float half_height = view.extent / 2;
    const float half_width =
        half_height * static_cast<float>(scene.options.width) / static_cast<float>(scene.options.height);
    return text + fmt::format("Camera \"orthographic\" \"float screenwindow\" [ {} {} {} {} ]\n", -half_width,
                              half_width, -half_height, half_height);
}

std::string shape_text(ForeignScene& scene, const ForeignMesh& mesh) {
    const Material& m = scene.material(mesh);
    std::string text = "AttributeBegin\n";
    const bool is_cut_out = m.transmittance_texture != none;
    if (is_cut_out)
        text += fmt::format("  Texture \"{0}-opacity\" \"float\" \"imagemap\" \"string filename\" \"{1}\"\n", mesh.name,
                            scene.add_opacity_image(mesh.material));
    if (m.reflectance_texture == none && !is_cut_out) {
        text += fmt::format("  Material \"diffuse\" \"rgb reflectance\" [ {} ]\n", triple(m.reflectance));
    } else {
        text += fmt::format(
            "  Texture \"{0}\" \"spectrum\" \"imagemap\" \"string filename\" \"{1}\"\n"
            "  Material \"diffuse\" \"texture reflectance\" \"{0}\"\n",
            mesh.name,
            is_cut_out ? scene.add_opaque_reflectance_image(mesh.material)
                       : scene.add_reflectance_image(mesh.material));
    }
    if (scene.emits(mesh)) {
        Rgb radiance = scene.radiance(mesh);
        if (m.exitance_texture != none) {
            radiance *= mean_texel(scene.scene.textures[m.exitance_texture]);
            scene.leave_out("images of emission: surfaces have their means");
        }
        text += fmt::format("  AreaLightSource \"diffuse\" \"rgb L\" [ {} ]{}\n", triple(radiance),
                            mesh.backs == Backs::emit ? " \"bool twosided\" true" : "");
    }
    return text + fmt::format("  Shape \"plymesh\" \"string filename\" \"{}\"{}\nAttributeEnd\n",
                              scene.add_file(mesh.name + ".ply", ply_of(mesh)),
                              is_cut_out ? fmt::format(" \"texture alpha\" \"{}-opacity\"", mesh.name) : "");
}

std::string luminaire_text(ForeignScene& scene, const Luminaire& luminaire) {
    if (const auto* light = std::get_if<PointLight>(&luminaire.kind))
        return fmt::format("LightSource \"point\" \"rgb I\" [ {} ] \"point3 from\" [ {} ]\n", triple(light->intensity),
                           triple(light->position));
    if (const auto* spot = std::get_if<SpotLight>(&luminaire.kind)) {
        if (spot->inner_angle < spot->outer_angle) scene.warnings.add("spot", "spots fade in another way there");
        return fmt::format(
            "LightSource \"spot\" \"rgb I\" [ {} ] \"point3 from\" [ {} ] \"point3 to\" [ {} ] \"float coneangle\" [ "
            "{} ] "
            "\"float conedeltaangle\" [ {} ]\n",
            triple(spot->intensity), triple(spot->position), triple(spot->position + spot->direction),
            spot->outer_angle, spot->outer_angle - spot->inner_angle);
    }
    if (const auto* directional = std::get_if<DirectionalLight>(&luminaire.kind)) {
        if (directional->diameter > 0) scene.warnings.add("disc", "the sun is a point there");
        return fmt::format("LightSource \"distant\" \"rgb L\" [ {} ] \"point3 from\" [ {} ] \"point3 to\" [ 0 0 0 ]\n",
                           triple(directional->irradiance), triple(-directional->direction));
    }
    if (!is_sky(luminaire)) scene.leave_out(fmt::format("lights of the kind '{}'", kind_name(luminaire)));
    return "";
}

/// Maps the unit square to directions, as EqualAreaSquareToSphere() of pbrt-v4 does (Clarberg 2008).
V3f octahedral_direction(float x, float y) {
    const float u = 2 * x - 1, v = 2 * y - 1, a = std::abs(u), b = std::abs(v);
    const float signed_distance = 1 - (a + b), distance = std::abs(signed_distance), r = 1 - distance;
    const float azimuth = (r == 0 ? 1 : (b - a) / r + 1) * pi / 4;
    const float z = std::copysign(1 - r * r, signed_distance), sine = r * std::sqrt(std::max(0.0f, 2 - r * r));
    return {std::copysign(std::cos(azimuth), u) * sine, std::copysign(std::sin(azimuth), v) * sine, z};
}

}  // namespace
}  // namespace for_pbrt

std::string pbrt_description(ForeignScene& scene) {
    using namespace for_pbrt;
    std::string text = fmt::format("# Interflect {}\n", INTERFLECT_VERSION);
    text += camera_text(scene, scene.views.front());
    if (scene.views.size() > 1) scene.leave_out("all views but the first: pbrt has one camera");
    text += fmt::format(
        "Film \"rgb\" \"integer xresolution\" [ {} ] \"integer yresolution\" [ {} ] \"string filename\" \"{}.exr\"\n"
        "PixelFilter \"box\"\nSampler \"zsobol\" \"integer pixelsamples\" [ {} ]\n"
        "Integrator \"path\" \"integer maxdepth\" [ 100 ]\nWorldBegin\n",
        scene.options.width, scene.options.height, scene.escape(scene.path.stem().string()), scene.options.samples);
    for (const ForeignMesh& mesh : scene.meshes) text += shape_text(scene, mesh);
    for (const Luminaire& luminaire : scene.scene.luminaires) text += luminaire_text(scene, luminaire);
    if (const std::string sky = scene.add_sky_image(1, octahedral_direction); !sky.empty())
        text += fmt::format("LightSource \"infinite\" \"string filename\" \"{}\"\n", sky);
    scene.warn_of_materials(ForeignScene::Support::without_glass_and_backs);
    return text;
}

}  // namespace interflect::detail
