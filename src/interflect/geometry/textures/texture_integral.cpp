#include "interflect/geometry/textures/texture_integral.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace interflect::detail {

namespace {

constexpr std::int64_t texels_per_sum = 8;

/// Limit of the texel lines that a border crosses; this number takes 0.1 s.
constexpr double max_crossings = 1 << 20;

/// Minimum height of a triangle [texels], which avoids a division by zero.
constexpr double min_height = 1e-3;

std::int64_t floor_of(double x) { return static_cast<std::int64_t>(std::floor(x)); }

std::int64_t wrapped(std::int64_t i, std::int64_t n) {
    const std::int64_t remainder = i % n;
    return remainder < 0 ? remainder + n : remainder;
}

double doubled_area(const std::array<Imath::V2d, 3>& x) { return (x[1] - x[0]).cross(x[2] - x[0]); }

void widen(std::array<Imath::V2d, 3>& x) {
    std::size_t longest = 0;
    const auto edge = [&](std::size_t i) { return x[(i + 1) % 3] - x[i]; };
    for (std::size_t i = 1; i < 3; ++i)
        if (edge(i).length2() > edge(longest).length2()) longest = i;
    const Imath::V2d along = edge(longest).normalized();
    const double height = doubled_area(x) / edge(longest).length();
    if (std::abs(height) < min_height) x[(longest + 2) % 3] += Imath::V2d(-along.y, along.x) * (min_height - height);
}

}  // namespace

TextureIntegral::TextureIntegral(const Texture& texture)
    : texture_(texture),
      sums_per_row_((texture.width + texels_per_sum - 1) / texels_per_sum + 1),
      largest_(largest_texel(texture)) {
    sums_.reserve(sums_per_row_ * texture.height);
    for (std::uint32_t row = 0; row < texture.height; ++row) {
        RgbD sum(0, 0, 0);
        for (std::uint32_t column = 0; column < texture.width; ++column) {
            if (column % texels_per_sum == 0) sums_.push_back(sum);
            sum += RgbD(texels_of(row)[column]);
        }
        sums_.push_back(sum);
        mean_ += sum / (static_cast<double>(texture.width) * texture.height);
    }
}

// In the functions below, x counts columns and y rows downwards, with texel centres at integers.

inline std::size_t TextureIntegral::wrapped_row(std::int64_t row) const {
    return static_cast<std::size_t>(wrapped(row, texture_.height));
}

/// Integrates along a row from the centre of texel 0 to the centre of `column`.
RgbD TextureIntegral::row_integral(std::int64_t column, std::size_t row) const {
    const std::int64_t width = texture_.width, within = wrapped(column, width);
    const RgbD* sums = &sums_[row * sums_per_row_];
    const Rgb* texels = texels_of(row);
    const std::int64_t repeats = (column - within) / width;
    RgbD sum = sums[within / texels_per_sum] + sums[sums_per_row_ - 1] * static_cast<double>(repeats);
    for (std::int64_t i = within / texels_per_sum * texels_per_sum; i < within; ++i) sum += RgbD(texels[i]);
    return sum + (RgbD(texels[within]) - RgbD(texels[0])) * 0.5;  // trapezoidal rule
}

RgbD TextureIntegral::value_at(const V2d& x) const {
    const std::int64_t column = floor_of(x.x), row = floor_of(x.y);
    const double s = x.x - static_cast<double>(column), t = x.y - static_cast<double>(row);
    const std::int64_t left = wrapped(column, texture_.width), right = wrapped(column + 1, texture_.width);
    const auto in_row = [&](std::int64_t y) {
        const Rgb* texels = texels_of(wrapped_row(y));
        return RgbD(RgbD(texels[left]) * (1 - s) + RgbD(texels[right]) * s);
    };
    return in_row(row) * (1 - t) + in_row(row + 1) * t;
}

