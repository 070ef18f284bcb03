#include "interflect/exports/mesh/shown_patches.h"

#include <algorithm>

#include "interflect/exports/mesh/encased_patches.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/ray_caster.h"
#include "interflect/solver/light/patch_light.h"

namespace interflect::detail {

namespace {

/// Maximum light of a dark patch, as in a moonless night, and its maximum relative to the mean. Such patches look black
/// beside lit rooms.
constexpr double max_dark = 1e-3;  // [lm/m^2]
constexpr double max_dark_of_mean = 1e-4;
/// Maximum light inside solids, relative to the mean. It is invisible, but exceeds the light of stray rays at seams
/// (2e-4 in a room with 5 million rays).
constexpr double max_stray_of_mean = 1e-3;
/// Maximum light inside solids, relative to the other side of the same face, because bright surroundings leak more.
constexpr float max_stray_of_outside = 0.02f;

double mean_of(const Scene& scene, const std::vector<float>& light) {
    double sum = 0, area = 0;
    for (std::size_t p = 0; p < light.size(); ++p) {
        const double patch_area = PatchGeometry(scene, scene.patches[p]).area();
        sum += patch_area * static_cast<double>(light[p]);
        area += patch_area;
    }
    return area > 0 ? sum / area : 0;
}

std::vector<bool> at_most(const std::vector<float>& light, double limit) {
    std::vector<bool> dark;
    dark.reserve(light.size());
    for (const float each : light) dark.push_back(static_cast<double>(each) <= limit);
    return dark;
}

/// Returns which patches are dark enough to be inside a solid.
std::vector<bool> may_be_inside(const Scene& scene, const std::vector<float>& light, double mean) {
    std::vector<bool> result = at_most(light, max_stray_of_mean * mean);
    for (PatchIndex p{0}; p < scene.patches.size(); ++p) {
        const PatchIndex outside = scene.patches[p].other_side;
        if (outside != none && light[p] <= max_stray_of_outside * light[outside]) result[p] = true;
    }
    return result;
}

}  // namespace

PatchVisibility patch_visibility(const Scene& scene, const Solution& solution) {
    const bool is_dimmed = !solution.undimmed_light.empty();
    PatchVisibility result;
    result.light = is_dimmed ? solution.undimmed_light : patch_light(scene, solution.irradiance);
    const double mean = mean_of(scene, result.light);
    result.lit = at_most(result.light, std::min(max_dark, max_dark_of_mean * mean));
    result.lit.flip();
    const RayCaster ray_caster(scene);
    for (PatchIndex p{0}; p < scene.patches.size(); ++p) result.hidden.push_back(ray_caster.uncovered_share(p) == 0);
    result.encased.resize(scene.patches.size());
    if (std::find(result.lit.begin(), result.lit.end(), true) == result.lit.end())
        return result;  // a scene without light keeps all faces
    result.encased = encased_patches(scene, ray_caster, may_be_inside(scene, result.light, mean));
    for (PatchIndex p{0}; p < scene.patches.size(); ++p)
        if (result.encased[p]) result.hidden[p] = true;
    return result;
}

std::vector<bool> shown_patches(const Scene& scene, const Solution& solution) {
    const PatchVisibility found = patch_visibility(scene, solution);
    std::vector<bool> shown(scene.patches.size());
    for (PatchIndex p{0}; p < shown.size(); ++p) {
        const PatchIndex other = scene.patches[p].other_side;
        const bool is_first_of_dark_face = other == none || (!found.lit[other] && p < other);
        shown[p] = !found.hidden[p] && (found.lit[p] || is_first_of_dark_face);
    }
    return shown;
}

}  // namespace interflect::detail
