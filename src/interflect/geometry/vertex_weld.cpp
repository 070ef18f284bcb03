#include "interflect/geometry/vertex_weld.h"

#include <bit>

#include "interflect/base/random.h"

namespace interflect {

namespace {

std::uint64_t hash(const V3f& position) {
    const auto bits = [](float f) { return std::uint64_t{std::bit_cast<std::uint32_t>(f)}; };
    const V3f x = position + V3f(0);  // -0 + 0 = 0
    return mix(bits(x.x) | bits(x.y) << 32, bits(x.z));
}

}  // namespace

/// The slot that holds the vertex at `position`, or the empty one where it belongs.
std::uint32_t& VertexWeld::slot_of(const V3f& position) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t i = hash(position) & mask;
    while (slots_[i] != none && vertices_[slots_[i]] != position) i = (i + 1) & mask;
    return slots_[i];
}

void VertexWeld::grow() {
    const std::vector<std::uint32_t> old = std::move(slots_);
    slots_.assign(2 * old.size(), none);
    for (const std::uint32_t vertex : old)
        if (vertex != none) slot_of(vertices_[vertex]) = vertex;
}

std::uint32_t VertexWeld::vertex(const V3f& position) {
    if (2 * (used_ + 1) > slots_.size()) grow();
    std::uint32_t& slot = slot_of(position);
    if (slot == none) {
        slot = static_cast<std::uint32_t>(vertices_.size());
        vertices_.push_back(position);
        ++used_;
    }
    return slot;
}

}  // namespace interflect
