#include "interflect/geometry/vertex_weld.h"

#include <bit>

#include "interflect/base/random.h"

namespace interflect::inline detail {

namespace {

std::uint64_t hash(const V3f& position, const V2f& coordinate) {
    const auto bits = [](float f) { return std::uint64_t{std::bit_cast<std::uint32_t>(f)}; };
    const V3f x = position + V3f(0);  // -0 + 0 = 0
    const V2f uv = coordinate + V2f(0);
    const std::uint64_t of_position = mix(bits(x.x) | bits(x.y) << 32, bits(x.z));
    return uv == V2f(0) ? of_position : mix(of_position, bits(uv.x) | bits(uv.y) << 32);
}

}  // namespace

/// The slot that holds this vertex, or the empty one where it belongs.
std::uint32_t& VertexWeld::slot_of(const V3f& position, const V2f& coordinate) {
    const auto is_other = [&](std::uint32_t v) {
        return scene_.vertices[v] != position || coordinate_of(v) != coordinate;
    };
    const std::size_t mask = slots_.size() - 1;
    std::size_t i = hash(position, coordinate) & mask;
    while (slots_[i] != none && is_other(slots_[i])) i = (i + 1) & mask;
    return slots_[i];
}

void VertexWeld::grow() {
    const std::vector<std::uint32_t> old = std::move(slots_);
    slots_.assign(2 * old.size(), none);
    for (const std::uint32_t vertex : old)
        if (vertex != none) slot_of(scene_.vertices[vertex], coordinate_of(vertex)) = vertex;
}

std::uint32_t VertexWeld::vertex(const V3f& position, const std::optional<V2f>& coordinate) {
    if (2 * (used_ + 1) > slots_.size()) grow();
    const V2f uv = coordinate.value_or(V2f(0));
    std::uint32_t& slot = slot_of(position, uv);
    if (slot == none) {
        slot = static_cast<std::uint32_t>(scene_.vertices.size());
        if (coordinate) scene_.texture_coordinates.resize(scene_.vertices.size(), V2f(0));
        scene_.vertices.push_back(position);
        if (coordinate || !scene_.texture_coordinates.empty()) scene_.texture_coordinates.push_back(uv);
        ++used_;
    }
    return slot;
}

}  // namespace interflect::inline detail
