#include "interflect/render/filters/own_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "interflect/base/threads/parallel.h"
#include "interflect/render/filters/surfaces.h"

namespace interflect::detail {

namespace {

constexpr int window_radius = 8, block_radius = 1, variance_radius = 2, mean_radius = 4;  // [pixels]
/// The factor k^2 of the noise variance in the distance of blocks of pixels (Rousselle et al. 2012).
constexpr float noise_share = 0.45f * 0.45f;

/// Irradiance over pi, by pixel, and its variance.
struct Field {
    std::array<std::vector<float>, 3> value;
    std::vector<float> grey, variance;  // mean of the channels, and its variance
};

Field make_field(const Image& light, const std::vector<float>& variance, const Image& albedo) {
    Field field;
    for (std::vector<float>* numbers :
         {&field.value[0], &field.value[1], &field.value[2], &field.grey, &field.variance})
        numbers->resize(light.pixels.size());
    for (std::size_t i = 0; i < light.pixels.size(); ++i) {
        const Rgb reflectance = floored(albedo.pixels[i]), irradiance = light.pixels[i] / reflectance;
        for (int c = 0; c < 3; ++c) field.value[static_cast<std::size_t>(c)][i] = irradiance[c];
        field.grey[i] = channel_sum(irradiance) / 3;
        const float mean = channel_sum(reflectance) / 3;
        field.variance[i] = variance[i] / (mean * mean);
    }
    return field;
}

/// Direct light, then indirect light.
using Fields = std::array<Field, 2>;
/// Returns the number of Fields to filter: indirect light between records has no noise.
std::size_t noisy_kinds(const PictureLayers& layers) { return layers.is_indirect_interpolated ? 1 : 2; }

/// Averages each pixel over its neighbours on the same surface. The large variance at edges of objects must not spread.
std::vector<float> surface_mean(const Surfaces& surfaces, const std::vector<float>& values) {
    std::vector<float> means(values.size());
    for_pixels(surfaces, [&](std::size_t i, int x, int y) {
        float sum = 0, weight = 0;
        visit_surface(surfaces, x, y, variance_radius, [&](std::size_t k, float w) {
            sum += w * values[k];
            weight += w;
        });
        means[i] = weight > 0 ? sum / weight : 0;
    });
    return means;
}

Fields make_fields(const PictureLayers& layers, const Surfaces& surfaces, const SampledLight& light) {
    Fields fields{make_field(light.direct, light.direct_variance, layers.albedo),
                  make_field(light.indirect, light.indirect_variance, layers.albedo)};
    for (std::size_t kind = 0; kind < noisy_kinds(layers); ++kind)
        fields[kind].variance = surface_mean(surfaces, fields[kind].variance);
    return fields;
}

/// Sum S_i of the weights of each pixel's pairs, indexed by [half of the samples][direct or indirect].
using WeightSums = std::array<std::array<std::vector<float>, 2>, 2>;

/// Filters a band of rows. The pixels i and k of a pair exchange w_ik / max(S_i, S_k) times the difference of their
/// values, where w is symmetric and S_i is the sum of w_ik over k. Each exchange preserves the sum of both pixels, so
/// the sum over all pixels is preserved for any weights.
class Band {
  public:
    Band(const PictureLayers& layers, const Surfaces& surfaces, const std::array<Fields, 2>& halves, int first_row,
         int end_row)
        : layers_(layers),
          surfaces_(surfaces),
          halves_(halves),
          width_(surfaces.width),
          height_(surfaces.height),
          first_(first_row),
          end_(end_row),
          difference_(pixel_at(0, end_row - first_row + 2 * block_radius, width_ + 2)),
          shape_(at(0, end_row - first_row)) {}

    /// Adds the weights of this band's pixels to `sums`.
    void sum_weights(WeightSums& sums) {
        visit_pairs([&](std::size_t h, std::size_t kind, int x, int y, std::size_t k, std::span<const float> weight) {
            static_cast<void>(k);
            float* sum = &sums[h][kind][at(x, y)];
            for (std::size_t n = 0; n < weight.size(); ++n) sum[n] += weight[n];
        });
    }

