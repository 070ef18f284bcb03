#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <unordered_map>
#include <utility>
#include <vector>

#include "interflect/base/numbers/random.h"

namespace interflect::detail {

/// Triangles whose equal vertices are stored once. @tparam Vertex  Must have 32-bit members only.
template <class Vertex>
class WeldedVertices {
  public:
    void add(const Vertex& vertex) {
        const auto number = static_cast<std::uint32_t>(vertices_.size());
        Words words;
        std::memcpy(words.data(), static_cast<const void*>(&vertex), sizeof(Vertex));
        const auto [entry, is_new] = numbers_.try_emplace(words, number);
        if (is_new) vertices_.push_back(vertex);
        indices_.push_back(entry->second);
    }

    /// Returns value(vertex) of each stored vertex.
    template <class Value>
    auto values(const Value& value) const {
        std::vector<decltype(value(std::declval<const Vertex&>()))> result;
        result.reserve(vertices_.size());
        for (const Vertex& vertex : vertices_) result.push_back(value(vertex));
        return result;
    }
    const std::vector<std::uint32_t>& indices() const { return indices_; }

  private:
    using Words = std::array<std::uint32_t, sizeof(Vertex) / sizeof(std::uint32_t)>;
    struct Hash {
        std::size_t operator()(const Words& words) const {
            std::uint64_t hash = 0;
            for (const std::uint32_t word : words) hash = mix(hash ^ word, 0);
            return hash;
        }
    };

    std::unordered_map<Words, std::uint32_t, Hash> numbers_;
    std::vector<Vertex> vertices_;
    std::vector<std::uint32_t> indices_;
};

}  // namespace interflect::detail
