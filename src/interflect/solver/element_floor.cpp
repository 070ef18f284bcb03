#include "interflect/solver/element_floor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "interflect/scene/patch_geometry.h"

namespace interflect {

namespace {

constexpr double smallest_side = 0.005;          // [m]
constexpr double typical_side_over_smallest = 1000;
/// Surfaces seen at a grazing angle are taken to be seen at this cosine: a pixel's share of them is long and narrow.
constexpr float least_cosine = 0.1f;

/// The side of the square of the patch that half of the scene's area lies in patches smaller than [m].
double typical_side(const Scene& scene) {
    std::vector<float> areas;
    areas.reserve(scene.patches.size());
    double all = 0;
    for (const Patch& patch : scene.patches) {
        areas.push_back(patch_area(scene, patch));
        all += areas.back();
    }
    std::sort(areas.begin(), areas.end());
    double below = 0;
    for (const float area : areas)
        if ((below += area) >= all / 2) return std::sqrt(area);
    return 0;
}

}  // namespace

ElementFloor::ElementFloor(const Scene& scene, const SolveOptions& options) : is_given_(options.smallest_area > 0) {
    const double side = std::min(smallest_side, typical_side(scene) / typical_side_over_smallest);
    unseen_ = static_cast<float>(is_given_ ? options.smallest_area : side * side);
    for (const WeightedView& w : options.views) {
        const double height = 2 * std::tan(0.5 * static_cast<double>(w.view.fov) * std::numbers::pi / 180);
        eyes_.push_back({V3f(w.view.eye - scene.origin), static_cast<float>(height / w.pixel_rows)});
    }
}

float ElementFloor::smallest_area(const V3f& centre, const V3f& normal, bool is_seen) const {
    if (!is_seen || is_given_ || eyes_.empty()) return unseen_;
    float smallest = std::numeric_limits<float>::infinity();
    for (const auto& [eye, pixel] : eyes_) {
        const V3f d = centre - eye;
        const float width = pixel * d.length();
        const float cosine = std::max(least_cosine, std::abs(normal.dot(d)) / std::max(d.length(), std::numeric_limits<float>::min()));
        smallest = std::min(smallest, width * width / cosine);
    }
    return smallest;
}

}  // namespace interflect
