// Scenes for Mitsuba 3 (https://mitsuba.readthedocs.io, 'Plugins').
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "interflect/base/numbers/random.h"
#include "interflect/exports/foreign/foreign_scene.h"
#include "interflect/ray_caster.h"
#include "interflect/render/lights/path_samples.h"

namespace interflect::detail {

namespace for_mitsuba {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

std::string rgb(const char* name, const Rgb& value) {
    return fmt::format("<rgb name=\"{}\" value=\"{}\"/>", name, triple(value, ", "));
}

std::string texture(const char* name, const std::string& file) {
    return fmt::format("<texture type=\"bitmap\" name=\"{}\"><string name=\"filename\" value=\"{}\"/></texture>", name,
                       file);
}

std::string bsdf_text(ForeignScene& scene, std::uint32_t material) {
    const Material& m = scene.scene.materials[material];
    const auto two_sided = [](const std::string& reflectance) {
        return fmt::format("<bsdf type=\"twosided\"><bsdf type=\"diffuse\">{}</bsdf></bsdf>", reflectance);
    };
    if (m.transmittance_texture != none)
        return fmt::format("<bsdf type=\"mask\">{}{}</bsdf>", texture("opacity", scene.add_opacity_image(material)),
                           two_sided(texture("reflectance", scene.add_opaque_reflectance_image(material))));
    return two_sided(m.reflectance_texture == none ? rgb("reflectance", m.reflectance)
                                                   : texture("reflectance", scene.add_reflectance_image(material)));
}

std::string point(const char* name, const V3f& value) {
    return fmt::format("<point name=\"{}\" x=\"{}\" y=\"{}\" z=\"{}\"/>", name, value.x, value.y, value.z);
}

std::string look_at(const V3f& origin, const V3f& target, const V3f& up) {
    return fmt::format("<lookat origin=\"{}\" target=\"{}\" up=\"{}\"/>", triple(origin, ", "), triple(target, ", "),
                       triple(up, ", "));
}

std::string sensor_text(const ForeignScene& scene, const View& view) {
    std::string transform = look_at(V3f(view.eye), V3f(view.look_at), view.up);
    std::string lens =
        fmt::format("    <string name=\"fov_axis\" value=\"y\"/>\n    <float name=\"fov\" value=\"{}\"/>\n", view.fov);
    if (view.extent > 0) {  // orthographic sensors cover [-1, 1] horizontally
        const float half_width =
            view.extent / 2 * static_cast<float>(scene.options.width) / static_cast<float>(scene.options.height);
        transform = fmt::format("<scale x=\"{0}\" y=\"{0}\"/>", half_width) + transform;
        lens.clear();
    }
    return fmt::format(
        "  <sensor type=\"{}\">\n{}"
        "    <transform name=\"to_world\">{}</transform>\n"
        "    <sampler type=\"independent\"><integer name=\"sample_count\" value=\"{}\"/></sampler>\n"
        "    <film type=\"hdrfilm\"><integer name=\"width\" value=\"{}\"/><integer name=\"height\" value=\"{}\"/>"
        "<string name=\"pixel_format\" value=\"rgb\"/><rfilter type=\"box\"/></film>\n"
        "  </sensor>\n",
        view.extent > 0 ? "orthographic" : "perspective", lens, transform, scene.options.samples, scene.options.width,
        scene.options.height);
}

/// Returns whether other faces are so close that hardly any light of the face leaves the gap, even after reflections.
/// @param widest  Largest width of a gap [m].
bool faces_narrow_gap(const RayCaster& ray_caster, const ForeignMesh& mesh, std::size_t face, float widest) {
    constexpr std::uint64_t ray_count = 64;
    constexpr int most_free = 3;            // rays that may leave the gap
    constexpr float share_of_side = 0.02f;  // ratio of gap to face size, at which reflected light hardly leaves
    const auto& corners = mesh.faces[face];
    const bool is_triangle = corners[3] == none;
    const auto at = [&](std::size_t k) { return mesh.positions[corners[k]]; };
    const V3f cross = (at(1) - at(0)).cross(at(is_triangle ? 2 : 3) - at(0)), normal = cross.normalized();
    const float gap = std::min(widest, share_of_side * std::sqrt(cross.length()));
    std::vector<Ray> rays;
    for (std::uint64_t i = 0; i < ray_count; ++i) {
        const auto places = random_words(face, 2 * i), directions = random_words(face, 2 * i + 1);
        float u = unit_float(places[0]), v = unit_float(places[1]);
        if (u + v > 1) std::tie(u, v) = std::pair(1 - u, 1 - v);
        const std::size_t triangle = is_triangle ? 0 : i % 2;  // triangle of a quadrilateral
        const V3f origin = at(0) + u * (at(1 + triangle) - at(0)) + v * (at(2 + triangle) - at(0));
        rays.push_back({origin, cosine_direction(normal, unit_float(directions[0]), unit_float(directions[1]))});
    }
    std::vector<Hit> hits(rays.size());
    ray_caster.trace(rays, hits);
    return std::count_if(hits.begin(), hits.end(),
                         [&](const Hit& hit) { return hit.patch == none || hit.distance > gap; }) <= most_free;
}

/// Returns the mesh without faces whose light stays in narrow gaps, as between the sheets of a thin lamp. Mitsuba would
/// leak this light, because its shadow rays do not test the last part of their length.
ForeignMesh without_narrow_gaps(const ForeignScene& scene, const RayCaster& ray_caster, ForeignMesh mesh) {
    constexpr float shadow_epsilon = 1e-3f;  // share of the length of a shadow ray that is not tested
    const float widest = shadow_epsilon * 2 * scene.size;
    std::vector<std::array<std::uint32_t, 4>> open;
    for (std::size_t i = 0; i < mesh.faces.size(); ++i)
        if (!faces_narrow_gap(ray_caster, mesh, i, widest)) open.push_back(mesh.faces[i]);
    mesh.faces = std::move(open);
    return mesh;
}

/// @param ray_caster  Ray caster of the scene, constructed at its first use.
std::string shape_text(ForeignScene& scene, const ForeignMesh& mesh, std::optional<RayCaster>& ray_caster) {
    const Material& m = scene.material(mesh);
    const std::string bsdf = bsdf_text(scene, mesh.material);
    std::string emitter;
    if (scene.emits(mesh))
        emitter = "    <emitter type=\"area\">" +
                  (m.exitance_texture == none ? rgb("radiance", scene.radiance(mesh))
                                              : texture("radiance", scene.add_radiance_image(mesh.material))) +
                  "</emitter>\n";
    const auto shape = [&](const ForeignMesh& side) {
        return fmt::format(
            "  <shape type=\"ply\">\n    <string name=\"filename\" value=\"{}\"/>\n"
            "    <boolean name=\"face_normals\" value=\"true\"/>\n    <boolean name=\"flip_tex_coords\" "
            "value=\"true\"/>\n"
            "    {}\n{}  </shape>\n",
            scene.add_file(side.name + ".ply", ply_of(side)), bsdf, emitter);
    };
    if (!scene.emits(mesh) || mesh.backs != Backs::emit) return shape(mesh);
    if (!ray_caster) ray_caster.emplace(scene.scene);
    const ForeignMesh backs = without_narrow_gaps(scene, *ray_caster, mesh.shifted_backs(scene.distance_of_backs()));
    return shape(mesh) + (backs.faces.empty() ? "" : shape(backs));
}

/// Describes the sun as a distant disc that has the sun's angle as seen from the whole scene, because Mitsuba has no
/// emitter for directional light with an angle.
std::string sun_text(const ForeignScene& scene, const DirectionalLight& sun) {
    constexpr float relative_distance = 1e4f;  // the angle varies by 1e-4 within the scene
    const V3f direction = sun.direction.normalized();
    const float sine = sun.disc_sine(), distance = relative_distance * std::max(scene.size, 1e-3f);
    const V3f position = scene.centre - distance * direction;
    const V3f up = std::abs(direction.z) < 0.9f ? V3f(0, 0, 1) : V3f(1, 0, 0);
    return fmt::format(
        "  <shape type=\"disk\">\n    <transform name=\"to_world\"><scale value=\"{}\"/>{}</transform>\n"
        "    <bsdf type=\"diffuse\">{}</bsdf>\n    <emitter type=\"area\">{}</emitter>\n  </shape>\n",
        distance * sine / std::sqrt(1 - sine * sine), look_at(position, scene.centre, up), rgb("reflectance", Rgb(0)),
        rgb("radiance", sun.disc_radiance()));
}

std::string luminaire_text(ForeignScene& scene, const Luminaire& luminaire) {
    if (const auto* light = std::get_if<PointLight>(&luminaire.kind))
        return fmt::format("  <emitter type=\"point\">{}{}</emitter>\n", point("position", light->position),
                           rgb("intensity", light->intensity));
    if (const auto* spot = std::get_if<SpotLight>(&luminaire.kind)) {
        if (spot->inner_angle < spot->outer_angle) scene.warnings.add("spot", "spots fade in another way there");
        if (spot->outer_angle > 90) scene.leave_out("light of spots beyond 90 degrees from their axes");
        const V3f up = std::abs(spot->direction.normalized().z) < 0.9f ? V3f(0, 0, 1) : V3f(1, 0, 0);
        return fmt::format(
            "  <emitter type=\"spot\">{}<float name=\"cutoff_angle\" value=\"{}\"/><float name=\"beam_width\" "
            "value=\"{}\"/>"
            "<transform name=\"to_world\">{}</transform></emitter>\n",
            rgb("intensity", spot->intensity), std::min(spot->outer_angle, 90.0f), std::min(spot->inner_angle, 90.0f),
            look_at(spot->position, spot->position + spot->direction, up));
    }
    if (const auto* directional = std::get_if<DirectionalLight>(&luminaire.kind)) {
        if (directional->diameter > 0) return sun_text(scene, *directional);
        const V3f& d = directional->direction;
        return fmt::format(
            "  <emitter type=\"directional\"><vector name=\"direction\" x=\"{}\" y=\"{}\" z=\"{}\"/>{}</emitter>\n",
            d.x, d.y, d.z, rgb("irradiance", directional->irradiance));
    }
    if (!is_sky(luminaire)) scene.leave_out(fmt::format("lights of the kind '{}'", kind_name(luminaire)));
    return "";
}

/// Returns the direction of a point of an 'envmap': -z at the left edge, +x a quarter to the right, +y at the upper
/// edge.
V3f envmap_direction(float x, float y) {
    const float azimuth = 2 * pi * x, polar = pi * y;
    return {std::sin(azimuth) * std::sin(polar), std::cos(polar), -std::cos(azimuth) * std::sin(polar)};
}

}  // namespace
}  // namespace for_mitsuba