/// Integrates F dy within a cell between four texel centres.
/// @param origin  Column where F is 0.
RgbD TextureIntegral::integral_within_cell(const V2d& a, const V2d& b, std::int64_t origin) const {
    const V2d middle = (a + b) * 0.5;
    const std::int64_t column = floor_of(middle.x), row = floor_of(middle.y);
    std::array<RgbD, 2> before, first, rise;
    const std::int64_t left = wrapped(column, texture_.width), right = wrapped(column + 1, texture_.width);
    for (std::size_t k = 0; k < 2; ++k) {
        const std::size_t y = wrapped_row(row + static_cast<std::int64_t>(k));
        before[k] = row_integral(column, y) - row_integral(origin, y);
        first[k] = RgbD(texels_of(y)[left]);
        rise[k] = RgbD(texels_of(y)[right]) - first[k];
    }
    const auto antiderivative = [&](const V2d& x) {
        const double s = x.x - static_cast<double>(column), t = x.y - static_cast<double>(row);
        const auto in_row = [&](std::size_t i) { return RgbD(before[i] + first[i] * s + rise[i] * (0.5 * s * s)); };
        return RgbD(in_row(0) * (1 - t) + in_row(1) * t);
    };
    return (antiderivative(a) + antiderivative(middle) * 4 + antiderivative(b)) * ((b.y - a.y) / 6);
}

/// Integrates F dy from a to b, cell by cell.
RgbD TextureIntegral::integral_along(const V2d& a, const V2d& b, std::int64_t origin) const {
    RgbD sum(0, 0, 0);
    const V2d d = b - a;
    if (d.y == 0) return sum;
    std::array<double, 2> line{}, at{};  // per axis: the next texel line, and its parameter on ab from 0 to 1
    const auto position = [&](int axis) { return d[axis] == 0 ? 2 : (line[axis] - a[axis]) / d[axis]; };
    for (int axis = 0; axis < 2; ++axis) {
        line[axis] = d[axis] > 0 ? std::floor(a[axis]) + 1 : std::ceil(a[axis]) - 1;
        at[axis] = position(axis);
    }
    V2d from = a;
    while (true) {
        const int axis = at[0] < at[1] ? 0 : 1;
        if (!(at[axis] < 1)) break;
        const V2d to = a + d * at[axis];
        sum += integral_within_cell(from, to, origin);
        from = to;
        line[axis] += d[axis] > 0 ? 1 : -1;
        at[axis] = position(axis);
    }
    return sum + integral_within_cell(from, b, origin);
}

/// Returns the mean over a triangle that extends over several cells.
RgbD TextureIntegral::mean_of_wide(std::array<V2d, 3> x) const {
    double crossings = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const V2d edge = x[(i + 1) % 3] - x[i];
        crossings += std::abs(edge.x) + std::abs(edge.y);
    }
    if (crossings > max_crossings) return mean_;
    widen(x);
    const std::int64_t origin = floor_of(x[0].x);
    RgbD sum(0, 0, 0);
    for (std::size_t i = 0; i < 3; ++i) sum += integral_along(x[i], x[(i + 1) % 3], origin);
    return sum / (0.5 * doubled_area(x));
}

Rgb TextureIntegral::mean(const std::array<V2f, 3>& corners) const {
    std::array<V2d, 3> x;
    for (std::size_t i = 0; i < 3; ++i)
        x[i] = {static_cast<double>(corners[i].x) * texture_.width - 0.5,
                (1 - static_cast<double>(corners[i].y)) * texture_.height - 0.5};
    bool in_one_cell = true;
    for (int axis = 0; axis < 2; ++axis)
        for (std::size_t i = 1; i < 3; ++i) in_one_cell &= floor_of(x[i][axis]) == floor_of(x[0][axis]);
    // The mean of the three midpoints is exact within a cell, where the texture is quadratic.
    const RgbD mean =
        in_one_cell
            ? RgbD((value_at((x[0] + x[1]) / 2) + value_at((x[1] + x[2]) / 2) + value_at((x[2] + x[0]) / 2)) / 3)
            : mean_of_wide(x);
    Rgb clamped;  // because rounding may leave the range of the texels
    for (int c = 0; c < 3; ++c) clamped[c] = std::clamp(static_cast<float>(mean[c]), 0.0f, largest_[c]);
    return clamped;
}

}  // namespace interflect::detail
