#include "interflect/checks/light_places.h"

#include <ImathBox.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>
#include <variant>

#include "interflect/checks/finder.h"
#include "interflect/luminaires/emission.h"
#include "interflect/scene/core.h"

namespace interflect::inline detail {

namespace {

constexpr std::size_t most_lights = 1024, rays_per_part = 4,
                      rays_per_light = rays_per_part * Emission::parts_per_emitter;
constexpr std::uint64_t seed_of_light = 31;

/// Minimum gap between luminaire and surface [m], or relative to the diagonal of scenes smaller than 2 m. A closer
/// surface takes light meant for the room.
constexpr float least_gap = 0.02f, least_gap_relative = 0.01f;

/// Multiple of the gap along a ray within which surfaces are close; excludes lamp shades.
constexpr float most_oblique = 5;

/// Measured light starts this fraction of the scene's largest coordinate before its opening (Emission), where it may
/// miss a ceiling just below. The checks start at an eighth: 16 roundings.
constexpr float start_offset = 0x1p-17f, checked_offset = 0x1p-20f;

bool is_local(const Luminaire& luminaire) {
    return std::holds_alternative<PointLight>(luminaire.kind) || std::holds_alternative<SpotLight>(luminaire.kind) ||
           std::holds_alternative<MeasuredLight>(luminaire.kind);
}

/// Direction is 0 for a point light.
struct Pose {
    V3f position, direction{0, 0, 0};
};
Pose pose_of(const Luminaire& luminaire) {
    if (const auto* point = std::get_if<PointLight>(&luminaire.kind)) return {point->position};
    if (const auto* spot = std::get_if<SpotLight>(&luminaire.kind))
        return {spot->position, spot->direction.normalized()};
    const auto& measured = std::get<MeasuredLight>(luminaire.kind);
    return {measured.position, measured.direction.normalized()};
}

/// At most `most_lights` luminaires, and a triangle with the bounding box of the scene.
Scene sample_of_lights(const Scene& scene) {
    Imath::Box3f box;
    for (const Patch& patch : scene.patches)
        for (int k = 0; k < patch.vertex_count(); ++k) box.extendBy(scene.vertices[patch.vertices[k]]);
    Scene sample;
    sample.vertices = {box.min, {box.max.x, box.min.y, box.min.z}, box.max};
    sample.patches.push_back({{0, 1, 2, none}});
    std::vector<const Luminaire*> lights;
    for (const Luminaire& luminaire : scene.luminaires)
        if (is_local(luminaire) && largest_channel(rating(luminaire)) > 0) lights.push_back(&luminaire);
    const std::size_t step = (lights.size() + most_lights - 1) / most_lights;
    for (std::size_t i = 0; i < lights.size(); i += step) sample.luminaires.push_back(*lights[i]);
    return sample;
}

float reach_of(const Scene& sample) {
    float reach = 0;
    for (const V3f& x : sample.vertices)
        for (int k = 0; k < 3; ++k) reach = std::max(reach, std::abs(x[k]));
    return reach;
}

/// Numbers of a luminaire's rays.
struct Outcome {
    std::size_t escaped = 0, close = 0;
};

/// Surfaces are close by the distance of their plane.
std::vector<Outcome> outcomes(const Scene& scene, const Scene& sample, const SightLines& lines, float close_distance) {
    const Emission emission(sample);
    const float back = (start_offset - checked_offset) * reach_of(sample);
    std::vector<Outcome> result(sample.luminaires.size());
    std::vector<Ray> rays(rays_per_part);
    PointBlock points;
    for (std::size_t part = 0; part < emission.part_count(); ++part) {
        const std::size_t light = emission.luminaire(part);
        emission.shoot(part, PointSet::random, seed_of_light, part * rays_per_part, points, rays);
        const bool is_measured = std::holds_alternative<MeasuredLight>(sample.luminaires[light].kind);
        for (Ray ray : rays) {
            if (is_measured) ray.origin -= back * ray.direction;
            const Hit hit = lines.first_surface(ray);
            result[light].escaped += hit.patch == none;
            if (hit.patch == none) continue;
            const V3f normal = PatchGeometry(scene, scene.patches[hit.patch]).normal();
            result[light].close += hit.distance < most_oblique * close_distance &&
                                   -hit.distance * ray.direction.dot(normal) < close_distance;
        }
    }
    return result;
}

/// Whether the planes C0 and C90 differ by more than a tenth of the peak.
bool depends_on_planes(const PhotometricWeb& web) {
    constexpr int steps = 36;  // of 5 degrees
    const float peak = web.peak();
    for (int i = 1; i < steps; ++i) {
        const float angle = std::numbers::pi_v<float> * static_cast<float>(i) / steps;
        const float c0 = web.intensity({std::sin(angle), 0, -std::cos(angle)}),
                    c90 = web.intensity({0, std::sin(angle), -std::cos(angle)});
        if (std::abs(c0 - c90) > peak / 10) return true;
    }
    return false;
}

bool is_eulumdat(const PhotometricWeb& web) {
    const std::string_view name = web.name;
    return name.ends_with(".ldt") || name.ends_with(".LDT");
}

}  // namespace

std::vector<Finding> find_misplaced_lights(const Scene& scene, const SightLines& lines, bool is_room,
                                           std::size_t places) {
    const Scene sample = sample_of_lights(scene);
    std::vector<Finding> findings;
    if (sample.luminaires.empty()) return findings;
    const auto finder = [&](const char* kind, bool is_problem, const char* message, const char* advice) {
        return Finder(scene, places, {kind, is_problem, message, advice, 0, {}});
    };
    Finder close = finder("close-luminaire", true,
                          "luminaires lie behind a surface or within 2 cm before it, which receives more than half of "
                          "their light at once",
                          "move them to the side of the surface that they should light, or away from it");
    Finder outside = finder("outside-luminaire", true,
                            "luminaires lie outside of the scene, or more than half of their light leaves it",
                            "check their positions, the unit and the up axis of the scene");
    Finder wide = finder("wide-opening", true, "luminaires have an opening larger than the scene",
                         "check the unit of the file with their light, and that of the scene");
    Finder mixed =
        finder("mixed-photometry", false,
               "luminaires of LM-63 and of EULUMDAT are in one scene: lamps usually lie along C0 in LM-63, and "
               "along C90 in EULUMDAT",
               "turn one that replaces a luminaire of the other format by 90 degrees about its axis");
    const Imath::Vec3<float> extent = core_bounds(scene).size();
    const float size = extent.length(), close_distance = std::min(least_gap, least_gap_relative * size);
    const std::vector<Outcome> outcome = outcomes(scene, sample, lines, close_distance);
    bool has_eulumdat = false, has_lm63 = false;
    for (std::size_t i = 0; i < sample.luminaires.size(); ++i) {
        const Luminaire& luminaire = sample.luminaires[i];
        const Pose pose = pose_of(luminaire);
        const V3f before =
            pose.position + start_offset * reach_of(sample) * pose.direction;  // before the surface that contains it
        const auto add_to = [&](Finder& found) {
            found.add_at(pose.position, scene.objects[luminaire.object], luminaire.name);
        };
        if (2 * outcome[i].close > rays_per_light)
            add_to(close);
        else if (outcome[i].escaped == rays_per_light ||
                 (is_room && (2 * outcome[i].escaped > rays_per_light || lines.is_open(before))))
            add_to(outside);
        const auto* measured = std::get_if<MeasuredLight>(&luminaire.kind);
        if (!measured) continue;
        const V3f& opening = measured->web->opening.size;
        if (std::max({opening.x, opening.y, opening.z}) > size) add_to(wide);
        if (!depends_on_planes(*measured->web)) continue;
        (is_eulumdat(*measured->web) ? has_eulumdat : has_lm63) = true;
        if (is_eulumdat(*measured->web)) add_to(mixed);
    }
    close.append_to(findings);
    outside.append_to(findings);
    wide.append_to(findings);
    if (has_eulumdat && has_lm63) mixed.append_to(findings);
    return findings;
}

}  // namespace interflect::inline detail