std::string mitsuba_description(ForeignScene& scene) {
    using namespace for_mitsuba;
    // Shadow rays of the integrator 'path' end at masks. Shadow rays of 'volpath' pass their holes.
    const bool has_holes = std::any_of(scene.meshes.begin(), scene.meshes.end(),
                                       [&](const ForeignMesh& mesh) { return scene.is_cut_out(mesh); });
    std::string text = fmt::format(
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<!-- Interflect {} -->\n<scene version=\"3.0.0\">\n"
        "  <integrator type=\"{}\"><integer name=\"max_depth\" value=\"-1\"/></integrator>\n",
        INTERFLECT_VERSION, has_holes ? "volpath" : "path");
    for (const View& view : scene.views) text += sensor_text(scene, view);
    std::optional<RayCaster> ray_caster;
    for (const ForeignMesh& mesh : scene.meshes) text += shape_text(scene, mesh, ray_caster);
    for (const Luminaire& luminaire : scene.scene.luminaires) text += luminaire_text(scene, luminaire);
    if (const std::string sky = scene.add_sky_image(2, envmap_direction); !sky.empty())
        text += fmt::format("  <emitter type=\"envmap\"><string name=\"filename\" value=\"{}\"/></emitter>\n", sky);
    scene.warn_of_materials(ForeignScene::Support::without_glass_and_backs);
    return text + "</scene>\n";
}

}  // namespace interflect::detail
