// Means of textures over triangles, against sums over many points, and against each other.
//
// Seen to fail when the trapezoidal rule is the rectangle rule, whole repeats are not counted, or triangles without an
// area are not widened.
#include "interflect/geometry/textures/texture_integral.h"

#include <gtest/gtest.h>

#include "interflect/base/numbers/random.h"
#include "tests/support/parameter_names.h"

namespace interflect {

using namespace detail;
namespace {

using Corners = std::array<V2f, 3>;

float number(std::uint64_t seed) { return static_cast<float>(mix(seed, 7) % 10'000) / 10'000; }

Texture random_texture(std::uint32_t width, std::uint32_t height) {
    Texture texture{"random", width, height, {}};
    for (std::uint64_t i = 0; i < std::uint64_t{width} * height; ++i)
        texture.texels.emplace_back(number(3 * i), number(3 * i + 1), number(3 * i + 2));
    return texture;
}

Corners random_triangle(std::uint64_t seed, float size) {
    const V2f start(6 * number(seed) - 3, 6 * number(seed + 1) - 3);
    const auto offset = [&](std::uint64_t i) {
        return V2f(number(seed + i) - 0.5f, number(seed + i + 1) - 0.5f) * size;
    };
    return {start, start + offset(2), start + offset(4)};
}

Rgb mean_of_points(const Texture& texture, const Corners& x, int n) {
    RgbD sum(0, 0, 0);
    const auto add = [&](float i, float j) {
        const float s = i / static_cast<float>(n), t = j / static_cast<float>(n);
        sum += RgbD(texel_at(texture, x[0] + (x[1] - x[0]) * s + (x[2] - x[0]) * t));
    };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i + j < n; ++i) {
            const auto u = static_cast<float>(i), v = static_cast<float>(j);
            add(u + 1 / 3.0f, v + 1 / 3.0f);
            if (i + j + 1 < n) add(u + 2 / 3.0f, v + 2 / 3.0f);
        }
    return Rgb(sum / (static_cast<double>(n) * n));
}

void expect_near(const Rgb& actual, const Rgb& expected, float tolerance) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(actual[c], expected[c], tolerance);
}

class TextureIntegralOfSize : public testing::TestWithParam<float> {};  // size of triangles, in repeats
INSTANTIATE_TEST_SUITE_P(FromTexelsToRepeats, TextureIntegralOfSize, testing::Values(0.01f, 0.1f, 1.0f, 6.0f),
                         testing_support::printed_name);

TEST_P(TextureIntegralOfSize, AgreesWithManyPoints) {
    const Texture texture = random_texture(19, 5);
    const TextureIntegral integral(texture);
    constexpr int points = 400;  // along a side
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const Corners x = random_triangle(10 * seed, GetParam());
        expect_near(integral.mean(x), mean_of_points(texture, x, points), 2e-4f);
    }
}

TEST_P(TextureIntegralOfSize, IsTheMeanOfFourEqualParts) {
    const Texture texture = random_texture(19, 5);
    const TextureIntegral integral(texture);
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        const Corners x = random_triangle(10 * seed, GetParam());
        const V2f a = (x[1] + x[2]) * 0.5f, b = (x[2] + x[0]) * 0.5f, c = (x[0] + x[1]) * 0.5f;
        Rgb sum(0, 0, 0);
        for (const Corners& part : {Corners{x[0], c, b}, {c, x[1], a}, {b, a, x[2]}, {a, b, c}})
            sum += integral.mean(part);
        expect_near(sum / 4, integral.mean(x), 5e-5f);  // coordinates are rounded
    }
}

TEST(TextureIntegral, OfTheWholeImageIsTheMeanOfItsTexels) {
    const Texture texture = random_texture(37, 50);
    RgbD mean(0, 0, 0);
    for (const Rgb& texel : texture.texels) mean += RgbD(texel) / static_cast<double>(texture.texels.size());
    const TextureIntegral integral(texture);
    const Rgb lower = integral.mean({V2f(0, 0), V2f(1, 0), V2f(1, 1)}),
              upper = integral.mean({V2f(0, 0), V2f(1, 1), V2f(0, 1)});
    expect_near((lower + upper) / 2, Rgb(mean), 1e-6f);
}

TEST(TextureIntegral, OfATriangleWithoutAreaIsThatOfALine) {
    const Texture texture = random_texture(19, 5);
    const TextureIntegral integral(texture);
    const V2f start(0.2f, 0.4f), end(2.3f, 1.5f), between = start + (end - start) * 0.3f;
    const Rgb expected = mean_of_points(texture, {start, end, between}, 2'000);
    expect_near(integral.mean({start, end, between}), expected, 1e-3f);
    expect_near(integral.mean({end, start, between}), expected, 1e-3f);
    const V2f along_row(2.3f, 0.4f), halfway((start.x + along_row.x) / 2, start.y);  // no area even after rounding
    expect_near(integral.mean({start, along_row, halfway}), mean_of_points(texture, {start, along_row, halfway}, 2'000),
                1e-3f);
    expect_near(integral.mean({start, start, start}), texel_at(texture, start), 1e-6f);
}

TEST(TextureIntegral, OfVeryManyRepeatsIsTheMeanOfItsTexels) {
    const Texture texture = random_texture(1'000, 1'000);
    const TextureIntegral integral(texture);
    const Rgb all = integral.mean({V2f(-4000, -4000), V2f(4000, -4000), V2f(0, 4000)});
    expect_near(all, Rgb(0.5f), 2e-3f);
}

}  // namespace
}  // namespace interflect
