#include "interflect/geometry/search/vertex_weld.h"

#include <bit>

#include "interflect/base/numbers/random.h"

namespace interflect::detail {

namespace {

std::uint64_t bits(float f) {
    return std::bit_cast<std::uint32_t>(f + 0.0f);  // adding 0 turns -0 into 0
}

std::uint64_t bits(const V2f& v) { return bits(v.x) | bits(v.y) << 32; }

std::uint64_t hash(const V3f& x, const VertexCoordinates& coordinates) {
    const V2f texture = coordinates.texture.value_or(V2f(0));
    std::uint64_t result = mix(bits(x.x) | bits(x.y) << 32, bits(x.z));
    if (texture != V2f(0)) result = mix(result, bits(texture));
    if (coordinates.lightmap) result = mix(result, bits(*coordinates.lightmap));
    const V3f& n = coordinates.normal;
    if (n != V3f(0)) result = mix(result, mix(bits(n.x) | bits(n.y) << 32, bits(n.z)));
    return result;
}

}  // namespace

std::uint32_t& VertexWeld::slot_of(const V3f& position, const VertexCoordinates& coordinates) {
    const bool are_bare =
        scene_.texture_coordinates.empty() && scene_.lightmap_coordinates.empty() && scene_.normals.empty();
    const auto is_other = [&](std::uint32_t v) {
        if (scene_.vertices[v] != position) return true;
        return (are_bare ? VertexCoordinates{} : coordinates_of(scene_, v)) != coordinates;
    };
    const std::size_t mask = slots_.size() - 1;
    std::size_t i = hash(position, coordinates) & mask;
    while (slots_[i] != none && is_other(slots_[i])) i = (i + 1) & mask;
    return slots_[i];
}

void VertexWeld::grow() {
    const std::vector<std::uint32_t> old = std::move(slots_);
    slots_.assign(2 * old.size(), none);
    for (const std::uint32_t vertex : old)
        if (vertex != none) slot_of(scene_.vertices[vertex], coordinates_of(scene_, vertex)) = vertex;
}

std::uint32_t VertexWeld::vertex(const V3f& position, const VertexCoordinates& coordinates) {
    if (2 * (used_ + 1) > slots_.size()) grow();
    std::uint32_t& slot = slot_of(position, coordinates);
    if (slot == none) {
        slot = add_vertex(scene_, position, coordinates);
        ++used_;
    }
    return slot;
}

}  // namespace interflect::detail
