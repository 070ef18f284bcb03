// Radiance (Ward 1994) divides photometric values by 179 lm/W.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "interflect/exports/foreign/foreign_scene.h"

namespace interflect::detail {

namespace for_radiance {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr float efficacy = 179;        // [lm/W]
constexpr float lamp_radius = 0.005f;  // of spheres for point lights [m]

std::string numbers(const V3f& v) { return "3 " + triple(v); }

std::string surface_text(ForeignScene& scene, const ForeignMesh& mesh) {
    const Material& m = scene.material(mesh);
    if (!scene.emits(mesh)) {
        Rgb reflectance = m.reflectance;
        if (m.reflectance_texture != none) {
            reflectance *= mean_texel(scene.scene.textures[m.reflectance_texture]);
            scene.leave_out("textures: surfaces have their means");
        }
        return fmt::format("void plastic {}\n0\n0\n5 {} 0 0\n", mesh.name, triple(reflectance));
    }
    if (m.reflectance != Rgb(0)) scene.leave_out("what emitting surfaces reflect");
    Rgb radiance = scene.radiance(mesh);
    if (m.exitance_texture != none) {
        radiance *= mean_texel(scene.scene.textures[m.exitance_texture]);
        scene.leave_out("textures: surfaces have their means");
    }
    return fmt::format("void light {}\n0\n0\n{}\n", mesh.name, numbers(radiance / efficacy));
}

std::string polygon(const ForeignMesh& mesh, std::size_t face, bool is_reversed, float offset) {
    std::vector<V3f> corners;
    for (const std::uint32_t v : mesh.faces[face])
        if (v != none) corners.push_back(mesh.positions[v]);
    if (is_reversed) {
        const V3f normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
        std::reverse(corners.begin(), corners.end());
        for (V3f& corner : corners) corner -= offset * normal;
    }
    std::string text = fmt::format("{} polygon {}.{}{}\n0\n0\n{}", mesh.name, mesh.name, face,
                                   is_reversed ? ".back" : "", 3 * corners.size());
    for (const V3f& corner : corners) text += "\n  " + triple(corner);
    return text + "\n";
}

std::string mesh_text(ForeignScene& scene, const ForeignMesh& mesh) {
    constexpr float offset = 1e-4f;  // between two emitting sides [m]
    std::string text = surface_text(scene, mesh);
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        text += polygon(mesh, face, false, 0);
        if (scene.emits(mesh) && mesh.backs == Backs::emit) text += polygon(mesh, face, true, offset);
    }
    return text;
}

std::string luminaire_text(ForeignScene& scene, const Luminaire& luminaire, const std::string& name) {
    const float disc = pi * lamp_radius * lamp_radius;  // [m^2]
    if (const auto* point = std::get_if<PointLight>(&luminaire.kind))
        return fmt::format("void light {0}\n0\n0\n{1}\n{0} sphere {0}.lamp\n0\n0\n4 {2} {3}\n", name,
                           numbers(point->intensity / disc / efficacy), triple(point->position), lamp_radius);
    if (const auto* spot = std::get_if<SpotLight>(&luminaire.kind)) {
        if (spot->inner_angle < spot->outer_angle)
            scene.leave_out("how spots fade: they are even up to the outer angle");
        return fmt::format("void spotlight {0}\n0\n0\n7 {1} {2} {3}\n{0} sphere {0}.lamp\n0\n0\n4 {4} {5}\n", name,
                           triple(spot->intensity / disc / efficacy), 2 * spot->outer_angle,
                           triple(spot->direction.normalized()), triple(spot->position), lamp_radius);
    }
    if (const auto* directional = std::get_if<DirectionalLight>(&luminaire.kind)) {
        const float diameter = directional->diameter > 0 ? directional->diameter : 0.01f;  // [degrees]
        const float sine = std::sin(diameter / 360 * pi);
        return fmt::format("void light {0}\n0\n0\n{1}\n{0} source {0}.disc\n0\n0\n4 {2} {3}\n", name,
                           numbers(directional->irradiance / (pi * sine * sine) / efficacy),
                           triple(-directional->direction), diameter);
    }
    if (const auto* sky = std::get_if<UniformSky>(&luminaire.kind))
        return fmt::format("void glow {0}\n0\n0\n4 {1} 0\n{0} source {0}.sky\n0\n0\n4 0 0 1 360\n", name,
                           triple(sky->radiance / efficacy));
    scene.leave_out(fmt::format("lights of the kind '{}'", kind_name(luminaire)));
    return "";
}

/// -vh and -vv are full angles, or sizes of orthographic views.
std::string view_text(const ForeignScene& scene, const View& view) {
    const float aspect = static_cast<float>(scene.options.width) / static_cast<float>(scene.options.height);
    const float half = std::tan(view.fov / 360 * pi);
    const float vertical = view.extent > 0 ? view.extent : view.fov;
    const float horizontal = view.extent > 0 ? aspect * view.extent : 360 / pi * std::atan(aspect * half);
    return fmt::format("rvu -vt{} -vp {} -vd {} -vu {} -vh {} -vv {}\n", view.extent > 0 ? 'l' : 'v',
                       triple(V3f(view.eye)), triple(V3f(view.look_at - view.eye)), triple(view.up), horizontal,
                       vertical);
}

}  // namespace
}  // namespace for_radiance

std::string radiance_description(ForeignScene& scene) {
    using namespace for_radiance;
    std::string text =
        fmt::format("# Interflect {}: lengths in metres, radiance in lm/(m2 sr) / {}\n", INTERFLECT_VERSION, efficacy);
    for (const ForeignMesh& mesh : scene.meshes) text += "\n" + mesh_text(scene, mesh);
    for (std::size_t i = 0; i < scene.scene.luminaires.size(); ++i)
        text += "\n" + luminaire_text(scene, scene.scene.luminaires[i], scene.luminaires[i]);
    for (std::size_t i = 0; i < scene.views.size(); ++i)
        scene.add_file(fmt::format("view-{}.vf", i), view_text(scene, scene.views[i]));
    scene.warn_of_materials(false, false);
    return text;
}

}  // namespace interflect::detail
