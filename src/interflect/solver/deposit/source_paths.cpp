#include "interflect/solver/deposit/source_paths.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numbers>

namespace interflect::detail {

SourcePaths::Path SourcePaths::append_leaf(ElementIndex leaf) {
    const PatchIndex patch = forest_.patch(leaf);
    const std::uint32_t path = forest_.path(leaf);
    const PatchGeometry& geometry = forest_.geometry(patch);
    const V3f normal = geometry.normal();
    ElementIndex element = patch;
    Cell cell;
    const auto first = static_cast<std::uint32_t>(sources_.size());
    for (int digit = std::bit_width(path) - 1;;) {
        const V3f centre = geometry.point(cell.centre(geometry.is_triangle()));
        sources_.push_back({element, cell, centre, normal, forest_.area(element), 0,
                            step_.light_for_oracle().of_element(patch, element)});
        if (digit == 0) break;
        digit -= 2;
        const unsigned k = path >> digit & 3u;
        element = forest_.first_child(element) + k;
        cell = cell.child(k, geometry.is_triangle());
    }
    return {first, static_cast<std::uint32_t>(sources_.size() - 1)};
}

/// Represents the part by a small disk that causes the same irradiance at the receiver.
SourcePaths::Path SourcePaths::append_part(std::uint32_t part, const Ray& ray, const Hit& hit) {
    constexpr float share_of_view = 1e-6f;  // small, so that the disk is never the larger end of a pair
    constexpr float tiny = std::numeric_limits<float>::min();
    const Emission::Proxy proxy = step_.emission->proxy(part, ray, hit.distance);
    const float squared = hit.distance * hit.distance;
    const float area = std::max(share_of_view * std::min(squared, 4 * step_.oracle.min_area), tiny);
    Rgb radiosity = proxy.intensity * (std::numbers::pi_v<float> / area);
    for (int c = 0; c < 3; ++c) radiosity[c] = std::min(radiosity[c], std::numeric_limits<float>::max());
    const float min_cosine = proxy.normal == V3f(0) ? 1.0f : 0.0f;
    sources_.push_back({no_element, Cell(), proxy.position, proxy.normal, area, min_cosine, radiosity});
    const auto number = static_cast<std::uint32_t>(sources_.size() - 1);
    return {number, number};
}

bool SourcePaths::subdivide(RayPairs& pairs, std::size_t i, const Parameters& start, const Rgb& reflectance,
                            bool may_grow) {
    Shooter shooter = sources_[pairs.shooter[i]];
    const PatchGeometry& geometry = forest_.geometry(forest_.patch(shooter.element));
    const ElementIndex children = find_or_create_children(forest_, shooter.element, may_grow);
    if (children == no_element) return false;
    const unsigned k = shooter.cell.child_at(start, geometry.is_triangle());
    shooter.cell = shooter.cell.child(k, geometry.is_triangle());
    shooter.element = children + k;
    shooter.centre = geometry.point(shooter.cell.centre(geometry.is_triangle()));
    shooter.area = forest_.area(shooter.element);
    sources_.push_back(shooter);
    pairs.lowest_shooter[i] = static_cast<std::uint32_t>(sources_.size() - 1);
    set_shooter(pairs, i, pairs.lowest_shooter[i], reflectance);
    return true;
}

}  // namespace interflect::detail
