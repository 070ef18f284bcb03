#include "interflect/formats/build/texture_limit.h"

#include <algorithm>
#include <cstddef>

namespace interflect::detail {

namespace {

std::uint32_t half(std::uint32_t size) { return (size + 1) / 2; }

/// Reduces a row or column by a box filter. @param step  Distance between consecutive texels in both arrays.
void average(const Rgb* from, std::uint32_t count, Rgb* to, std::uint32_t target, std::size_t step) {
    const double width = static_cast<double>(count) / target;
    for (std::uint32_t i = 0; i < target; ++i) {
        const double begin = i * width, end = std::min<double>((i + 1) * width, count);
        RgbD sum(0);
        for (auto k = static_cast<std::uint32_t>(begin); k < end; ++k)
            sum += RgbD(from[k * step]) * (std::min<double>(k + 1, end) - std::max<double>(k, begin));
        to[i * step] = Rgb(sum / (end - begin));
    }
}

void halve(Texture& texture) {
    const std::uint32_t width = half(texture.width), height = half(texture.height);
    for (std::size_t y = 0; y < texture.height; ++y)
        average(&texture.texels[y * texture.width], texture.width, &texture.texels[y * width], width, 1);
    for (std::size_t x = 0; x < width; ++x)
        average(&texture.texels[x], texture.height, &texture.texels[x], height, width);
    texture.width = width;
    texture.height = height;
    texture.texels.resize(std::size_t{width} * height);
    texture.texels.shrink_to_fit();
}

}  // namespace

std::uint64_t texel_count(const std::vector<Texture>& textures) {
    std::uint64_t texels = 0;
    for (const Texture& texture : textures) texels += texture.texels.size();
    return texels;
}

bool reduce_textures(std::vector<Texture>& textures, std::uint64_t most) {
    bool is_reduced = false;
    for (; texel_count(textures) > most; is_reduced = true) {
        std::size_t largest = 1;
        for (const Texture& texture : textures) largest = std::max(largest, texture.texels.size());
        if (largest == 1) break;
        for (Texture& texture : textures)
            if (texture.texels.size() == largest) halve(texture);
    }
    return is_reduced;
}

}  // namespace interflect::detail