    /// Adds the exchanged light to `irradiance`, which contains the noisy light [irradiance over pi].
    void filter(const WeightSums& sums, Image& irradiance) {
        visit_pairs([&](std::size_t h, std::size_t kind, int x, int y, std::size_t k, std::span<const float> weight) {
            const std::size_t i = at(x, y);
            const Field& field = halves_[h][kind];
            std::array<float, per_chunk> share;
            for (std::size_t n = 0; n < weight.size(); ++n)
                share[n] = 0.5f * weight[n] / std::max(sums[h][kind][i + n], sums[h][kind][k + n]);
            for (std::size_t n = 0; n < weight.size(); ++n)
                if (weight[n] > 0)
                    for (int c = 0; c < 3; ++c) {
                        const auto& value = field.value[static_cast<std::size_t>(c)];
                        irradiance.pixels[i + n][c] += share[n] * (value[k + n] - value[i + n]);
                    }
        });
    }

  private:
    static constexpr int per_chunk = 64;

    /// Calls visit(half, kind, x, y, k, weights) for a row of pairs: weights[n] belongs to pixel (x + n, y) and pixel k
    /// + n. The weights of each half come from the light of the other half, so they are independent of the filtered
    /// light.
    void visit_pairs(const auto& visit) {
        for (int dy = -window_radius; dy <= window_radius; ++dy)
            for (int dx = -window_radius; dx <= window_radius; ++dx) {
                compare_shapes(dx, dy);
                for (std::size_t h = 0; h < 2; ++h)
                    for (std::size_t kind = 0; kind < noisy_kinds(layers_); ++kind) {
                        compare_light(halves_[1 - h][kind], dx, dy);
                        visit_rows(dx, dy, [&](int x, int y, std::size_t k, std::span<const float> weight) {
                            visit(h, kind, x, y, k, weight);
                        });
                    }
            }
    }

    std::size_t at(int x, int y) const { return pixel_at(x, y, width_); }
    /// Index in difference_, whose rows have an additional column at both ends. Its row 0 is row first_ - block_radius
    /// of the picture.
    std::size_t padded(int x, int row) const { return pixel_at(x + 1, row, width_ + 2); }
    std::pair<int, int> columns(int dx) const { return {std::max(0, -dx), std::min(width_, width_ - dx)}; }
    bool has_row(int y) const { return y >= 0 && y < height_; }

    /// Sets shape_ to the weights of the surfaces of all pairs.
    void compare_shapes(int dx, int dy) {
        std::fill(shape_.begin(), shape_.end(), 0.0f);
        const float steps = distance_of(dx, dy);
        const auto [begin, end] = columns(dx);
        if (begin >= end) return;
        for (int y = first_; y < end_; ++y) {
            if (!has_row(y + dy)) continue;
            const auto row = std::span(shape_).subspan(at(begin, y - first_), static_cast<std::size_t>(end - begin));
            surfaces_.weigh(at(begin, y), at(begin + dx, y + dy), steps, row);
        }
    }

    /// Sets difference_ to the squared differences of the light, relative to its noise.
    void compare_light(const Field& field, int dx, int dy) {
        constexpr float tiny = 1e-20f;
        std::fill(difference_.begin(), difference_.end(), 0.0f);
        const auto [begin, end] = columns(dx);
        for (int y = first_ - block_radius; y < end_ + block_radius; ++y) {
            if (!has_row(y) || !has_row(y + dy)) continue;
            float* row = &difference_[padded(0, y - first_ + block_radius)];
            const std::size_t i = at(0, y), k = at(0, y + dy) + static_cast<std::size_t>(dx);
            for (int x = begin; x < end; ++x) {
                const auto c = static_cast<std::size_t>(x);
                const float d = field.grey[i + c] - field.grey[k + c];
                const float here = field.variance[i + c], there = field.variance[k + c];
                row[x] = (d * d - (here + there)) / (noise_share * (here + there) + tiny);
            }
        }
    }

    void visit_rows(int dx, int dy, const auto& visit) const {
        const auto [begin, end] = columns(dx);
        std::array<float, per_chunk> weight{};  // cannot overlap the vectors, so a compiler can use vector code
        for (int y = first_; y < end_; ++y)
            if (has_row(y + dy))
                for (int x = begin; x < end; x += per_chunk) {
                    const int count = std::min(per_chunk, end - x);
                    weigh_row(x, y, count, weight);
                    visit(x, y, at(x + dx, y + dy), std::span(weight).first(static_cast<std::size_t>(count)));
                }
    }

