#include "interflect/generators/building/walls/solids.h"

#include <array>
#include <cmath>

namespace interflect::detail::building {

namespace {

/// Corner bits: 1 for high x, 2 for y, 4 for z. Counter-clockwise from outside.
constexpr std::array<std::array<std::uint32_t, 4>, 6> box_faces{
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
constexpr std::size_t underside_face = 4;

}  // namespace

Placement Placement::quarter_turned(const V3f& origin, int quarter_turns) {
    constexpr std::array<float, 4> cosines{1, 0, -1, 0};
    Placement placement;
    placement.origin_ = origin;
    placement.cosine_ = cosines[quarter_turns & 3];
    placement.sine_ = cosines[(quarter_turns + 3) & 3];
    return placement;
}

Placement Placement::turned(const V3f& origin, float radians) {
    Placement placement;
    placement.origin_ = origin;
    placement.cosine_ = std::cos(radians);
    placement.sine_ = std::sin(radians);
    return placement;
}

Placement Placement::at(const V3f& local, float radians) const {
    const Placement relative = turned(point(local), radians);
    Placement placement;
    placement.origin_ = relative.origin_;
    placement.cosine_ = cosine_ * relative.cosine_ - sine_ * relative.sine_;
    placement.sine_ = sine_ * relative.cosine_ + cosine_ * relative.sine_;
    return placement;
}

void Solids::box(const V3f& low, const V3f& high, std::uint32_t material,
                 std::optional<std::uint32_t> underside) const {
    tapered_box(low, high, 1, material);
    if (underside) scene_->patches[scene_->patches.size() - box_faces.size() + underside_face].material = *underside;
}

void Solids::tapered_box(const V3f& low, const V3f& high, float top_scale, std::uint32_t material) const {
    const auto first = static_cast<std::uint32_t>(scene_->vertices.size());
    const V3f centre = (low + high) / 2, half = (high - low) / 2;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const float scale = corner & 4 ? top_scale : 1;
        scene_->vertices.push_back(
            placement_.point({centre.x + (corner & 1 ? half.x : -half.x) * scale,
                              centre.y + (corner & 2 ? half.y : -half.y) * scale, corner & 4 ? high.z : low.z}));
    }
    for (const auto& face : box_faces)
        scene_->patches.push_back({.vertices = {first + face[0], first + face[1], first + face[2], first + face[3]},
                                   .material = material,
                                   .object = object_});
}

}  // namespace interflect::detail::building
