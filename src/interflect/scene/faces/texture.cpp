#include "interflect/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace interflect {

namespace {

/// Neighbouring texels of a coordinate, and the weight of the second for linear interpolation.
struct TexelPair {
    std::uint32_t first, second;
    float weight;

    TexelPair(float coordinate, std::uint32_t count) {
        const double within = static_cast<double>(coordinate) - std::floor(static_cast<double>(coordinate));
        const double centre = within * count - 0.5, below = std::floor(centre);
        weight = static_cast<float>(centre - below);
        first = below < 0 ? count - 1 : std::min(static_cast<std::uint32_t>(below), count - 1);
        second = first + 1 == count ? 0 : first + 1;
    }
};

}  // namespace

Rgb texel_at(const Texture& texture, const V2f& coordinate) {
    const TexelPair x(coordinate.x, texture.width), y(1 - coordinate.y, texture.height);
    const auto in_row = [&](std::uint32_t row) {
        const Rgb* texels = &texture.texels[std::size_t{row} * texture.width];
        return Rgb(texels[x.first] * (1 - x.weight) + texels[x.second] * x.weight);
    };
    return in_row(y.first) * (1 - y.weight) + in_row(y.second) * y.weight;
}

Rgb largest_texel(const Texture& texture) {
    Rgb largest(0, 0, 0);
    for (const Rgb& texel : texture.texels)
        for (int c = 0; c < 3; ++c) largest[c] = std::max(largest[c], texel[c]);
    return largest;
}

std::string texture_fault(const Texture& texture) {
    if (texture.width < 1 || texture.height < 1 || std::max(texture.width, texture.height) > max_texels_of_side)
        return fmt::format("has {} x {} texels; expected 1 to {} a side", texture.width, texture.height,
                           max_texels_of_side);
    if (texture.texels.size() != std::size_t{texture.width} * texture.height)
        return fmt::format("of {} x {} texels holds {}", texture.width, texture.height, texture.texels.size());
    const auto is_wrong = [](const Rgb& t) { return !is_finite(t) || std::min({t.x, t.y, t.z}) < 0; };
    const auto wrong = std::find_if(texture.texels.begin(), texture.texels.end(), is_wrong);
    if (wrong == texture.texels.end()) return {};
    const auto index = static_cast<std::size_t>(wrong - texture.texels.begin());
    return fmt::format("has a texel, {} from the left and {} from the top, that is negative or not finite",
                       index % texture.width, index / texture.width);
}

std::string texture_coordinate_fault(const V2f& c) {
    // NaN fails this test.
    if (std::abs(c.x) <= farthest_texture_coordinate && std::abs(c.y) <= farthest_texture_coordinate) return {};
    return fmt::format("has the texture coordinates ({}, {}); expected numbers up to {}", c.x, c.y,
                       farthest_texture_coordinate);
}

}  // namespace interflect