    /// Computes the weights of `count` pairs, whose first pixels are (x, y), (x + 1, y), ..., from the mean of
    /// difference_ over blocks of 3 x 3 pixels, and shape_.
    void weigh_row(int x, int y, int count, std::array<float, per_chunk>& weight) const {
        const std::size_t first = at(x, y - first_);
        const float* above = &difference_[padded(x, y - first_)];
        const float *level = above + width_ + 2, *below = level + width_ + 2;
        for (int n = 0; n < count; ++n) {
            float d = 0;
            for (const float* row : {above, level, below}) d += row[n - 1] + row[n] + row[n + 1];
            weight[static_cast<std::size_t>(n)] = exp_minus(std::max(0.0f, d / 9));
        }
        for (std::size_t n = 0; n < static_cast<std::size_t>(count); ++n) weight[n] *= shape_[first + n];
    }

    const PictureLayers& layers_;
    const Surfaces& surfaces_;
    const std::array<Fields, 2>& halves_;
    int width_, height_;
    int first_, end_;  // rows of the band
    std::vector<float> difference_, shape_;
};

/// Returns the light before filtering: the mean irradiance of both halves, over pi.
Image noisy_irradiance(const PictureLayers& layers, const std::array<Fields, 2>& halves) {
    Image irradiance(layers.albedo.width, layers.albedo.height);
    for (std::size_t i = 0; i < irradiance.pixels.size(); ++i)
        for (const Fields& half : halves)
            for (std::size_t kind = 0; kind < noisy_kinds(layers); ++kind) {
                const auto& value = half[kind].value;
                irradiance.pixels[i] += Rgb(value[0][i], value[1][i], value[2][i]) / 2;
            }
    return irradiance;
}

/// Adds the difference between noisy and filtered light, averaged over 9 x 9 pixels on the same surface, because the
/// filter blurs variations below the noise, such as a faint shadow. As in Band, pairs exchange light.
void return_means(const Surfaces& surfaces, const Image& noisy, Image& filtered) {
    Image difference = noisy;
    for (std::size_t i = 0; i < difference.pixels.size(); ++i) difference.pixels[i] -= filtered.pixels[i];
    std::vector<float> sum(difference.pixels.size());
    for_pixels(surfaces, [&](std::size_t i, int x, int y) {
        visit_surface(surfaces, x, y, mean_radius, [&](std::size_t, float w) { sum[i] += w; });
    });
    for_pixels(surfaces, [&](std::size_t i, int x, int y) {
        Rgb mean = difference.pixels[i];
        visit_surface(surfaces, x, y, mean_radius, [&](std::size_t k, float w) {
            if (w > 0) mean += (w / std::max(sum[i], sum[k])) * (difference.pixels[k] - difference.pixels[i]);
        });
        filtered.pixels[i] += mean;
    });
}

}  // namespace

Image own_filter(const PictureLayers& layers) {
    const auto height = static_cast<std::size_t>(layers.albedo.height);
    const Surfaces surfaces(layers);
    const std::array<Fields, 2> halves{make_fields(layers, surfaces, layers.halves[0]),
                                       make_fields(layers, surfaces, layers.halves[1])};
    const auto visit_bands = [&](const auto& visit) {
        constexpr std::size_t rows = 16;
        parallel_for_ranges(height, rows, [&](std::size_t begin, std::size_t end) {
            Band band(layers, surfaces, halves, static_cast<int>(begin), static_cast<int>(end));
            visit(band);
        });
    };
    WeightSums sums;
    for (auto& of_half : sums)
        for (std::vector<float>& of_kind : of_half) of_kind.assign(layers.depth.size(), 0.0f);
    visit_bands([&](Band& band) { band.sum_weights(sums); });
    const Image noisy = noisy_irradiance(layers, halves);
    Image irradiance = noisy;
    visit_bands([&](Band& band) { band.filter(sums, irradiance); });
    return_means(surfaces, noisy, irradiance);

    Image picture = layers.emitted;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        if (layers.is_indirect_interpolated) picture.pixels[i] += layers.reflected.indirect.pixels[i];
        if (layers.depth[i] > 0) picture.pixels[i] += irradiance.pixels[i] * floored(layers.albedo.pixels[i]);
    }
    return picture;
}

}  // namespace interflect::detail
