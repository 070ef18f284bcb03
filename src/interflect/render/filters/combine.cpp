#include "interflect/render/filters/combine.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "interflect/base/threads/parallel.h"

namespace interflect::detail {

namespace {

/// Half the width of a region [pixels]. The share of returned light has a variance of about 2 / pixels of the region:
/// with 4,225 it adds 0.05% of the noise's variance at each scale.
constexpr int region_radius = 32;
/// Half the width of the surroundings whose light normalises errors [pixels].
constexpr int level_radius = 4;
/// Share of the picture's mean light that is added to the light of the surroundings.
constexpr double least_level = 0.1;
/// Number of scales. The largest is a mean with a standard deviation of 26 pixels on both axes: over 8,500 pixels,
/// with 1.1% of the noise of a pixel.
constexpr int scales = 6;

/// Means of light over a pixel's neighbours on the same surface, `spacing` pixels apart: a step of an edge-avoiding
/// wavelet transform (Dammertz et al. 2010). Pairs of pixels exchange light, so the sum over a surface is exact. Its
/// weights depend on surfaces alone, hence the means of independent light are independent.
class SurfaceSmoothing {
  public:
    SurfaceSmoothing(const Surfaces& surfaces, int spacing) : surfaces_(surfaces), spacing_(spacing) {
        const std::size_t pixels = pixel_at(0, surfaces.height, surfaces.width);
        std::vector<float> support(pixels);
        for (std::vector<float>& weights : weights_) weights.resize(pixels);
        for_pixels(surfaces, [&](std::size_t i, int x, int y) {
            support[i] = centre;
            std::size_t n = 0;
            visit_neighbours(x, y, [&](std::size_t k, float share, float steps) {
                support[i] += weights_[n++][i] = share * surfaces_.weight(i, k, steps);
            });
        });
        for_pixels(surfaces, [&](std::size_t i, int x, int y) {
            std::size_t n = 0;
            visit_neighbours(x, y, [&](std::size_t k, float, float) {
                weights_[n++][i] /= std::max({support[i], support[k], least_support});
            });
        });
        kept_.resize(pixels);
        for (std::size_t i = 0; i < pixels; ++i) kept_[i] = std::min(1.0f, support[i] / least_support);
    }

    Image operator()(const Image& light) const {
        Image means(light.width, light.height);
        for_pixels(surfaces_, [&](std::size_t i, int x, int y) {
            Rgb mean = light.pixels[i];
            std::size_t n = 0;
            visit_neighbours(x, y, [&](std::size_t k, float, float) {
                mean += weights_[n++][i] * (light.pixels[k] - light.pixels[i]);
            });
            means.pixels[i] = kept_[i] * mean;
        });
        return means;
    }

  private:
    /// Product of linear B-splines.
    static constexpr float centre = 0.25f, beside = 0.125f, diagonal = 0.0625f;
    /// Sum of weights below which a mean is reduced. The light of pixels with few neighbours on their surface, such as
    /// a wire, thus vanishes in larger scales.
    static constexpr float least_support = 0.5f;

    void visit_neighbours(int x, int y, const auto& visit) const {
        for (int v = -1; v <= 1; ++v)
            for (int u = -1; u <= 1; ++u) {
                const int across = x + u * spacing_, down = y + v * spacing_;
                if ((u == 0 && v == 0) || across < 0 || down < 0 || across >= surfaces_.width ||
                    down >= surfaces_.height)
                    continue;
                visit(pixel_at(across, down, surfaces_.width), u == 0 || v == 0 ? beside : diagonal,
                      distance_of(u * spacing_, v * spacing_));
            }
    }

    const Surfaces& surfaces_;
    int spacing_;
    std::array<std::vector<float>, 8> weights_;  // [n][pixel]: weight of its n-th neighbour within the picture
    std::vector<float> kept_;                    // factor that reduces the mean of each pixel
};

/// Sums values over the square region around each pixel.
class RegionSums {
  public:
    RegionSums(int width, int height, int radius)
        : width_(width), height_(height), radius_(static_cast<std::size_t>(radius)) {}

    std::vector<double> operator()(const std::vector<double>& values) const {
        std::vector<double> rows(values.size()), sums(values.size());
        add_lines(values, rows, static_cast<std::size_t>(height_), static_cast<std::size_t>(width_),
                  static_cast<std::size_t>(width_), 1);
        add_lines(rows, sums, static_cast<std::size_t>(width_), 1, static_cast<std::size_t>(height_),
                  static_cast<std::size_t>(width_));
        return sums;
    }

  private:
    void add_lines(const std::vector<double>& values, std::vector<double>& sums, std::size_t lines,
                   std::size_t line_step, std::size_t length, std::size_t step) const {
        parallel_for_ranges(lines, 16, [&](std::size_t begin, std::size_t end) {
            std::vector<double> before(length + 1);  // sums of the first values of a line
            for (std::size_t line = begin; line < end; ++line) {
                for (std::size_t i = 0; i < length; ++i)
                    before[i + 1] = before[i] + values[line * line_step + i * step];
                for (std::size_t i = 0; i < length; ++i)
                    sums[line * line_step + i * step] =
                        before[std::min(length, i + radius_ + 1)] - before[i - std::min(i, radius_)];
            }
        });
    }

