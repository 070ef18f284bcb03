// Textures with too many texels are halved.
#include "interflect/formats/build/texture_limit.h"

#include <gtest/gtest.h>

#include <numeric>

#include "interflect/base/numbers/random.h"

namespace interflect {

using namespace detail;
namespace {

Texture noise(std::uint32_t width, std::uint32_t height) {
    Texture texture{"noise", width, height, {}};
    for (std::uint64_t i = 0; i < std::uint64_t{width} * height; ++i)
        texture.texels.emplace_back(static_cast<float>(mix(i, width) % 1000) / 1000);
    return texture;
}

double mean(const Texture& texture) {
    double sum = 0;
    for (const Rgb& texel : texture.texels) sum += static_cast<double>(texel.x);
    return sum / static_cast<double>(texture.texels.size());
}

/// Seen to fail when a texel shared by two others counts for only one of them.
TEST(TextureLimit, KeepsTheMeanOfOddSizesToo) {
    for (const auto& [width, height] : {std::pair(8u, 6u), {7u, 5u}, {1u, 9u}, {2u, 1u}}) {
        std::vector<Texture> textures{noise(width, height)};
        const double before = mean(textures[0]);
        EXPECT_TRUE(reduce_textures(textures, width * height - 1));
        EXPECT_EQ(textures[0].width, (width + 1) / 2);
        EXPECT_EQ(textures[0].height, (height + 1) / 2);
        EXPECT_EQ(texture_fault(textures[0]), "");
        EXPECT_NEAR(mean(textures[0]), before, 1e-6) << width << " x " << height;
    }
}

TEST(TextureLimit, AveragesSquaresOfFour) {
    Texture texture{"four", 4, 2, {Rgb(1), Rgb(2), Rgb(0), Rgb(0), Rgb(3), Rgb(4), Rgb(0), Rgb(8)}};
    std::vector<Texture> textures{texture};
    reduce_textures(textures, 7);
    EXPECT_EQ(textures[0].texels, (std::vector<Rgb>{Rgb(2.5f), Rgb(2)}));
}

TEST(TextureLimit, HalvesTheLargestAndEqualOnesAlike) {
    std::vector<Texture> textures{noise(8, 8), noise(2, 3), noise(8, 8), noise(4, 4)};
    EXPECT_FALSE(reduce_textures(textures, 64 + 6 + 64 + 16));
    EXPECT_TRUE(reduce_textures(textures, 149));
    EXPECT_EQ(texel_count(textures), 16u + 6 + 16 + 16);
    EXPECT_TRUE(reduce_textures(textures, 20));
    EXPECT_EQ(texel_count(textures), 4u + 6 + 4 + 4);
    EXPECT_EQ(textures[0].width, textures[2].width);
}

}  // namespace
}  // namespace interflect
