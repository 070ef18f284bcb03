#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "interflect/base/colour.h"

namespace interflect {

/// New vertices of a scene, found again by where they lie, so that neighbours share them.
class VertexPool {
  public:
    /// @param vertices  New ones go at the end; those that are there already are not found again.
    explicit VertexPool(std::vector<V3f>& vertices) : vertices_(vertices) {}

    std::uint32_t add(const V3f& v) {
        const auto [entry, is_new] = index_.try_emplace(v, static_cast<std::uint32_t>(vertices_.size()));
        if (is_new) vertices_.push_back(v);
        return entry->second;
    }

  private:
    struct Hash {
        std::size_t operator()(const V3f& v) const {
            const std::hash<float> h;
            return (h(v.x) * 31 + h(v.y)) * 31 + h(v.z);
        }
    };
    std::vector<V3f>& vertices_;
    std::unordered_map<V3f, std::uint32_t, Hash> index_;
};

}  // namespace interflect
