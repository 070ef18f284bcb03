#include "interflect/exports/shown_patches.h"

namespace interflect::inline detail {

std::vector<bool> shown_patches(const Scene& scene, std::span<const Rgb> irradiance) {
    const auto is_dark = [&](std::uint32_t p) {
        return largest_channel(irradiance[p]) == 0 &&
               largest_channel(scene.materials[scene.patches[p].material].exitance) == 0;
    };
    std::vector<bool> shown(scene.patches.size(), true);
    for (std::uint32_t p = 0; p < shown.size(); ++p) {
        const std::uint32_t other = scene.patches[p].other_side;
        if (other != none && is_dark(p)) shown[p] = is_dark(other) && p < other;
    }
    return shown;
}

}  // namespace interflect::inline detail
