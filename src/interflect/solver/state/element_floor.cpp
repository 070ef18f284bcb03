#include "interflect/solver/state/element_floor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "interflect/prepare.h"

namespace interflect::detail {

namespace {

/// Minimum cosine for the area of a pixel, which becomes long and narrow at grazing angles.
constexpr float min_cosine = 0.1f;

}  // namespace

ElementFloor::ElementFloor(const Scene& scene, const SolveOptions& options)
    : is_given_(options.refinement.min_area > 0) {
    default_min_area_ =
        static_cast<float>(is_given_ ? options.refinement.min_area : std::pow(default_element_size(scene), 2));
    for (const WeightedView& w : options.views) {
        const double height = 2 * std::tan(0.5 * static_cast<double>(w.view.fov) * std::numbers::pi / 180);
        cameras_.push_back({V3f(w.view.eye - scene.origin), static_cast<float>(height / w.pixel_rows)});
    }
}

float ElementFloor::pixel_area(const V3f& centre, const V3f& normal) const {
    float smallest = std::numeric_limits<float>::infinity();
    for (const auto& [eye, pixel] : cameras_) {
        const V3f d = centre - eye;
        const float width = pixel * d.length();
        const float along_normal = std::abs(normal.dot(d)) / std::max(d.length(), std::numeric_limits<float>::min());
        smallest = std::min(smallest, width * width / std::max(min_cosine, along_normal));
    }
    return smallest;
}

float ElementFloor::min_area(const V3f& centre, const V3f& normal, bool is_seen) const {
    return !is_seen || is_given_ || cameras_.empty() ? default_min_area_ : pixel_area(centre, normal);
}

}  // namespace interflect::detail
