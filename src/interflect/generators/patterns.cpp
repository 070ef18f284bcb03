#include "interflect/generators/patterns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "interflect/image/codecs/srgb.h"

namespace interflect::detail {

namespace {

/// @param shade  sRGB bytes at column x and row y from the top.
template <class Shade>
Texture draw(const char* name, std::uint32_t side, const Shade& shade) {
    Texture texture{name, side, side, {}};
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            Rgb& texel = texture.texels.emplace_back();
            const std::array<int, 3> bytes = shade(x, y);
            for (int c = 0; c < 3; ++c)
                texel[c] = srgb_decode(static_cast<float>(bytes[static_cast<std::size_t>(c)]) / 255);
        }
    return texture;
}

}  // namespace

Texture make_tiles() {
    constexpr std::uint32_t side = 64, tile = side / 2, joint = 2;
    return draw("tiles", side, [](std::uint32_t x, std::uint32_t y) -> std::array<int, 3> {
        if (x % tile < joint || y % tile < joint) return {90, 85, 80};
        if ((x / tile + y / tile) % 2 == 0) return {250, 245, 235};
        return {150, 165, 180};
    });
}

Texture make_label() {
    constexpr std::array<std::string_view, 8> rows = {"########", "#......#", "#.###..#", "#.#....#",
                                                      "#.##...#", "#.#....#", "#......#", "########"};
    constexpr std::uint32_t texels_per_sign = 8;
    return draw("label", static_cast<std::uint32_t>(rows.size()) * texels_per_sign,
                [&](std::uint32_t x, std::uint32_t y) -> std::array<int, 3> {
                    if (rows[y / texels_per_sign][x / texels_per_sign] == '#') return {120, 60, 40};
                    return {255, 255, 255};
                });
}

Texture make_louvres() {
    constexpr std::uint32_t side = 96, pitch = side / 6, bar = 2;
    return draw("louvres", side, [](std::uint32_t x, std::uint32_t y) -> std::array<int, 3> {
        if (x % pitch < bar || y % pitch < bar) return {40, 40, 40};
        const auto hump = [](std::uint32_t i) {
            return std::sin(std::numbers::pi_v<float> * (static_cast<float>(i % pitch) + 0.5f) / pitch);
        };
        constexpr float dimmest = 150, rise = 105;
        const int shade = static_cast<int>(dimmest + rise * hump(x) * hump(y));
        return {shade, shade, shade};
    });
}

std::uint32_t add_texture(Scene& scene, Texture texture) {
    scene.textures.push_back(std::move(texture));
    return static_cast<std::uint32_t>(scene.textures.size() - 1);
}

void lay_image(Scene& scene, PatchIndex patch, float repeat) {
    constexpr std::size_t corners_of_patch = 4;
    scene.texture_coordinates.resize(scene.vertices.size(), V2f(0));
    auto& v = scene.patches[patch].vertices;
    const auto height = [&](std::size_t k) {
        return scene.vertices[v[k]].z + scene.vertices[v[(k + 1) % corners_of_patch]].z;
    };
    std::size_t lowest = 0;
    for (std::size_t k = 1; k < corners_of_patch; ++k)
        if (height(k) < height(lowest)) lowest = k;
    std::rotate(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(lowest), v.end());
    const auto length = [&](std::size_t i, std::size_t j) {
        return (scene.vertices[v[j]] - scene.vertices[v[i]]).length();
    };
    const V2f size = repeat > 0 ? V2f(length(0, 1), length(0, 3)) / repeat : V2f(1);
    const std::array<V2f, corners_of_patch> corners = {V2f(0, 0), V2f(size.x, 0), size, V2f(0, size.y)};
    for (std::size_t k = 0; k < corners_of_patch; ++k) {
        scene.vertices.push_back(V3f(scene.vertices[v[k]]));
        scene.texture_coordinates.push_back(corners[k]);
        v[k] = static_cast<std::uint32_t>(scene.vertices.size() - 1);
    }
}

}  // namespace interflect::detail
