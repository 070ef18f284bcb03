#include "interflect/checks/lights/light_places.h"

#include <ImathBox.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string_view>
#include <variant>

#include "interflect/checks/search/finder.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/scene/core/core.h"

namespace interflect::detail {

namespace {

/// Minimum gap to a surface [m], or relative to a small scene's diagonal.
constexpr float min_gap = 0.02f, min_gap_relative = 0.01f;

/// Maximum distance to a close surface along a ray, relative to the gap. Longer oblique rays hit lamp shades.
constexpr float max_oblique = 5;

/// Numbers of a luminaire's rays that escape or hit a close surface.
struct Outcome {
    std::size_t escaped = 0, close = 0;
};

Outcome outcome_of(const Scene& scene, std::span<const Ray> rays, const SightLines& lines, float close_distance) {
    Outcome result;
    for (const Ray& ray : rays) {
        const Hit hit = lines.first_surface(ray);
        result.escaped += hit.patch == none;
        if (hit.patch == none) continue;
        const V3f normal = PatchGeometry(scene, scene.patches[hit.patch]).normal();
        result.close +=
            hit.distance < max_oblique * close_distance && -hit.distance * ray.direction.dot(normal) < close_distance;
    }
    return result;
}

/// Whether more than a twentieth of a luminaire's light would start behind a wall after a shift.
bool reaches_through_walls(std::span<const Ray> rays, const V3f& middle, const SightLines& lines,
                           const V3f& shift = V3f(0)) {
    constexpr std::size_t step = 4;  // tests a quarter of the rays
    constexpr float flush = 0.99f;   // an opening may touch a ceiling
    std::size_t outside = 0;
    for (std::size_t i = 0; i < rays.size(); i += step) {
        const V3f start = middle + flush * (rays[i].origin - middle) + shift;
        if (!lines.is_clear(middle, start)) outside += lines.is_open(start);
    }
    return 20 * step * outside > rays.size();
}

/// Whether planes C0 and C90 differ by more than a tenth of the peak intensity.
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

std::vector<Finding> find_misplaced_lights(const Scene& scene, const LocalLights& lights, const SightLines& lines,
                                           const Shell& shell, std::size_t places) {
    std::vector<Finding> findings;
    if (lights.size() == 0) return findings;
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
    Finder wide = finder("wide-opening", true,
                         "luminaires have an opening that is larger than the scene or reaches through its walls",
                         "check the units of their photometric file and of the scene, and their positions");
    Finder sunk = finder("sunk-luminaire", true,
                         "luminaires reach into a ceiling or wall by half of their height, and the light of the hidden "
                         "half is lost",
                         "place them by the top of their opening, not by its middle");
    Finder mixed =
        finder("mixed-photometry", false,
               "luminaires of LM-63 and of EULUMDAT are in one scene: lamps usually lie along C0 in LM-63, and "
               "along C90 in EULUMDAT",
               "turn one that replaces a luminaire of the other format by 90 degrees about its axis");
    const Imath::Vec3<float> extent = core_bounds(scene).size();
    const float size = extent.length(), close_distance = std::min(min_gap, min_gap_relative * size);
    bool has_eulumdat = false, has_lm63 = false;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const Luminaire& luminaire = lights.luminaire(i);
        const Outcome outcome = outcome_of(scene, lights.rays(i), lines, close_distance);
        const auto add_to = [&](Finder& found) {
            found.add_at(lights.position(i), scene.objects[luminaire.object], luminaire.name);
        };
        // Position: light that hits a close surface or leaves the scene
        if (2 * outcome.close > LocalLights::rays_per_light)
            add_to(close);
        else if (outcome.escaped == LocalLights::rays_per_light ||
                 (shell.is_room &&
                  (2 * outcome.escaped > LocalLights::rays_per_light || lines.is_open(lights.in_front_of(i)))))
            add_to(outside);
        const auto* measured = std::get_if<MeasuredLight>(&luminaire.kind);
        if (!measured) continue;
        // Opening: larger than the scene, or partly outside
        const V3f& opening = measured->web->opening.size;
        const float width = std::max({opening.x, opening.y, opening.z});
        if (width > size) {
            add_to(wide);
        } else if (width > 0 && shell.is_closed &&
                   reaches_through_walls(lights.rays(i), lights.in_front_of(i), lines)) {
            const V3f shift = measured->web->opening.mounting_depth() * measured->direction.normalized();
            add_to(reaches_through_walls(lights.rays(i), lights.in_front_of(i), lines, shift) ? wide : sunk);
        }
        // Orientation of the C planes, which depends on the format
        if (!depends_on_planes(*measured->web)) continue;
        (is_eulumdat(*measured->web) ? has_eulumdat : has_lm63) = true;
        if (is_eulumdat(*measured->web)) add_to(mixed);
    }
    close.append_to(findings);
    outside.append_to(findings);
    wide.append_to(findings);
    sunk.append_to(findings);
    if (has_eulumdat && has_lm63) mixed.append_to(findings);
    return findings;
}

}  // namespace interflect::detail
