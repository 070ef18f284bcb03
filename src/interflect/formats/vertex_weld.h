#pragma once

#include <cstdint>
#include <cstring>
#include <unordered_map>

#include "interflect/base/random.h"
#include "interflect/scene/scene.h"

namespace interflect {

/// Gives one vertex of a scene to each distinct position: what meets in a point shares a vertex there, whatever names
/// or copies the file used. Positions are compared bit for bit; -0 counts as 0.
class VertexWeld {
  public:
    explicit VertexWeld(Scene& scene) : scene_(scene) {}

    std::uint32_t vertex(const V3f& position) {
        const V3f key = position + V3f(0);  // -0 + 0 = 0
        const auto [entry, is_new] = index_.try_emplace(key, static_cast<std::uint32_t>(scene_.vertices.size()));
        if (is_new) scene_.vertices.push_back(key);
        return entry->second;
    }

  private:
    struct Hash {
        std::size_t operator()(const V3f& p) const {
            std::uint32_t bits[3];
            std::memcpy(bits, &p, sizeof bits);
            return mix(bits[0] | std::uint64_t{bits[1]} << 32, bits[2]);
        }
    };
    Scene& scene_;
    std::unordered_map<V3f, std::uint32_t, Hash> index_;
};

}  // namespace interflect