    int width_, height_;
    std::size_t radius_;
};

template <class Combine>
Image combined(const Image& a, const Image& b, const Combine& combine) {
    Image result(a.width, a.height);
    parallel_for_indices(a.pixels.size(), [&](std::size_t i) { result.pixels[i] = combine(a.pixels[i], b.pixels[i]); });
    return result;
}
Image difference(const Image& a, const Image& b) { return combined(a, b, std::minus<Rgb>()); }
Image sum(const Image& a, const Image& b) { return combined(a, b, std::plus<Rgb>()); }

double dot(const Rgb& a, const Rgb& b) { return channel_sum(RgbD(a) * RgbD(b)); }

/// Radiance of the surroundings of each pixel, positive. Errors are relative to it.
std::vector<double> levels(const Image& irradiance, const Image& albedo) {
    const RegionSums around(irradiance.width, irradiance.height, level_radius);
    constexpr double tiny = 1e-30;  // keeps the level of a black picture positive
    std::vector<double> level(irradiance.pixels.size());
    double total = 0;
    for (std::size_t i = 0; i < level.size(); ++i)
        total += level[i] = std::max(0.0, dot(irradiance.pixels[i], albedo.pixels[i]) / 3);
    level = around(level);
    const std::vector<double> counts = around(std::vector<double>(level.size(), 1.0));
    for (std::size_t i = 0; i < level.size(); ++i)
        level[i] = level[i] / counts[i] + least_level * total / static_cast<double>(level.size()) + tiny;
    return level;
}

/// P, M and D of combine(), at one scale.
struct Moved {
    Image removed, removed_difference, noise;
};

/// Estimates the share of the filtered light in the best combination for each pixel, 1 - s.
std::vector<double> kept_shares(const Moved& moved, const Image& albedo, const std::vector<double>& level,
                                const RegionSums& region) {
    const std::size_t pixels = level.size();
    std::vector<double> squares(pixels), products(pixels);
    parallel_for_indices(pixels, [&](std::size_t i) {
        const auto relative = [&](const Image& light) {
            return light.pixels[i] * albedo.pixels[i] / static_cast<float>(level[i]);
        };
        const Rgb removed = relative(moved.removed);
        squares[i] = dot(removed, removed);
        products[i] = dot(relative(moved.removed_difference), relative(moved.noise));
    });
    squares = region(squares);
    products = region(products);
    for (std::size_t i = 0; i < pixels; ++i)
        products[i] = squares[i] > 0 ? std::clamp(products[i] / squares[i], 0.0, 1.0) : 1;
    return products;
}

/// Estimates the squared error of the combination: the mean over a region, in proportion to the squared radiance of
/// each pixel and a share of its surroundings.
/// @param left  P, M and D of the combination.
Image squared_error(const Moved& left, const Image& combined, const Image& albedo, const RegionSums& region) {
    constexpr double share_of_surroundings = 0.1;
    const std::size_t pixels = combined.pixels.size();
    const std::vector<double> level = levels(combined, albedo);
    Image result(combined.width, combined.height);
    for (int c = 0; c < 3; ++c) {
        std::vector<double> errors(pixels), spreads(pixels), squares(pixels);
        parallel_for_indices(pixels, [&](std::size_t i) {
            const auto relative = [&](const Image& light) {
                return static_cast<double>(light.pixels[i][c] * albedo.pixels[i][c]) / level[i];
            };
            const double p = relative(left.removed), m = relative(left.removed_difference), d = relative(left.noise);
            errors[i] = (p * p + d * d - 2 * d * m) / 4;
            spreads[i] = (d - m) * (d - m) / 4;  // difference of the halves of the result: its noise
            squares[i] = std::pow(relative(combined), 2) + std::pow(share_of_surroundings, 2);
        });
        errors = region(errors);
        spreads = region(spreads);
        const std::vector<double> squares_of_region = region(squares);
        parallel_for_indices(pixels, [&](std::size_t i) {
            result.pixels[i][c] = static_cast<float>(level[i] * level[i] * squares[i] *
                                                     std::max(errors[i], spreads[i]) / squares_of_region[i]);
        });
    }
    return result;
}

}  // namespace

CombinedLight combine(const Surfaces& surfaces, const Image& albedo, const std::array<Image, 2>& noisy,
                      const std::array<Image, 2>& filtered) {
    const std::size_t pixels = albedo.pixels.size();
    const RegionSums region(surfaces.width, surfaces.height, region_radius);
    const std::array<Image, 2> removed{difference(noisy[0], filtered[0]), difference(noisy[1], filtered[1])};
    const Moved all{sum(removed[0], removed[1]), difference(removed[0], removed[1]), difference(noisy[0], noisy[1])};
    const Image filtered_sum = sum(filtered[0], filtered[1]);
    const std::vector<double> level = levels(filtered_sum, albedo);

    // Return a share of the light that was removed at each scale, and all of its means over larger scales.
    Moved rest = all, left = all;
    for (int scale = 0; scale < scales; ++scale) {
        const SurfaceSmoothing smooth(surfaces, 1 << scale);
        Moved means{smooth(rest.removed), smooth(rest.removed_difference), smooth(rest.noise)};
        const Moved details{difference(rest.removed, means.removed),
                            difference(rest.removed_difference, means.removed_difference),
                            difference(rest.noise, means.noise)};
        const std::vector<double> kept = kept_shares(details, albedo, level, region);
        parallel_for_indices(pixels, [&](std::size_t i) {
            const auto returned = static_cast<float>(1 - kept[i]);
            left.removed.pixels[i] -= returned * details.removed.pixels[i];
            left.removed_difference.pixels[i] -= returned * details.removed_difference.pixels[i];
        });
        rest = std::move(means);
    }
    left.removed = difference(left.removed, rest.removed);
    left.removed_difference = difference(left.removed_difference, rest.removed_difference);

    CombinedLight result;
    result.light = sum(filtered_sum, difference(all.removed, left.removed));
    for (Rgb& pixel : result.light.pixels) pixel /= 2;
    result.squared_error = squared_error(left, result.light, albedo, region);
    return result;
}

}  // namespace interflect::detail
