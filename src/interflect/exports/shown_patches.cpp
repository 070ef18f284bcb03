#include "interflect/exports/shown_patches.h"

#include <algorithm>

#include "interflect/exports/encased_patches.h"
#include "interflect/ray_caster.h"

namespace interflect::inline detail {

std::vector<bool> shown_patches(const Scene& scene, std::span<const Rgb> irradiance) {
    const auto is_dark = [&](std::uint32_t p) {
        return largest_channel(irradiance[p]) == 0 &&
               largest_channel(scene.materials[scene.patches[p].material].exitance) == 0;
    };
    const RayCaster ray_caster(scene);
    std::vector<bool> shown(scene.patches.size(), true);
    for (std::uint32_t p = 0; p < shown.size(); ++p) {
        const std::uint32_t other = scene.patches[p].other_side;
        if (other != none && is_dark(p)) shown[p] = is_dark(other) && p < other;
        if (ray_caster.uncovered_share(p) == 0) shown[p] = false;
    }
    std::vector<bool> dark(shown.size());
    for (std::uint32_t p = 0; p < dark.size(); ++p) dark[p] = is_dark(p);
    if (std::find(dark.begin(), dark.end(), false) == dark.end())
        return shown;  // a scene without light keeps its faces
    const std::vector<bool> encased = encased_patches(scene, ray_caster, dark);
    for (std::uint32_t p = 0; p < shown.size(); ++p)
        if (encased[p]) shown[p] = false;
    return shown;
}

}  // namespace interflect::inline detail
